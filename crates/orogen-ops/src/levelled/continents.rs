//! Continents with rivers, without bounds.

use super::drained::{self, Lattices, Reading};
use super::layer_passes::lower_layers;
use super::passes::{self, GivenInputs};
use crate::declare::Declared;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, GridInputs, Levelled, Levels, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::multiscale::continents::Continents as Land;
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::{MAX_LEVELS, Refinement};

op! {
    /// Eroded land without bounds: continents with ranges, plains and plateaus, coasts, inland basins with lakes, and
    /// rivers from their sources to the sea.
    ///
    /// The land is made level by level. The coarsest level places sea, uplift and the courses of the largest rivers by
    /// noise. Each finer level has half the cell: rivers keep their course, area and fall, and new branches grow
    /// between them, with slopes by the steady state of the stream power law, S = (U/K) A^-m, limited on hillslopes. A
    /// window of a level depends on the coarser level around it only, so any window is made by itself, a river of 4000
    /// km runs through tiles that know nothing of each other, and a larger cell shows the same land coarsely. Sea level
    /// is at 0.
    ///
    /// Related: hydrology-based terrain (Génevaux and others 2013), Dendry (Gaillard and others 2019), multi-scale
    /// terrain amplification (Schott and others 2024).
    pub struct Continents = "continents", levelled, revision 3;
    inputs {
        /// Distance to the shore in metres, positive on land, in place of the op's own continents. Lakes and rivers
        /// keep what they need; rivers end in its sea or, where a coarse level saw a sea that is not there, in a lake.
        /// Where it is NaN, the op's own is used.
        shore: optional,
        /// Uplift over erodibility in place of the op's own ranges and plains: about 1.5 in high mountains, 0.5 in
        /// hills, 0.1 in plains. Where it is NaN, the op's own is used.
        uplift: optional,
        /// Factor of the stable slope of hillsides, greater where rock is harder. Default: 1.
        stability_factor: optional,
        /// Factor of the creep of soil, up to 1.25. Default: 1.
        creep_factor: optional,
        /// Factor of the width of valley floors. Default: 1.
        floor_factor: optional,
        /// Factor of the rain: `flow` and the slopes of rivers follow the discharge, which is that of a larger drainage
        /// area where more rain falls. Default: 1.
        rain: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level of valleys.
        cell: f64 = 60.0, unit "m", range 1e-2 to 1e4;
        /// Number of times the coarsest cell is halved. Continents and ranges are placed at the coarsest cell: 122.88
        /// km by default.
        halvings: u32 = 11, range 1 to 24;
        /// Share of land, about.
        land: f64 = 0.37, range 0.05 to 0.95;
        /// Factor of the uplift, and so of heights and slopes.
        relief: f64 = 1.0, range 0.01 to 10.0;
        /// Distance over which soil creep rounds hillsides at `cell`, in cells. Detail levels have creep, too, unless
        /// it is 0.
        creep: f64 = 1.0, range 0.0 to 5.0;
        /// Factor of the variation of the rock, which each level adds to: 0 makes even slopes and straight side
        /// valleys.
        variation: f64 = 1.0, range 0.0 to 4.0;
        /// Factor of the size of continents and ranges.
        size: f64 = 1.0, range 0.01 to 100.0;
        /// Share of the suitable inland basins that hold a lake without an outlet. All other land drains to the sea.
        basins: f64 = 0.8, range 0.0 to 1.0;
        /// Drainage area from which on there is a river, for `width` and `depth`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Runoff from the ground: a river with discharge Q (m^3/s) is 5 Q^0.5 m wide and 0.3 Q^0.4 m deep (Leopold and
        /// Maddock 1953).
        runoff: f64 = 0.5, unit "m/yr", range 0.0 to 1000.0;
        /// Number of further halvings, below `cell`: 6 make levels from 30 m to 0.94 m. Their slopes are those of the
        /// finest valleys, with gullies on them, rough rock where they are steep, and beds and banks of rivers that are
        /// wider than a sample. Finer samples are interpolated.
        details: u32 = 0, range 0 to 10;
        /// How frequent lakes with an outlet are along rivers, from none to many. Their regions are about 100 km wide;
        /// there are few in plains. They begin at cells of 5 km to 400 m: levels that begin with a smaller cell have
        /// none.
        lakes: f64 = 0.0, range 0.0 to 1.0;
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
        /// Height of the node in the cell south-east of the sample; the water level of water. It falls from each node
        /// to its receiver. At `cell` nodes are at the samples; on other levels the other layers are interpolated
        /// between them, or are those of the nearest one.
        node_height: label, unit "m";
        /// Drainage area of this node, including its cell.
        node_flow: label, unit "m^2";
        /// Flow direction of this node, to the node in the next cell; 8 in water, 16 more than the direction in lakes
        /// with an outlet.
        node_receiver: label;
        /// Distance of this node east of the sample.
        node_east: label, unit "m";
        /// Distance of this node south of the sample.
        node_south: label, unit "m";
    }
}

