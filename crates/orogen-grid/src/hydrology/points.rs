//! Irregular points: a mesh without preferred directions of flow.
//!
//! On a square lattice water has eight directions, and slopes at the limit form facets in these directions, so that
//! ridges and valleys align with the grid. A mesh of irregular points has no preferred directions (as in the
//! triangulated models of Tucker et al., "An object-oriented framework for distributed hydrologic and geomorphic
//! modeling using triangulated irregular networks", 2001). Here each cell keeps its eight neighbors, but its point is
//! displaced within the cell. Distances then differ from pair to pair, and the directions of flow and of facets vary.

use super::direction::{STEPS, hashed, neighbor, opposite};
use super::outlets::Outlets;
use crate::grid::{Grid, Window};
use crate::parallel;

/// One point for each cell of a map, and the distances between neighbors.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    window: Window,
    /// Maximum displacement along each axis, in cells.
    reach: f32,
    salt: u32,
    /// The inverse of the distance, in cells, to the neighbors in the east, south-east, south and south-west.
    inverse_distance: [Vec<f32>; 4],
}

/// Half a cell. With a larger displacement, points could swap places.
const FURTHEST: f64 = 0.5;

impl Points {
    /// Points displaced by up to `share` (0 to 1) of half a cell along each axis, by a hash of their position and
    /// `salt`. Needs 16 bytes per cell.
    #[must_use]
    pub fn new(window: Window, share: f64, salt: u32) -> Points {
        let reach = Points::reach(share);
        let (width, cells) = (window.width, window.len());
        let mut points = Points { window, reach, salt, inverse_distance: std::array::from_fn(|_| vec![1.0; cells]) };
        let mut planes = std::mem::take(&mut points.inverse_distance);
        let [east, south_east, south, south_west] = &mut planes;
        let rows = |plane| <[f32]>::chunks_mut(plane, width.max(1));
        let planes_of_rows = rows(east).zip(rows(south_east)).zip(rows(south).zip(rows(south_west)));
        parallel::for_each(planes_of_rows.enumerate(), |(j, ((east, south_east), (south, south_west)))| {
            // From one column before the first to one after the last.
            let offsets = |j: usize| -> Vec<[f32; 2]> { (-1..=width as i64).map(|i| points.at(i, j as i64)).collect() };
            let (here, below) = (offsets(j), offsets(j + 1));
            for (code, plane) in [east, south_east, south, south_west].into_iter().enumerate() {
                let (x, y) = STEPS[code];
                let there = if y == 0 { &here } else { &below };
                let pairs = here[1..].iter().zip(&there[1usize.wrapping_add_signed(x)..]);
                for (near, (here, there)) in plane.iter_mut().zip(pairs) {
                    let (x, y) = (x as f32 + there[0] - here[0], y as f32 + there[1] - here[1]);
                    *near = 1.0 / (x * x + y * y).sqrt();
                }
            }
        });
        points.inverse_distance = planes;
        points
    }

    /// The maximum displacement along each axis, in cells, for a share of half a cell.
    #[doc(hidden)]
    #[must_use]
    pub fn reach(share: f64) -> f32 {
        (share.clamp(0.0, 1.0) * FURTHEST) as f32
    }

    /// The displacement, in cells east and south, of the point of column `i` and row `j`.
    #[inline]
    fn at(&self, i: i64, j: i64) -> [f32; 2] {
        let hash = hashed(self.window.x + i, (self.window.y + j) ^ (i64::from(self.salt) << 32));
        [hash & 0xFFFF, hash >> 16].map(|bits| (bits as f32 * (2.0 / 65535.0) - 1.0) * self.reach)
    }

    /// The inverse distances, in 1 / cells, from the inner cells of row `j` to their neighbors, in the order of
    /// [`STEPS`].
    pub(super) fn around(&self, j: usize) -> [&[f32]; 8] {
        let width = self.window.width;
        std::array::from_fn(|code| {
            // The distance in the opposite direction is the same.
            let (plane, (east, south)) = if code < 4 { (code, (0, 0)) } else { (code - 4, STEPS[code]) };
            let start = (j.wrapping_add_signed(south) * width + 1).wrapping_add_signed(east);
            &self.inverse_distance[plane][start..start + width - 2]
        })
    }

