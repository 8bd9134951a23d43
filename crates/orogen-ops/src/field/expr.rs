//! Arithmetic expressions.

use crate::declare::{Input, set_named};
use crate::expression::term::Term;
use crate::expression::text::Expression;
use crate::op::Field;

op! {
    /// The value of an expression, such as "a * smoothstep(0, 1, b) + height^0.5".
    ///
    /// Each name in the expression is an input. If the node has a key of that name, the key's value is the input;
    /// otherwise the input is the parameter, the node or the layer (`node.layer`) of that name. Operators, from lowest
    /// to highest precedence: `< <= > >= == !=` (1 if true, else 0), `+ -`, `* / %` (`%` is the remainder of floored
    /// division), unary sign, and `^` (right-associative). `pi` and `tau` are constants. Functions: `min max clamp mix
    /// lerp smoothstep step smin smax abs sign floor ceil round fract sqrt exp log log2 log10 pow sin cos tan asin acos
    /// atan atan2 tanh hypot`; angles are in radians.
    ///
    /// Expressions compile to the same instructions as the ops `add`, `multiply`, `mix`, `min`, `max` and `clamp`, with
    /// the same bits and the same cost. Powers with the exponents 0.5, 2, 3 and 4 are computed as roots and products.
    /// Values are f32; a division by 0 is infinite, and the root of a negative number is NaN.
    pub struct Expr = "expr", field, revision 1;
    inputs of expr;
    params {
        /// The expression.
        expr: Expression = Expression::default();
    }
    check |op| match (op.expr.error(), op.inputs.iter().find(|(name, _)| !op.expr.names().contains(name))) {
        (Some(fault), _) => Err(("expr", fault.message.clone())),
        (None, Some((name, _))) => Err(("expr", format!("`{name}` is set, but the expression does not use it"))),
        (None, None) => Ok(()),
    };
}

impl Expr {
    /// An expression in which every name is the node or layer of that name.
    #[must_use]
    pub fn new(expression: &str) -> Expr {
        let expr = Expression::from(expression);
        let inputs = expr.names().iter().map(|name| (name.clone(), Input::from(name))).collect();
        Expr { expr, inputs }
    }

    /// Replaces the input for a name.
    pub fn with(mut self, name: &str, input: impl Into<Input>) -> Expr {
        set_named(&mut self.inputs, self.expr.names(), name, input.into());
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
