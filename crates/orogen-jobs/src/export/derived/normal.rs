//! The layer `normal`.

use super::layer::{Derived, LoweredRows, Made, Nature, RowLayer, none, nothing};
use crate::options::Options;
use orogen_engine::lower::{HORN, Passes};
use orogen_grid::analysis::slope::normals;
use std::sync::LazyLock;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "normal",
    about: "normal map: components of the surface normal to the east, north and up",
    palette: "",
    options: &[],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Normal,
        channels: |_| ["X", "Y", "Z"].map(String::from).to_vec(),
        prepare: nothing,
        layers: none,
        reach: |_| 1,
        make: |around, window| normals(&around.bordered(window)).into(),
        lowered: Some(LoweredRows { passes, heights: |around, window| around.bordered(window) }),
    }),
};

/// The passes of a graphics card.
fn passes(cell: f64, _: &Options) -> Passes {
    static CODE: LazyLock<String> = LazyLock::new(|| format!("{HORN}{}", include_str!("normal.wgsl")));
    Passes::new(&CODE, &[(1.0 / (8.0 * cell)) as f32]).then("normal", 0, [1; 2])
}
