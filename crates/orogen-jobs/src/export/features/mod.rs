//! Vector features from heights: options (`options`, `outlets`, `layer`), the terrain that they are made of (`source`;
//! `ground`: that of an area), and layers prepared for writing (`drawing`). The layers are in `vectors`.

pub(crate) mod drawing;
pub(crate) mod ground;
pub(crate) mod layer;
pub mod list;
pub mod options;
pub mod outlets;
pub mod source;
pub(crate) mod svg;
