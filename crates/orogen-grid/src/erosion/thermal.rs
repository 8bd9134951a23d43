//! Thermal weathering: slopes slide until they reach the talus angle.

use super::planes::{self, Pass, Planes};
use super::rows::settle;
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;
use crate::strata::Strata;
use orogen_simd::{Body, Simd, dispatch};

/// Thermal weathering after F. K. Musgrave, C. E. Kolb and R. S. Mace, "The synthesis and rendering of eroded fractal
/// terrains" (1989): material on slopes above the talus angle moves down.
///
/// The original compares each cell with its neighbors in eight directions, which gives octagonal cones. Here the
/// following amount of material crosses the side between two cells, where g is the gradient there (both components) and
/// T the stable slope:
///
/// ```text
/// q = fraction (1 - T / |g|) g_across    where |g| > T, else 0
/// ```
///
/// so the talus slope is the same in all directions. The amount that leaves one cell enters the next, so mass is
/// conserved.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Thermal {
    /// Stable slope, rise over run.
    pub talus: f64,
    /// Share of the excess that moves in a pass, 0 to 1. All values are stable.
    pub rate: f64,
}

impl Thermal {
    /// Weathering to the stable slope `talus` (rise over run), with a rate of 1.
    #[must_use]
    pub const fn new(talus: f64) -> Thermal {
        Thermal { talus, rate: 1.0 }
    }
}

orogen_noise::builder!(Thermal: with_talus(talus: f64), with_rate(rate: f64));

/// The share of a height difference that crosses a side at a rate of 1. With 1/4 or more, a checkerboard of heights
/// would not decay.
const FASTEST: f64 = 0.2;

impl Thermal {
    /// The heights after `passes` passes, over a window that is smaller by one sample per pass on each side. Use
    /// [`Grid::padded`] for a result as large as the heights.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn run(&self, heights: &Grid, passes: usize, progress: &Progress) -> Result<Grid> {
        let mut planes = Planes::new(heights.width(), heights.height());
        planes.fill(0, heights);
        let [stands, share] = self.numbers(heights.window().cell);
        let pass = Slide { stands, share };
        let settled = planes::run(planes, passes, &pass, progress)?;
        Ok(settled.grid(0, heights.window().shrunk(passes)))
    }

    /// [`Thermal::run`] in strata, each with its own stable slope: material moves where the slope is above that of the
    /// rock of the higher cell. `bottoms` has the heights of the bottom of their sequence; there are no strata where it
    /// has no value.
    ///
    /// # Errors
    /// If the work is cancelled.
    #[doc(hidden)]
    pub fn run_in_strata(
        &self,
        strata: &Strata,
        heights: &Grid,
        bottoms: &Grid,
        passes: usize,
        progress: &Progress,
    ) -> Result<Grid> {
        let mut planes = Planes::new(heights.width(), heights.height());
        planes.fill(0, heights);
        planes.fill(1, bottoms);
        let cell = heights.window().cell;
        let [stands, share] = self.numbers(cell);
        let pass = Layered { slide: Slide { stands, share }, strata, cell };
        let settled = planes::run(planes, passes, &pass, progress)?;
        Ok(settled.grid(0, heights.window().shrunk(passes)))
    }

    /// The height difference between neighbors at the stable slope, and the share of a difference that moves in a pass.
    #[doc(hidden)]
    #[must_use]
    pub fn numbers(&self, cell: f64) -> [f32; 2] {
        [(self.talus * cell) as f32, (self.rate * FASTEST) as f32]
    }
}

/// The rule in units of samples: `stands` is the height difference between neighbors at the stable slope.
struct Slide {
    stands: f32,
    share: f32,
}

impl Pass<1> for Slide {
    const RADIUS: usize = 1;

    fn make(&self, from: &Planes<1>, to: &mut Planes<1>, scratch: &mut Vec<f32>) {
        scratch.resize(2 * to.width() + 1 + to.width(), 0.0);
        dispatch(Rows { slide: self, from, to, scratch });
    }
}

struct Rows<'a> {
    slide: &'a Slide,
    from: &'a Planes<1>,
    to: &'a mut Planes<1>,
    scratch: &'a mut [f32],
}

impl Body for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let width = self.to.width();
        let (sides, rest) = self.scratch.split_at_mut(width + 1);
        let (mut above, mut below) = rest.split_at_mut(width);
        let stands = |_: usize, _: bool| self.slide.stands;
        let [first, second] = [0, 1].map(|j| self.from.row(j)[0]);
        self.slide.across_rows(first, second, stands, above);
        for j in 0..self.to.height() {
            let [north, here, south] = [j, j + 1, j + 2].map(|j| self.from.row(j)[0]);
            self.slide.across_columns(north, here, south, stands, sides);
            self.slide.across_rows(here, south, stands, below);
            let [out] = self.to.row_mut(j);
            settle(&here[1..=width], [&*sides, &*above, &*below], out);
            std::mem::swap(&mut above, &mut below);
        }
    }
}