impl Continents {
    fn reading(&self) -> Reading {
        Reading { share: 0.0, stream: self.stream, runoff: self.runoff, sea_level: 0.0 }
    }

    fn land(&self, context: &Context) -> Land {
        let refinement = self.refinement().with_seed(context.world_params.seed_of(self.seed));
        Land::default().with_refinement(refinement).with_land(self.land).with_size(self.size).with_basins(self.basins)
    }

    fn lattices(refinement: Refinement, continents: Option<&Land>) -> Lattices<'_> {
        Lattices { refinement, ahead: |_| 0, continents }
    }

    /// The levels without the seed, on which neither cells nor reaches depend.
    fn refinement(&self) -> Refinement {
        Refinement::default()
            .with_cell(self.cell)
            .with_levels((self.halvings as usize).min(MAX_LEVELS))
            .with_relief(self.relief)
            .with_creep(self.creep)
            .with_variation(self.variation)
            .with_details(self.details as usize)
            .with_lakes(self.lakes)
    }
}

fn given<'a>(inputs: &GridInputs<'a>) -> Given<'a> {
    Given {
        shore: inputs.get("shore"),
        uplift: inputs.get("uplift"),
        stability_factor: inputs.get("stability_factor"),
        creep_factor: inputs.get("creep_factor"),
        floor_factor: inputs.get("floor_factor"),
        rain: inputs.get("rain"),
        continents: None,
    }
}

impl Levelled for Continents {
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
        if level == 0 { Land::COARSEST_REACH } else { self.refinement().given_reach(level) }
    }

    fn level_at_samples(&self) -> usize {
        self.refinement().levels
    }

    fn levels_with_inputs(&self) -> usize {
        drained::levels_with_inputs(&self.refinement())
    }

    fn coarsest(&self, inputs: &GridInputs, window: &Window, context: &Context) -> Result<Vec<Grid>> {
        Ok(self.land(context).coarsest(&given(inputs), window, context.progress)?.into_planes())
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        inputs: &GridInputs,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        let land = self.land(context);
        Self::lattices(land.refinement, Some(&land)).refine(level, parent, inputs, given, window, context)
    }

    fn parent(&self, level: usize, window: &Window) -> Window {
        Self::lattices(self.refinement(), None).parent(level, window)
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
        drained::layers_of(&self.refinement(), &self.reading(), level, planes, window, out, context)
    }

    fn lower_layers(&self, level: usize, wanted: &[bool], _: &WorldParams) -> Lowering<Passes> {
        lower_layers(&self.refinement(), &self.reading(), level, wanted)
    }

    fn lower(&self, level: usize, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let refinement = self.refinement().with_seed(world_params.seed_of(self.seed));
        if refinement.has_geography(level) {
            return Lowering::Processor("continents and ranges are placed in f64");
        }
        let input = |name: &str| self.spec().given_input(name, given);
        let given = GivenInputs {
            shore: input("shore"),
            uplift: input("uplift"),
            stability_factor: input("stability_factor"),
            creep_factor: input("creep_factor"),
            floor_factor: input("floor_factor"),
            rain: input("rain"),
        };
        passes::lower(&refinement, level, &given, |_| 0)
    }

    fn cost(&self, level: usize) -> f64 {
        // Tiles of the coarsest level work on a wide halo.
        if level == 0 { 2e4 } else { drained::COST }
    }

    fn scratch(&self, level: usize, window: &Window) -> u64 {
        let halo = if level == 0 { Land::COARSEST_REACH } else { 2 * self.halo(level) };
        drained::scratch(window, halo, self.spec().inputs.len())
    }
}