    /// The inverse distance, in 1 / cells, from cell `c` to the neighbor in direction `code`.
    #[inline(always)]
    pub(super) fn inverse_distance(&self, c: usize, code: u8, strides: &[isize; 8]) -> f32 {
        match code {
            0..4 => self.inverse_distance[usize::from(code)][c],
            _ => self.inverse_distance[usize::from(opposite(code))][neighbor(c, strides[usize::from(code)])],
        }
    }

    /// Interpolates the heights at the points to the lattice, along the local slope. Outlets keep their heights. With
    /// `has_cliffs` heights stay between those of the eight neighbors and the point: beside a cliff there is no slope
    /// to go along.
    pub fn onto_lattice(&self, heights: &mut Grid, outlets: &Outlets, has_cliffs: bool) {
        let (width, height) = (self.window.width, self.window.height);
        if self.reach == 0.0 || width < 3 || height < 3 {
            return;
        }
        let before = heights.clone();
        let h = before.data();
        // Each thread takes several rows, so that an offset is hashed only once for the three rows that use it.
        parallel::for_each(heights.data_mut().chunks_mut(width * ROWS).enumerate(), |(band, rows)| {
            let first = band * ROWS;
            let mut offsets = [Offsets::default(), Offsets::default(), Offsets::default()];
            for (j, row) in (first..).zip(rows.chunks_mut(width)).filter(|(j, _)| *j > 0 && j + 1 < height) {
                if j == first || j == 1 {
                    self.offsets(j - 1, &mut offsets[0]);
                    self.offsets(j, &mut offsets[1]);
                } else {
                    offsets.rotate_left(1);
                }
                self.offsets(j + 1, &mut offsets[2]);
                let around = [j - 1, j, j + 1].map(|j| &h[j * width..(j + 1) * width]);
                carry_over(around, [&offsets[0], &offsets[1], &offsets[2]], has_cliffs, row);
                for (i, height) in row.iter_mut().enumerate() {
                    if i == 0 || i + 1 == width || outlets.at(j * width + i) {
                        *height = around[1][i];
                    }
                }
            }
        });
    }

    /// The offsets of the points of a row.
    fn offsets(&self, j: usize, out: &mut Offsets) {
        let width = self.window.width;
        out.east.resize(width, 0.0);
        out.south.resize(width, 0.0);
        for (i, (east, south)) in out.east.iter_mut().zip(&mut out.south).enumerate() {
            [*east, *south] = self.at(i as i64, j as i64);
        }
    }
}

/// Number of rows that are interpolated together.
const ROWS: usize = 16;

/// The displacements of a row's points, in cells.
#[derive(Default)]
struct Offsets {
    east: Vec<f32>,
    south: Vec<f32>,
}

