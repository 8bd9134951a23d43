//! Hydraulic erosion by droplets.

use super::brush::Brush;
use super::droplet_paths::{self, Step};
use super::loose::{LOOSE, Loose};
use super::planes::Planes;
use crate::error::Result;
use crate::grid::Grid;
use crate::parallel;
use crate::progress::Progress;

/// Erosion by droplets, after H. T. Beyer, "Implementation of a method for hydraulic erosion" (2015), with lengths in
/// metres.
///
/// A droplet moves one cell at a time in the direction inertia d - (1 - inertia) slope, where d is its previous
/// direction. With s the slope ahead of it, v its speed, w its water and a the ground area that it represents (one over
/// the density), its capacity is the volume
///
/// ```text
/// C = capacity max(s, least) v w a        v^2 = v^2 + g (h - h_ahead)        w = w exp(-evaporation l)
/// ```
///
/// It erodes a share `erosion` of the unused capacity, at most the drop ahead of it, and deposits a share `deposition`
/// of the excess. Before a rise it fills the hollow that it is in. (In widely copied code the sign before g is wrong.)
/// At the end of its path it deposits everything that it carries, so mass is conserved.
///
/// The result of droplets that are simulated one after another depends on their order. Here they are simulated in
/// batches: all droplets of a batch see the same ground, and their changes are summed in fixed point, where the order
/// does not matter. The result is therefore exact for any window.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Droplets {
    /// Droplets per km^2, in all batches together.
    pub density: f64,
    /// Number of batches.
    pub batches: usize,
    /// Maximum length of a path, in metres.
    pub lifetime: f64,
    /// Radius of the brush, in metres.
    pub radius: f64,
    /// Inertia: the share of the previous direction that is kept, 0 to 1.
    pub inertia: f64,
    /// Capacity per m/s on a vertical slope, in metres of ground.
    pub capacity: f64,
    /// Minimum slope for the capacity.
    pub least_slope: f64,
    /// Share of the unused capacity that is eroded at each cell.
    pub erosion: f64,
    /// Share of the excess sediment that is deposited at each cell.
    pub deposition: f64,
    /// Share of the water that evaporates per metre.
    pub evaporation: f64,
    /// Gravity, in m/s^2.
    pub gravity: f64,
    /// Seed of the droplets.
    pub seed: u64,
}

impl Default for Droplets {
    /// The defaults of the op `droplets`.
    fn default() -> Droplets {
        Droplets {
            density: 5000.0,
            batches: 4,
            lifetime: 300.0,
            radius: 30.0,
            inertia: 0.05,
            capacity: 0.4,
            least_slope: 0.01,
            erosion: 0.3,
            deposition: 0.3,
            evaporation: 0.001,
            gravity: 4.0,
            seed: 0,
        }
    }
}

orogen_noise::builder!(
    Droplets:
    with_density(density: f64),
    with_batches(batches: usize),
    with_lifetime(lifetime: f64),
    with_radius(radius: f64),
    with_inertia(inertia: f64),
    with_capacity(capacity: f64),
    with_least_slope(least_slope: f64),
    with_erosion(erosion: f64),
    with_deposition(deposition: f64),
    with_evaporation(evaporation: f64),
    with_gravity(gravity: f64),
    with_seed(seed: u64)
);

impl Droplets {
    /// Maximum length of a path, in cells.
    fn steps(&self, cell: f64) -> usize {
        (self.lifetime / cell).ceil().min(FARTHEST) as usize
    }

    fn brush(&self, cell: f64) -> Brush {
        Brush::new((self.radius / cell).min(FARTHEST))
    }

    /// The halo of all batches, in samples.
    #[must_use]
    pub fn halo(&self, cell: f64) -> usize {
        self.batches * self.reach(cell)
    }

    /// The halo of one batch: a path, the cells around its end, the brush, and the passes in which deposits slide.
    fn reach(&self, cell: f64) -> usize {
        self.steps(cell) + 2 + self.brush(cell).reach() + SETTLED
    }

