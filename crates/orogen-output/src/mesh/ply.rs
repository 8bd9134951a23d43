//! The Stanford polygon format (.ply), binary, little-endian.
//!
//! G. Turk, "The PLY polygon file format", 1994. Metres; x east, y north, z up, with the first sample of the grid at
//! the origin: y is zero along the first row and negative south of it. Each vertex has its normal and either its sRGB
//! color or its texture coordinates (s to the right, t up): readers that support both use the texture coordinates and
//! ignore the colors.

use std::io::{self, Write};

use super::surface::{Surface, Wanted, push};
use orogen_grid::error::{Error, ErrorKind};

/// Writes a surface. `comments` are lines of the header.
///
/// Fails if `out` fails, or if there are more vertices than the signed indices that readers expect can address.
pub fn write(out: &mut dyn Write, surface: &Surface, comments: &[String]) -> io::Result<()> {
    let [corners, triangles] = [surface.shape.corners(), surface.shape.triangles()];
    if corners > i32::MAX as usize || triangles > i32::MAX as usize {
        let message = format!(
            "a .ply file holds at most 2147483647 vertices and triangles, and this mesh has {triangles} triangles; use --max-error, a smaller window or a larger cell"
        );
        return Err(Error::new(ErrorKind::Request, message).into());
    }
    let colors = surface.painter.is_some();
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    comments.iter().try_for_each(|comment| writeln!(out, "comment {comment}"))?;
    writeln!(out, "element vertex {corners}")?;
    ["x", "y", "z", "nx", "ny", "nz"].iter().try_for_each(|name| writeln!(out, "property float {name}"))?;
    match colors {
        true => ["red", "green", "blue"].iter().try_for_each(|name| writeln!(out, "property uchar {name}"))?,
        false => ["s", "t"].iter().try_for_each(|name| writeln!(out, "property float {name}"))?,
    }
    writeln!(out, "element face {triangles}\nproperty list uchar int vertex_indices\nend_header")?;
    surface.corners(out, Wanted { normals: true, colors }, |corner, bytes| {
        let [east, up, south] = corner.normal;
        push(&[corner.east, 0.0 - corner.south, corner.height], bytes);
        push(&[east, 0.0 - south, up], bytes);
        match colors {
            true => bytes.extend_from_slice(&corner.color),
            false => push(&[corner.texture[0], 1.0 - corner.texture[1]], bytes),
        }
    })?;
    surface.triangles(out, |triangle, bytes| {
        bytes.push(3);
        triangle.iter().for_each(|corner| bytes.extend_from_slice(&corner.to_le_bytes()));
    })
}
