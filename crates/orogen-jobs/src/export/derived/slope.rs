//! The layer `slope`.

use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::Slope;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "slope",
    about: "slope in degrees, by Horn's 3 x 3 method",
    palette: "slope",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| {
        let source = to.extrapolated(1);
        Ok(to.add(Slope { source, ..Slope::default() }).layer("slope"))
    })),
};
