//! Coarse land with ever smaller valleys.

use super::drained::{self, Reading};
use crate::declare::Declared;
use crate::op::{Context, Levelled, Levels, halved};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::multiscale::coarse::{Coarse, REACH};
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::{MAX_LEVELS, Refinement};

op! {
    /// Coarse land refined level by level: its rivers keep their course, area and fall, and ever smaller valleys and slopes grow between them.
    ///
    /// The heights and drainage areas of the coarsest level are those of the source, usually a `stream-power` solved over the whole world at a cell
    /// of about a kilometre, which takes a moment. Each finer level has half the cell. Rivers are led through it, branches grow up from them, and
    /// slopes follow the steady state of the stream power law, S = (U/K) A^-m, limited on hillslopes. A window of a level depends on the coarser
    /// level around it only, so any window is made by itself, and a larger cell shows the same land coarsely. Where the coarse land has no receiver,
    /// in depressions and beyond its border, there is standing water. Ground below sea level is refined like land: there is no sea.
    ///
    /// Related: terrain amplification (Schott and others 2024), hydrology-based terrain (Génevaux and others 2013).
    pub struct Amplify = "amplify", levelled, revision 2;
    inputs {
        /// Heights of the coarse land without depressions. It is read at the coarsest cell, `cell` times 2 to the power of `halvings`: solve it there.
        source: required,
        /// Drainage area of the coarse land in m^2.
        flow: required,
        /// Flow direction of the coarse land, clockwise from east (0) to north-east (7); 8 where it has no receiver. Default: the steepest descent.
        receiver: optional,
        /// Uplift over erodibility: about 1.5 in high mountains, 0.5 in hills, 0.1 in plains. Default: 1.
        uplift: optional,
        /// Factor of the stable slope of hillsides, greater where rock is harder. Default: 1.
        stability_factor: optional,
        /// Factor of the creep of soil, up to 1.25. Default: 1.
        creep_factor: optional,
        /// Factor of the width of valley floors. Default: 1.
        floor_factor: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level. Finer samples are interpolated.
        cell: f64 = 60.0, unit "m", range 1e-2 to 1e4;
        /// Number of times the coarsest cell is halved.
        halvings: u32 = 4, range 1 to 24;
        /// Factor of the uplift, and so of the slopes that grow.
        relief: f64 = 1.0, range 0.01 to 10.0;
        /// Distance over which soil creep rounds hillsides at the finest level, in its cells.
        creep: f64 = 1.0, range 0.0 to 5.0;
        /// Factor of the variation of the rock, which each level adds to: 0 makes even slopes and straight side valleys.
        variation: f64 = 1.0, range 0.0 to 4.0;
        /// Drainage area from which on there is a river, for `width` and `depth`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Runoff from the ground: a river with discharge Q (m^3/s) is 5 Q^0.5 m wide and 0.3 Q^0.4 m deep (Leopold and Maddock 1953).
        runoff: f64 = 0.5, unit "m/yr", range 0.0 to 1000.0;
        /// How far the rivers of the source are displaced within its cells: 1 places them at random, so that the grid does not show; 0 places them in
        /// the source's valleys, by 3 x 3 heights around each sample, which suits real land.
        jitter: f64 = 1.0, range 0.0 to 1.0;
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
        /// Width of the river; 0 outside rivers.
        width: label, unit "m";
        /// Depth of the river from bank to bed; 0 outside rivers.
        depth: label, unit "m";
    }
}

impl Amplify {
    /// The levels without the seed, on which neither cells nor reaches depend.
    fn refinement(&self) -> Refinement {
        Refinement::default()
            .with_cell(self.cell)
            .with_levels((self.halvings as usize).min(MAX_LEVELS))
            .with_relief(self.relief)
            .with_creep(self.creep)
            .with_variation(self.variation)
            .with_jitter(self.jitter)
    }

    fn seeded(&self, context: &Context) -> Refinement {
        self.refinement().with_seed(context.world_params.seed_of(self.seed))
    }
}

