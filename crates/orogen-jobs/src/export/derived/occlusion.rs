//! The layer `occlusion`.

use super::appended::{Appended, AppendedNode};
use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::Occlusion;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "occlusion",
    about: "ambient occlusion: visible share of the sky within 1000 m or 128 samples; 1 on open ground",
    palette: "grey",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("occlusion")))),
};

/// Appends the node. Beyond the world the sky is open.
pub fn append(to: &mut Appended) -> AppendedNode {
    let source = to.extrapolated(0);
    to.add(Occlusion { source, ..Occlusion::default() })
}
