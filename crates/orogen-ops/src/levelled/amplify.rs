//! Coarse land with ever smaller valleys.

use super::drained::{self, Lattices, Reading};
use super::layer_passes::lower_layers;
use super::passes::{self, GivenInputs};
use crate::declare::Declared;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, GridInputs, Levelled, Levels, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::multiscale::coarse::{Coarse, REACH};
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::{MAX_LEVELS, Refinement};

op! {
    /// Coarse land refined level by level: its rivers keep their course, area and fall, and ever smaller valleys and
    /// slopes grow between them.
    ///
    /// The heights and drainage areas of the coarsest level are those of the source, usually a `stream-power` solved
    /// over the whole world at a cell of about a kilometre, which takes a moment. Each finer level has half the cell.
    /// Rivers are led through it, branches grow up from them, and slopes follow the steady state of the stream power
    /// law, S = (U/K) A^-m, limited on hillslopes. A window of a level depends on the coarser level around it only, so
    /// any window is made by itself, and a larger cell shows the same land coarsely. Where the coarse land has no
    /// receiver, in depressions and beyond its border, there is standing water. Ground below sea level is refined like
    /// land, unless `sea` is set.
    ///
    /// Related: terrain amplification (Schott and others 2024), hydrology-based terrain (Génevaux and others 2013).
    pub struct Amplify = "amplify", levelled, revision 2;
    inputs {
        /// Heights of the coarse land without depressions. It is read at the coarsest cell, `cell` times 2 to the power
        /// of `halvings`: solve it there.
        source: required,
        /// Drainage area of the coarse land in m^2.
        flow: required,
        /// Flow direction of the coarse land, clockwise from east (0) to north-east (7); 8 where it has no receiver.
        /// Default: the steepest descent.
        receiver: optional,
        /// Uplift over erodibility: about 1.5 in high mountains, 0.5 in hills, 0.1 in plains. Default: 1.
        uplift: optional,
        /// Factor of the stable slope of hillsides, greater where rock is harder. Default: 1.
        stability_factor: optional,
        /// Factor of the creep of soil, up to 1.25. Default: 1.
        creep_factor: optional,
        /// Factor of the width of valley floors. Default: 1.
        floor_factor: optional,
        /// Factor of the rain: `flow` and the slopes of rivers follow the discharge, which is that of a larger drainage
        /// area where more rain falls. The `flow` of the source should contain it. Default: 1.
        rain: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level of valleys.
        cell: f64 = 60.0, unit "m", range 1e-2 to 1e4;
        /// Number of times the coarsest cell is halved.
        halvings: u32 = 4, range 1 to 24;
        /// Factor of the uplift, and so of the slopes that grow.
        relief: f64 = 1.0, range 0.01 to 10.0;
        /// Distance over which soil creep rounds hillsides at `cell`, in cells. Detail levels have creep, too, unless
        /// it is 0.
        creep: f64 = 1.0, range 0.0 to 5.0;
        /// Factor of the variation of the rock, which each level adds to: 0 makes even slopes and straight side
        /// valleys.
        variation: f64 = 1.0, range 0.0 to 4.0;
        /// Drainage area from which on there is a river, for `width` and `depth`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Runoff from the ground: a river with discharge Q (m^3/s) is 5 Q^0.5 m wide and 0.3 Q^0.4 m deep (Leopold and
        /// Maddock 1953).
        runoff: f64 = 0.5, unit "m/yr", range 0.0 to 1000.0;
        /// How far the rivers of the source are displaced within its cells: 1 places them at random, so that the grid
        /// does not show; 0 places them in the source's valleys, by 3 x 3 heights around each sample, which suits real
        /// land.
        jitter: f64 = 1.0, range 0.0 to 1.0;
        /// Number of further halvings, below `cell`. Their slopes are those of the finest valleys, with gullies on
        /// them, rough rock where they are steep, and beds and banks of rivers that are wider than a sample. Finer
        /// samples are interpolated.
        details: u32 = 0, range 0 to 10;
        /// How frequent lakes with an outlet are along rivers, from none to many. Their regions are about 100 km wide;
        /// there are few in plains. They begin at cells of 5 km to 400 m: levels that begin with a smaller cell have
        /// none.
        lakes: f64 = 0.0, range 0.0 to 1.0;
        /// Whether there is a sea where the source is at or below the world's sea level. It is as deep as the source,
        /// up to 4944 m, and rivers end at its shore.
        sea: bool = false;
    }
    layers {
        /// Height of the ground, and of the beds of lakes and the sea.
        height: height, unit "m";
        /// Drainage area, including the cell itself; weighted by `rain` if it is given.
        flow: flow, unit "m^2";
        /// Depth of standing water in lakes, 0 elsewhere.
        lake: height, unit "m";
        /// Height of the ground or of the water above it.
        surface: height, unit "m";
        /// Flow direction, clockwise from east (0) to north-east (7), also in lakes with an outlet; 8 in other water.
        receiver: label;
        /// Width of the river; 0 outside rivers.
        width: label, unit "m";
        /// Depth of the river from bank to bed; 0 outside rivers.
        depth: label, unit "m";
        /// Depth of the water over the ground in a flood; 0 where there is none. It is max(0, b + 3 d - z) over ground
        /// of height z, with the height b of the banks and the `depth` d of the first river downstream (height above
        /// the nearest drainage; Rennó and others 2008, Nobre and others 2011), and 4 d in rivers: about twice as deep
        /// as between full banks (Rosgen 1994). It reaches at most 4000 m or 96 samples from a river.
        floodplain: height, unit "m";
        /// Thickness of the sediment of rivers on valley floors; 0 on hillsides and in standing water. It is 100 f /
        /// (100 + f) m for f = 0.25 min(e, w - r): below the floor the sides of the valley go on with a slope of 0.25
        /// (Jaboyedoff and Derron 2005). e is the distance to the foot of the hillside, r that from the river, and w
        /// half the width of the river's floor, at most 4000 m or 128 samples.
        sediment: height, unit "m";
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
            .with_details(self.details as usize)
            .with_lakes(self.lakes)
            .with_sea(self.sea)
    }

    fn reading(&self, level: usize, world_params: &WorldParams) -> Reading {
        // The samples of level 0 are those of the source, in the middles of its cells; those of finer levels are at the
        // corners of theirs.
        let share = if level == 0 { 0.5 } else { 0.0 };
        // Levels with a sea have it at 0.
        let sea_level = if self.sea { world_params.sea_level as f32 } else { 0.0 };
        Reading { share, stream: self.stream, runoff: self.runoff, sea_level }
    }

    fn seeded(&self, context: &Context) -> Refinement {
        self.refinement().with_seed(context.world_params.seed_of(self.seed))
    }
}

