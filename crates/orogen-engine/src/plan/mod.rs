//! Plans: the steps of a computation, their order and their memory, known before any sample is made.

mod allocate;
mod arithmetic;
mod around;
mod assemble;
mod compile;
mod coord_sets;
pub(crate) mod cost;
pub mod domain;
pub(crate) mod explain;
mod grid_merge;
mod keep;
pub(crate) mod key;
pub(crate) mod levels;
pub(crate) mod memory;
pub(crate) mod parts;
pub mod planner;
mod request;
mod schedule;
mod solves;
mod space;
pub(crate) mod split;
pub mod steps;
mod stored;

#[doc(inline)]
pub use orogen_ops::program;
