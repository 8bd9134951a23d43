//! Where a recipe that is used by another reads what it is given.

use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// An input of the recipe: its source, or what a recipe that uses this one gives.
    ///
    /// A recipe with `[use.NAME]` and `inputs = { this = "hills" }` has its node `hills` in place of the source of the node `this`. It computes nothing: reading it is reading
    /// its source.
    pub struct GraphInput = "input", field, revision 1;
    inputs {
        /// What it is where nothing is given; without it, 0.
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
