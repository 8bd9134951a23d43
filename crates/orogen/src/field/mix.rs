//! From one to another.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// a where `amount` is 0, b where it is 1, and in between in proportion: a + (b - a) * amount.
    ///
    /// The amount is cut to 0 ..= 1.
    pub struct Mix = "mix", field, revision 1;
    inputs {
        /// Shows where the amount is 0.
        a: required,
        /// Shows where the amount is 1.
        b: required,
        /// How much of b.
        amount: required,
    }
}

impl Field for Mix {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0), Term::Name(1), Term::Name(2), Term::Apply(Function::Mix, [0, 1, 2])])
    }
}
