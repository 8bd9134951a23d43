//! Curvature of the ground.
//!
//! A quadric is fitted to the 3 x 3 neighborhood a b c / d e f / g h i of cells of c metres (Zevenbergen and Thorne,
//! "Quantitative analysis of land surface topography", 1987):
//!
//! ```text
//! r = (d - 2 e + f) / c^2      s = (a - c - g + i) / 4 c^2 (rows down the page)      t = (b - 2 e + h) / c^2
//! p = (f - d) / 2 c            q = (h - b) / 2 c
//! ```
//!
//! where p and r are along x, and q and t along y (south). Curvatures are in 1/m and positive where the ground is
//! convex, for example on ridges.

use super::slope::inner;
use crate::grid::Grid;

/// The kinds of curvature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Curvature {
    /// Profile curvature, along the slope line: positive where the slope steepens downhill. 0 on level ground.
    Profile,
    /// Plan curvature, along the contour: positive where water diverges. 0 on level ground.
    Plan,
    /// Total curvature: the negative Laplacian, -(r + t). Positive on summits, negative in pits.
    Total,
}

/// The curvature in 1/m at every sample of `grid` except its border; NaN where one of the nine samples is not finite.
#[must_use]
pub fn curvature(grid: &Grid, kind: Curvature) -> Grid {
    let window = inner(grid.window());
    let mut out = Grid::filled(window, 0.0f32);
    let c = window.cell;
    for j in 0..window.height {
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        for (i, out) in out.row_mut(j).iter_mut().enumerate() {
            let z = |y: usize, x: usize| f64::from(rows[y][i + x]);
            let z = [0, 1, 2].map(|y| [0, 1, 2].map(|x| z(y, x)));
            *out = bend(z, c, kind);
        }
    }
    out
}

/// The curvature, in 1/m, at the center of 3 x 3 heights that are `c` metres apart, rows from the north; NaN if a
/// height is not finite.
#[must_use]
pub fn bend(z: [[f64; 3]; 3], c: f64, kind: Curvature) -> f32 {
    let r = (z[1][0] - 2.0 * z[1][1] + z[1][2]) / (c * c);
    let t = (z[0][1] - 2.0 * z[1][1] + z[2][1]) / (c * c);
    let s = (z[0][0] - z[0][2] - z[2][0] + z[2][2]) / (4.0 * c * c);
    let (p, q) = ((z[1][2] - z[1][0]) / (2.0 * c), (z[2][1] - z[0][1]) / (2.0 * c));
    let steep = p * p + q * q;
    let bend = match kind {
        Curvature::Total => -(r + t),
        _ if steep == 0.0 => 0.0 * (r + s + t),
        Curvature::Profile => {
            let one = 1.0 + steep;
            -(r * p * p + 2.0 * s * p * q + t * q * q) / (steep * one * one.sqrt())
        }
        Curvature::Plan => -(r * q * q - 2.0 * s * p * q + t * p * p) / (steep * steep.sqrt()),
    };
    // The corners contribute only to s; this check detects a corner that is not finite.
    if s.is_finite() { bend as f32 } else { f32::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    fn made(f: impl Fn(f64, f64) -> f64) -> Grid {
        let window = Window::new(21, 21, 2.0).at(-10, -10);
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..21 {
            for i in 0..21 {
                grid.row_mut(j)[i] = f(window.east(i), window.south(j)) as f32;
            }
        }
        grid
    }

    #[test]
    fn quadrics_have_their_own_curvatures() {
        // The crest of a cylinder along y at x = 0 with z = -x^2 / 2. At (x, y) the slope is -x, and all curvature is
        // in the direction of the slope.
        let crest = made(|x, _| -x * x / 2.0);
        let profile = curvature(&crest, Curvature::Profile);
        let expect = |x: f64| 1.0 / libm::pow(1.0 + x * x, 1.5);
        for i in [2usize, 5, 14] {
            let x = crest.window().east(i + 1);
            assert!((f64::from(profile[(i, 7)]) - expect(x)).abs() < 1e-5);
        }
        assert!(curvature(&crest, Curvature::Plan).data().iter().all(|v| v.abs() < 1e-6));
        assert!(curvature(&crest, Curvature::Total).data().iter().all(|v| (v - 1.0).abs() < 1e-5));
        // The total curvature of a saddle is 0.
        assert!(curvature(&made(|x, y| x * y), Curvature::Total).data().iter().all(|v| v.abs() < 1e-5));
    }

    #[test]
    fn contours_of_a_cone_bend_by_their_radius() {
        let cone = made(|x, y| -(x * x + y * y).sqrt());
        let plan = curvature(&cone, Curvature::Plan);
        let (x, y) = (cone.window().east(17), cone.window().south(16));
        let radius = (x * x + y * y).sqrt();
        assert!((f64::from(plan[(16, 15)]) * radius - 1.0).abs() < 0.02);
        // Flow converges in a valley: the opposite sign.
        let hollow = curvature(&made(|x, y| (x * x + y * y).sqrt()), Curvature::Plan);
        assert!(hollow[(16, 15)] < 0.0);
    }

    #[test]
    fn any_missing_sample_of_the_nine_is_noticed() {
        for (x, y) in [(0, 0), (1, 0), (1, 1), (2, 2)] {
            let mut grid = Grid::filled(Window::new(3, 3, 1.0), 1.0);
            grid.row_mut(y)[x] = f32::NAN;
            for kind in [Curvature::Profile, Curvature::Plan, Curvature::Total] {
                assert!(curvature(&grid, kind)[(0, 0)].is_nan(), "{x} {y} {kind:?}");
            }
        }
    }
}
