//! Layers derived from the heights, available for every recipe. One file each; [`list`] names them.

pub mod albedo;
pub mod appended;
pub mod aspect;
pub mod cover;
pub mod curvature;
pub mod drainage;
pub mod geomorphons;
pub mod height_above_drainage;
pub mod hillshade;
pub mod insolation;
pub mod layer;
pub mod list;
pub mod normal;
pub mod occlusion;
pub mod position;
pub mod roughness;
pub mod rows;
pub mod ruggedness;
pub mod slope;
pub mod soil_depth;
pub mod splat;
pub mod viewshed;
pub mod wetness;
