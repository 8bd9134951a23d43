//! Mountains whose ridges branch as an aggregate does.

use crate::aggregate::relief::{self, Ridges};
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Solution, Solver, Sources};

op! {
    /// Mountains whose ridges are a branching aggregate: diffusion-limited aggregation (Witten and Sander 1981) at many scales.
    ///
    /// On a grid of 12 cells walkers wander until they stick to what grew from the world's middle; each finer grid takes the figure over, bent a
    /// little, and lets it grow on, so that coarse branches become ranges and fine ones their spurs. At every scale a ridge stands the higher
    /// the farther it is from its tip, by 1 - 1 / (1 + d / `taper`); the scales are added, coarse ones smoothed at each refinement. The grids halve
    /// from the world's longer side down to its cell, so a finer cell adds finer spurs and moves nothing. It has no valleys carved by water:
    /// follow it by `stream-power`. Time grows with the world, about 0.3 microseconds a cell of it; memory is up to 120 bytes a cell.
    pub struct Dla = "dla", solver, revision 1;
    params {
        /// How high the highest summit is.
        height: f64 = 2500.0, unit "m", range 0.0 to 1e6;
        /// How far it grows from the middle, as a share of the way to the world's edges.
        reach: f64 = 0.95, range 0.05 to 1.0;
        /// The share of the ground that ridges cover at every scale: more is a denser net of spurs.
        density: f64 = 0.2, range 0.01 to 0.6;
        /// How high spurs half as long are, beside the ridges they grow on.
        gain: f64 = 0.65, range 0.0 to 1.0;
        /// How far from its tip a ridge has half its height, in cells of its scale.
        taper: f64 = 8.0, range 0.1 to 1000.0;
        /// Which chances.
        seed: u64 = 0;
    }
    layers {
        /// The heights, from about 0 between the ridges.
        height: height, unit "m";
    }
}

impl Solver for Dla {
    fn scratch(&self, padded: &Window) -> u64 {
        // Its grid is up to twice as fine each way as the world.
        padded.len() as u64 * 4 * 30
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let (world, padded) = (sources.world(), sources.padded());
        let ridges = Ridges {
            seed: context.world_params.seed_of(self.seed),
            reach: self.reach,
            density: self.density,
            gain: self.gain,
            taper: self.taper,
        };
        let (across, down, map) = relief::heights(world.width, world.height, &ridges, context.progress)?;
        context.progress.check()?;
        let summit = map.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
        let factor = self.height as f32 / summit;
        let longest = world.width.max(world.height).saturating_sub(1).max(1) as f64;
        let fine = across.max(down) as f64;
        let mut out = Grid::filled(*padded, 0.0f32);
        let samples = map.into_iter().map(|h| h * factor).collect();
        let map = Grid::from_data(Window::new(across, down, 1.0), samples)
            .unwrap_or_else(|| Grid::filled(Window::new(1, 1, 1.0), 0.0));
        // Cells of the relief to one of the world, from middle to middle.
        let along = |i: i64, count: usize| ((i as f64 / longest * fine) - 0.5).clamp(0.0, count as f64 - 1.0);
        let rows: Vec<f64> = (0..padded.height).map(|j| along(padded.y + j as i64 - world.y, down)).collect();
        let columns: Vec<f64> = (0..padded.width).map(|i| along(padded.x + i as i64 - world.x, across)).collect();
        for (j, y) in rows.iter().enumerate() {
            for (sample, x) in out.row_mut(j).iter_mut().zip(&columns) {
                *sample = between(&map, *x, *y);
            }
        }
        Ok(Solution { layers: vec![sources.keep(out)?], scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        400.0
    }
}

/// Between the samples, bilinear.
fn between(map: &Grid, x: f64, y: f64) -> f32 {
    let (i, j) = (x as usize, y as usize);
    let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
    let (right, below) = ((i + 1).min(map.width() - 1), (j + 1).min(map.height() - 1));
    let mixed = |j: usize| map.get(i, j) * (1.0 - u) + map.get(right, j) * u;
    mixed(j) * (1.0 - v) + mixed(below) * v
}
