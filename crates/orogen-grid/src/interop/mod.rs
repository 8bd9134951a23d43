//! Grids as what other crates of the field take and return, each behind a feature of its name that is off by default.
//!
//! Points are plain arrays (`[f64; 2]`, `[f32; 3]`), which the types of `mint` are made from with `into()`; they need no feature.

#[cfg(feature = "image")]
mod image;
#[cfg(feature = "ndarray")]
mod ndarray;
