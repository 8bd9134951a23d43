//! The layer `splat`: weights of the surfaces.

use super::cover;
use super::layer::{Derived, Made, Nature, RowLayer};
use orogen_engine::recipe::surface::expand::expand;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "splat",
    about: "splat map: weights of the recipe's surfaces, or of grass, sand, scree, rock, snow and river bed",
    palette: "",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Weights,
        channels: cover::names,
        prepare: expand,
        layers: cover::shares,
        reach: |_| 0,
        make: |around, window| cover::of(around).weights(window, cover::names(around.recipe).len()),
        lowered: None,
    }),
};
