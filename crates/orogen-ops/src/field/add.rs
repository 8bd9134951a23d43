//! Sum of two fields.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// The sum a + b. Both terms must have the same unit.
    pub struct Add = "add", field, revision 1;
    inputs {
        /// First term.
        a: required,
        /// Second term.
        b: required,
    }
}

impl Field for Add {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0), Term::Name(1), Term::Apply(Function::Add, [0, 1, 0])])
    }
}
