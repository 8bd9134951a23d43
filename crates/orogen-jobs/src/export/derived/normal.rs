//! The layer `normal`.

use super::appended::AppendedNode;
use super::layer::{Channels, Derived, Made, Nature};
use orogen_engine::filter::Normal;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "normal",
    about: "normal map: components of the surface normal to the east, north and up",
    palette: "",
    options: || &[],
    made: Made::Channels(Channels {
        nature: Nature::Normal,
        names: |_| ["X", "Y", "Z"].map(String::from).to_vec(),
        prepare: |to| {
            let source = to.extrapolated(1);
            to.add(Normal { source });
        },
        layers: |_| ["east", "north", "up"].map(|layer| AppendedNode::of("normal").name_of(layer)).to_vec(),
        make: None,
    }),
};
