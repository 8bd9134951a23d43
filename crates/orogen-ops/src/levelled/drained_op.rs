//! The common implementation of levelled ops that make drained land.

use super::drained::Drained;
use super::layer_passes::lower_layers;
use super::layers::{layers_of, surface_halo};
use super::passes;
use crate::declare::Declared;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, GridInputs, Levelled, Levels, WorldParams, halved};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::multiscale::coarse::{Coarse, REACH};
use orogen_grid::multiscale::drawn_ridges::DrawnRidges;
use orogen_grid::multiscale::drawn_rivers::DrawnRivers;
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::Refinement;
use std::sync::Arc;

/// Approximate time for a sample of a coarsest level that is given by inputs, in nanoseconds.
const COST_OF_GIVEN: f64 = 50.0;
/// Approximate time for a sample of a coarsest level with continents, whose tiles have a wide halo, in nanoseconds.
const COST_OF_CONTINENTS: f64 = 2e4;
/// Approximate time for a sample of a finer level, in nanoseconds.
const COST: f64 = 300.0;

/// `op!` for drained land: the common layers of such ops come before the declared ones. The op's method `completed`
/// sets parameters of the land that not all of these ops have, and its methods `drawn_rivers` and
/// `drawn_ridges` return what is drawn.
macro_rules! drained_op {
    (
        $(#[doc = $doc:literal])+
        pub struct $name:ident = $op:literal, levelled, revision $revision:literal;
        inputs { $($inputs:tt)* }
        params { $($params:tt)* }
        $(layers { $($layers:tt)* })?
    ) => {
        $crate::op! {
            $(#[doc = $doc])+
            pub struct $name = $op, levelled, revision $revision;
            inputs { $($inputs)* }
            params { $($params)* }
            layers {
                /// Height of the ground, and of the beds of lakes and the sea.
                height: height, unit "m";
                /// Drainage area, including the cell itself; weighted by `rain` if it is given.
                flow: flow, unit "m^2";
                /// Depth of standing water in lakes, 0 elsewhere.
                lake: height, unit "m";
                /// Height of the ground or of the water above it.
                surface: height, unit "m";
                /// Flow direction, clockwise from east (0) to north-east (7), also in lakes with an outlet; 8 in other
                /// water.
                receiver: label;
                /// Width of the river; 0 outside rivers.
                width: label, unit "m";
                /// Depth of the river from bank to bed; 0 outside rivers.
                depth: label, unit "m";
                /// Depth of the water over the ground in a flood; 0 where there is none. It is max(0, b + 3 d - z) over
                /// ground of height z, with the height b of the banks and the `depth` d of the first river downstream
                /// (height above the nearest drainage; Rennó and others 2008, Nobre and others 2011), and 4 d in
                /// rivers: about twice as deep as between full banks (Rosgen 1994). It reaches at most 4000 m or 96
                /// samples from a river.
                floodplain: height, unit "m";
                /// Thickness of the sediment of rivers on valley floors; 0 on hillsides and in standing water. It is
                /// 100 f / (100 + f) m for f = 0.25 min(e, w - r): below the floor the sides of the valley go on with a
                /// slope of 0.25 (Jaboyedoff and Derron 2005). e is the distance to the foot of the hillside, r that
                /// from the river, and w half the width of the river's floor, at most 4000 m or 128 samples.
                sediment: height, unit "m";
                $($($layers)*)?
            }
        }

        impl $crate::levelled::drained_op::DrainedOp for $name {
            fn drained(&self) -> $crate::levelled::drained::Drained {
                use orogen_grid::multiscale::refinement::{MAX_LEVELS, Refinement};
                let refinement = Refinement::new(self.seed)
                    .with_cell(self.cell)
                    .with_levels((self.halvings as usize).min(MAX_LEVELS))
                    .with_relief(self.relief)
                    .with_creep(self.creep)
                    .with_variation(self.variation)
                    .with_details(self.details as usize)
                    .with_lakes(self.lakes);
                let (stream, runoff) = (self.stream, self.runoff);
                let land = $crate::levelled::drained::Drained { refinement, continents: None, stream, runoff };
                self.completed(land)
            }

            fn rivers(&self) -> Option<std::sync::Arc<orogen_grid::multiscale::drawn_rivers::DrawnRivers>> {
                self.drawn_rivers()
            }

            fn ridges(&self) -> Option<std::sync::Arc<orogen_grid::multiscale::drawn_ridges::DrawnRidges>> {
                self.drawn_ridges()
            }
        }
    };
}
pub(super) use drained_op;

/// An op whose levels are drained land.
pub trait DrainedOp: Declared + Send + Sync {
    /// The land with the op's parameters and the seed of the node.
    fn drained(&self) -> Drained;

    /// The rivers that every level leads along their lines.
    fn rivers(&self) -> Option<Arc<DrawnRivers>>;

    /// The ridges and summits that have their heights on every level.
    fn ridges(&self) -> Option<Arc<DrawnRidges>>;
}

/// The inputs of all such ops; inputs that an op does not declare are `None`.
fn given<'a>(inputs: &GridInputs<'a>) -> Given<'a> {
    Given {
        shore: inputs.get("shore"),
        uplift: inputs.get("uplift"),
        stability_factor: inputs.get("stability_factor"),
        creep_factor: inputs.get("creep_factor"),
        floor_factor: inputs.get("floor_factor"),
        rain: inputs.get("rain"),
        continents: None,
        rivers: None,
        ridges: None,
        binding: None,
    }
}

