//! Vector features out of heights: what is asked for (`options`, `layer`), the ground that it is made of (`ground`), and layers ready to be written
//! (`drawing`). The layers themselves are in `vectors`.

pub(crate) mod drawing;
pub(crate) mod layer;
pub mod list;
pub mod options;
pub mod source;
pub(crate) mod svg;
