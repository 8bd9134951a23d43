//! Continents with rivers, without bounds.

use crate::op::{Context, Levelled, Levels};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::multiscale::continents::{Continents as Land, MAX_LEVELS};
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::Level;

op! {
    /// Eroded land without bounds: continents with ranges, plains and plateaus, coasts, inland basins with lakes, and rivers from their sources
    /// to the sea.
    ///
    /// The land is made level by level. The coarsest level places sea, uplift and the courses of the largest rivers by noise. Each finer level has half
    /// the cell: rivers keep their course, area and fall, and new branches grow between them, with slopes by the steady state of the stream power
    /// law, S = (U/K) A^-m, limited on hillslopes. A window of a level depends on the coarser level around it only, so any window is made by
    /// itself, a river of 4000 km runs through tiles that know nothing of each other, and a larger cell shows the same land coarsely. Sea
    /// level is at 0.
    ///
    /// Related: hydrology-based terrain (Génevaux and others 2013), Dendry (Gaillard and others 2019), multi-scale terrain amplification
    /// (Schott and others 2024).
    pub struct Continents = "continents", levelled, revision 1;
    inputs {
        /// Distance to the shore in metres, positive on land, in place of the op's own continents. Lakes and rivers keep what they need; where it is NaN, the op's own
        /// is used.
        shore: optional,
        /// Uplift over erodibility in place of the op's own ranges and plains: about 1.5 in high mountains, 0.5 in hills, 0.1 in plains. Where it is NaN, the op's own is used.
        uplift: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level. Finer samples are interpolated.
        cell: f64 = 60.0, unit "m", range 1e-2 to 1e4;
        /// Number of times the coarsest cell is halved. Continents and ranges are placed at the coarsest cell: 122.88 km by default.
        halvings: u32 = 11, range 1 to 24;
        /// Share of land, about.
        land: f64 = 0.37, range 0.05 to 0.95;
        /// Factor of the uplift, and so of heights and slopes.
        relief: f64 = 1.0, range 0.01 to 10.0;
        /// Factor of the size of continents and ranges.
        size: f64 = 1.0, range 0.01 to 100.0;
        /// Share of the suitable inland basins that hold a lake without an outlet. All other land drains to the sea.
        basins: f64 = 0.8, range 0.0 to 1.0;
    }
    layers {
        /// Height of the ground, and of the beds of lakes and the sea.
        height: height, unit "m";
        /// Drainage area, including the cell itself.
        flow: flow, unit "m^2";
        /// Depth of standing water in lakes, 0 elsewhere.
        lake: height, unit "m";
        /// Height of the ground or of the water above it.
        surface: height, unit "m";
        /// Flow direction, clockwise from east (0) to north-east (7); 8 in water.
        receiver: label;
    }
}

impl Continents {
    fn land(&self, context: &Context) -> Land {
        self.with_seed(context.world_params.seed_of(self.seed))
    }

    fn with_seed(&self, seed: u64) -> Land {
        Land::new(seed)
            .with_cell(self.cell)
            .with_levels((self.halvings as usize).min(MAX_LEVELS))
            .with_land(self.land)
            .with_relief(self.relief)
            .with_size(self.size)
            .with_basins(self.basins)
    }
}

fn given<'a>(inputs: &[Option<&'a Grid>]) -> Given<'a> {
    let input = |i: usize| inputs.get(i).copied().flatten();
    Given { shore: input(0), uplift: input(1) }
}

impl Levelled for Continents {
    fn levels(&self) -> Levels {
        Levels { finest: self.cell, count: self.halvings as usize + 1 }
    }

    fn planes(&self) -> usize {
        Level::PLANES
    }

    fn halo(&self, level: usize) -> usize {
        self.with_seed(0).reach(level)
    }

    fn source_halo(&self, level: usize) -> usize {
        self.with_seed(0).given_reach(level)
    }

    fn coarsest(&self, inputs: &[Option<&Grid>], window: &Window, context: &Context) -> Result<Vec<Grid>> {
        Ok(self.land(context).coarsest_with(&given(inputs), window, context.progress)?.into_planes())
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &[Option<&Grid>],
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        let parent = Level::from_planes(level - 1, &parent.iter().collect::<Vec<_>>())?;
        Ok(self.land(context).refine_with(&parent, &given(inputs), window, context.progress)?.into_planes())
    }

    fn surface_halo(&self) -> usize {
        Land::SURFACE_REACH
    }

    fn layers_of(
        &self,
        level: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let level = Level::from_planes(level, &planes.iter().collect::<Vec<_>>())?;
        let made = self.land(context).surface(&level, window, context.progress)?;
        let [height, flow, lake, surface, receiver] = out else { return Ok(()) };
        if let Some(surface) = surface {
            *surface = made.height.clone();
            for (surface, water) in surface.data_mut().iter_mut().zip(made.water_level.data()) {
                *surface = if water.is_nan() { *surface } else { *water };
            }
        }
        if let Some(receiver) = receiver {
            let codes = receiver.data_mut().iter_mut().zip(made.receiver.data());
            codes.for_each(|(out, code)| *out = f32::from(*code));
        }
        let layers = [(height, made.height), (flow, made.flow), (lake, made.lake_depth)];
        layers.into_iter().for_each(|(out, made)| *out = out.take().map(|_| made));
        Ok(())
    }

    fn cost(&self, level: usize) -> f64 {
        // Tiles of the coarsest level work on a wide halo.
        if level == 0 { 2e4 } else { 300.0 }
    }

    fn scratch(&self, level: usize, window: &Window) -> u64 {
        let halo = if level == 0 { Land::COARSEST_REACH } else { 2 * self.halo(level) };
        let samples = window.grown(halo);
        Land::bytes_per_sample().saturating_mul(samples.width as u64).saturating_mul(samples.height as u64)
    }
}
