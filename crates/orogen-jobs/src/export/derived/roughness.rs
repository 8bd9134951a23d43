//! The layer `roughness`.

use super::cover;
use super::layer::{Channels, Derived, Made, Nature};

/// The layer.
pub static LAYER: Derived = Derived {
    name: "roughness",
    about: "roughness map: roughness of the ground by the recipe's surfaces, from 0 (mirror) to 1 (matt)",
    palette: "grey",
    options: || &[],
    made: Made::Channels(Channels {
        nature: Nature::Numbers,
        names: |_| vec!["roughness".into()],
        prepare: cover::prepare,
        layers: cover::shares,
        make: Some(|recipe, layers, window| vec![cover::of(recipe, layers).roughness(window)]),
    }),
};
