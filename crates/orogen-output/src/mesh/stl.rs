//! Stereolithography (.stl), binary: a solid to print.
//!
//! 3D Systems' StereoLithography interface specification, 1989.

use std::io::{self, Write};

use orogen_grid::parallel;

use super::solid::Solid;
use super::surface::push;
use orogen_grid::error::{Error, ErrorKind};
use orogen_grid::progress::Progress;

/// Number of triangles that a thread writes at a time.
const PIECE: usize = 1 << 13;

/// Writes a solid.
///
/// Fails if `out` fails, or if there are more triangles than 32 bits can count.
pub fn write(out: &mut dyn Write, solid: &Solid, progress: &Progress) -> io::Result<()> {
    let triangles = solid.triangles.len();
    let count = u32::try_from(triangles).map_err(|_| {
        let message = format!(
            "an .stl file holds at most 4294967295 triangles, and this solid has {triangles}; use --max-error, a smaller window or a larger cell"
        );
        Error::new(ErrorKind::Request, message)
    })?;
    let mut header = [b' '; 80];
    let name = concat!("Orogen ", env!("CARGO_PKG_VERSION"), ", millimetres, z up");
    header[..name.len()].copy_from_slice(name.as_bytes());
    out.write_all(&header)?;
    out.write_all(&count.to_le_bytes())?;
    progress.expect(triangles as f64);
    for band in solid.triangles.chunks(PIECE * parallel::threads()) {
        let pieces: Vec<&[[u32; 3]]> = band.chunks(PIECE).collect();
        let made = parallel::map(&pieces, |piece| {
            let mut bytes = Vec::with_capacity(50 * piece.len());
            for triangle in *piece {
                facet(triangle.map(|corner| solid.corners[corner as usize]), &mut bytes);
            }
            bytes
        });
        made.iter().try_for_each(|bytes| out.write_all(bytes))?;
        progress.step(band.len() as f64)?;
    }
    Ok(())
}

/// Appends a facet: its normal, its vertices, and no attributes.
fn facet(corners: [[f32; 3]; 3], bytes: &mut Vec<u8>) {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let [u, v]: [[f64; 3]; 2] = [std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i])];
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]).sqrt();
    push(&normal.map(|part| if length > 0.0 { (part / length) as f32 } else { 0.0 }), bytes);
    corners.iter().for_each(|corner| push(corner, bytes));
    bytes.extend_from_slice(&[0, 0]);
}
