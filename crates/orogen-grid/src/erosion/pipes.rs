//! Hydraulic erosion with virtual pipes.

use super::pipe_rows::{AHEAD, BED, Constants, DEPTH, EAST, SOUTH, Sweep};
use super::planes::Planes;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;
use orogen_simd::{Body, Simd, dispatch};

/// Hydraulic erosion with virtual pipes, after X. Mei, P. Decaudin and B. Hu, "Fast hydraulic erosion simulation and
/// visualization on GPU" (2007) and O. Stava, B. Benes, M. Brisbin and J. Krivanek, "Interactive terrain modeling using
/// hydraulic erosion" (2008).
///
/// In each iteration of dt seconds, with H the surface of the water, A the area of a pipe, l the cell and d the depth:
///
/// ```text
/// f' = friction f + dt g A (H_i - H_j) / l        through the side between cells i and j, counted from i to j
/// f  = f' min(1, d l^2 / (dt sum of what flows out of the cell it comes from))
/// d' = d + dt (in - out) / l^2
/// C  = capacity sin(slope) |q|                    |q| the discharge a metre of width, m^2/s
/// ```
///
/// Where the sediment s is less than C, erosion dt (C - s) is eroded; where it is more, deposition dt (s - C) is
/// deposited. Erosion is limited to half the drop to the lowest neighbor, and deposition to the neighbors' mean plus
/// a quarter of the water depth, which prevents pits and spikes. Sediment moves as a share of the water that flows over
/// each side, instead of backtracing along the velocity as in Mei and others, so mass is conserved. One signed flow per
/// side replaces their two (J. F. O'Brien and J. K. Hodgins, 1995).
///
/// Erosion and deposition are shared over 3 x 3 cells, with weights (1, 2, 1) along each axis; otherwise grooves would
/// form along the grid's axes. An iteration reads three cells on each side: a side's flow depends on the surfaces of
/// its two cells, the limit depends on the other sides of a cell, and finally the changes are shared.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pipes {
    /// Rain, in metres of water per second.
    pub rain: f64,
    /// Share of the water that evaporates per second.
    pub evaporation: f64,
    /// Sediment, in metres, that a discharge of 1 m^2/s carries on a vertical slope.
    pub capacity: f64,
    /// Share of the unused capacity that is eroded per second.
    pub erosion: f64,
    /// Share of the excess sediment that is deposited per second.
    pub deposition: f64,
    /// Area of a pipe, in m^2 per metre of a cell's side.
    pub pipe: f64,
    /// Share of the flow that friction removes per second.
    pub friction: f64,
    /// Gravity, in m/s^2.
    pub gravity: f64,
    /// Time step in seconds. It is reduced to the longest stable step.
    pub time_step: f64,
}

impl Default for Pipes {
    /// The defaults of the op `pipes`.
    fn default() -> Pipes {
        Pipes {
            rain: 0.002,
            evaporation: 0.01,
            capacity: 2.0,
            erosion: 0.3,
            deposition: 0.3,
            pipe: 1.0,
            friction: 0.05,
            gravity: 9.81,
            time_step: 1.0,
        }
    }
}

orogen_noise::builder!(
    Pipes:
    with_rain(rain: f64),
    with_evaporation(evaporation: f64),
    with_capacity(capacity: f64),
    with_erosion(erosion: f64),
    with_deposition(deposition: f64),
    with_pipe(pipe: f64),
    with_friction(friction: f64),
    with_gravity(gravity: f64),
    with_time_step(time_step: f64)
);

/// The radius that an iteration reads, in cells.
pub const RADIUS: usize = 3;

/// Maximum of dt^2 g A / l^3: waves are stable below 1/2.
const COURANT: f64 = 0.25;

/// Ground and water. The planes are bed, depth and sediment (in metres), and flow east and flow south (in metres of a
/// cell's water per iteration).
#[derive(Debug, Clone, PartialEq)]
pub struct Wet {
    /// The planes, with one row and column around them that represent the walls.
    planes: Planes<5>,
    window: Window,
}

impl Wet {
    /// Dry ground surrounded by walls.
    #[must_use]
    pub fn new(bed: &Grid) -> Wet {
        let window = *bed.window();
        let mut wet = Wet { planes: Planes::new(window.width + 2, window.height + 2), window };
        let rows = wet.planes.rows_mut(1, window.height).into_iter().enumerate();
        parallel::for_each(rows, |(j, row)| row[BED][1..=window.width].copy_from_slice(bed.row(j)));
        wet.wall();
        wet
    }

