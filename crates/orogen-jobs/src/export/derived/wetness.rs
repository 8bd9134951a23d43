//! Layers of indices of drainage area and slope.

use super::appended::{Appended, AppendedNode};
use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::FlowIndices;

/// Appends the nodes.
fn append(to: &mut Appended) -> AppendedNode {
    let (source, flow) = (to.heights(), to.drainage().layer("flow"));
    to.add(FlowIndices { source, flow, ..FlowIndices::default() })
}

/// The layer `wetness`.
pub static WETNESS: Derived = Derived {
    name: "wetness",
    about: "topographic wetness index ln(a / tan b) (Beven and Kirkby 1979)",
    palette: "viridis",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("wetness"))).bounded()),
};

/// The layer `stream-power-index`.
pub static STREAM_POWER: Derived = Derived {
    name: "stream-power-index",
    about: "stream power index a tan b, in m (Moore, Grayson and Ladson 1991)",
    palette: "magma",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("stream_power"))).bounded()),
};

/// The layer `ls-factor`.
pub static LS_FACTOR: Derived = Derived {
    name: "ls-factor",
    about: "LS factor of soil erosion (Moore and Burch 1986)",
    palette: "magma",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("ls_factor"))).bounded()),
};
