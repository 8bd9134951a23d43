//! Diffusion-limited aggregation: branching clusters of random walkers that stick together, and mountains from them.

#[doc(hidden)]
pub mod relief;
#[doc(hidden)]
pub mod single;
#[doc(hidden)]
pub mod tree;

pub use relief::{Ridges, ridge_heights};
pub use single::aggregate;
pub use tree::Tree;