/// Number of samples that the lattice of a level is ahead of the samples of windows. A sample of the source is in the
/// middle of its coarsest cell, and the finer lattices begin at the corner of cell 0, half a coarsest cell before.
fn ahead(level: usize) -> i64 {
    if level == 0 { 0 } else { 1i64 << (level - 1).min(MAX_LEVELS) }
}

fn given<'a>(inputs: &GridInputs<'a>) -> Given<'a> {
    Given {
        shore: None,
        uplift: inputs.get("uplift"),
        stability_factor: inputs.get("stability_factor"),
        creep_factor: inputs.get("creep_factor"),
        floor_factor: inputs.get("floor_factor"),
        rain: inputs.get("rain"),
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

    fn level_at_samples(&self) -> usize {
        self.refinement().levels
    }

    fn levels_with_inputs(&self) -> usize {
        drained::levels_with_inputs(&self.refinement())
    }

    fn coarsest(&self, inputs: &GridInputs, window: &Window, context: &Context) -> Result<Vec<Grid>> {
        let height = inputs.required("source")?;
        let coarse = Coarse { height, flow: inputs.required("flow")?, receiver: inputs.get("receiver") };
        let mut level = self.seeded(context).coarsest_of(&coarse, &given(inputs), window, context.progress)?;
        if self.sea {
            level.drown(height, context.world_params.sea_level as f32);
        }
        Ok(level.into_planes())
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &GridInputs,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        let lattices = Lattices { refinement: self.seeded(context), ahead, continents: None };
        lattices.refine(level, parent, inputs, given, window, context)
    }

    fn parent(&self, level: usize, window: &Window) -> Window {
        Lattices { refinement: self.refinement(), ahead, continents: None }.parent(level, window)
    }

    fn surface_halo(&self, level: usize, wanted: &[bool]) -> usize {
        drained::surface_halo(&self.refinement(), level, wanted)
    }

    fn layers_of(
        &self,
        level: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let reading = self.reading(level, context.world_params);
        drained::layers_of(&self.seeded(context), &reading, level, planes, window, out, context)
    }

    fn lower_layers(&self, level: usize, wanted: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        lower_layers(&self.refinement(), &self.reading(level, world_params), level, wanted)
    }

    fn lower(&self, level: usize, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let refinement = self.refinement().with_seed(world_params.seed_of(self.seed));
        let input = |name: &str| self.spec().given_input(name, given);
        let given = GivenInputs {
            shore: None,
            uplift: input("uplift"),
            stability_factor: input("stability_factor"),
            creep_factor: input("creep_factor"),
            floor_factor: input("floor_factor"),
            rain: input("rain"),
        };
        passes::lower(&refinement, level, &given, ahead)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn cost(&self, level: usize) -> f64 {
        if level == 0 { 50.0 } else { drained::COST }
    }

    fn scratch(&self, level: usize, window: &Window) -> u64 {
        let halo = if level == 0 { REACH } else { 2 * self.halo(level) };
        drained::scratch(window, halo, self.spec().inputs.len())
    }
}
