//! Erosion with local rules: slopes slide, and water flows and carries sediment.
//!
//! All functions are pure functions on grids. The result at a sample depends only on the samples within a fixed
//! distance, so any window grown by that distance gives the same bits. The filters of the same names request exactly
//! that halo.

#[doc(hidden)]
pub mod brush;
#[doc(hidden)]
pub mod droplet_paths;
#[doc(hidden)]
pub mod droplets;
#[doc(hidden)]
pub mod local_stream_power;
#[doc(hidden)]
pub mod loose;
#[doc(hidden)]
pub mod pipe_rows;
#[doc(hidden)]
pub mod pipes;
#[doc(hidden)]
pub mod planes;
#[doc(hidden)]
pub mod power;
#[doc(hidden)]
pub mod rows;
#[doc(hidden)]
pub mod thermal;

pub use droplets::Droplets;
pub use local_stream_power::LocalStreamPower;
pub use pipes::Pipes;
pub use thermal::Thermal;
