//! The engine, which runs plans.

pub(crate) mod inline;
pub(crate) mod interpreter;
mod refine;
pub(crate) mod run;
mod solve;
mod tiles;
