//! Water as meshes: rivers as ribbons on the ground, lakes and the sea as level surfaces.

use orogen_grid::grid::Grid;

/// A mesh of water. Vertices are in metres from the first sample of the ground: east, height, south.
#[derive(Debug, Clone, PartialEq)]
pub struct WaterMesh {
    /// The name.
    pub name: &'static str,
    /// Red, green and blue in linear light, and opacity: 0 to 1.
    pub color: [f32; 4],
    /// The vertices.
    pub corners: Vec<[f32; 3]>,
    /// Triangles, counter-clockwise seen from above.
    pub triangles: Vec<[u32; 3]>,
}

/// A river as the input of a ribbon.
#[derive(Debug, Clone, PartialEq)]
pub struct Ribbon {
    /// Column, row and height of each point, downstream.
    pub points: Vec<[f64; 3]>,
    /// Width between the banks at the first and at the last point, in metres.
    pub widths: [f64; 2],
}

/// Maximum distance between cross-sections of a ribbon, in samples.
const STEP: f64 = 0.5;

impl WaterMesh {
    /// A mesh without triangles.
    #[must_use]
    pub fn new(name: &'static str, color: [f32; 4]) -> WaterMesh {
        WaterMesh { name, color, corners: Vec::new(), triangles: Vec::new() }
    }

    /// Adds a ribbon on the ground. At each cross-section, both banks and the middle are at the height of the river, or
    /// `lift` metres above the ground if that is higher.
    pub fn lay(&mut self, ribbon: &Ribbon, ground: &Grid, lift: f64) {
        let points = resampled(&ribbon.points);
        if points.len() < 2 {
            return;
        }
        let cell = ground.window().cell;
        let ends = [ground.width(), ground.height()].map(|samples| samples.saturating_sub(1) as f64);
        let first = self.corners.len() as u32;
        for (k, [x, y, z]) in points.iter().copied().enumerate() {
            let (before, after) = (points[k.saturating_sub(1)], points[(k + 1).min(points.len() - 1)]);
            let (east, south) = (after[0] - before[0], after[1] - before[1]);
            let length = libm::hypot(east, south).max(1e-12);
            let share = k as f64 / (points.len() - 1) as f64;
            let half = (ribbon.widths[0] + (ribbon.widths[1] - ribbon.widths[0]) * share) / 2.0 / cell;
            // From the left bank to the right one, looking downstream.
            for side in [-1.0, 0.0, 1.0] {
                let at = [x - side * half * south / length, y + side * half * east / length];
                let at = [at[0].clamp(0.0, ends[0]), at[1].clamp(0.0, ends[1])];
                let height = z.max(height(ground, at) + lift);
                self.corners.push([(at[0] * cell) as f32, height as f32, (at[1] * cell) as f32]);
            }
        }
        for k in 0..points.len() as u32 - 1 {
            let (here, next) = (first + 3 * k, first + 3 * k + 3);
            for side in 0..2 {
                let [a, b, c, d] = [here + side, here + side + 1, next + side, next + side + 1];
                for triangle in [[a, b, c], [b, d, c]] {
                    // Triangles beyond the border of the ground have no area.
                    if self.area(triangle) > 0.0 {
                        self.triangles.push(triangle);
                    }
                }
            }
        }
    }

    /// Covers all squares between samples that have a wet corner with level water. The ground next to it rises above
    /// the water, so the shore is the intersection of both meshes. `level` returns the water level at a sample.
    pub fn cover(&mut self, ground: &Grid, level: impl Fn(usize, usize) -> Option<f32>) {
        let cell = ground.window().cell;
        let at = |i: usize| (i as f64 * cell) as f32;
        for j in 0..ground.height().saturating_sub(1) {
            // Adjacent squares with the same level are merged.
            let mut open: Option<(usize, f32)> = None;
            for i in 0..ground.width() {
                let square =
                    || [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].into_iter().find_map(|(i, j)| level(i, j));
                let here = if i + 1 < ground.width() { square() } else { None };
                if let Some((start, height)) = open
                    && here != Some(height)
                {
                    let first = self.corners.len() as u32;
                    let (west, east, north, south) = (at(start), at(i), at(j), at(j + 1));
                    self.corners.extend([
                        [west, height, north],
                        [west, height, south],
                        [east, height, south],
                        [east, height, north],
                    ]);
                    self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
                    open = None;
                }
                if open.is_none() {
                    open = here.map(|height| (i, height));
                }
            }
        }
    }

    /// Twice the area of a triangle seen from above.
    fn area(&self, triangle: [u32; 3]) -> f32 {
        let [a, b, c] = triangle.map(|corner| self.corners[corner as usize]);
        (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2])
    }

    /// The upward unit normal of each vertex: the area-weighted mean of the adjacent triangles.
    #[must_use]
    pub fn normals(&self) -> Vec<[f32; 3]> {
        let mut sums = vec![[0.0f64; 3]; self.corners.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| self.corners[corner as usize].map(f64::from));
            let [u, v]: [[f64; 3]; 2] = [b, c].map(|end| std::array::from_fn(|k| end[k] - a[k]));
            let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            for corner in triangle {
                sums[*corner as usize].iter_mut().zip(cross).for_each(|(sum, part)| *sum += part);
            }
        }
        let unit = |sum: [f64; 3]| {
            let length = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt();
            // A vertex without a triangle, where a ribbon ends beyond the ground.
            if length > 0.0 { sum.map(|part| (part / length) as f32) } else { [0.0, 1.0, 0.0] }
        };
        sums.into_iter().map(unit).collect()
    }

    /// Multiplies heights by `factor`.
    pub fn exaggerate(&mut self, factor: f32) {
        self.corners.iter_mut().for_each(|corner| corner[1] *= factor);
    }
}

