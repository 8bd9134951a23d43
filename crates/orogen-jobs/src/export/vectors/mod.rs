//! The layers of vector features, one per file. Every file that declares `pub static LAYER: VectorLayer` is included in
//! the list.

// The list below is written by `cargo xtask codegen`.
pub mod coast;
pub mod contours;
pub mod lakes;
pub mod rivers;
pub mod roads;
pub mod scatter;
pub mod summits;
pub mod watershed;
pub mod watersheds;
