//! A chunk as arrays.

use orogen::{Grid, Window};

use crate::colors::colors_of;

/// The order of the vertices of a triangle that is seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Winding {
    /// As Bevy and glTF have it.
    Counterclockwise,
    /// As Godot has it.
    Clockwise,
}

/// A chunk of ground.
#[derive(Debug, Clone, PartialEq)]
pub struct ChunkArrays {
    /// Columns and rows of samples.
    pub size: [usize; 2],
    /// Distance between samples, in metres.
    pub cell: f32,
    /// Metres east and south of the world's origin, at the first sample.
    pub corner: [f64; 2],
    /// The heights in metres, row by row from the north: what a collider needs.
    pub heights: Vec<f32>,
    /// Vertices from the corner: the samples in the same order, then the skirt.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// Colors by height and slope, in patches of light and dark, linear RGB and 1.
    pub colors: Vec<[f32; 4]>,
    /// Triangles.
    pub indices: Vec<u32>,
}

/// Depth of the skirt that hides the cracks between chunks of two levels, in cells.
const SKIRT: f32 = 1.0;

impl ChunkArrays {
    /// The arrays of a chunk. `wide` has the samples of `window` and, for the normals, those around it where there are
    /// any. Samples that are not finite become the sea level.
    ///
    /// Cells are cut from their south-west to their north-east corner, as the height fields of parry and Godot cut
    /// them.
    #[must_use]
    pub fn of(wide: &Grid, window: &Window, sea_level: f32, winding: Winding) -> ChunkArrays {
        let (width, height, cell) = (window.width, window.height, window.cell as f32);
        let around = *wide.window();
        let shift = [window.x - around.x, window.y - around.y];
        let at = |column: i64, row: i64| {
            let column = (column + shift[0]).clamp(0, around.width as i64 - 1) as usize;
            let row = (row + shift[1]).clamp(0, around.height as i64 - 1) as usize;
            let sample = wide.row(row)[column];
            if sample.is_finite() { sample } else { sea_level }
        };
        let places = || (0..height as i64).flat_map(|row| (0..width as i64).map(move |column| (column, row)));
        let heights: Vec<f32> = places().map(|(column, row)| at(column, row)).collect();
        let mut positions: Vec<[f32; 3]> = places()
            .zip(&heights)
            .map(|((column, row), height)| [column as f32 * cell, *height, row as f32 * cell])
            .collect();
        // Where there is no sample beyond the edge, the difference is over one cell.
        let span = |from: i64, shift: i64, length: usize| {
            let ends = [(from - 1 + shift).max(0), (from + 1 + shift).min(length as i64 - 1)];
            (ends[1] - ends[0]).max(1) as f32 * cell
        };
        let mut normals: Vec<[f32; 3]> = places()
            .map(|(column, row)| {
                let east = (at(column + 1, row) - at(column - 1, row)) / span(column, shift[0], around.width);
                let south = (at(column, row + 1) - at(column, row - 1)) / span(row, shift[1], around.height);
                let length = (east * east + south * south + 1.0).sqrt();
                [-east / length, 1.0 / length, -south / length]
            })
            .collect();
        let mut colors = colors_of(window, &heights, &normals, sea_level);
        let mut indices = Vec::with_capacity(6 * width * height);
        let mut triangle = |corners: [usize; 3]| {
            let [a, b, c] = corners.map(|corner| corner as u32);
            indices.extend(match winding {
                Winding::Counterclockwise => [a, b, c],
                Winding::Clockwise => [a, c, b],
            });
        };
        for row in 0..height - 1 {
            for column in 0..width - 1 {
                let first = row * width + column;
                let [east, south, across] = [first + 1, first + width, first + width + 1];
                triangle([first, south, east]);
                triangle([south, across, east]);
            }
        }
        // The skirt follows the edge counterclockwise, seen from above: west, south, east, north.
        let west = (0..height - 1).map(|row| row * width);
        let south = (0..width - 1).map(|column| (height - 1) * width + column);
        let east = (1..height).rev().map(|row| row * width + width - 1);
        let north = (1..width).rev();
        let edge: Vec<usize> = west.chain(south).chain(east).chain(north).collect();
        let start = positions.len();
        for (k, top) in edge.iter().enumerate() {
            let [x, y, z] = positions[*top];
            positions.push([x, y - SKIRT * cell, z]);
            normals.push(normals[*top]);
            colors.push(colors[*top]);
            let next = (k + 1) % edge.len();
            triangle([*top, start + k, edge[next]]);
            triangle([start + k, start + next, edge[next]]);
        }
        let corner = [window.east(0), window.south(0)];
        ChunkArrays { size: [width, height], cell, corner, heights, positions, normals, colors, indices }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of 3 x 4 samples with an edge around it.
    fn chunk(winding: Winding) -> ChunkArrays {
        let window = Window::new(3, 4, 2.0).at(10, -5);
        let wide = window.grown(1);
        let heights = (0..wide.height).flat_map(|j| (0..wide.width).map(move |i| (j * j + 3 * i) as f32)).collect();
        ChunkArrays::of(&Grid::from_data(wide, heights).unwrap(), &window, 0.0, winding)
    }

    fn turn(arrays: &ChunkArrays, triangle: &[u32]) -> [f32; 3] {
        let [a, b, c] = [0, 1, 2].map(|k| arrays.positions[triangle[k] as usize]);
        let [u, v]: [[f32; 3]; 2] = [[b, a], [c, a]].map(|[end, start]| std::array::from_fn(|k| end[k] - start[k]));
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    }

    #[test]
    fn samples_are_vertices_at_their_places() {
        let arrays = chunk(Winding::Counterclockwise);
        assert_eq!((arrays.size, arrays.corner, arrays.cell), ([3, 4], [20.0, -10.0], 2.0));
        assert_eq!(arrays.heights[4], 4.0 + 6.0);
        assert_eq!(arrays.positions[4], [2.0, 10.0, 2.0]);
        assert_eq!(arrays.positions.len(), 12 + 10);
        assert_eq!([arrays.normals.len(), arrays.colors.len()], [22; 2]);
        assert_eq!(
            arrays.colors[..12],
            colors_of(&Window::new(3, 4, 2.0).at(10, -5), &arrays.heights, &arrays.normals, 0.0)
        );
        let [x, y, z] = arrays.normals[4];
        assert!((x / y + 1.5).abs() < 1e-6 && (z / y + 2.0).abs() < 1e-6, "{x} {y} {z}");
    }

    #[test]
    fn triangles_face_up_and_the_skirt_outward() {
        for (winding, sign) in [(Winding::Counterclockwise, 1.0), (Winding::Clockwise, -1.0)] {
            let arrays = chunk(winding);
            let (ground, skirt) = arrays.indices.split_at(3 * 2 * 2 * 3);
            assert!(ground.chunks(3).all(|triangle| sign * turn(&arrays, triangle)[1] > 0.0));
            assert_eq!(skirt.len(), 3 * 2 * 10);
            for triangle in skirt.chunks(3) {
                let out = turn(&arrays, triangle).map(|part| sign * part);
                let middle: [f32; 3] = std::array::from_fn(|k| {
                    triangle.iter().map(|at| arrays.positions[*at as usize][k]).sum::<f32>() / 3.0
                });
                // From the middle of the chunk to the edge.
                assert!(out[1] == 0.0 && out[0] * (middle[0] - 2.0) + out[2] * (middle[2] - 3.0) > 0.0, "{out:?}");
            }
        }
    }

    #[test]
    fn without_samples_around_normals_are_one_sided() {
        let window = Window::new(3, 3, 1.0);
        let heights = (0..9).map(|k| (k % 3) as f32 * 2.0).collect();
        let arrays =
            ChunkArrays::of(&Grid::from_data(window, heights).unwrap(), &window, 0.0, Winding::Counterclockwise);
        assert!(arrays.normals.iter().all(|normal| (normal[0] / normal[1] + 2.0).abs() < 1e-6 && normal[2] == 0.0));
        let heights = vec![f32::NAN; 9];
        let missing =
            ChunkArrays::of(&Grid::from_data(window, heights).unwrap(), &window, 7.0, Winding::Counterclockwise);
        assert_eq!(missing.heights, [7.0; 9]);
    }
}
