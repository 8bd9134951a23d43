//! The layer `occlusion`.

use super::layer::{Derived, Made, Nature, RowLayer, none, nothing};
use orogen_grid::analysis::sky;

/// Search radius of horizons, in metres, and its maximum in samples.
const METRES: f64 = 1000.0;
const MOST: f64 = 128.0;

fn reach(cell: f64) -> usize {
    (METRES / cell).ceil().clamp(1.0, MOST) as usize
}

/// The layer.
pub static LAYER: Derived = Derived {
    name: "occlusion",
    about: "ambient occlusion: visible share of the sky within 1000 m or 128 samples; 1 on open ground",
    palette: "grey",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Numbers,
        channels: |_| vec!["occlusion".into()],
        prepare: nothing,
        layers: none,
        reach,
        make: |around, window| vec![sky::view(around.heights, window, reach(window.cell))],
    }),
};
