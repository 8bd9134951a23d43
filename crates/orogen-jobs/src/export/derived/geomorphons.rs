//! The layer `landforms`.

use super::layer::{Derived, Made, NodeLayer};
use crate::options::{OptionSpec, ValueKind};
use orogen_engine::filter::Geomorphons;

/// Option for the search radius, in metres.
const REACH: OptionSpec = OptionSpec::new("reach", "M", ValueKind::Number(0.0, 1e6))
    .with_about("Search radius of geomorphons, in metres [default: 500]");

/// Option for the angle up to which ground is level, in degrees.
const FLAT: OptionSpec = OptionSpec::new("flat", "DEG", ValueKind::Number(0.0, 45.0))
    .with_about("Flatness threshold of geomorphons, in degrees [default: 1]");

/// The layer.
pub static LAYER: Derived = Derived {
    name: "landforms",
    about: "landforms (geomorphons): 1 flat, 2 peak, 3 ridge, 4 shoulder, 5 spur, 6 slope, 7 hollow, 8 footslope, 9 valley, 10 pit",
    palette: "turbo",
    options: || &[REACH, FLAT],
    made: Made::Nodes(NodeLayer::new(|to| {
        let (options, defaults) = (to.options(), Geomorphons::default());
        let reach = options.number(REACH.name).unwrap_or(defaults.reach);
        let flat = options.number(FLAT.name).unwrap_or(defaults.flat);
        let source = to.heights();
        Ok(to.add(Geomorphons { source, reach, flat, ..defaults }).layer("form"))
    })),
};
