//! The layer `hillshade`.

use super::layer::{Derived, Made, Nature, RowLayer, none, nothing};
use orogen_grid::analysis::hillshade::{Light, hillshade};

/// The layer.
pub static LAYER: Derived = Derived {
    name: "hillshade",
    about: "hillshade: light from the north-west at 45 degrees elevation, slope by Horn's method; 1 is full light, 0 none",
    palette: "grey",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Numbers,
        channels: |_| vec!["hillshade".into()],
        prepare: nothing,
        layers: none,
        reach: |_| 1,
        make: |around, window| vec![hillshade(&around.bordered(window), &Light::default())],
    }),
};
