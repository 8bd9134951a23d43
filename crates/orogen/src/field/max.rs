//! The greater of two, with a rounded seam if asked.

use super::seam::rounded;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// The greater of a and b; with `smooth` above 0 the seam between them is rounded.
    ///
    /// The rounded form is the quadratic polynomial: with h = max(0, smooth - |a - b|) / smooth, the result is
    /// max(a, b) + h^2 smooth / 4 (Quilez, "Smooth minimum").
    pub struct Max = "max", field, revision 1;
    inputs {
        /// One.
        a: required,
        /// The other.
        b: required,
    }
    params {
        /// Difference of the two up to which their seam is rounded, in their unit.
        smooth: f64 = 0.0, range 0.0 to 1e9;
    }
}

impl Field for Max {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        rounded(out, inputs.required(0), inputs.required(1), self.smooth as f32, -1.0);
    }
}
