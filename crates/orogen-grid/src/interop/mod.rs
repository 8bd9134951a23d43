//! Conversions to and from types of other crates. Each has a feature with the crate's name, which is off by default.
//!
//! Points in results are plain arrays (`[f64; 2]`, `[f32; 3]`); types of `mint` convert from them with `into()`,
//! without a feature.

#[cfg(feature = "image")]
mod image;
#[cfg(feature = "mint")]
mod mint;
#[cfg(feature = "ndarray")]
mod ndarray;
