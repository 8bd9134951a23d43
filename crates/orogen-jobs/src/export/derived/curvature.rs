//! The layer `curvature`.

use super::layer::{Derived, Made, Nature, RowLayer, none, nothing};
use orogen_grid::analysis::curvature::{Curvature, curvature};

/// The layer.
pub static LAYER: Derived = Derived {
    name: "curvature",
    about: "total curvature in 1/m, positive on summits and negative in hollows (Zevenbergen and Thorne)",
    palette: "oleron",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "1/m",
        nature: Nature::Numbers,
        channels: |_| vec!["curvature".into()],
        prepare: nothing,
        layers: none,
        reach: |_| 1,
        make: |around, window| vec![curvature(&around.bordered(window), Curvature::Total)],
        lowered: None,
    }),
};
