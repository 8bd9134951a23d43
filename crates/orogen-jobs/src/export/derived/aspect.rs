//! The layer `aspect`.

use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::Aspect;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "aspect",
    about: "aspect: downhill direction in degrees clockwise from north; NaN on level ground",
    palette: "aspect",
    options: || &[],
    made: Made::Nodes(
        NodeLayer::new(|to| {
            let source = to.extrapolated(1);
            Ok(to.add(Aspect { source }).layer("aspect"))
        })
        .counting_heights(),
    ),
};
