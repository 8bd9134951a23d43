//! Linear interpolation between two fields.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// Linear interpolation from a to b: a + (b - a) * amount.
    ///
    /// The amount is limited to 0 ..= 1.
    pub struct Mix = "mix", field, revision 1;
    inputs {
        /// Result where the amount is 0.
        a: required,
        /// Result where the amount is 1.
        b: required,
        /// Share of b, 0 to 1.
        amount: required,
    }
}

impl Field for Mix {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0), Term::Name(1), Term::Name(2), Term::Apply(Function::Mix, [0, 1, 2])])
    }
}
