//! Measures whether water is consistent on a mosaic of tiles that are made separately and joined without any repair.
//!
//! Reads the layers `height` (the bed, in m), `flow` (drainage area, in m²) and, if the recipe has them, `lakes` (depth
//! of standing water, in m; or numbers of lakes, with their water surface in the layer `surface`) and `receiver` (flow
//! direction, clockwise from east). The sea is where the bed is below the sea level.
//!
//! `water_mosaics.rs` tests it; `cargo xtask bench water` runs it for any recipe.

pub mod agreement;
pub mod beds;
pub mod borders;
pub mod depressions;
pub mod faults;
pub mod lakes;
pub mod layers;
pub mod mosaic;
pub mod network;
pub mod report;
