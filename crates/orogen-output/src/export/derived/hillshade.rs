//! The layer `hillshade`.

use super::layer::{Derived, LoweredRows, Made, Nature, RowLayer, none, nothing};
use orogen_engine::lower::{HORN, Passes};
use orogen_grid::analysis::hillshade::{Light, hillshade};
use std::sync::LazyLock;

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
        lowered: Some(LoweredRows { passes, heights: |around, window| around.bordered(window) }),
    }),
};

/// The passes of a graphics card.
fn passes(cell: f64) -> Passes {
    static CODE: LazyLock<String> = LazyLock::new(|| format!("{HORN}{}", include_str!("hillshade.wgsl")));
    let [east, north, up, z_factor] = Light::default().numbers();
    Passes::new(&CODE, &[(1.0 / (8.0 * cell)) as f32, east, north, up, z_factor]).then("hillshade", 0, [1; 2])
}
