//! The mesh of the 3D view: a lattice over the land, with walls and water. Its heights come from a texture.

/// A vertex: position from 0, 0 to 1, 1; 1 for the lower end of a wall; and the part that it belongs to, with the codes
/// of `relief.wgsl`.
pub type Vertex = [f32; 4];

/// A mesh of triangles, and the lines of its lattice.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// Triangles of the ground and its walls.
    pub ground: Vec<u32>,
    /// Triangles of the water and its walls.
    pub water: Vec<u32>,
    /// Lines of the lattice.
    pub lines: Vec<u32>,
}

const GROUND: f32 = 0.0;
const WALL: f32 = 1.0;
const WATER: f32 = 2.0;
const WATER_WALL: f32 = 3.0;

impl Mesh {
    /// A lattice of vertices, at least 2 along each side.
    #[must_use]
    pub fn new(columns: usize, rows: usize) -> Mesh {
        let (columns, rows) = (columns.max(2), rows.max(2));
        let mut mesh = Mesh::default();
        let share = |at: usize, count: usize| at as f32 / (count - 1) as f32;
        for j in 0..rows {
            for i in 0..columns {
                mesh.vertices.push([share(i, columns), share(j, rows), 0.0, GROUND]);
            }
        }
        let at = |i: usize, j: usize| (j * columns + i) as u32;
        for j in 0..rows - 1 {
            for i in 0..columns - 1 {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
                mesh.ground.extend([a, c, b, b, c, d]);
                mesh.lines.extend([a, b, a, c]);
            }
        }
        let around: Vec<[f32; 2]> = (0..columns - 1)
            .map(|i| [share(i, columns), 0.0])
            .chain((0..rows - 1).map(|j| [1.0, share(j, rows)]))
            .chain((1..columns).rev().map(|i| [share(i, columns), 1.0]))
            .chain((1..rows).rev().map(|j| [0.0, share(j, rows)]))
            .collect();
        for kind in [WALL, WATER_WALL] {
            let first = mesh.vertices.len() as u32;
            for [u, v] in &around {
                mesh.vertices.extend([[*u, *v, 0.0, kind], [*u, *v, 1.0, kind]]);
            }
            let count = around.len() as u32;
            let indices = if kind == WALL { &mut mesh.ground } else { &mut mesh.water };
            for k in 0..count {
                let [a, b] = [first + 2 * k, first + 2 * ((k + 1) % count)];
                indices.extend([a, b, a + 1, b, b + 1, a + 1]);
            }
        }
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[u, v]| [u, v, 0.0, WATER]));
        mesh.water.extend([0, 2, 1, 1, 2, 3].map(|k| first + k));
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_has_its_triangles_walls_and_water() {
        let mesh = Mesh::new(4, 3);
        let (cells, border) = (3 * 2, 2 * (3 + 2));
        assert_eq!(mesh.ground.len(), 6 * (cells + border));
        assert_eq!(mesh.water.len(), 6 * (border + 1));
        assert_eq!(mesh.vertices.len(), 12 + 4 * border + 4);
        let all = mesh.ground.iter().chain(&mesh.water).chain(&mesh.lines);
        assert!(all.into_iter().all(|index| (*index as usize) < mesh.vertices.len()));
    }
}
