//! The maximum of two fields, with an optional rounded seam.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// The maximum of a and b. With `smooth` above 0 the seam between them is rounded.
    ///
    /// Rounded form (quadratic polynomial): max(a, b) + h^2 smooth / 4 with h = max(0, smooth - |a - b|) / smooth
    /// (Quilez, "Smooth minimum").
    pub struct Max = "max", field, revision 1;
    inputs {
        /// First value.
        a: required,
        /// Second value.
        b: required,
    }
    params {
        /// Difference of a and b below which the seam is rounded, in their unit.
        smooth: f64 = 0.0, range 0.0 to 1e9;
    }
}

impl Field for Max {
    fn terms(&self) -> Option<Vec<Term>> {
        let seam = Term::Number(self.smooth);
        Some(match self.smooth > 0.0 {
            true => vec![Term::Name(0), Term::Name(1), seam, Term::Apply(Function::SmoothMax, [0, 1, 2])],
            false => vec![Term::Name(0), Term::Name(1), Term::Apply(Function::Max, [0, 1, 0])],
        })
    }
}
