//! The engine, which runs plans.

mod exactness;
pub(crate) mod inline;
pub(crate) mod interpreter;
mod level_tiles;
mod on_device;
mod refine;
pub(crate) mod run;
mod solve;
mod tiles;
mod volume;
