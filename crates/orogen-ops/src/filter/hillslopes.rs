//! Land between rivers as a network has learned it from real land.

use crate::declare::NetworkFile;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::learned::{Drained, Draw, MAX_NOISE, Network};

/// Approximate time for a sample, in nanoseconds.
const COST: f64 = 500.0;

op! {
    /// The land between rivers, made anew by a network that has learned from real land and its rivers: crests are
    /// sharper, slopes rougher and small gullies more various than those of an erosion.
    ///
    /// Heights are kept where the drainage area is at least `rivers` samples, in lakes and in the sea. Everywhere else
    /// the network sees the means of 3 x 3 heights, the beds and areas of rivers, and noise, and makes land that fits
    /// them: a draw, which depends on the seed, or with `noise = 0` the most likely land. Each sample stays above its
    /// receiver, so that `flow` and `receiver` are those of the new land, too, and there are no new depressions.
    ///
    /// Forms of several samples stay as they are; the cell decides how large these are. The network has 133 kB and
    /// learned at cells of 60 to 180 m from the heights of ten places and their drainage: see docs/learned.md.
    pub struct Hillslopes = "hillslopes", filter, revision 1;
    inputs {
        /// The heights, and the surface of water where there is any, such as `continents.surface`.
        source: required,
        /// Drainage area in m^2, such as `continents.flow`.
        flow: required,
        /// Flow direction, clockwise from east (0) to north-east (7), such as `continents.receiver`. Heights are kept
        /// where it is 8.
        receiver: required,
        /// Lakes: heights are kept where it is above 0. Default: none.
        lake: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Drainage area, in samples, from which beds are kept.
        rivers: u32 = 64, range 8 to 256;
        /// How much of the land is chance: 0 is the most likely land, 1 looks like real land.
        noise: f64 = 1.0, range 0.0 to MAX_NOISE;
        /// Path of a file with another network, made by the scripts in `training/`. A relative path is resolved against
        /// the folder of the recipe. Default: the network that is part of Orogen.
        weights: NetworkFile = NetworkFile::default();
    }
}

impl Hillslopes {
    fn network(&self) -> Result<&Network> {
        self.weights.network_of_rivers()
    }
}

impl Filter for Hillslopes {
    fn halo(&self, _: f64) -> usize {
        self.network().map_or(0, |network| network.halo_of_hillslopes(self.rivers))
    }

    fn scratch(&self, window: &Window) -> u64 {
        self.network().map_or(0, |network| network.scratch_of_hillslopes(window, self.rivers))
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let land = Drained {
            height: inputs.required("source")?,
            flow: inputs.required("flow")?,
            receiver: inputs.required("receiver")?,
            lake: inputs.get("lake"),
        };
        let out = only_layer(out)?;
        let draw = Draw { seed: context.world_params.seed_of(self.seed), level: 1, noise: self.noise as f32 };
        *out = self.network()?.hillslopes(&land, window, self.rivers, &draw, context.progress)?;
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("samples are raised above their receivers one after the other")
    }

    fn cost(&self, _: f64) -> f64 {
        COST
    }
}
