//! The mesh of the 3D view: a lattice over a part of the land, with walls and water. Its heights come from a texture.

use std::ops::Range;

/// A vertex: position from 0, 0 to 1, 1; 1 for the lower end of a wall; and the part that it belongs to, with the codes
/// of `relief.wgsl`.
pub type Vertex = [f32; 4];

/// A mesh of triangles, and the lines of its lattice.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// Triangles of the ground, tile by tile.
    pub ground: Vec<u32>,
    /// Triangles of the walls of the ground.
    pub walls: Vec<u32>,
    /// Triangles of the water.
    pub water: Vec<u32>,
    /// Triangles of the walls of the water.
    pub water_walls: Vec<u32>,
    /// Lines of the lattice, tile by tile.
    pub lines: Vec<u32>,
    /// The tiles of the lattice.
    pub tiles: Vec<Tile>,
}

/// A tile of the lattice, which is drawn only if it may be visible.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Its first and last position, from 0, 0 to 1, 1.
    pub rect: [[f32; 2]; 2],
    /// Its indices in the triangles of the ground.
    pub ground: Range<u32>,
    /// Its indices in the lines of the lattice.
    pub lines: Range<u32>,
}

const GROUND: f32 = 0.0;
const WALL: f32 = 1.0;
const WATER: f32 = 2.0;
const WATER_WALL: f32 = 3.0;

/// Number of tiles along each side.
const TILES: usize = 16;

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
        let [wide, high] = [columns, rows].map(|count| (count - 1).div_ceil(TILES));
        for top in (0..rows - 1).step_by(high) {
            for left in (0..columns - 1).step_by(wide) {
                let firsts = [mesh.ground.len(), mesh.lines.len()].map(|count| count as u32);
                let [right, bottom] = [(left + wide).min(columns - 1), (top + high).min(rows - 1)];
                for j in top..bottom {
                    for i in left..right {
                        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
                        mesh.ground.extend([a, c, b, b, c, d]);
                        mesh.lines.extend([a, b, a, c]);
                    }
                }
                mesh.tiles.push(Tile {
                    rect: [[left, top], [right, bottom]].map(|[i, j]| [share(i, columns), share(j, rows)]),
                    ground: firsts[0]..mesh.ground.len() as u32,
                    lines: firsts[1]..mesh.lines.len() as u32,
                });
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
            let indices = if kind == WALL { &mut mesh.walls } else { &mut mesh.water_walls };
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
        assert_eq!((mesh.ground.len(), mesh.walls.len()), (6 * cells, 6 * border));
        assert_eq!((mesh.water.len(), mesh.water_walls.len()), (6, 6 * border));
        assert_eq!(mesh.vertices.len(), 12 + 4 * border + 4);
        let parts = [&mesh.ground, &mesh.walls, &mesh.water, &mesh.water_walls, &mesh.lines];
        assert!(parts.into_iter().flatten().all(|index| (*index as usize) < mesh.vertices.len()));
    }

    #[test]
    fn tiles_cover_the_lattice_once() {
        for [columns, rows] in [[2, 2], [257, 257], [100, 40], [1024, 3]] {
            let mesh = Mesh::new(columns, rows);
            let mut ends = [0, 0];
            for tile in &mesh.tiles {
                assert_eq!([tile.ground.start, tile.lines.start], ends);
                ends = [tile.ground.end, tile.lines.end];
                for k in tile.ground.clone() {
                    let [u, v, ..] = mesh.vertices[mesh.ground[k as usize] as usize];
                    let [[left, top], [right, bottom]] = tile.rect;
                    assert!((left..=right).contains(&u) && (top..=bottom).contains(&v));
                }
            }
            assert_eq!(ends.map(|end| end as usize), [mesh.ground.len(), mesh.lines.len()]);
        }
    }
}
