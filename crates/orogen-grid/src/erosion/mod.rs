//! Ground wears away by rules that look at a finite neighbourhood: slopes slide, water runs and carries sediment.
//!
//! Pure functions on grids. What a rule makes at a sample depends on the samples within its reach alone, so any window
//! grown by that reach gives the same bits; the filters of the same names ask for just so much.

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
