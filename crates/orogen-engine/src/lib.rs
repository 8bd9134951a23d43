//! The engine.
#![forbid(unsafe_code)]

#[macro_use]
pub mod declare;

pub mod bands;
pub mod budget;
pub mod chunks;
mod engine;
pub mod expression;
pub mod field;
pub mod filter;
pub mod growth;
#[doc(hidden)]
pub mod large;
pub mod layer;
pub mod node;
pub mod op;
pub mod plan;
mod pool;
pub mod recipe;
pub mod sampler;
pub mod session;
pub mod solver;
pub mod store;
pub mod tiles;
pub mod value;
pub mod world;
