//! The layer `roughness`.

use super::cover;
use super::layer::{Derived, Made, Nature, RowLayer};
use orogen_engine::recipe::surface::expand::expand;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "roughness",
    about: "roughness map: roughness of the ground by the recipe's surfaces, from 0 (mirror) to 1 (matt)",
    palette: "grey",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Numbers,
        channels: |_| vec!["roughness".into()],
        prepare: expand,
        layers: cover::shares,
        reach: |_| 0,
        make: |around, window| vec![cover::of(around).roughness(window)],
        lowered: None,
    }),
};