    /// The window of the cells.
    #[must_use]
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The values of one plane.
    #[must_use]
    pub fn plane(&self, plane: usize) -> Grid {
        let mut out = Grid::filled(self.window, 0.0f32);
        let rows = out.data_mut().chunks_mut(self.window.width.max(1)).enumerate();
        parallel::for_each(rows, |(j, row)| row.copy_from_slice(&self.planes.row(j + 1)[plane][1..=self.window.width]));
        out
    }

    /// Sets the walls to the height of the adjacent ground, so that they have no slope, and removes their water.
    fn wall(&mut self) {
        let (width, height) = (self.window.width, self.window.height);
        for j in 0..height + 2 {
            let [bed, rest @ ..] = self.planes.row_mut(j);
            (bed[0], bed[width + 1]) = (bed[1], bed[width]);
            for plane in rest {
                if j == 0 || j == height + 1 {
                    plane.fill(0.0);
                }
                (plane[0], plane[width + 1]) = (0.0, 0.0);
            }
        }
        for (from, to) in [(1, 0), (height, height + 1)] {
            let bed = self.planes.row(from)[BED].to_vec();
            self.planes.set(BED, to, &bed);
        }
    }

    /// The speed of the water, in m/s, with the time step of `pipes`: discharge over depth. It is 0 where the depth is
    /// less than 0.1 mm.
    #[must_use]
    pub fn speed(&self, pipes: &Pipes) -> Grid {
        let mut out = Grid::filled(self.window, 0.0f32);
        let scale = pipes.speed_scale(self.window.cell);
        for j in 0..self.window.height {
            let [north, here] = [self.planes.row(j), self.planes.row(j + 1)];
            for (i, out) in out.row_mut(j).iter_mut().enumerate() {
                let east = here[EAST][i] + here[EAST][i + 1];
                let south = north[SOUTH][i + 1] + here[SOUTH][i + 1];
                let depth = here[DEPTH][i + 1];
                if depth >= 1e-4 {
                    *out = scale * (east * east + south * south).sqrt() / depth;
                }
            }
        }
        out
    }
}

impl Pipes {
    /// Seconds per iteration for this cell size: the time step, or the longest stable step if that is shorter.
    #[must_use]
    pub fn step(&self, cell: f64) -> f64 {
        self.time_step.min(cell * (COURANT / (self.gravity * self.pipe)).sqrt())
    }

    /// Advances by `iterations`; the walls enclose the ground.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn enclosed(&self, wet: Wet, iterations: usize, progress: &Progress) -> Result<Wet> {
        self.go(wet, iterations, 0, progress)
    }

    /// Advances by `iterations` on a part of larger ground. The result is smaller by [`RADIUS`] cells per iteration on
    /// each side, because the walls may have influenced these cells.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn open(&self, wet: Wet, iterations: usize, progress: &Progress) -> Result<Wet> {
        self.go(wet, iterations, RADIUS, progress)
    }

    fn go(&self, mut wet: Wet, iterations: usize, lost: usize, progress: &Progress) -> Result<Wet> {
        let constants = self.constants(wet.window.cell);
        let mut next = Wet { planes: Planes::new(0, 0), window: wet.window };
        let mut spare = Vec::new();
        let mut left = iterations;
        progress.expect(iterations as f64);
        while left > 0 && !wet.window.is_empty() {
            progress.check()?;
            let now = left.min(AT_ONCE);
            let stride = Stride { iterations: now, lost: now * lost };
            advance(&wet, &mut next, &mut spare, stride, &constants, progress)?;
            std::mem::swap(&mut wet, &mut next);
            left -= now;
        }
        Ok(wet)
    }

    /// The constants of an iteration, in the order of [`Constants`], and the speed in m/s of a flow over two sides at a
    /// depth of 1 m.
    #[doc(hidden)]
    #[must_use]
    pub fn numbers(&self, cell: f64) -> [(&'static str, f32); 9] {
        let Constants { pull, kept, rain, capacity, level, erosion, deposition, left } = self.constants(cell);
        [
            ("pull", pull),
            ("kept", kept),
            ("rained", rain),
            ("capacity", capacity),
            ("level_slope", level),
            ("erosion", erosion),
            ("deposition", deposition),
            ("kept_water", left),
            ("speed_scale", self.speed_scale(cell)),
        ]
    }

    /// The speed in m/s of a flow over two sides at a depth of 1 m.
    fn speed_scale(&self, cell: f64) -> f32 {
        (0.5 * cell / self.step(cell)) as f32
    }

    fn constants(&self, cell: f64) -> Constants {
        let dt = self.step(cell);
        let share = |rate: f64| (rate * dt).min(1.0);
        Constants {
            pull: (dt * dt * self.gravity * self.pipe / (cell * cell)) as f32,
            kept: (1.0 - share(self.friction)) as f32,
            rain: (dt * self.rain) as f32,
            // Discharge per metre of width from the sum of the flows over two sides, and slope from the difference of
            // two beds.
            capacity: (self.capacity * 0.5 * cell / dt) as f32,
            level: (4.0 * cell * cell) as f32,
            erosion: share(self.erosion) as f32,
            deposition: share(self.deposition) as f32,
            left: (1.0 - share(self.evaporation)) as f32,
        }
    }
}

