//! Sum of two.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// a + b, in the unit the two share.
    pub struct Add = "add", field, revision 1;
    inputs {
        /// One.
        a: required,
        /// The other.
        b: required,
    }
}

impl Field for Add {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0), Term::Name(1), Term::Apply(Function::Add, [0, 1, 0])])
    }
}
