//! The layer `slope`.

use super::layer::{Derived, Made, Nature, RowLayer, none, nothing};
use orogen_grid::analysis::slope::slope_degrees;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "slope",
    about: "slope in degrees, by Horn's 3 x 3 method",
    palette: "slope",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "deg",
        nature: Nature::Numbers,
        channels: |_| vec!["slope".into()],
        prepare: nothing,
        layers: none,
        reach: |_| 1,
        make: |around, window| vec![slope_degrees(&around.bordered(window))],
        lowered: None,
    }),
};
