//! Product of two.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// a * b: scales one by the other.
    pub struct Multiply = "multiply", field, revision 1;
    inputs {
        /// One.
        a: required,
        /// The other.
        b: required,
    }
}

impl Field for Multiply {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0), Term::Name(1), Term::Apply(Function::Multiply, [0, 1, 0])])
    }
}