/// The rule in strata.
struct Layered<'a> {
    slide: Slide,
    strata: &'a Strata,
    cell: f64,
}

impl Layered<'_> {
    /// The height differences between neighbors at the stable slopes of a row of cells.
    fn stand(&self, [heights, bottoms]: [&[f32]; 2], out: &mut [f32]) {
        for ((out, height), bottom) in out.iter_mut().zip(heights).zip(bottoms) {
            let above = f64::from(*height) - f64::from(*bottom);
            let stands = (self.strata.max_slope(above) * self.cell) as f32;
            *out = if above.is_finite() { stands } else { self.slide.stands };
        }
    }
}

impl Pass<2> for Layered<'_> {
    const RADIUS: usize = 1;

    fn make(&self, from: &Planes<2>, to: &mut Planes<2>, scratch: &mut Vec<f32>) {
        let (width, wide) = (to.width(), from.width());
        scratch.resize(2 * wide + 3 * width + 1, 0.0);
        let (sides, rest) = scratch.split_at_mut(width + 1);
        let (mut above, rest) = rest.split_at_mut(width);
        let (mut below, rest) = rest.split_at_mut(width);
        let (mut stands, mut stands_south) = rest.split_at_mut(wide);
        self.stand(from.row(0), stands);
        for j in 0..=to.height() {
            // The sides between rows j and j + 1 of `from`.
            let [[north, _], south] = [j, j + 1].map(|j| from.row(j));
            self.stand(south, stands_south);
            let higher = |i: usize, is_north: bool| if is_north { stands[i] } else { stands_south[i] };
            self.slide.across_rows(north, south[0], higher, below);
            if let Some(j) = j.checked_sub(1) {
                let [before, [here, bottoms], after] = [j, j + 1, j + 2].map(|j| from.row(j));
                let higher = |i: usize, is_west: bool| if is_west { stands[i] } else { stands[i + 1] };
                self.slide.across_columns(before[0], here, after[0], higher, sides);
                let [out, out_bottoms] = to.row_mut(j);
                settle(&here[1..=width], [&*sides, &*above, &*below], out);
                out_bottoms.copy_from_slice(&bottoms[1..=width]);
            }
            std::mem::swap(&mut above, &mut below);
            std::mem::swap(&mut stands, &mut stands_south);
        }
    }
}

impl Slide {
    /// Material that moves east over the sides between the columns of row `here`. `stands` is the height difference at
    /// the stable slope of the cell on either side of a side: that in the west or that in the east.
    #[inline(always)]
    fn across_columns(
        &self,
        north: &[f32],
        here: &[f32],
        south: &[f32],
        stands: impl Fn(usize, bool) -> f32,
        out: &mut [f32],
    ) {
        let n = out.len();
        let [nw, ne] = [&north[..n], &north[1..=n]];
        let [w, e] = [&here[..n], &here[1..=n]];
        let [sw, se] = [&south[..n], &south[1..=n]];
        for i in 0..n {
            let across = w[i] - e[i];
            out[i] = self.moved(across, ((nw[i] - sw[i]) + (ne[i] - se[i])) * 0.25, stands(i, across > 0.0));
        }
    }

    /// Material that moves south from the inner samples of `north` to those of `south`. `stands` is as for columns, by
    /// the columns of these rows: that in the north or that in the south.
    #[inline(always)]
    fn across_rows(&self, north: &[f32], south: &[f32], stands: impl Fn(usize, bool) -> f32, out: &mut [f32]) {
        let n = out.len();
        let [nw, n_, ne] = [&north[..n], &north[1..=n], &north[2..n + 2]];
        let [sw, s_, se] = [&south[..n], &south[1..=n], &south[2..n + 2]];
        for i in 0..n {
            let across = n_[i] - s_[i];
            out[i] = self.moved(across, ((nw[i] - ne[i]) + (sw[i] - se[i])) * 0.25, stands(i + 1, across > 0.0));
        }
    }

