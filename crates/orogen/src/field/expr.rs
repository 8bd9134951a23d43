//! Arithmetic in a line of text.

use crate::declare::{Input, set_named};
use crate::expression::term::{Expression, Term};
use crate::op::Field;

op! {
    /// The value of an expression, such as "a * smoothstep(0, 1, b) + height^0.5".
    ///
    /// A name in it is an input: a key of the node of that name says what it reads, and without one it is the parameter or else the node (or
    /// `node.layer`) of that name. Operators, from loose to tight: `< <= > >= == !=` (1 where they hold, else 0), `+ -`, `* / %` (`%` is the remainder of
    /// a division rounded down), a sign, and `^` (from the right). `pi` and `tau` are numbers. The functions are
    /// `min max clamp mix lerp smoothstep step smin smax abs sign floor ceil round fract sqrt exp log log2 log10 pow sin cos tan asin acos atan atan2 tanh hypot`;
    /// angles are radians.
    ///
    /// An expression is made of the same instructions as the ops `add`, `multiply`, `mix`, `min`, `max` and `clamp`: the same bits in the same time.
    /// Powers with the exponents 0.5, 2, 3 and 4 are roots and products. Numbers are f32; a division by 0 is infinite, the root of a negative number
    /// is no number.
    pub struct Expr = "expr", field, revision 1;
    inputs of expr;
    params {
        /// The expression.
        expr: Expression = Expression::default();
    }
    check |op| match (op.expr.fault(), op.inputs.iter().find(|(name, _)| !op.expr.names().contains(name))) {
        (Some(fault), _) => Err(("expr", fault.message.clone())),
        (None, Some((name, _))) => Err(("expr", format!("`{name}` is given, but the expression does not name it"))),
        (None, None) => Ok(()),
    };
}

impl Expr {
    /// An expression in which every name is the node or layer of that name.
    pub fn new(expression: &str) -> Expr {
        let expr = Expression::from(expression);
        let inputs = expr.names().iter().map(|name| (name.clone(), Input::from(name))).collect();
        Expr { expr, inputs }
    }

    /// The same with something else for a name.
    pub fn with(mut self, name: &str, input: impl Into<Input>) -> Expr {
        set_named(&mut self.inputs, self.expr.names(), name.to_string(), input.into());
        self
    }
}

impl Field for Expr {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(self.expr.terms().to_vec())
    }

    fn cost(&self) -> f64 {
        let functions = self.expr.terms().iter().map(|term| match term {
            Term::Apply(function, _) => function.cost(),
            Term::Number(_) | Term::Name(_) => 0.0,
        });
        functions.sum()
    }
}
