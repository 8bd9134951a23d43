//! Filters: ops that read a finite halo around each sample.

// The list below is written by `cargo xtask codegen`.
mod aspect;
mod blur;
mod curvature;
mod distance;
mod droplets;
mod extrapolate;
mod flow_direction;
mod flow_indices;
mod geomorphons;
mod hillshade;
mod local_stream_power;
mod normal;
mod occlusion;
mod pipes;
mod ruggedness;
mod select_aspect;
mod select_curvature;
mod select_slope;
mod slope;
mod soil_depth;
mod thermal;
mod topographic_position;

pub use aspect::Aspect;
pub use blur::Blur;
pub use curvature::Curvature;
pub use distance::Distance;
pub use droplets::Droplets;
pub use extrapolate::Extrapolate;
pub use flow_direction::{FlowCodes, FlowDirection};
pub use flow_indices::FlowIndices;
pub use geomorphons::{Comparison, Geomorphons};
pub use hillshade::Hillshade;
pub use local_stream_power::LocalStreamPower;
pub use normal::Normal;
pub use occlusion::Occlusion;
pub use pipes::Pipes;
pub use ruggedness::Ruggedness;
pub use select_aspect::SelectAspect;
pub use select_curvature::{CurvatureKind, SelectCurvature};
pub use select_slope::SelectSlope;
pub use slope::{Slope, SlopeUnit};
pub use soil_depth::SoilDepth;
pub use thermal::Thermal;
pub use topographic_position::TopographicPosition;
