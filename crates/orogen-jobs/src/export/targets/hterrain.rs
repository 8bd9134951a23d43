//! HTerrain, for Godot 3 and 4 (godot_heightmap_plugin).
//!
//! Its height map is an EXR with one channel of half floats, 2^n + 1 samples per side, in metres; its splat maps have
//! one row and one column less.

use super::target::{EngineObjects, EngineTarget};
use crate::export::formats::{exr, tres};
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
    objects: Some(EngineObjects {
        formats: &[tres::FORMAT.name],
        import: &["a MultiMeshInstance3D at the position of the terrain takes each file, with a mesh of yours"],
    }),
};

fn import(side: usize, cell: f64, levels: &Levels) -> Vec<String> {
    vec![
        format!("Terrain > Import Maps > Heightmap: {0} x {0}, metres, {1} to {2}", side, levels.low(), levels.high()),
        format!("HTerrain > Map Scale {cell}, 1, {cell}"),
        "rows run south, which is +Z: no flip is needed".to_string(),
    ]
}
