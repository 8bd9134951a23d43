//! The layer `aspect`.

use super::layer::{Derived, Made, Nature, RowLayer, none, nothing};
use orogen_grid::analysis::aspect::aspect;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "aspect",
    about: "aspect: downhill direction in degrees clockwise from north; NaN on level ground",
    palette: "aspect",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "deg",
        nature: Nature::Numbers,
        channels: |_| vec!["aspect".into()],
        prepare: nothing,
        layers: none,
        reach: |_| 1,
        make: |around, window| vec![aspect(&around.bordered(window))],
        lowered: None,
    }),
};
