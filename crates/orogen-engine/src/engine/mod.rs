//! The engine, which runs plans.

mod exactness;
mod executor;
mod grids;
pub(crate) mod inline;
mod level_tiles;
mod on_device;
pub(crate) mod preview;
mod refine;
pub(crate) mod run;
mod solve;
mod tiles;
mod volume;
