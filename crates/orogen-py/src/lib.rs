//! The native part of the Python package `orogen`: calls of the library with numbers, text and arrays. Names, defaults,
//! conversions and docs are in the Python part (`python/orogen`), which is the only user of this module.
#![forbid(unsafe_code)]

mod array;
mod contours;
mod erosion;
mod failure;
mod hydrology;
mod jobs;
mod layer;
mod noise;
mod options;
mod output;
mod run;
mod world;

use pyo3::prelude::*;

/// The native part of the package `orogen`.
#[pymodule(gil_used = false)]
mod _orogen {
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        #[cfg(feature = "remote")]
        orogen::remote::mount();
        Ok(())
    }

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use super::contours::contours;
    #[pymodule_export]
    use super::erosion::{droplets, pipes, stream_power, thermal};
    #[pymodule_export]
    use super::hydrology::{above_drainage, accumulate, breach, fill, flow_direction, lakes, stream_order, watersheds};
    #[pymodule_export]
    use super::jobs::write;
    #[pymodule_export]
    use super::layer::layer;
    #[pymodule_export]
    use super::noise::noise;
    #[pymodule_export]
    use super::options::{declared, derived_layers};
    #[pymodule_export]
    use super::world::{Points, World, cache_folder, fit, memory_of, presets};
}
