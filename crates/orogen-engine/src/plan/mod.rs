//! Plans: the steps of a computation, their order and their memory, known before any sample is made.

mod compile;
pub(crate) mod cost;
pub mod domain;
pub(crate) mod explain;
mod grid_merge;
pub(crate) mod key;
pub(crate) mod memory;
pub mod planner;
pub mod program;
pub mod steps;
