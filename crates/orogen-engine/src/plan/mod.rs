//! Plans: the steps of a computation, their order and their memory, known before any sample is made.

mod allocate;
mod arithmetic;
mod around;
mod assemble;
mod compile;
mod coord_sets;
pub(crate) mod cost;
#[doc(hidden)]
pub mod domain;
pub(crate) mod explain;
mod grid_merge;
mod keep;
pub(crate) mod key;
pub(crate) mod levels;
pub(crate) mod memory;
pub(crate) mod parts;
#[doc(hidden)]
pub mod planner;
mod request;
pub(crate) mod resolved;
mod schedule;
mod solves;
mod space;
pub(crate) mod split;
#[doc(hidden)]
pub mod steps;
mod stored;

pub use steps::Plan;

#[doc(hidden)]
pub use orogen_ops::program;
