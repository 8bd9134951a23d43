//! The engine, which runs plans.

pub mod inline;
pub mod interpreter;
pub mod run;
mod solve;
mod tiles;