/// Points at most [`STEP`] apart.
fn resampled(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut out: Vec<[f64; 3]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let steps = (length / STEP).ceil().max(1.0);
        if length > 0.0 {
            out.extend(
                (1..=steps as usize).map(|k| [0, 1, 2].map(|c| from[c] + (to[c] - from[c]) * (k as f64 / steps))),
            );
        }
    }
    out
}

/// The ground between samples: the higher of the two possible triangulations of the square.
fn height(ground: &Grid, [x, y]: [f64; 2]) -> f64 {
    let along = |v: f64, samples: usize| {
        let start = (v.floor() as usize).min(samples.saturating_sub(2));
        (start, (start + 1).min(samples - 1), v - start as f64)
    };
    let ((west, east, u), (north, south, v)) = (along(x, ground.width()), along(y, ground.height()));
    let at = |i: usize, j: usize| f64::from(ground[(i, j)]);
    let (nw, ne, sw, se) = (at(west, north), at(east, north), at(west, south), at(east, south));
    let falling = if u > v { nw + (ne - nw) * u + (se - ne) * v } else { nw + (se - sw) * u + (sw - nw) * v };
    let rising = if u + v < 1.0 {
        nw + (ne - nw) * u + (sw - nw) * v
    } else {
        se + (sw - se) * (1.0 - u) + (ne - se) * (1.0 - v)
    };
    falling.max(rising)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    #[test]
    fn a_ribbon_is_as_wide_as_its_river_and_never_below_the_ground() {
        let mut ground = Grid::filled(Window::new(30, 20, 10.0), 0.0);
        for j in 0..20 {
            for i in 0..30 {
                ground.row_mut(j)[i] = 100.0 - i as f32 + 3.0 * (j as f32 - 9.0).abs();
            }
        }
        let points = (2..28).map(|i| [i as f64, 9.0, 100.0 - i as f64]).collect();
        let mut mesh = WaterMesh::new("rivers", [0.0; 4]);
        mesh.lay(&Ribbon { points, widths: [4.0, 8.0] }, &ground, 0.1);
        assert_eq!((mesh.corners.len(), mesh.triangles.len()), (3 * 51, 4 * 50));
        assert!(mesh.triangles.iter().all(|triangle| mesh.area(*triangle) > 0.0));
        for (section, width) in [(0usize, 4.0f32), (50, 8.0)] {
            let [left, _, right] = [0, 1, 2].map(|k| mesh.corners[3 * section + k]);
            assert!(((left[2] - right[2]).abs() - width).abs() < 1e-3 && left[2] < right[2], "{left:?} {right:?}");
        }
        for [east, high, south] in &mesh.corners {
            let under = height(&ground, [f64::from(*east) / 10.0, f64::from(*south) / 10.0]);
            assert!(f64::from(*high) >= under + 0.099);
        }
        // Its normals point downstream and match the slope of 1 in 10.
        let middle = mesh.normals()[3 * 25 + 1];
        assert!((middle[0] / middle[1] - 0.1).abs() < 0.01 && middle[2].abs() < 0.01, "{middle:?}");
    }

    #[test]
    fn a_ribbon_along_the_border_has_no_triangles_beyond_it() {
        let ground = Grid::filled(Window::new(9, 9, 10.0), 5.0);
        let mut mesh = WaterMesh::new("rivers", [0.0; 4]);
        let points = (0..9).map(|i| [f64::from(i), 0.0, 5.0]).collect();
        mesh.lay(&Ribbon { points, widths: [4.0, 4.0] }, &ground, 0.1);
        assert!(mesh.triangles.iter().all(|triangle| mesh.area(*triangle) > 0.0));
        assert_eq!(mesh.triangles.len(), 2 * 16, "the half on the ground");
        assert!(mesh.normals().iter().all(|normal| *normal == [0.0, 1.0, 0.0]));
    }

    #[test]
    fn water_covers_the_squares_that_it_touches() {
        let mut ground = Grid::filled(Window::new(9, 7, 5.0), 10.0);
        for j in 2..4 {
            ground.row_mut(j)[3..6].fill(2.0);
        }
        let mut mesh = WaterMesh::new("lakes", [0.0; 4]);
        mesh.cover(&ground, |i, j| (ground[(i, j)] < 8.0).then_some(8.0));
        let area: f32 = mesh.triangles.iter().map(|triangle| mesh.area(*triangle) / 2.0).sum();
        // Three rows of four squares, each row one strip.
        assert_eq!((area, mesh.triangles.len()), (12.0 * 25.0, 6));
        assert!(mesh.corners.iter().all(|corner| corner[1] == 8.0));
        assert!(mesh.normals().iter().all(|normal| *normal == [0.0, 1.0, 0.0]));
        mesh.exaggerate(2.0);
        assert!(mesh.corners.iter().all(|corner| corner[1] == 16.0));
        let mut none = WaterMesh::new("sea", [0.0; 4]);
        none.cover(&ground, |_, _| None);
        assert!(none.triangles.is_empty());
    }
}
