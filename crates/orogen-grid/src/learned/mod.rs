//! Learned detail: a small convolutional network that continues heights at half their cell.
//!
//! The network sees the slopes, bends and roughness of the coarse heights around a sample, in units of the slope there,
//! and hashed noise. What it adds to cubic interpolation is a draw from the land that fits these coarse heights. A
//! sample reads [`Network::halo`] coarse samples on each side, so any window is made independently, and sums have one
//! order, so the bits are the same at every SIMD level.
//!
//! `weights` reads the files of networks, `features` computes what the network sees, `convolution` is its layers, and
//! `network` runs them row by row; `lowered` has their numbers for shaders. `hillslopes` replaces the land between
//! rivers; `rivers` is what the network sees of these. The directory `training/` of the repository makes the weights.

mod convolution;
mod cubic;
mod features;
mod hillslopes;
mod lowered;
mod network;
mod rivers;
#[cfg(test)]
mod tests;
mod weights;

/// Maximum factor of the noise of a draw.
pub const MAX_NOISE: f64 = 2.0;

pub use lowered::Words;
pub use network::{Draw, Network};
pub use rivers::Drained;
