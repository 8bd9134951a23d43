//! Tangent-space normal maps, which add the detail of the ground to a mesh with few triangles.
//!
//! glTF 2.0.1, sections 3.7.2.1 and 3.9.3: a texel (x, y, z) stands for the normal x T + y B + z N, where N and T are
//! the normal and the tangent of the vertices, interpolated over the triangle and normalized, and B is the interpolated
//! cross product of the two. T points east, B north.

use super::surface::Surface;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;

/// A texel that does not change the normal.
const FLAT: [u8; 3] = [128, 128, 255];

/// The tangent of the ground at a vertex with this normal (east, up, south): the unit vector eastward along the ground.
#[must_use]
pub fn tangent([east, up, _]: [f32; 3]) -> [f32; 3] {
    let length = (east * east + up * up).sqrt();
    if length > 0.0 { [up / length, -east / length, 0.0] } else { [1.0, 0.0, 0.0] }
}

/// The normal map of a surface: the normals of all its samples relative to the triangles over them, three bytes each,
/// row-major.
///
/// # Errors
/// If the work is cancelled.
pub fn bake(surface: &Surface) -> Result<Vec<u8>> {
    let (grid, shape) = (surface.grid, surface.shape);
    let (width, normals) = (grid.width(), surface.normals());
    let mut texels: Vec<u8> = FLAT.repeat(normals.len());
    for piece in 0..shape.pieces() {
        surface.progress.map_or(Ok(()), Progress::check)?;
        shape.piece(grid, piece, |triangle| {
            let corners = triangle.map(|corner| shape.sample(corner));
            let frames = corners.map(|[i, j]| frame(normals[j * width + i]));
            each_sample(corners, |[i, j], shares| {
                let at = j * width + i;
                let frame = [0, 1, 2].map(|axis| {
                    let mixed: [f32; 3] =
                        std::array::from_fn(|c| (0..3).map(|k| shares[k] * frames[k][axis][c]).sum::<f32>());
                    unit(mixed)
                });
                texels[3 * at..3 * at + 3].copy_from_slice(&texel(frame, normals[at]));
            });
        });
    }
    Ok(texels)
}

/// Tangent, bitangent and normal at a vertex.
fn frame(normal: [f32; 3]) -> [[f32; 3]; 3] {
    let tangent = tangent(normal);
    [tangent, cross(normal, tangent), normal]
}

