//! MultiMesh resources of Godot 4 as text: many instances of one mesh.

use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes a MultiMesh without a mesh. A transform is the 3 x 4 matrix of an instance, row by row: basis and origin, in
/// metres with x east, y up and z south.
///
/// Fails if `out` fails.
pub fn write_multimesh(out: &mut dyn Write, transforms: impl ExactSizeIterator<Item = [f32; 12]>) -> io::Result<()> {
    // The comment marks the file as generated: Godot removes it when it saves.
    writeln!(out, "[gd_resource type=\"MultiMesh\" format=3]\n; made by Orogen\n\n[resource]")?;
    // 1 is TRANSFORM_3D. It must precede the number of instances.
    writeln!(out, "transform_format = 1\ninstance_count = {}", transforms.len())?;
    write!(out, "buffer = PackedFloat32Array(")?;
    let mut text = String::new();
    for (k, transform) in transforms.enumerate() {
        text.clear();
        for (i, number) in transform.into_iter().enumerate() {
            text.push_str(if k > 0 || i > 0 { ", " } else { "" });
            let _ = write!(text, "{number}");
        }
        out.write_all(text.as_bytes())?;
    }
    writeln!(out, ")")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_numbers_for_each_instance() {
        let mut bytes = Vec::new();
        let moved = |east: f32| [1.0, 0.0, 0.0, east, 0.0, 1.0, 0.0, 0.5, 0.0, 0.0, 1.0, -3.0];
        write_multimesh(&mut bytes, [moved(1e7), moved(2.25)].into_iter()).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let expect = "[gd_resource type=\"MultiMesh\" format=3]\n; made by Orogen\n\n[resource]\ntransform_format = 1\ninstance_count = 2\n\
                      buffer = PackedFloat32Array(1, 0, 0, 10000000, 0, 1, 0, 0.5, 0, 0, 1, -3, 1, 0, 0, 2.25, 0, 1, 0, 0.5, 0, 0, 1, -3)\n";
        assert_eq!(text, expect);
    }
}