/// Number of samples that a level's lattice of nodes is ahead of the samples of windows. A sample of the source is in the middle of its coarsest cell,
/// and the finer lattices begin at the corner of cell 0, half a coarsest cell before.
fn ahead(level: usize) -> i64 {
    if level == 0 { 0 } else { 1i64 << (level - 1).min(MAX_LEVELS) }
}

/// The nodes of a level at the samples of a window.
fn nodes_at(level: usize, window: &Window) -> Window {
    window.at(window.x + ahead(level), window.y + ahead(level))
}

/// An input of a level with the window of its nodes.
fn input_at_nodes(level: usize, input: Option<&Grid>) -> Option<Grid> {
    let input = input?;
    Grid::from_data(nodes_at(level, input.window()), input.data().to_vec())
}

fn given<'a>(inputs: &[Option<&'a Grid>]) -> Given<'a> {
    let input = |i: usize| inputs.get(i).copied().flatten();
    Given {
        shore: None,
        uplift: input(3),
        stability_factor: input(4),
        creep_factor: input(5),
        floor_factor: input(6),
        continents: None,
    }
}

impl Levelled for Amplify {
    fn levels(&self) -> Levels {
        drained::levels(&self.refinement())
    }

    fn planes(&self) -> usize {
        Level::PLANES
    }

    fn halo(&self, level: usize) -> usize {
        self.refinement().reach(level)
    }

    fn source_halo(&self, level: usize) -> usize {
        if level == 0 { REACH } else { self.refinement().given_reach(level) }
    }

    fn coarsest(&self, inputs: &[Option<&Grid>], window: &Window, context: &Context) -> Result<Vec<Grid>> {
        let &[Some(height), Some(flow), receiver, ..] = inputs else {
            return Err(Error::new(ErrorKind::Internal, "an input of `amplify` is missing"));
        };
        let coarse = Coarse { height, flow, receiver };
        Ok(self.seeded(context).coarsest_of(&coarse, &given(inputs), window, context.progress)?.into_planes())
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &[Option<&Grid>],
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        let mut above = drained::level_of(level - 1, parent)?;
        above.window = nodes_at(level - 1, &above.window);
        let inputs: Vec<Option<Grid>> = inputs.iter().map(|input| input_at_nodes(level, *input)).collect();
        let inputs: Vec<Option<&Grid>> = inputs.iter().map(Option::as_ref).collect();
        let nodes = nodes_at(level, window);
        let mut made = self.seeded(context).refine(&above, &given(&inputs), &nodes, context.progress)?;
        made.window = *window;
        Ok(made.into_planes())
    }

    fn parent(&self, level: usize, window: &Window) -> Window {
        let above = halved(&nodes_at(level, window), self.levels().cell(level.saturating_sub(1)));
        let ahead = ahead(level.saturating_sub(1));
        above.at(above.x - ahead, above.y - ahead).grown(self.halo(level))
    }

    fn surface_halo(&self) -> usize {
        Refinement::SURFACE_REACH
    }

    fn layers_of(
        &self,
        level: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        // The samples of level 0 are those of the source, in the middles of its cells; those of finer levels are at the corners of theirs.
        let share = if level == 0 { 0.5 } else { 0.0 };
        let reading = Reading { share, stream: self.stream, runoff: self.runoff };
        drained::layers_of(&self.seeded(context), &reading, level, planes, window, out, context)
    }

    fn cost(&self, level: usize) -> f64 {
        if level == 0 { 50.0 } else { drained::COST }
    }

    fn scratch(&self, level: usize, window: &Window) -> u64 {
        let halo = if level == 0 { REACH } else { 2 * self.halo(level) };
        // Inputs are copied to the windows of the nodes.
        let copies = 4 * self.spec().inputs.len() as u64;
        let samples = window.grown(halo + 1);
        let copied = copies.saturating_mul(samples.width as u64).saturating_mul(samples.height as u64);
        drained::scratch(window, halo).saturating_add(copied)
    }
}
