//! Coarse land with detail that a network has learned from real land.

use crate::declare::NetworkFile;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, GridInputs, Levelled, Levels, WorldParams};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::learned::{Draw, Network};

/// Approximate time for a sample of a finer level, in nanoseconds.
const COST: f64 = 450.0;
/// Approximate time for a sample of the coarsest level, in nanoseconds.
const COST_OF_COARSEST: f64 = 1.0;

op! {
    /// Coarse land made finer by a network that has learned from real land: each level has half the cell of the one
    /// above it.
    ///
    /// The network sees the slopes, bends and roughness of the coarse heights 9 samples around, in units of the slope
    /// there, and noise. It adds to their cubic interpolation what real land of that form has at half the cell:
    /// gullies, spurs and rough slopes, steeper where the land is steep. Detail is a draw, which depends on the seed,
    /// or with `noise = 0` the most likely land, which is smoother and closest to the truth. It knows no rivers: small
    /// depressions are as frequent as in other files of heights; put a `breach` after it where water has to flow.
    ///
    /// The network that is part of Orogen has 123 kB and learned at cells of 60 to 180 m from ten places on Earth,
    /// whose heights are in the public domain (SRTM): see docs/learned.md. Smaller and larger cells get the detail of
    /// the nearest of these. Where nine neighboring samples have the same height there is water, which stays level.
    ///
    /// Related: a conditional energy score as the loss (Gneiting and Raftery 2007), super-resolution with sub-pixel
    /// convolution (Shi and others 2016).
    pub struct Learned = "learned", levelled, revision 1;
    inputs {
        /// Heights of the coarse land. They are read at the coarsest cell, `cell` times 2 to the power of `halvings`:
        /// solve them there.
        source: required,
    }
    params {
        /// Seed of the detail, hashed with the world's seed.
        seed: u64 = 0;
        /// Cell of the finest level. Finer samples are interpolated.
        cell: f64 = 30.0, unit "m", range 1e-2 to 1e6;
        /// Number of times the coarsest cell is halved.
        halvings: u32 = 2, range 1 to 16;
        /// How much of the detail is chance: 0 is the most likely land, 1 looks like real land.
        noise: f64 = 1.0, range 0.0 to 2.0;
        /// Path of a file with another network, made by the scripts in `training/`. A relative path is resolved against
        /// the folder of the recipe. Default: the network that is part of Orogen.
        weights: NetworkFile = NetworkFile::default();
    }
    layers {
        /// Height of the ground.
        height: height, unit "m";
    }
}

impl Learned {
    fn network(&self) -> Result<&Network> {
        self.weights.network()
    }
}

impl Levelled for Learned {
    fn levels(&self) -> Levels {
        Levels { finest: self.cell, count: self.halvings as usize + 1 }
    }

    fn planes(&self) -> usize {
        1
    }

    fn halo(&self, _: usize) -> usize {
        self.network().map_or(0, Network::halo)
    }

    fn reads_input(&self, level: usize, _: usize) -> bool {
        level == 0
    }

    fn coarsest(&self, inputs: &GridInputs, window: &Window, _: &Context) -> Result<Vec<Grid>> {
        let heights = inputs.required("source")?.crop(window);
        Ok(vec![heights.ok_or_else(|| too_small("its source"))?])
    }

    fn refine(
        &self,
        level: usize,
        parent: &[Grid],
        _: &GridInputs,
        window: &Window,
        context: &Context,
    ) -> Result<Vec<Grid>> {
        let parent = parent.first().ok_or_else(|| too_small("the coarser level"))?;
        let seed = context.world_params.seed_of(self.seed);
        let draw = Draw { seed, level, noise: self.noise as f32 };
        Ok(vec![self.network()?.refine(parent, window, &draw, context.progress)?])
    }

    fn surface_halo(&self, _: usize, _: &[bool]) -> usize {
        0
    }

    fn layers_of(
        &self,
        _: usize,
        planes: &[Grid],
        window: &Window,
        out: &mut [Option<Grid>],
        _: &Context,
    ) -> Result<()> {
        let [Some(height)] = out else { return Ok(()) };
        let made = planes.first().and_then(|plane| plane.crop(window));
        *height = made.ok_or_else(|| too_small("the level"))?;
        Ok(())
    }

    fn lower(&self, _: usize, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("a network sums in the order of the processor")
    }

    fn lower_layers(&self, _: usize, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("a network sums in the order of the processor")
    }

    fn cost(&self, level: usize) -> f64 {
        if level == 0 { COST_OF_COARSEST } else { COST }
    }

    fn scratch(&self, level: usize, window: &Window) -> u64 {
        if level == 0 {
            return 0;
        }
        let read = self.parent(level, window);
        self.network().map_or(0, |network| network.scratch(read.width, read.height))
    }
}

fn too_small(what: &str) -> Error {
    Error::new(ErrorKind::Internal, format!("`learned` needs more of {what}"))
}
