//! Terrain3D, for Godot 4.
//!
//! "Importing & Exporting Data" (terrain3d.readthedocs.io): EXR or r16 for heights, in metres; it splits the map into
//! regions of 1024 samples itself. Three channels of 32 bits without alpha, which Godot reads as floats; half floats
//! would have steps of 2 m at 3000 m.

use super::target::{EngineObjects, EngineTarget};
use crate::export::formats::{exr, tres};
use orogen_io::format::levels::Levels;

/// The target.
pub static TARGET: EngineTarget = EngineTarget {
    name: "terrain3d",
    about: "Terrain3D for Godot 4: EXR of f32 in metres with channels R, G and B, whole regions of 1024 samples",
    sides: &[256, 512, 1024, 2048, 4096, 8192, 16384],
    formats: &[exr::FORMAT.name],
    tile: None,
    weights_less: 0,
    weights: "rgba",
    normal: "opengl",
    heights: |_, options| options.give(&exr::RGB, ""),
    import,
    objects: Some(EngineObjects {
        formats: &[tres::FORMAT.name],
        import: &[
            "a MultiMeshInstance3D at the position of the terrain's first sample takes each file, with a mesh of yours",
        ],
    }),
};

fn import(side: usize, cell: f64, levels: &Levels) -> Vec<String> {
    let middle = side as f64 / 2.0;
    vec![
        format!(
            "importer.tscn > Height File Name; Import Scale 1, Height Offset 0 (metres {} to {})",
            levels.low(),
            levels.high()
        ),
        format!("Import Position {middle}, 0, {middle} puts the first sample at the origin; Vertex Spacing {}", cell),
        "rows run south, which is +Z: no flip is needed".to_string(),
    ]
}
