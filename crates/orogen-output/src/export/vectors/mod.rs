//! The layers of vector features, one a file. A file that declares `pub static LAYER: VectorLayer` is one, and joins the list by existing.

// The list below is written by `cargo xtask codegen`.
pub mod coast;
pub mod contours;
pub mod lakes;
pub mod rivers;
pub mod summits;
pub mod watersheds;
