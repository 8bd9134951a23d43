//! Layers that a recipe need not have: what follows from its heights. One file each, and [`list`] names them.

pub mod albedo;
pub mod aspect;
pub mod cover;
pub mod curvature;
pub mod hillshade;
pub mod layer;
pub mod list;
pub mod normal;
pub mod occlusion;
pub mod roughness;
pub mod rows;
pub mod slope;
pub mod splat;
