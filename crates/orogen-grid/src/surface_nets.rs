//! Surfaces of three-dimensional densities as triangle meshes: surface nets.
//!
//! After Gibson (1998), "Constrained elastic surface nets", in the simple form without relaxation. Each cube of eight
//! samples that do not all have the same sign has one vertex: the mean of the points where the surface crosses its
//! edges. Each edge whose ends differ in sign has a quadrilateral between the vertices of its four cubes. A vertex
//! depends only on the eight samples of its cube, so vertices that two parts share have the same bits, and parts join
//! without cracks.

use crate::error::{Error, ErrorKind, Result};

/// Densities at the points of a cubic lattice, positive inside the solid.
#[derive(Debug, Clone, Copy)]
pub struct Lattice<'a> {
    /// The column, row and level of the first sample in the lattice of the world.
    pub start: [i64; 3],
    /// Number of columns, rows and levels.
    pub size: [usize; 3],
    /// The densities, level by level and within a level row by row. A density that is NaN counts as outside.
    pub densities: &'a [f32],
}

/// A triangle mesh of a surface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Net {
    /// The cube of each vertex: column, row and level of its first sample in the lattice of the world.
    pub cubes: Vec<[i64; 3]>,
    /// The position of each vertex in its cube, 0 to 1 along each axis.
    pub offsets: Vec<[f32; 3]>,
    /// The unit normal of each vertex, which points away from the solid: the gradient of the densities of its cube.
    pub normals: Vec<[f32; 3]>,
    /// Triangles, counter-clockwise when seen from outside with the left-handed axes of the lattice: east, south, up.
    pub triangles: Vec<[u32; 3]>,
}

/// The edges of a cube, as pairs of corners. The bits of a corner's number are its column, row and level.
const EDGES: [[usize; 2]; 12] =
    [[0, 1], [2, 3], [4, 5], [6, 7], [0, 2], [1, 3], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7]];

/// Index of a cube without a vertex.
const NONE: u32 = u32::MAX;

impl Lattice<'_> {
    /// The surface between the cubes of the lattice. Only edges that begin at the second sample or later of each axis
    /// get quadrilaterals, so parts of N + 2 samples that are placed N samples apart cover the space exactly once.
    ///
    /// # Errors
    /// If the number of densities does not match the size.
    ///
    /// ```
    /// use orogen_grid::surface_nets::Lattice;
    ///
    /// // A ball.
    /// let at = |k: usize| [k % 16, k / 16 % 16, k / 256].map(|at| at as f32 - 7.3);
    /// let ball: Vec<f32> = (0..16 * 16 * 16).map(|k| 5.0 - at(k).iter().map(|x| x * x).sum::<f32>().sqrt()).collect();
    /// let net = Lattice { start: [0; 3], size: [16; 3], densities: &ball }.net()?;
    /// // A closed surface like a sphere: vertices less edges plus triangles are two.
    /// assert_eq!(net.cubes.len() + net.triangles.len() - 3 * net.triangles.len() / 2, 2);
    /// # Ok::<(), orogen_grid::error::Error>(())
    /// ```
    pub fn net(&self) -> Result<Net> {
        let [width, height, count] = self.size;
        if self.densities.len() != width * height * count {
            return Err(Error::new(ErrorKind::Request, "the densities of a lattice do not fit its size"));
        }
        let mut net = Net::default();
        if [width, height, count].iter().any(|side| *side < 2) {
            return Ok(net);
        }
        let steps = [1, width, width * height];
        let mut vertices = vec![NONE; self.densities.len()];
        for level in 0..count - 1 {
            for row in 0..height - 1 {
                for column in 0..width - 1 {
                    let at = (level * height + row) * width + column;
                    let corners: [f32; 8] = std::array::from_fn(|corner| {
                        self.densities[at + (0..3).map(|axis| (corner >> axis & 1) * steps[axis]).sum::<usize>()]
                    });
                    let Some((offset, normal)) = vertex(corners) else { continue };
                    vertices[at] = net.cubes.len() as u32;
                    let place = [column, row, level];
                    net.cubes.push([0, 1, 2].map(|axis| self.start[axis] + place[axis] as i64));
                    net.offsets.push(offset);
                    net.normals.push(normal);
                }
            }
        }
        // Each edge along an axis belongs to four cubes: those before and after it along the two other axes.
        for level in 1..count - 1 {
            for row in 1..height - 1 {
                for column in 1..width - 1 {
                    let at = (level * height + row) * width + column;
                    for axis in 0..3 {
                        let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
                        let [here, there] = [at, at + steps[axis]].map(|at| self.densities[at] > 0.0);
                        if here == there {
                            continue;
                        }
                        let quad = [at - steps[u] - steps[v], at - steps[v], at, at - steps[u]].map(|at| vertices[at]);
                        let [a, b, c, d] = if here { quad } else { [quad[0], quad[3], quad[2], quad[1]] };
                        // The quadrilateral is split along the same diagonal in every part.
                        net.triangles.extend([[a, c, b], [a, d, c]]);
                    }
                }
            }
        }
        Ok(net)
    }
}

