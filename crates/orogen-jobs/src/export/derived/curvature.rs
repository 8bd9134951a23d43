//! The layer `curvature`.

use super::layer::{Derived, Made, NodeLayer};
use orogen_engine::filter::Curvature;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "curvature",
    about: "total curvature in 1/m, positive on summits and negative in hollows (Zevenbergen and Thorne)",
    palette: "oleron",
    options: || &[],
    made: Made::Nodes(NodeLayer::new(|to| {
        let source = to.extrapolated(1);
        Ok(to.add(Curvature { source, ..Curvature::default() }).layer("curvature"))
    })),
};
