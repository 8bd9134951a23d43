//! Erosion by local rules: slopes slide, water flows and carries sediment.
//!
//! Pure functions on grids. The result at a sample depends only on the samples within a fixed reach, so any window
//! grown by that reach gives the same bits; the filters of the same names request exactly that halo.

pub mod brush;
pub mod droplet_paths;
pub mod droplets;
pub mod local_stream_power;
pub mod loose;
pub mod pipe_rows;
pub mod pipes;
pub mod planes;
pub mod power;
pub mod rows;
pub mod thermal;
