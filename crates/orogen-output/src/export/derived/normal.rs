//! The layer `normal`.

use super::layer::{Derived, LoweredRows, Made, Nature, RowLayer, none, nothing};
use crate::export::options::Options;
use orogen_engine::lower::{HORN, Passes};
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::grid::Grid;
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
        make: |around, window| {
            let heights = around.bordered(window);
            let mut parts = vec![Grid::filled(*window, 0.0); 3];
            for j in 0..window.height {
                let rows = [heights.row(j), heights.row(j + 1), heights.row(j + 2)];
                gradients_between(rows, window.cell, |i, gradient| {
                    for (part, value) in parts.iter_mut().zip(gradient.normal()) {
                        part.row_mut(j)[i] = value;
                    }
                });
            }
            parts
        },
        lowered: Some(LoweredRows { passes, heights: |around, window| around.bordered(window) }),
    }),
};

/// The passes of a graphics card.
fn passes(cell: f64, _: &Options) -> Passes {
    static CODE: LazyLock<String> = LazyLock::new(|| format!("{HORN}{}", include_str!("normal.wgsl")));
    Passes::new(&CODE, &[(1.0 / (8.0 * cell)) as f32]).then("normal", 0, [1; 2])
}
