//! Stereolithography (.stl), binary: a solid to print.
//!
//! 3D Systems' StereoLithography interface specification, 1989. Millimetres; x east, y north, z up, with the
//! south-western corner of the base at the origin. The surface is closed by four walls and a flat base, so that the
//! solid is watertight: every edge has a triangle on both sides and every normal points outward.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::shape::Shape;
use super::surface::{Surface, push};
use orogen_grid::error::{Error, ErrorKind};

/// Dimensions of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Print {
    /// Length of the longer side in millimetres, between the centres of its first and last sample.
    pub size: f64,
    /// Thickness of the base below the lowest sample, in millimetres; 3 by default.
    pub base: f64,
}

impl Print {
    /// A solid with a longer side of this many millimetres.
    #[must_use]
    pub fn new(size: f64) -> Print {
        Print { size, base: 3.0 }
    }

    /// The same with a base of this thickness, in millimetres.
    #[must_use]
    pub fn with_base(self, base: f64) -> Print {
        Print { base, ..self }
    }
}

/// Writes the solid of a surface, and returns its height in millimetres.
///
/// Fails if `out` fails, if there are holes, or if there are more triangles than 32 bits can count.
pub fn write(out: &mut dyn Write, surface: &Surface, print: &Print) -> io::Result<f64> {
    let grid = surface.grid;
    let holes = grid.data().iter().filter(|height| !height.is_finite()).count();
    if holes > 0 {
        let message = format!(
            "{holes} of {} samples are nodata, and a solid must not have holes; choose a window or a layer without nodata",
            grid.data().len()
        );
        return Err(Error::new(ErrorKind::Request, message).into());
    }
    let solid = Solid::new(surface, print);
    let border = border(surface);
    let triangles = surface.shape.triangles() as u64 + 3 * border.len() as u64;
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
    surface.triangles(out, |triangle, bytes| facet(triangle.map(|corner| solid.top(surface.shape, corner)), bytes))?;
    // All border edges are visible from a point in the middle of the base.
    let middle = [0.5 * solid.extent[0], 0.5 * solid.extent[1], 0.0];
    let mut bytes = Vec::new();
    for [from, to] in border {
        let [from, to] = [from, to].map(|corner| solid.top(surface.shape, corner));
        let [from_below, to_below] = [from, to].map(|[x, y, _]| [x, y, 0.0]);
        // The border runs counter-clockwise, the land to its left: seen from outside, from left to right.
        facet([from, from_below, to_below], &mut bytes);
        facet([from, to_below, to], &mut bytes);
        facet([to_below, from_below, middle], &mut bytes);
        if bytes.len() > 1 << 18 {
            out.write_all(&bytes)?;
            bytes.clear();
        }
    }
    out.write_all(&bytes)?;
    Ok(solid.height)
}

/// Conversion from samples to millimetres.
struct Solid<'a> {
    surface: &'a Surface<'a>,
    /// Millimetres per metre.
    scale: f64,
    lowest: f64,
    base: f64,
    /// Extent east and north, in millimetres.
    extent: [f32; 2],
    height: f64,
}

impl<'a> Solid<'a> {
    fn new(surface: &'a Surface<'a>, print: &Print) -> Solid<'a> {
        let window = surface.grid.window();
        let [east, south] = [window.width, window.height].map(|samples| (samples - 1) as f64 * window.cell);
        let scale = print.size / east.max(south);
        let [least, greatest] = surface.bounds();
        let (lowest, highest) = (f64::from(least[1]), f64::from(greatest[1]));
        let extent = [(east * scale) as f32, (south * scale) as f32];
        Solid { surface, scale, lowest, base: print.base, extent, height: print.base + (highest - lowest) * scale }
    }

    /// The position of a vertex of the surface.
    fn top(&self, shape: &Shape, corner: u32) -> [f32; 3] {
        let [column, row] = shape.sample(corner);
        let grid = self.surface.grid;
        let [_, height, _] = self.surface.place(column, row);
        let along = |steps: usize| (steps as f64 * grid.window().cell * self.scale) as f32;
        let up = self.base + (f64::from(height) - self.lowest) * self.scale;
        [along(column), along(grid.height() - 1 - row), up as f32]
    }
}

/// The edges around a surface, from vertex to vertex, with the land to their left.
fn border(surface: &Surface) -> Vec<[u32; 2]> {
    let shape = surface.shape;
    let [east, south] = [surface.grid.width() - 1, surface.grid.height() - 1];
    // Vertices on the border by side and position along it; a corner of the grid is on two sides.
    let mut sides: [BTreeMap<usize, u32>; 4] = Default::default();
    let mut corner = 0;
    for row in shape.rows() {
        row.each(|column| {
            for (side, on, along) in [
                (0, row.row == 0, column),
                (1, column == east, row.row),
                (2, row.row == south, column),
                (3, column == 0, row.row),
            ] {
                if on {
                    sides[side].insert(along, corner);
                }
            }
            corner += 1;
        });
    }
    let mut edges = Vec::new();
    // Counter-clockwise from above: west along the north, south along the west, east along the south, north along the east.
    for (side, backwards) in [(0, true), (3, false), (2, false), (1, true)] {
        let mut corners: Vec<u32> = sides[side].values().copied().collect();
        if backwards {
            corners.reverse();
        }
        edges.extend(corners.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    edges
}

/// Appends a facet: its normal, its corners, and no attributes.
fn facet(corners: [[f32; 3]; 3], bytes: &mut Vec<u8>) {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let [u, v]: [[f64; 3]; 2] = [std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i])];
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]).sqrt();
    push(&normal.map(|part| if length > 0.0 { (part / length) as f32 } else { 0.0 }), bytes);
    corners.iter().for_each(|corner| push(corner, bytes));
    bytes.extend_from_slice(&[0, 0]);
}
