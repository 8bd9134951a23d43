//! Vector features from heights. `options`, `outlets` and `layer` are options and definitions, `source` is the terrain
//! that features are made from, `ground` has the attributes of an area, and `drawing` prepares layers for writing. The
//! layers are in `vectors`.

pub(crate) mod drawing;
pub(crate) mod ground;
pub(crate) mod layer;
pub mod list;
pub mod options;
pub mod outlets;
pub mod source;
pub(crate) mod svg;