    /// The heights after all batches, over a window that is smaller by [`Droplets::halo`] on each side.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn run(&self, heights: &Grid, progress: &Progress) -> Result<Grid> {
        let mut heights = heights.clone();
        let mut sums = [Vec::new(), Vec::new()];
        progress.expect(self.batches as f64);
        for batch in 0..self.batches {
            progress.check()?;
            let part = progress.part(1.0);
            heights = self.batch(&heights, batch as u64, &mut sums, &part)?;
            part.finish();
        }
        Ok(heights)
    }

    /// Computes one batch. `sums` is memory that is reused between calls.
    fn batch(&self, heights: &Grid, batch: u64, sums: &mut [Vec<i64>; 2], progress: &Progress) -> Result<Grid> {
        let window = *heights.window();
        let reach = self.reach(window.cell);
        if window.shrunk(reach).is_empty() {
            return Ok(Grid::filled(window.shrunk(reach), 0.0f32));
        }
        // Approximate nanoseconds per cell.
        let rain = self.density * window.cell * window.cell / 1e6 / self.batches as f64;
        let [raining, settling] =
            progress.parts([5.0 + rain * (100.0 + 30.0 * self.steps(window.cell) as f64), 2.0 * SETTLED as f64]);
        self.sum(heights, batch, sums, &raining)?;
        let [cut, laid] = &*sums;
        let brush = self.brush(window.cell);
        let border = reach - SETTLED;
        let inner = window.shrunk(border);
        let cut = brush.over(cut, window.width, border);
        let laid = Brush::new(0.5 * brush.radius()).over(laid, window.width, border);
        let mut planes = Planes::new(inner.width, inner.height);
        parallel::for_each(planes.rows_mut(0, inner.height).into_iter().enumerate(), |(j, [firm, loose])| {
            let before = &heights.row(j + border)[border..border + inner.width];
            for ((firm, before), cut) in firm.iter_mut().zip(before).zip(&cut[j * inner.width..]) {
                *firm = before - cut;
            }
            loose.copy_from_slice(&laid[j * inner.width..][..inner.width]);
        });
        let settled = Loose { stands: (LIES * window.cell) as f32 }.run(planes, SETTLED, &settling)?;
        let mut out = Grid::filled(window.shrunk(reach), 0.0f32);
        let width = out.width();
        parallel::for_each(out.data_mut().chunks_mut(width).enumerate(), |(j, row)| {
            let before = &heights.row(j + reach)[reach..reach + width];
            let cut = &cut[(j + SETTLED) * inner.width + SETTLED..][..width];
            let loose = settled.row(j)[LOOSE];
            // The sum is rounded once.
            for (((out, before), cut), loose) in row.iter_mut().zip(before).zip(cut).zip(loose) {
                *out = before + (loose - cut);
            }
        });
        Ok(out)
    }

    /// The eroded and deposited amounts of one batch at each cell, in multiples of [`droplet_paths::UNIT`]. Bands of
    /// rows run in parallel, first the even ones and then the odd ones, because only neighboring bands write to the
    /// same rows.
    fn sum(&self, heights: &Grid, batch: u64, sums: &mut [Vec<i64>; 2], progress: &Progress) -> Result<()> {
        let window = *heights.window();
        let reach = self.steps(window.cell) + 2;
        let step = self.step(window.cell, batch);
        // Each thread gets the same number of bands of each kind.
        let all = 2 * parallel::threads();
        let most = (window.height / (2 * reach)).clamp(1, 8 * all);
        let bands = if most > all { most - most % all } else { most };
        let rows = window.height.div_ceil(bands).max(2 * reach);
        for sums in &mut *sums {
            if sums.len() < window.len() {
                *sums = vec![0; window.len()];
            }
            sums.truncate(window.len());
            parallel::for_each(sums.chunks_mut(window.width.max(1)), |row| row.fill(0));
        }
        progress.expect(window.height as f64);
        for parity in [0, 1] {
            let mut bands = Vec::new();
            let [mut cut, mut laid] = sums.each_mut().map(Vec::as_mut_slice);
            let mut taken = 0;
            for top in (0..window.height).step_by(rows).skip(parity).step_by(2) {
                let bottom = window.height.min(top + rows);
                let (first, last) = (top.saturating_sub(reach), window.height.min(bottom + reach));
                let skip = (first - taken) * window.width;
                let size = (last - first) * window.width;
                bands.push((top..bottom, first, part(&mut cut, skip, size), part(&mut laid, skip, size)));
                taken = last;
            }
            parallel::try_for_each(bands, |(rows, first, cut, laid)| {
                droplet_paths::run(heights, &step, rows, droplet_paths::Sums { first, cut, laid }, progress)
            })?;
        }
        Ok(())
    }

    fn step(&self, cell: f64, batch: u64) -> Step {
        let ground = 1e6 / self.density.max(1e-9);
        Step {
            seed: self.seed ^ batch.wrapping_mul(0xA076_1D64_78BD_642F),
            expected: self.density * cell * cell / 1e6 / self.batches as f64,
            steps: self.steps(cell),
            inertia: self.inertia as f32,
            // Volumes are expressed in metres over one cell.
            capacity: (self.capacity * ground / (cell * cell)) as f32,
            per_cell: (1.0 / cell) as f32,
            least_slope: self.least_slope as f32,
            erosion: self.erosion as f32,
            deposition: self.deposition as f32,
            left: libm::exp(-self.evaporation * cell) as f32,
            gravity: self.gravity as f32,
        }
    }
}

