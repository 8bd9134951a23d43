//! Layers of the height and distance above streams.

use super::appended::{Appended, AppendedNode, STREAM};
use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::solver::HeightAboveDrainage;

/// Appends the node.
fn append(to: &mut Appended) -> AppendedNode {
    let (source, stream) = (to.heights(), to.stream());
    to.add(HeightAboveDrainage { source, stream, ..HeightAboveDrainage::default() })
}

/// The layer `height-above-drainage`.
pub static HEIGHT_ABOVE: Derived = Derived {
    name: "height-above-drainage",
    about: "height above nearest drainage (HAND) in m: above the stream that the ground drains to",
    palette: "batlow",
    options: || &[STREAM],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("height"))).bounded()),
};

/// The layer `flow-distance`.
pub static FLOW_DISTANCE: Derived = Derived {
    name: "flow-distance",
    about: "length of the flow path to the stream that the ground drains to, in m",
    palette: "viridis",
    options: || &[STREAM],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("flow_distance"))).bounded()),
};

/// The layer `stream-distance`.
pub static STREAM_DISTANCE: Derived = Derived {
    name: "stream-distance",
    about: "straight-line distance to the nearest stream, in m",
    palette: "viridis",
    options: || &[STREAM],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("distance"))).bounded()),
};
