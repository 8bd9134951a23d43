//! HTerrain, for Godot 3 and 4 (godot_heightmap_plugin).
//!
//! Its height map is an EXR with one channel of half floats, 2^n + 1 samples per side, in metres; its splat maps have
//! one row and one column less.

use super::target::EngineTarget;
use crate::export::formats::exr;
use orogen_io::format::levels::Levels;

/// The target.
pub static TARGET: EngineTarget = EngineTarget {
    name: "hterrain",
    about: "HTerrain for Godot: EXR with one channel of half floats, 2^n + 1 samples",
    sides: &[65, 129, 257, 513, 1025, 2049, 4097],
    formats: &[exr::FORMAT.name],
    tile: None,
    weights_less: 1,
    weights: "rgba",
    normal: "opengl",
    heights: |_, options| options.give(&exr::HALF, ""),
    import,
};

fn import(side: usize, cell: f64, levels: &Levels) -> Vec<String> {
    vec![
        format!("Terrain > Import Maps > Heightmap: {0} x {0}, metres, {1} to {2}", side, levels.low(), levels.high()),
        format!("HTerrain > Map Scale {cell}, 1, {cell}"),
        "rows run south, which is +Z: no flip is needed".to_string(),
    ]
}
