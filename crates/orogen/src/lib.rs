//! Orogen: a recipe describes a world; the engine makes any window of it, at any resolution, always the same.
#![forbid(unsafe_code)]

pub mod analysis;
pub mod error;
pub mod file;
pub mod format;
pub mod grid;
pub mod map;
pub mod palette;

pub use error::{Error, ErrorKind, Result};
pub use grid::{Grid, Window};
