//! Layers derived from the heights, available for every recipe. Each has its own file; [`list`] lists them.

pub mod albedo;
pub(crate) mod appended;
pub mod array;
pub(crate) mod aspect;
pub(crate) mod cover;
pub(crate) mod curvature;
pub(crate) mod drainage;
pub(crate) mod geomorphons;
pub(crate) mod height_above_drainage;
pub(crate) mod hillshade;
pub(crate) mod insolation;
pub mod layer;
pub mod list;
pub(crate) mod normal;
pub(crate) mod occlusion;
pub(crate) mod params;
pub(crate) mod position;
pub mod roughness;
pub mod rows;
pub(crate) mod ruggedness;
pub(crate) mod slope;
pub(crate) mod soil_depth;
pub(crate) mod splat;
pub(crate) mod viewshed;
pub(crate) mod wetness;
