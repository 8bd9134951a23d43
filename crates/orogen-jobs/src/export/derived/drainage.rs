//! Layers of drainage: filled heights, area, direction, order, watersheds.

use super::appended::STREAM;
use super::layer::{Derived, Made, NodeLayer};
use crate::options::{OptionSpec, ValueKind};
use orogen_engine::filter::{FlowCodes, FlowDirection};
use orogen_engine::solver::Fill;

/// Option for the codes of directions: esri (1 east, 2 south-east, 4 south ...), grass, taudem, whitebox or pcraster.
const CODES: OptionSpec =
    OptionSpec::new("codes", "WHOSE", ValueKind::Word(&["esri", "grass", "taudem", "whitebox", "pcraster"]))
        .with_about(
            "Encoding of flow directions: esri (1 east, 2 south-east, 4 south ...), grass, taudem, whitebox or \
             pcraster [default: esri]",
        );

/// The layer `drainage-area`.
pub static AREA: Derived = Derived {
    name: "drainage-area",
    about: "flow accumulation: drainage area of each cell including itself, in m^2 (D8; that of the levels where the recipe has its own network)",
    palette: "viridis",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(to.flow())).bounded_or_network()),
};

/// The layer `flow-direction`.
pub static DIRECTION: Derived = Derived {
    name: "flow-direction",
    about: "flow direction (D8), in the encoding of another program (--codes)",
    palette: "",
    options: || &[CODES],
    made: Made::Nodes(
        NodeLayer::new(|to| {
            let codes = match to.options().word(CODES.name) {
                Some("grass") => FlowCodes::Grass,
                Some("taudem") => FlowCodes::Taudem,
                Some("whitebox") => FlowCodes::Whitebox,
                Some("pcraster") => FlowCodes::Pcraster,
                _ => FlowCodes::Esri,
            };
            let source = to.receiver();
            Ok(to.add(FlowDirection { source, codes }).layer("direction"))
        })
        .bounded_or_network(),
    ),
};

/// The layer `strahler`.
pub static STRAHLER: Derived = Derived {
    name: "strahler",
    about: "Strahler order of streams; 0 elsewhere",
    palette: "viridis",
    options: || &[STREAM],
    made: Made::Nodes(NodeLayer::new(|to| Ok(to.drainage().layer("strahler"))).bounded()),
};

/// The layer `watershed`.
pub static WATERSHED: Derived = Derived {
    name: "watershed",
    about: "watersheds: the ground that drains to each outlet, numbered from 1; 0 in the sea",
    palette: "",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| Ok(to.drainage().layer("watershed"))).bounded()),
};

/// The layer `filled`.
pub static FILLED: Derived = Derived {
    name: "filled",
    about: "depression-free heights: every depression filled to its spill level; filled ground is level",
    palette: "batlow",
    options: || &[],
    made: Made::Nodes(
        NodeLayer::new(|to| {
            let source = to.heights();
            Ok(to.add(Fill { source, ..Fill::default() }).layer("filled"))
        })
        .bounded(),
    ),
};