/// The vertex of a cube and its normal; `None` if all corners are solid or no corner is.
fn vertex(corners: [f32; 8]) -> Option<([f32; 3], [f32; 3])> {
    let is_solid = corners.map(|density| density > 0.0);
    let solid = is_solid.iter().filter(|is_solid| **is_solid).count();
    if solid == 0 || solid == 8 {
        return None;
    }
    let (mut sum, mut crossed) = ([0.0f32; 3], 0.0f32);
    for [a, b] in EDGES {
        if is_solid[a] == is_solid[b] {
            continue;
        }
        let (from, to) = (corners[a], corners[b]);
        let share = from / (from - to);
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        for (axis, sum) in sum.iter_mut().enumerate() {
            let [from, to] = [a, b].map(|corner| (corner >> axis & 1) as f32);
            *sum += from + (to - from) * share;
        }
        crossed += 1.0;
    }
    let offset = sum.map(|sum| sum / crossed);
    // The gradient of the trilinear interpolation at the vertex.
    let mut gradient = [0.0f32; 3];
    for (corner, density) in corners.iter().enumerate().filter(|(_, density)| density.is_finite()) {
        for (axis, gradient) in gradient.iter_mut().enumerate() {
            let mut weight = if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            for other in [(axis + 1) % 3, (axis + 2) % 3] {
                weight *= if corner >> other & 1 == 1 { offset[other] } else { 1.0 - offset[other] };
            }
            *gradient += weight * density;
        }
    }
    let length = gradient.iter().map(|part| part * part).sum::<f32>().sqrt();
    let is_unit = length > 0.0 && length.is_finite();
    let normal = if is_unit { gradient.map(|part| -part / length) } else { [0.0, 0.0, 1.0] };
    Some((offset, normal))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// Bumpy ground with a tunnel, at any position of an infinite lattice.
    fn density([x, y, z]: [i64; 3]) -> f32 {
        let [x, y, z] = [x, y, z].map(|at| at as f32);
        let ground = 6.3 + 2.0 * libm::sinf(x * 0.4) + 1.5 * libm::cosf(y * 0.3) - z;
        let tunnel = ((y - 11.0) * (y - 11.0) + (z - 3.0) * (z - 3.0)).sqrt() - 2.2;
        ground.min(tunnel)
    }

    fn net(start: [i64; 3], size: [usize; 3]) -> Net {
        let [width, height, count] = size;
        let at = |k: usize| [k % width, k / width % height, k / width / height];
        let place = |k: usize| [0, 1, 2].map(|axis| start[axis] + at(k)[axis] as i64);
        let densities: Vec<f32> = (0..width * height * count).map(|k| density(place(k))).collect();
        Lattice { start, size, densities: &densities }.net().unwrap()
    }

    /// The triangles by the positions of their vertices, as bits, each rotated so that its smallest vertex comes first.
    fn triangles(net: &Net) -> Vec<[[u64; 6]; 3]> {
        let corner = |at: u32| {
            let (cube, offset) = (net.cubes[at as usize], net.offsets[at as usize]);
            let [x, y, z] = cube.map(|at| at as u64);
            let [u, v, w] = offset.map(|at| u64::from(at.to_bits()));
            [x, y, z, u, v, w]
        };
        net.triangles
            .iter()
            .map(|triangle| {
                let corners = triangle.map(corner);
                let first = (0..3).min_by_key(|at| corners[*at]).unwrap();
                [0, 1, 2].map(|at| corners[(first + at) % 3])
            })
            .collect()
    }

    #[test]
    fn parts_are_the_whole_and_have_no_cracks() {
        let whole = net([-1, -1, -3], [34, 26, 16]);
        let mut parts = Vec::new();
        // Chunks of 8 cubes, with one more cube before each.
        for y in 0..3 {
            for x in 0..4 {
                parts.extend(triangles(&net([8 * x - 1, 8 * y - 1, -3], [10, 10, 16])));
            }
        }
        let mut whole = triangles(&whole);
        let counted = parts.len();
        parts.sort_unstable();
        whole.sort_unstable();
        whole.dedup();
        parts.dedup();
        assert_eq!((parts.len(), counted), (whole.len(), whole.len()), "each triangle is in one part");
        assert!(parts == whole);
    }

    #[test]
    fn edges_inside_have_two_triangles_and_normals_point_outside() {
        let net = net([0, 0, -3], [32, 24, 16]);
        let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
        for [a, b, c] in &net.triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                *edges.entry([*from.min(to), *from.max(to)]).or_default() += if from < to { 1 } else { -1 };
            }
        }
        let is_border = |at: u32| {
            let [x, y, _] = net.cubes[at as usize];
            x == 0 || y == 0 || x == 30 || y == 22
        };
        for ([a, b], turns) in edges {
            assert!(turns == 0 || is_border(a) && is_border(b), "{:?}", net.cubes[a as usize]);
        }
        let mut outward = 0;
        for [a, b, c] in &net.triangles {
            let place = |at: &u32| {
                let at = *at as usize;
                [0, 1, 2].map(|axis| net.cubes[at][axis] as f32 + net.offsets[at][axis])
            };
            let [a_at, b_at, c_at] = [a, b, c].map(place);
            let [u, v] = [b_at, c_at].map(|end| [0, 1, 2].map(|axis| end[axis] - a_at[axis]));
            // East, south, up: a left-handed system, in which the cross product points the other way.
            let cross = [v[1] * u[2] - v[2] * u[1], v[2] * u[0] - v[0] * u[2], v[0] * u[1] - v[1] * u[0]];
            let normal = net.normals[*a as usize];
            outward += i32::from(cross.iter().zip(normal).map(|(a, b)| a * b).sum::<f32>() > 0.0);
        }
        assert!(outward as usize > net.triangles.len() * 97 / 100, "{outward} of {}", net.triangles.len());
    }

    #[test]
    fn what_is_not_finite_is_not_solid() {
        let densities = [f32::NAN, f32::INFINITY, -1.0, f32::NEG_INFINITY, 1.0, 1.0, -1.0, f32::NAN];
        let net = Lattice { start: [0; 3], size: [2; 3], densities: &densities }.net().unwrap();
        assert!(net.offsets.iter().chain(&net.normals).flatten().all(|part| part.is_finite()) && net.cubes.len() == 1);
        assert!(Lattice { start: [0; 3], size: [2, 2, 3], densities: &densities }.net().is_err());
    }
}
