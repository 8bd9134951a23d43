//! Mountains from diffusion-limited aggregation.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::aggregate::relief::{self, Ridges};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Mountains with branching ridges, made by diffusion-limited aggregation (Witten and Sander 1981) at many scales.
    ///
    /// On a grid of 12 cells random walkers move until they attach to the aggregate that grows from the world's center.
    /// Each finer grid takes over the aggregate, slightly bent, and continues the growth, so that coarse branches
    /// become ranges and fine ones their spurs. At each scale the height of a ridge grows with the distance d from its
    /// tip, by 1 - 1 / (1 + d / `taper`). The scales are added; coarse ones are smoothed at each refinement. The grid
    /// spacing halves from the world's longer side down to its cell, so a smaller cell adds finer spurs and leaves the
    /// rest in place. The result has no valleys carved by water: put `stream-power` after it. Time grows with the
    /// world, about 0.3 microseconds per cell; memory is up to 120 bytes per cell.
    pub struct Dla = "dla", solver, revision 1;
    margin;
    params {
        /// Height of the highest summit.
        height: f64 = 2500.0, unit "m", range 0.0 to 1e6;
        /// Extent of the aggregate from the center, as a share of the distance to the world's edges.
        reach: f64 = 0.95, range 0.05 to 1.0;
        /// Share of the ground covered by ridges at each scale. Higher values give a denser network of spurs.
        density: f64 = 0.2, range 0.01 to 0.6;
        /// Height of spurs relative to ridges twice as long.
        gain: f64 = 0.65, range 0.0 to 1.0;
        /// Distance from its tip at which a ridge has half its height, in cells of its scale.
        taper: f64 = 8.0, range 0.1 to 1000.0;
        /// Seed of the random choices.
        seed: u64 = 0;
    }
    layers {
        /// The heights. They are about 0 between the ridges.
        height: height, unit "m";
    }
}

impl Solver for Dla {
    fn scratch(&self, padded: &Window) -> u64 {
        // The grid is up to twice as fine as the world in each direction.
        memory(padded, 4 * 30)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let (domain, padded) = (sources.domain(), sources.padded());
        let ridges = Ridges::default()
            .with_seed(context.world_params.seed_of(self.seed))
            .with_reach(self.reach)
            .with_density(self.density)
            .with_gain(self.gain)
            .with_taper(self.taper);
        let (across, down, map) = relief::ridge_heights(domain.width, domain.height, &ridges, context.progress)?;
        context.progress.check()?;
        let summit = map.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
        let factor = self.height as f32 / summit;
        let longest = domain.width.max(domain.height).saturating_sub(1).max(1) as f64;
        let fine = across.max(down) as f64;
        let mut out = Grid::filled(*padded, 0.0f32);
        let samples = map.into_iter().map(|h| h * factor).collect();
        let map = Grid::from_data(Window::new(across, down, 1.0), samples)
            .unwrap_or_else(|| Grid::filled(Window::new(1, 1, 1.0), 0.0));
        // The position in cells of the relief, measured between cell centers.
        let along = |i: i64, count: usize| ((i as f64 / longest * fine) - 0.5).clamp(0.0, count as f64 - 1.0);
        let rows: Vec<f64> = (0..padded.height).map(|j| along(padded.y + j as i64 - domain.y, down)).collect();
        let columns: Vec<f64> = (0..padded.width).map(|i| along(padded.x + i as i64 - domain.x, across)).collect();
        for (j, y) in rows.iter().enumerate() {
            for (sample, x) in out.row_mut(j).iter_mut().zip(&columns) {
                *sample = between(&map, *x, *y);
            }
        }
        Ok(Solution { layers: vec![sources.keep(out)?], scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("random walkers attach one after the other")
    }

    fn cost(&self) -> f64 {
        400.0
    }
}

/// Bilinear interpolation between the samples.
fn between(map: &Grid, x: f64, y: f64) -> f32 {
    let (i, j) = (x as usize, y as usize);
    let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
    let (right, below) = ((i + 1).min(map.width() - 1), (j + 1).min(map.height() - 1));
    let mixed = |j: usize| map[(i, j)] * (1.0 - u) + map[(right, j)] * u;
    mixed(j) * (1.0 - v) + mixed(below) * v
}