impl<T: DrainedOp> Levelled for T {
    fn levels(&self) -> Levels {
        let Refinement { levels, details, .. } = self.drained().refinement;
        let finest = levels + details;
        Levels { finest: self.drained().refinement.cell_of(finest), count: finest + 1 }
    }

    fn planes(&self) -> usize {
        Level::PLANES
    }

    fn halo(&self, level: usize) -> usize {
        self.drained().refinement.reach(level)
    }

    fn source_halo(&self, level: usize) -> usize {
        let Drained { refinement, continents, .. } = self.drained();
        match (level, continents) {
            (0, Some(continents)) => continents.with_refinement(refinement).coarsest_reach(),
            (0, None) => REACH,
            _ => refinement.given_reach(level),
        }
    }

    fn level_at_samples(&self) -> usize {
        self.drained().refinement.levels
    }

    fn reads_input(&self, level: usize, input: usize) -> bool {
        // Detail levels take over the data of the finest level of valleys. Some read the shore again.
        let Drained { refinement, .. } = self.drained();
        let is_shore = self.spec().inputs.get(input).is_some_and(|input| input.name == "shore");
        level <= refinement.levels || (is_shore && refinement.reads_shore(level))
    }

    fn coarsest(&self, inputs: &GridInputs, window: &Window, context: &Context) -> Result<Vec<Grid>> {
        let Drained { refinement, continents, .. } = self.drained().seeded(context.world_params);
        let (rivers, ridges) = (self.rivers(), self.ridges());
        let given = Given { rivers: rivers.as_deref(), ridges: ridges.as_deref(), ..given(inputs) };
        if let Some(continents) = continents {
            return Ok(continents.coarsest(&given, window, context.progress)?.into_planes());
        }
        let height = inputs.required("source")?;
        let coarse = Coarse { height, flow: inputs.required("flow")?, receiver: inputs.get("receiver") };
        let mut level = refinement.coarsest_of(&coarse, &given, window, context.progress)?;
        if refinement.sea {
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
        let land = self.drained().seeded(context.world_params);
        let mut above = level_of(level - 1, parent)?;
        above.window = land.nodes_at(level - 1, &above.window);
        let nodes = land.nodes_at(level, window);
        let moved = |input: &Grid| Grid::from_data(land.nodes_at(level, input.window()), input.data().to_vec());
        let moved: Vec<Option<Grid>> = inputs.all().iter().map(|input| moved((*input)?)).collect();
        let moved: Vec<Option<&Grid>> = moved.iter().map(Option::as_ref).collect();
        let (rivers, ridges) = (self.rivers(), self.ridges());
        let given = Given {
            continents: land.continents.as_ref(),
            rivers: rivers.as_deref(),
            ridges: ridges.as_deref(),
            ..given(&inputs.with(&moved))
        };
        let mut made = land.refinement.refine(&above, &given, &nodes, context.progress)?;
        made.window = *window;
        Ok(made.into_planes())
    }

    fn parent(&self, level: usize, window: &Window) -> Window {
        let (land, above) = (self.drained(), level.saturating_sub(1));
        let nodes = halved(&land.nodes_at(level, window), land.refinement.cell_of(above));
        land.samples_at(above, &nodes).grown(land.refinement.reach(level))
    }

    fn surface_halo(&self, level: usize, wanted: &[bool]) -> usize {
        surface_halo(&self.drained().refinement, level, self.spec(), wanted)
    }

    fn layers_of(
        &self,
        level: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let level = level_of(level, planes)?;
        layers_of(&self.drained(), self.ridges().as_deref(), level, self.spec(), window, out, context)
    }

    fn lower(&self, level: usize, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let land = self.drained().seeded(world_params);
        if land.refinement.drawn {
            return Lowering::Processor("drawn rivers are led along their lines in f64");
        }
        if land.refinement.ridges {
            return Lowering::Processor("land is raised to drawn ridges in f64");
        }
        if land.refinement.has_geography(level) && land.continents.is_some() {
            return Lowering::Processor("continents and ranges are placed in f64");
        }
        passes::lower(&land, level, self.spec(), given)
    }

    fn lower_layers(&self, level: usize, wanted: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        if self.drained().refinement.ridges {
            return Lowering::Processor("land is raised to drawn ridges in f64");
        }
        lower_layers(&self.drained(), level, self.spec(), wanted, world_params)
    }

    fn reads_sea_level(&self) -> bool {
        self.drained().refinement.sea
    }

    fn cost(&self, level: usize) -> f64 {
        match (level, self.drained().continents) {
            (0, Some(_)) => COST_OF_CONTINENTS,
            (0, None) => COST_OF_GIVEN,
            _ => COST,
        }
    }

    fn scratch(&self, level: usize, window: &Window) -> u64 {
        let halo = if level == 0 { self.source_halo(0) } else { 2 * self.halo(level) };
        let samples = window.grown(halo + 1);
        // Inputs are copied to the windows of the nodes.
        let bytes = Refinement::bytes_per_sample().saturating_add(4 * self.spec().inputs.len() as u64);
        let rivers = self.rivers().map_or(0, |rivers| rivers.memory());
        let drawn = self.ridges().map_or(rivers, |ridges| rivers + ridges.memory());
        // Distances and heights of ridges, and copies of heights.
        let bytes = bytes + if self.drained().refinement.ridges { 40 } else { 0 };
        bytes.saturating_mul(samples.width as u64).saturating_mul(samples.height as u64).saturating_add(drawn)
    }
}

/// The level from its planes.
fn level_of(depth: usize, planes: &[Grid]) -> Result<Level> {
    Level::from_planes(depth, &planes.iter().collect::<Vec<_>>())
}