/// Number of iterations that follow each other down the rows. Their data stays in a core's own cache, and memory is
/// read only once for all of them. More iterations would gain little, and bands would compute more rows twice.
const AT_ONCE: usize = 8;

/// The extent of one call of [`advance`].
struct Stride {
    iterations: usize,
    /// Cells lost on each side.
    lost: usize,
}

/// Computes `to` from `from`. Bands of rows, one per thread, run in parallel, each with enough rows of its neighbors.
/// The bits do not depend on the number of bands. `spare` is memory that is reused between calls.
fn advance(
    from: &Wet,
    to: &mut Wet,
    spare: &mut Vec<Planes<5>>,
    stride: Stride,
    constants: &Constants,
    progress: &Progress,
) -> Result<()> {
    let (window, lost) = (from.window, stride.lost);
    to.window = window.shrunk(lost);
    let (width, height) = (to.window.width, to.window.height);
    to.planes.resize(width + 2, height + 2);
    let reach = stride.iterations * RADIUS;
    let rows = height.div_ceil(parallel::threads()).max(4 * reach);
    spare.resize_with(height.div_ceil(rows), || Planes::new(0, 0));
    let bands = to.planes.bands_mut(1, height, rows).into_iter().zip(spare);
    let work = stride.iterations as f64 / bands.len().max(1) as f64;
    parallel::try_for_each(bands.enumerate(), |(band, (mut out, planes))| {
        let (top, bottom) = (lost + band * rows, lost + height.min((band + 1) * rows));
        let (first, last) = (top.saturating_sub(reach), window.height.min(bottom + reach));
        // The cells from first to last, and a row of walls on each side.
        planes.copy_rows(&from.planes, first, last + 2);
        progress.check()?;
        dispatch(Down { planes, iterations: stride.iterations, constants, progress })?;
        for (j, out) in out.iter_mut().enumerate() {
            progress.check()?;
            for (out, row) in out.iter_mut().zip(planes.row(top - first + j + 1)) {
                out[1..=width].copy_from_slice(&row[1 + lost..=width + lost]);
            }
        }
        progress.advance(work);
        Ok(())
    })?;
    to.wall();
    Ok(())
}

/// Iterations that follow each other down the rows, in place.
struct Down<'a> {
    planes: &'a mut Planes<5>,
    iterations: usize,
    constants: &'a Constants,
    progress: &'a Progress,
}

impl Body for Down<'_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Result<()> {
        let (width, rows) = (self.planes.width(), self.planes.height());
        let mut sweeps: Vec<Sweep> = (0..self.iterations).map(|_| Sweep::new(width)).collect();
        // An iteration at a row makes the second row above it final. The next iteration reads that row as the row below
        // its own.
        for step in 0..=rows + AHEAD * self.iterations {
            self.progress.check()?;
            for (k, sweep) in sweeps.iter_mut().enumerate() {
                if let Some(j) = step.checked_sub(AHEAD * k).filter(|j| *j <= rows) {
                    simd.run(Row { sweep, planes: &mut *self.planes, j, constants: self.constants });
                }
            }
        }
        Ok(())
    }
}

/// One iteration at one row.
struct Row<'a> {
    sweep: &'a mut Sweep,
    planes: &'a mut Planes<5>,
    j: usize,
    constants: &'a Constants,
}