    #[inline(always)]
    fn moved(&self, across: f32, along: f32, stands: f32) -> f32 {
        let steep = (across * across + along * along).sqrt();
        let excess = 1.0 - stands / steep;
        // On level ground this is a division by 0, and the resulting NaN must move nothing.
        let excess = if excess > 0.0 { excess } else { 0.0 };
        self.share * excess * across
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::slope;
    use crate::grid::Window;
    use crate::strata::Stratum;

    fn made(window: Window, height: impl Fn(f64, f64) -> f64) -> Grid {
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..window.height {
            for i in 0..window.width {
                grid.row_mut(j)[i] = height(window.east(i), window.south(j)) as f32;
            }
        }
        grid
    }

    fn sum(grid: &Grid) -> f64 {
        grid.data().iter().map(|v| f64::from(*v)).sum()
    }

    fn weathered(heights: &Grid, angle: f64, passes: usize) -> Grid {
        let thermal = Thermal { talus: libm::tan(angle.to_radians()), rate: 1.0 };
        thermal.run(heights, passes, &Progress::none()).unwrap()
    }

    #[test]
    fn a_steep_cone_ends_at_the_talus_angle_in_all_directions() {
        let passes = 300;
        for angle in [25.0, 33.0, 45.0] {
            let window = Window::new(41, 41, 5.0).at(-20, -20).grown(passes);
            let cone = made(window, |x, y| (75.0 - 1.5 * (x * x + y * y).sqrt()).max(0.0));
            let done = weathered(&cone, angle, passes);
            let degrees = slope::slope_degrees(&done);
            let mut seen = [0; 16];
            for j in 0..degrees.height() {
                for i in 0..degrees.width() {
                    let (x, y) = (degrees.window().east(i), degrees.window().south(j));
                    let r = (x * x + y * y).sqrt();
                    // Excludes the tip and the foot, which are rounded.
                    if (24.0..46.0).contains(&r) {
                        let off = f64::from(degrees[(i, j)]) - angle;
                        assert!(off.abs() < 0.5, "{angle}: {off} off at ({x}, {y})");
                        seen[(libm::atan2(y, x).to_degrees() + 180.0) as usize * 16 / 361] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
        }
    }

    #[test]
    fn mass_is_kept() {
        let passes = 60;
        let window = Window::new(64, 64, 2.0).at(7, -3).grown(passes);
        let heap = made(window, |x, y| {
            let near = (x - 70.0).abs() < 40.0 && (y - 60.0).abs() < 40.0;
            1000.0
                + if near { ((x * 13.7).rem_euclid(31.0) * (y * 7.9).rem_euclid(17.0)).rem_euclid(25.0) } else { 0.0 }
        });
        let before = sum(&heap.crop(&window.shrunk(passes)).unwrap());
        let after = weathered(&heap, 30.0, passes);
        assert!((sum(&after) - before).abs() < 1e-7 * before, "{before} {}", sum(&after));
        assert_ne!(heap.crop(after.window()).unwrap(), after);
    }

    #[test]
    fn what_stands_stays_and_the_fastest_rate_makes_nothing_higher() {
        let window = Window::new(40, 30, 10.0).grown(9);
        let hills = made(window, |x, y| 3.0 * libm::sin(x / 40.0) * libm::cos(y / 55.0));
        assert_eq!(weathered(&hills, 40.0, 9), hills.crop(&window.shrunk(9)).unwrap());
        // A checkerboard, the worst case, is smoothed.
        let board = made(window, |x, y| if ((x + y) / 10.0).rem_euclid(2.0) < 0.5 { 50.0 } else { -50.0 });
        let done = weathered(&board, 10.0, 9);
        assert!(done.data().iter().all(|h| h.abs() < 8.0), "{:?}", done[(5, 5)]);
    }

    #[test]
    fn each_stratum_ends_at_its_own_talus_angle() {
        let passes = 400;
        let window = Window::new(121, 3, 5.0).at(-60, 0).grown(passes);
        let ridge = made(window, |x, _| (90.0 - 1.8 * x.abs()).max(0.0));
        let bottoms = Grid::filled(window, 0.0);
        // 30 m at 30 degrees below 1000 m at 50 degrees.
        let strata = [(1000.0, 50.0), (30.0, 30.0)].map(|(thickness, talus_angle)| Stratum {
            thickness,
            talus_angle,
            ..Stratum::default()
        });
        let strata = Strata::new(&strata, false, 1.0).unwrap();
        let thermal = Thermal::new(1.0);
        let done = thermal.run_in_strata(&strata, &ridge, &bottoms, passes, &Progress::none()).unwrap();
        let mut seen = [0; 2];
        for i in 1..120 {
            let height = done[(i, 1)];
            let rise = f64::from(done[(i + 1, 1)] - done[(i - 1, 1)]).abs() / 10.0;
            let angle = libm::atan(rise).to_degrees();
            for (k, (range, talus)) in [(6.0..25.0, 30.0), (36.0..52.0, 50.0)].into_iter().enumerate() {
                if range.contains(&height) {
                    assert!((angle - talus).abs() < 6.0, "{angle} at {height} m");
                    seen[k] += 1;
                }
            }
        }
        assert!(seen.iter().all(|count| *count > 3), "{seen:?}");
        // Strata of one talus angle are that angle.
        let even = Strata::new(&[Stratum::default(), Stratum::default()], true, 1.0).unwrap();
        let layered = thermal.run_in_strata(&even, &ridge, &bottoms, 9, &Progress::none()).unwrap();
        assert_eq!(layered, thermal.run(&ridge, 9, &Progress::none()).unwrap());
    }
}
