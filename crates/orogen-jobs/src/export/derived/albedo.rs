//! The layer `albedo`: the color of the ground.

use super::cover;
use super::layer::{Channels, Derived, Made, Nature};

/// The layer.
pub static LAYER: Derived = Derived {
    name: "albedo",
    about: "albedo or base color map: unlit color of the ground by the recipe's surfaces",
    palette: "",
    options: || &[],
    made: Made::Channels(Channels {
        nature: Nature::Color,
        names: |_| ["R", "G", "B"].map(String::from).to_vec(),
        prepare: cover::prepare,
        layers: cover::shares_and_positions,
        make: Some(|recipe, layers, window| cover::of(recipe, layers).albedo(window)),
    }),
};
