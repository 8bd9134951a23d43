//! The layer `splat`: weights of the surfaces.

use super::cover;
use super::layer::{Channels, Derived, Made, Nature};

/// The layer.
pub static LAYER: Derived = Derived {
    name: "splat",
    about: "splat map: weights of the recipe's surfaces, or of grass, sand, scree, rock, snow and river bed",
    palette: "",
    options: || &[],
    made: Made::Channels(Channels {
        nature: Nature::Weights,
        names: cover::names,
        // The picture of the surfaces (`--preview`) includes relief shading.
        prepare: cover::prepare_with_slopes,
        layers: cover::shares,
        make: Some(|recipe, layers, window| cover::of(recipe, layers).weights(window, cover::names(recipe).len())),
    }),
};
