//! Diffusion-limited aggregation: branching clusters of random walkers that stick together, and mountains made of them.

pub mod relief;
pub mod single;
pub mod tree;
