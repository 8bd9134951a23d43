//! The layer `albedo`: the color of the ground.

use super::cover;
use super::layer::{Derived, Made, Nature, RowLayer};
use orogen_engine::recipe::surface::expand::expand;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "albedo",
    about: "albedo or base color map: unlit color of the ground by the recipe's surfaces",
    palette: "",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Color,
        channels: |_| ["R", "G", "B"].map(String::from).to_vec(),
        prepare: expand,
        layers: cover::shares_and_positions,
        reach: |_| 0,
        make: |around, window| cover::of(around).albedo(window),
        lowered: None,
    }),
};