/// Splits off `size` sums after the first `skip`; the sums after them remain in `all`.
fn part<'a>(all: &mut &'a mut [i64], skip: usize, size: usize) -> &'a mut [i64] {
    let (_, rest) = std::mem::take(all).split_at_mut(skip);
    let (part, rest) = rest.split_at_mut(size);
    *all = rest;
    part
}

/// Number of passes in which freshly deposited ground slides. All droplets of a batch see the same hollow, and would
/// otherwise fill it to a spike.
const SETTLED: usize = 16;

/// Slope, rise over run, at which deposited ground is stable.
const LIES: f64 = 0.02;

/// Maximum length of a path in cells. Halos of longer paths would not fit in memory.
const FARTHEST: f64 = 16_384.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    fn droplets() -> Droplets {
        Droplets {
            density: 8000.0,
            batches: 2,
            lifetime: 150.0,
            radius: 25.0,
            inertia: 0.05,
            capacity: 0.4,
            least_slope: 0.01,
            erosion: 0.3,
            deposition: 0.3,
            evaporation: 1e-3,
            gravity: 4.0,
            seed: 7,
        }
    }

    fn ground(window: Window) -> Grid {
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..window.height {
            for i in 0..window.width {
                let (x, y) = (window.east(i), window.south(j));
                let rough = (x * 1.37 + y * 0.71).rem_euclid(13.0) * (y * 0.93 - x * 0.37).rem_euclid(11.0) / 20.0;
                grid.row_mut(j)[i] = (900.0 + 60.0 * libm::sin(x / 90.0) * libm::cos(y / 110.0) + rough) as f32;
            }
        }
        grid
    }

    #[test]
    fn droplets_end_where_heights_are_missing() {
        let window = Window::new(60, 50, 10.0);
        let whole = ground(window);
        let mut holed = whole.clone();
        holed.row_mut(20)[25..31].fill(f32::NAN);
        holed.row_mut(30)[10] = f32::INFINITY;
        let settled = droplets().run(&holed.padded(droplets().halo(10.0)), &Progress::none()).unwrap();
        for (made, given) in settled.data().iter().zip(holed.data()) {
            assert_eq!(made.is_finite(), given.is_finite(), "{made} of {given}");
            assert!(!given.is_finite() || (made - given).abs() < 200.0, "{made} of {given}");
        }
        assert_ne!(settled.row(5), whole.row(5));
    }

    #[test]
    fn a_window_is_the_middle_of_a_larger_one_on_any_number_of_threads() {
        let droplets = droplets();
        let window = Window::new(90, 140, 10.0).at(-31, 17);
        let grown = |by: usize| ground(window.grown(by + droplets.halo(10.0)));
        let ok = Progress::none();
        let large = droplets.run(&grown(23), &ok).unwrap().crop(&window).unwrap();
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| droplets.run(&grown(0), &ok)).unwrap(), large);
        }
        assert_ne!(ground(window), large);
    }

    #[test]
    fn mass_is_kept() {
        // A mountain on a plain: no sediment crosses the window's border.
        let droplets = droplets();
        let window = Window::new(160, 160, 10.0).at(-80, -80).grown(droplets.halo(10.0));
        let mut ground = Grid::filled(window, 0.0f32);
        for j in 0..window.height {
            for i in 0..window.width {
                let (x, y) = (window.east(i), window.south(j));
                ground.row_mut(j)[i] = (250.0 * libm::exp(-(x * x + 2.0 * y * y) / 9e4)) as f32;
                if ground.row(j)[i] < 2.0 {
                    ground.row_mut(j)[i] = 2.0;
                }
            }
        }
        let done = droplets.run(&ground, &Progress::none()).unwrap();
        let before = ground.crop(done.window()).unwrap();
        let [mut net, mut total] = [0.0, 0.0];
        for (a, b) in before.data().iter().zip(done.data()) {
            net += f64::from(*b) - f64::from(*a);
            total += f64::from(*a);
        }
        // Each batch rounds each height once.
        assert!(net.abs() < 2e-6 * total, "{net} of {total}");
        // The eroded and the deposited volume of a batch are equal.
        let mut sums = [Vec::new(), Vec::new()];
        droplets.sum(&ground, 0, &mut sums, &Progress::none()).unwrap();
        let [cut, laid] = sums;
        let metres = |sums: &[i64]| sums.iter().map(|sum| *sum as f64 * droplet_paths::UNIT).sum::<f64>();
        assert!(metres(&cut) > 1000.0 && (metres(&laid) / metres(&cut) - 1.0).abs() < 1e-8, "{}", metres(&cut));
    }
}
