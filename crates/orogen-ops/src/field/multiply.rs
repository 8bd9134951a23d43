//! Product of two fields.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// The product a * b.
    pub struct Multiply = "multiply", field, revision 1;
    inputs {
        /// First factor.
        a: required,
        /// Second factor.
        b: required,
    }
}

impl Field for Multiply {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0), Term::Name(1), Term::Apply(Function::Multiply, [0, 1, 0])])
    }
}
