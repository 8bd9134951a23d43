//! The layer `hillshade`.

use super::layer::{Derived, Made, NodeLayer};
use super::params;
use crate::options::OptionSpec;
use orogen_engine::filter::Hillshade;
use std::sync::LazyLock;

/// The options: the parameters of the op.
static OPTIONS: LazyLock<Vec<OptionSpec>> = LazyLock::new(params::options::<Hillshade>);

/// The layer.
pub static LAYER: Derived = Derived {
    name: "hillshade",
    about: "hillshade: light from the north-west at 45 degrees altitude (--azimuth, --altitude), slope by Horn's method; 1 is full light, 0 none",
    palette: "grey",
    options: || &OPTIONS,
    made: Made::Nodes(
        NodeLayer::new(|to| {
            let source = to.extrapolated(1);
            let op: Hillshade = params::given(to.options())?;
            Ok(to.add(Hillshade { source, ..op }).layer("hillshade"))
        })
        // Missing heights are dark.
        .counting_heights(),
    ),
};
