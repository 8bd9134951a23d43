//! The formats, one a file. A file that declares `pub static FORMAT: Format` is one, and joins the registry by existing.

// The list below is written by `cargo xtask codegen`.
pub mod npy;
pub mod png;
pub mod tif;
