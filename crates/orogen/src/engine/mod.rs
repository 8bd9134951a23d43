//! The engine: runs plans.

mod machine;
pub mod run;
mod tiles;