/// Calls `visit` with each sample inside or on the edges of a triangle, and its barycentric coordinates.
fn each_sample(corners: [[usize; 2]; 3], mut visit: impl FnMut([usize; 2], [f32; 3])) {
    let [a, b, c] = corners.map(|corner| corner.map(|at| at as i64));
    let side = |a: [i64; 2], b: [i64; 2], p: [i64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let area = side(a, b, c);
    if area == 0 {
        return;
    }
    let ends = |k: usize| (a[k].min(b[k]).min(c[k]), a[k].max(b[k]).max(c[k]));
    let ((west, east), (north, south)) = (ends(0), ends(1));
    for j in north..=south {
        for i in west..=east {
            // Integers: a sample on a common edge belongs to both triangles.
            let parts = [side(b, c, [i, j]), side(c, a, [i, j]), side(a, b, [i, j])].map(|part| part * area.signum());
            if parts.iter().all(|part| *part >= 0) {
                visit([i as usize, j as usize], parts.map(|part| part as f32 / area.abs() as f32));
            }
        }
    }
}

/// A normal in the frame of tangent, bitangent and normal, which need not be orthogonal, as bytes.
fn texel([t, b, n]: [[f32; 3]; 3], normal: [f32; 3]) -> [u8; 3] {
    let determinant = dot(t, cross(b, n));
    let solved = [dot(normal, cross(b, n)), dot(normal, cross(n, t)), dot(normal, cross(t, b))];
    let [x, y, z] = unit(solved.map(|part| part / determinant));
    if !(x + y + z).is_finite() {
        return FLAT;
    }
    // Slightly above one half, so that a rounded 0 is always 128.
    [x, y, z.max(0.0)].map(|part| (part * 127.5 + 127.501).round() as u8)
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(vector: [f32; 3]) -> [f32; 3] {
    let length = dot(vector, vector).sqrt();
    vector.map(|part| part / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::adaptive::adaptive;
    use crate::mesh::shape::Shape;
    use orogen_grid::analysis::halo::Halo;
    use orogen_grid::grid::{Grid, Window};

    fn waves() -> Grid {
        let mut grid = Grid::filled(Window::new(65, 50, 10.0), 0.0);
        for j in 0..50 {
            for i in 0..65 {
                let (x, y) = (i as f64 / 5.0, j as f64 / 7.0);
                grid.row_mut(j)[i] = (40.0 * libm::sin(x + 0.4 * y) * libm::cos(y)) as f32;
            }
        }
        grid
    }

    fn surface<'a>(grid: &'a Grid, halo: &'a Halo, shape: &'a Shape) -> Surface<'a> {
        Surface { grid, halo, shape, exaggeration: 1.5, painter: None, progress: None }
    }

    #[test]
    fn a_mesh_of_all_samples_needs_no_normal_map() {
        let (grid, halo) = (waves(), Halo::default());
        let shape = Shape::lattice(&grid, 1).unwrap();
        assert!(bake(&surface(&grid, &halo, &shape)).unwrap().chunks_exact(3).all(|texel| *texel == FLAT));
    }

    #[test]
    fn it_stops_when_cancelled() {
        let (grid, halo) = (waves(), Halo::default());
        let (shape, progress) = (Shape::lattice(&grid, 4).unwrap(), Progress::none());
        progress.cancel();
        let surface = Surface { progress: Some(&progress), ..surface(&grid, &halo, &shape) };
        assert!(bake(&surface).is_err());
    }

    #[test]
    fn east_is_red_and_north_is_green() {
        for (east, south, expect) in
            [(1.0, 0.0, [0, 128]), (-1.0, 0.0, [255, 128]), (0.0, 1.0, [128, 255]), (0.0, -1.0, [128, 0])]
        {
            // A texel of ground that rises to the east or south, over a level triangle: its normal points to the west
            // or north.
            let normal = unit([-east, 0.0001, -south]);
            let [x, y, _] = texel(frame([0.0, 1.0, 0.0]), normal);
            assert_eq!([x, y], expect, "{east} {south}");
        }
    }

    /// The normal that a viewer computes from a texel and the vertices of its triangle.
    #[test]
    fn a_viewer_finds_the_normals_of_all_samples_on_few_triangles() {
        let (grid, halo) = (waves(), Halo::default());
        for shape in [Shape::lattice(&grid, 4).unwrap(), adaptive(&grid, 6.0).unwrap()] {
            let surface = surface(&grid, &halo, &shape);
            let (texels, normals) = (bake(&surface).unwrap(), surface.normals());
            let mut seen = vec![false; normals.len()];
            let mut plain = 0.0f32;
            for piece in 0..shape.pieces() {
                shape.piece(&grid, piece, |triangle| {
                    let corners = triangle.map(|corner| shape.sample(corner));
                    each_sample(corners, |[i, j], shares| {
                        let at = j * 65 + i;
                        seen[at] = true;
                        let own = corners.map(|[i, j]| normals[j * 65 + i]);
                        let mix = |vectors: [[f32; 3]; 3]| -> [f32; 3] {
                            unit(std::array::from_fn(|c| (0..3).map(|k| shares[k] * vectors[k][c]).sum()))
                        };
                        let [n, t, b] =
                            [mix(own), mix(own.map(tangent)), mix(own.map(|normal| cross(normal, tangent(normal))))];
                        let [x, y, z] = [0, 1, 2].map(|k| f32::from(texels[3 * at + k]) / 127.5 - 1.0);
                        let shown = unit(std::array::from_fn(|c| x * t[c] + y * b[c] + z * n[c]));
                        assert!(dot(shown, normals[at]) > 0.9998, "{i} {j}: {shown:?} {:?}", normals[at]);
                        plain = plain.max(1.0 - dot(n, normals[at]));
                    });
                });
            }
            assert!(seen.iter().all(|seen| *seen) && plain > 0.01, "{plain}");
        }
    }
}
