//! Terrain analysis: pure functions from grids to grids and numbers.

#[doc(hidden)]
pub mod aspect;
#[doc(hidden)]
pub mod clear_sky;
#[doc(hidden)]
pub mod curvature;
#[doc(hidden)]
pub mod distance;
#[doc(hidden)]
pub mod finite;
#[doc(hidden)]
pub mod fourier;
#[doc(hidden)]
pub mod geomorphons;
#[doc(hidden)]
pub mod halo;
#[doc(hidden)]
pub mod hillshade;
#[doc(hidden)]
pub mod hypsometry;
#[doc(hidden)]
pub mod insolation;
#[doc(hidden)]
pub mod nine;
#[doc(hidden)]
pub mod patches;
#[doc(hidden)]
pub mod position;
#[doc(hidden)]
pub mod roughness;
#[doc(hidden)]
pub mod selection;
#[doc(hidden)]
pub mod shadow;
#[doc(hidden)]
pub mod sky;
#[doc(hidden)]
pub mod slope;
#[doc(hidden)]
pub mod soil;
#[doc(hidden)]
pub mod spectrum;
#[doc(hidden)]
pub mod summary;
#[doc(hidden)]
pub mod sun;
#[doc(hidden)]
pub mod viewshed;

pub use aspect::aspect;
pub use curvature::{Curvature, curvature};
#[doc(hidden)]
pub use finite::FiniteCount;
pub use geomorphons::{FORMS, Look, geomorphons};
pub use hillshade::{Light, hillshade};
pub use hypsometry::{hypsometric_curve, hypsometric_integral};
pub use insolation::{Period, insolation};
pub use position::{Position, positions};
pub use roughness::{riley, ruggedness};
#[doc(hidden)]
pub use shadow::Shadows;
pub use sky::sky_view;
pub use slope::{Gradient, gradients, normals, slope_degrees, steepness};
pub use soil::Soil;
pub use spectrum::{Band, hurst, spectral_slope, spectrum};
pub use summary::{Summary, summary};
pub use sun::Moment;
pub use viewshed::{Observer, viewshed};
