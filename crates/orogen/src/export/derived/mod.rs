//! Layers that a recipe need not have: what follows from its heights. One file each, and [`list`] names them.

pub mod aspect;
pub mod curvature;
pub mod hillshade;
pub mod layer;
pub mod list;
pub mod normal;
pub mod occlusion;
pub mod rows;
pub mod slope;
pub mod splat;
