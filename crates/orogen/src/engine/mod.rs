//! The engine: runs plans.

pub mod machine;
pub mod run;
mod solve;
