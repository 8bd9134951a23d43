//! The layer `soil-depth`.

use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::SoilDepth;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "soil-depth",
    about: "steady-state soil depth in m, where production balances creep (Heimsath and others 1997)",
    palette: "batlow",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| {
        let source = to.heights();
        Ok(to.add(SoilDepth { source, ..SoilDepth::default() }).layer("depth"))
    })),
};
