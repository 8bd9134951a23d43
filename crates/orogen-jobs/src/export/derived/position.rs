//! Layers of topographic position.

use super::appended::{Appended, AppendedNode};
use super::layer::{Derived, Made, NodeLayer};
use crate::options::{OptionSpec, ValueKind};
use orogen_engine::filter::TopographicPosition;

/// Option for the radius of the disc, in metres.
const RADIUS: OptionSpec = OptionSpec::new("disc", "M", ValueKind::Number(0.0, 1e6))
    .with_about("Radius of the disc, in metres [default: 300]");

/// Appends the node.
fn append(to: &mut Appended) -> AppendedNode {
    let (source, defaults) = (to.heights(), TopographicPosition::default());
    let radius = to.options().number(RADIUS.name).unwrap_or(defaults.radius);
    to.add(TopographicPosition { source, radius })
}

/// The layer `tpi`.
pub static POSITION: Derived = Derived {
    name: "tpi",
    about: "topographic position index: height above the mean of a disc, in m (Weiss 2001)",
    palette: "oleron",
    options: || &[RADIUS],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("position")))),
};

/// The layer `slope-position`.
pub static CLASS: Derived = Derived {
    name: "slope-position",
    about: "slope position (Weiss 2001): 1 ridge, 2 upper slope, 3 middle slope, 4 flat, 5 lower slope, 6 valley",
    palette: "turbo",
    options: || &[RADIUS],
    made: Made::Nodes(NodeLayer::new(|to| Ok(append(to).layer("class")))),
};
