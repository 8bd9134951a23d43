//! Plans: the steps of a computation, their order and their memory, known before any sample is made.

mod compile;
pub(crate) mod cost;
pub mod explain;
mod grid_merge;
pub mod key;
pub mod memory;
pub mod planner;
pub mod program;
pub mod steps;
