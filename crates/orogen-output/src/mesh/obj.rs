//! Wavefront OBJ (.obj), text, with its material (.mtl).
//!
//! The Advanced Visualizer's appendix B1. Metres; x east, y up, z south, with the first sample of the grid at the
//! origin. Each vertex has a texture coordinate (u to the right, v up) and a normal with the same index; colors follow
//! the position, a common extension. Numbers have enough digits to restore the same f32.

use std::io::{self, Write};

use super::surface::{Surface, Wanted};

/// The name of the material.
const MATERIAL: &str = "terrain";

/// Writes a surface. `comments` are lines before it; `library` is the name of the material's file, if there is one.
///
/// Fails if `out` fails.
pub fn write(out: &mut dyn Write, surface: &Surface, comments: &[String], library: Option<&str>) -> io::Result<()> {
    comments.iter().try_for_each(|comment| writeln!(out, "# {comment}"))?;
    if let Some(library) = library {
        writeln!(out, "mtllib {library}")?;
    }
    writeln!(out, "o terrain")?;
    let colors = surface.painter.is_some();
    surface.corners(out, Wanted { normals: false, colors }, |corner, bytes| {
        line(bytes, "v", &[corner.east, corner.height, corner.south]);
        if colors {
            bytes.pop();
            line(bytes, "", &corner.color.map(|part| f32::from(part) / 255.0));
        }
    })?;
    surface.corners(out, Wanted::default(), |corner, bytes| {
        line(bytes, "vt", &[corner.texture[0], 1.0 - corner.texture[1]]);
    })?;
    surface.corners(out, Wanted { normals: true, colors: false }, |corner, bytes| line(bytes, "vn", &corner.normal))?;
    if library.is_some() {
        writeln!(out, "usemtl {MATERIAL}")?;
    }
    writeln!(out, "s 1")?;
    surface.triangles(out, |[a, b, c], bytes| {
        // Indices start at 1.
        let [a, b, c] = [a, b, c].map(|corner| u64::from(corner) + 1);
        // Writing to a vector does not fail.
        let _ = writeln!(bytes, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}");
    })
}

/// Writes a material with a texture of this name.
pub fn write_material(out: &mut dyn Write, picture: &str) -> io::Result<()> {
    write!(out, "newmtl {MATERIAL}\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\nmap_Kd -clamp on {picture}\n")
}

/// A keyword and numbers, as a line.
fn line(bytes: &mut Vec<u8>, word: &str, numbers: &[f32]) {
    bytes.extend_from_slice(word.as_bytes());
    for number in numbers {
        let _ = write!(bytes, " {number}");
    }
    bytes.push(b'\n');
}
