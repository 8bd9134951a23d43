//! Inputs of a recipe that another recipe uses.

use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// An input of the recipe: its source, or the node that another recipe passes in with `[use.NAME]`.
    ///
    /// If a recipe has `[use.NAME]` with `inputs = { this = "hills" }`, its node `hills` replaces the source of the
    /// node `this`. The op computes nothing: reading it is reading its source.
    pub struct GraphInput = "input", field, revision 1;
    inputs {
        /// Value of the input if nothing is passed in. Default: 0.
        source: optional,
    }
}

impl Field for GraphInput {
    fn terms(&self) -> Option<Vec<Term>> {
        Some(vec![Term::Name(0)])
    }

    fn cost(&self) -> f64 {
        0.0
    }
}
