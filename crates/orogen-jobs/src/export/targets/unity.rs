//! Unity terrains.
//!
//! "Working with Heightmaps" and "Terrain Settings" (docs.unity3d.com): 2^n + 1 samples, 33 to 4097; 16-bit RAW. A
//! terrain's first row is the southern one (z increases northward), so rows are written from the south and no flip is
//! needed.

use super::target::{EngineObjects, EngineTarget};
use crate::export::formats::{json, r16};
use crate::export::quantizer::{FIRST_ROW, RANGE};
use orogen_io::format::levels::Levels;

/// The target.
pub static TARGET: EngineTarget = EngineTarget {
    name: "unity",
    about: "Unity terrains: r16, little-endian, first row in the south, 2^n + 1 samples, tiles _x_z",
    sides: &[33, 65, 129, 257, 513, 1025, 2049, 4097],
    formats: &[r16::FORMAT.name],
    // Columns and rows from the south-west, as in its Terrain Toolbox.
    tile: Some(|column, row, rows| format!("_{column}_{}", rows - 1 - row)),
    // Weights have one pixel per quad.
    weights_less: 1,
    weights: "rgba",
    normal: "opengl",
    heights: |levels, options| {
        let (low, high) = ends(levels);
        options.give(&RANGE, &format!("{low},{high}"))?;
        options.give(&FIRST_ROW, "south")
    },
    import,
    objects: Some(EngineObjects {
        formats: &[json::FORMAT.name],
        import: &[
            "a script reads it with JsonUtility and sets TerrainData.treePrototypes and treeInstances: docs/scatter.md has the lines",
        ],
    }),
};

/// The heights of 0 and 65535; level ground gets a range of one metre.
fn ends(levels: &Levels) -> (f32, f32) {
    match levels.is_flat() {
        true => (levels.low(), levels.low() + 1.0),
        false => (levels.low(), levels.high()),
    }
}

fn import(side: usize, cell: f64, levels: &Levels) -> Vec<String> {
    let (low, high) = ends(levels);
    let metres = (side - 1) as f64 * cell;
    vec![
        format!(
            "Terrain Settings > Heightmap Resolution {0} x {0}, then Import Raw: Depth Bit 16, Byte Order Windows, Flip Vertically off",
            side
        ),
        format!("Terrain Size: X {metres}, Y {}, Z {metres}; the terrain's position Y {low}", high - low),
        format!("weight maps (--layer splat) have {0} x {0} pixels: Control Texture Resolution {0}", side - 1),
    ]
}
