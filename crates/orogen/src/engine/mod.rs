//! The engine: runs plans.

pub mod alone;
pub mod machine;
pub mod run;
mod solve;
mod tiles;