/// The heights at the lattice points of the middle one of three rows, except at its ends.
fn carry_over(h: [&[f32]; 3], offsets: [&Offsets; 3], has_cliffs: bool, row: &mut [f32]) {
    let width = row.len();
    let (here_x, here_y) = (&offsets[1].east[1..width - 1], &offsets[1].south[1..width - 1]);
    let here = &h[1][1..width - 1];
    // The eight neighbors in the order of STEPS: heights and displacements, shifted along the row.
    let around = STEPS.map(|(east, south)| {
        let from = 1usize.wrapping_add_signed(east);
        let at = 1usize.wrapping_add_signed(south);
        let range = from..from + width - 2;
        (east as f32, south as f32, &h[at][range.clone()], &offsets[at].east[range.clone()], &offsets[at].south[range])
    });
    for (i, height) in row[1..width - 1].iter_mut().enumerate() {
        // The least-squares plane through the point: two equations.
        let [mut xx, mut xy, mut yy, mut xh, mut yh] = [0.0f32; 5];
        for (east, south, heights, there_x, there_y) in &around {
            let (x, y) = (east + there_x[i] - here_x[i], south + there_y[i] - here_y[i]);
            let rise = heights[i] - here[i];
            xx += x * x;
            xy += x * y;
            yy += y * y;
            xh += x * rise;
            yh += y * rise;
        }
        let scale = 1.0 / (xx * yy - xy * xy);
        let slope = [(xh * yy - yh * xy) * scale, (yh * xx - xh * xy) * scale];
        *height = here[i] - slope[0] * here_x[i] - slope[1] * here_y[i];
        if has_cliffs {
            let (mut low, mut high) = (here[i], here[i]);
            for (_, _, heights, _, _) in &around {
                low = if heights[i] < low { heights[i] } else { low };
                high = if heights[i] > high { heights[i] } else { high };
            }
            *height = if *height < low { low } else { *height };
            *height = if *height > high { high } else { *height };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::direction::strides;
    use crate::hydrology::samples;

    #[test]
    fn both_ways_are_as_far_and_shifted_windows_agree() {
        let window = Window::new(40, 30, 1.0).at(-7, 3);
        let points = Points::new(window, 1.0, 5);
        let (strides, inner) = (strides(40), strides(20));
        let part = Points::new(Window::new(20, 15, 1.0).at(2, 8), 1.0, 5);
        let (mut least, mut most) = (f32::INFINITY, 0.0f32);
        for j in 1..29 {
            let around = points.around(j);
            for i in 1..39 {
                let c = j * 40 + i;
                for code in 0..8u8 {
                    let near = points.inverse_distance(c, code, &strides);
                    let there = neighbor(c, strides[usize::from(code)]);
                    assert_eq!(near, points.inverse_distance(there, opposite(code), &strides));
                    assert_eq!(near, around[usize::from(code)][i - 1]);
                    if (10..28).contains(&i) && (6..19).contains(&j) {
                        let c = (j - 5) * 20 + i - 9;
                        assert_eq!(near, part.inverse_distance(c, code, &inner));
                    }
                    (least, most) = (least.min(near), most.max(near));
                }
            }
        }
        assert!(least > 0.35 && most.is_finite() && most > 2.0, "{least} {most}");
    }

    #[test]
    fn no_share_is_the_lattice() {
        let points = Points::new(Window::new(5, 5, 3.0), 0.0, 5);
        for (code, distance) in crate::hydrology::direction::DISTANCES.iter().enumerate() {
            assert_eq!(
                f64::from(points.inverse_distance(12, code as u8, &strides(5))),
                f64::from((1.0 / distance) as f32)
            );
        }
    }

    #[test]
    fn a_plane_is_carried_over_as_it_is() {
        let window = Window::new(50, 40, 10.0);
        let points = Points::new(window, 1.0, 9);
        let outlets = Outlets::new(&Grid::filled(window, 0.0), None);
        let plane = |x: f32, y: f32| 100.0 + 3.0 * x - 2.0 * y;
        let mut heights = Grid::filled(window, 0.0);
        for j in 0..40i64 {
            for i in 0..50i64 {
                let [x, y] = if outlets.at((j * 50 + i) as usize) { [0.0; 2] } else { points.at(i, j) };
                heights.row_mut(j as usize)[i as usize] = plane(i as f32 + x, j as f32 + y);
            }
        }
        points.onto_lattice(&mut heights, &outlets, false);
        for j in 2..38 {
            for i in 2..48 {
                let (got, expect) = (heights[(i, j)], plane(i as f32, j as f32));
                assert!((got - expect).abs() < 1e-3, "{got}, not {expect}");
            }
        }
        let before = samples::hills(20, 20, 3);
        let mut same = before.clone();
        Points::new(*before.window(), 0.0, 9).onto_lattice(&mut same, &Outlets::new(&before, None), true);
        assert_eq!(same, before);
    }
}
