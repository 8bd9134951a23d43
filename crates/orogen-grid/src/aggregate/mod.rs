//! Diffusion-limited aggregation: branching figures that grow by what wanders into them, and mountains made of them.

pub mod random;
pub mod relief;
pub mod single;
pub mod tree;
