//! The layer `tri`.

use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::Ruggedness;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "tri",
    about: "terrain ruggedness index in m (Riley, DeGloria and Elliot 1999)",
    palette: "magma",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(to.add(Ruggedness { source: to.heights() }).layer("ruggedness")))),
};