impl Body for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        self.sweep.row(self.planes, self.j, self.constants);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::erosion::pipe_rows::SEDIMENT;

    fn pipes() -> Pipes {
        Pipes {
            rain: 2e-3,
            evaporation: 0.02,
            capacity: 3.0,
            erosion: 0.4,
            deposition: 0.3,
            pipe: 1.0,
            friction: 0.05,
            gravity: 9.81,
            time_step: 1.0,
        }
    }

    fn ground(window: Window) -> Grid {
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..window.height {
            for i in 0..window.width {
                let (x, y) = (window.east(i), window.south(j));
                let rough = (x * 1.37 + y * 0.71).rem_euclid(13.0) * (y * 0.93 - x * 0.37).rem_euclid(11.0) / 20.0;
                grid.row_mut(j)[i] = (1500.0 + 90.0 * libm::sin(x / 130.0) * libm::cos(y / 170.0) + rough) as f32;
            }
        }
        grid
    }

    fn sum(grid: &Grid) -> f64 {
        grid.data().iter().map(|v| f64::from(*v)).sum()
    }

    #[test]
    fn a_closed_box_keeps_its_mass_and_accounts_for_rain_and_evaporation() {
        let bed = ground(Window::new(120, 90, 10.0));
        let pipes = pipes();
        let ok = Progress::none();
        let wet = pipes.enclosed(Wet::new(&bed), 200, &ok).unwrap();
        let cells = bed.window().len() as f64;
        let dt = pipes.step(10.0);
        // Each iteration removes a fraction of all water by evaporation, then adds rain to all cells.
        let water = (0..200).fold(0.0, |water, _| water * (1.0 - pipes.evaporation * dt) + pipes.rain * dt * cells);
        let there = sum(&wet.plane(DEPTH));
        assert!((there / water - 1.0).abs() < 1e-5, "{there} of {water}");
        let (before, after, carried) = (sum(&bed), sum(&wet.plane(BED)), sum(&wet.plane(SEDIMENT)));
        let moved: f64 = bed.data().iter().zip(wet.plane(BED).data()).map(|(a, b)| f64::from((a - b).abs())).sum();
        assert!(moved > 0.1 * cells, "{moved} m moved");
        assert!((before - after - carried).abs() < 1e-5 * moved, "{before} {after} {carried}, {moved} moved");
        // The rounding error of a bed 1500 m high changes the sediment.
        assert!(wet.plane(DEPTH).data().iter().chain(wet.plane(SEDIMENT).data()).all(|v| *v > -2e-4));
    }

    #[test]
    fn an_open_window_is_the_middle_of_a_larger_one_on_any_number_of_threads() {
        let (window, iterations) = (Window::new(70, 260, 10.0).at(-9, 4), 7);
        let ok = Progress::none();
        let grown = |by: usize| ground(window.grown(by + RADIUS * iterations));
        let large = pipes().open(Wet::new(&grown(20)), iterations, &ok).unwrap();
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let small = pool.install(|| pipes().open(Wet::new(&grown(0)), iterations, &ok)).unwrap();
            assert_eq!(*small.window(), window);
            for plane in [BED, DEPTH, SEDIMENT, EAST, SOUTH] {
                assert_eq!(small.plane(plane), large.plane(plane).crop(&window).unwrap(), "{plane}");
            }
        }
    }

    #[test]
    fn water_comes_to_rest_level() {
        // A bowl that contains water: no rain, no erosion.
        let still = Pipes { rain: 0.0, evaporation: 0.0, capacity: 0.0, friction: 0.2, ..pipes() };
        let window = Window::new(41, 41, 5.0).at(-20, -20);
        let mut bed = Grid::filled(window, 0.0);
        for j in 0..41 {
            for i in 0..41 {
                let (x, y) = (window.east(i), window.south(j));
                bed.row_mut(j)[i] = ((x * x + y * y) / 500.0) as f32;
            }
        }
        let mut wet = Wet::new(&bed);
        for j in 1..=41 {
            wet.planes.row_mut(j)[DEPTH][1..=41].fill(2.0);
        }
        let done = still.enclosed(wet, 3000, &Progress::none()).unwrap();
        let (bed, depth) = (done.plane(BED), done.plane(DEPTH));
        let surfaces: Vec<f32> =
            bed.data().iter().zip(depth.data()).filter(|(_, d)| **d > 0.05).map(|(b, d)| b + d).collect();
        let (low, high) = surfaces.iter().fold((f32::MAX, f32::MIN), |(l, h), s| (l.min(*s), h.max(*s)));
        assert!(surfaces.len() > 300 && high - low < 0.01, "{low} to {high} over {}", surfaces.len());
        assert!(done.speed(&still).data().iter().all(|v| *v < 0.1));
    }
}
