//! Coarse land with detail that a network has learned from real land.

use crate::declare::NetworkFile;
use crate::lower::{Extent, Lowering, Over, Pass, Passes};
use crate::op::{Context, GridInputs, Levelled, Levels, WorldParams};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::learned::{Draw, MAX_NOISE, Network, Words};

/// Approximate time for a sample of a finer level, in nanoseconds.
const COST: f64 = 450.0;
/// Approximate time for a sample of the coarsest level, in nanoseconds.
const COST_OF_COARSEST: f64 = 1.0;

/// The shaders of a graphics card.
const CODE: &str =
    concat!(include_str!("../lower/product.wgsl"), include_str!("../lower/hash.wgsl"), include_str!("learned.wgsl"));
/// Number of channels that a call of the function `convolve` computes.
const TOGETHER: usize = 16;
/// Planes of the level above that the channels follow: heights, the scale of slopes, and standing water.
const BEFORE_CHANNELS: usize = 3;

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
        noise: f64 = 1.0, range 0.0 to MAX_NOISE;
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

    fn lower(&self, level: usize, _: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        if level == 0 {
            return Lowering::Processor("the coarsest level is its source");
        }
        let Ok(network) = self.network() else { return Lowering::Processor("its network is broken") };
        if network.keeps_rivers() {
            return Lowering::Processor("its network keeps rivers");
        }
        let draw = Draw { seed: world_params.seed_of(self.seed), level, noise: self.noise as f32 };
        Lowering::Shader(passes(network, self.levels().cell(level - 1), &draw))
    }

    fn lower_layers(&self, _: usize, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        // The plane of a level is its layer.
        let mut passes = Passes::new("", &[]).with_scratch(1);
        passes.extent = Extent::Before(0);
        passes.layers = vec![0];
        Lowering::Shader(passes)
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

/// The passes by which a graphics card makes a level from coarse heights with this cell.
fn passes(network: &Network, cell: f64, draw: &Draw) -> Passes {
    let ([filters, layers], sizes) = (network.passes(), network.sizes());
    let channels = sizes.iter().find(|(name, _)| *name == "CHANNELS").map_or(0, |(_, size)| *size as usize);
    let Words { hashes, numbers } = network.words(cell, draw);
    let mut passes = Passes::new(CODE, &[])
        .with_constants(sizes)
        .with_pairs(hashes)
        .with_numbers(numbers)
        .with_table("weight", network.weights())
        .with_scratch(1);
    let reach = network.halo();
    passes.extent = Extent::Above { scratch: BEFORE_CHANNELS - 1 + 2 * channels, ahead: [0; 2], reach };
    passes.layers = vec![0];
    let pass = |function, step: usize, over, reads| {
        let (code, step) = (CODE, step as u32);
        Pass { code, function, step, over, reads, is_shared: false }
    };
    let above = |function, step, inset, reads| pass(function, step, Over::Above([inset; 2]), reads);
    // The second set of channels is empty before the first layer. It has the squares of slopes and smooth heights, each
    // of them in two planes that are read and written in turn.
    let squares = BEFORE_CHANNELS + channels;
    let heights = squares + 2;
    passes.passes.push(above("square", squares, 1, 4));
    for k in 0..filters {
        let [from, to] = [squares + k % 2, squares + (k + 1) % 2];
        passes.passes.push(above("filter_binomially", from | to << 16, k + 2, 9));
    }
    for k in 0..filters {
        let from = if k == 0 { 0 } else { heights + (k + 1) % 2 };
        passes.passes.push(above("filter_binomially", from | (heights + k % 2) << 16, k + 1, 9));
    }
    let smooth = [squares + filters % 2, heights + (filters + 1) % 2];
    passes.passes.push(above("see", smooth[0] | smooth[1] << 16, filters + 1, 20));
    for layer in 0..layers {
        let inputs = if layer == 0 { sizes[0].1 as usize } else { channels };
        for first in (0..channels).step_by(TOGETHER) {
            // Each input is multiplied with as many weights as there are channels, which all calls share.
            let reads = 9 * inputs * (1 + TOGETHER / 4);
            passes.passes.push(above("convolve", layer | first << 16, filters + layer + 2, reads));
        }
    }
    passes.passes.push(above("find_residuals", 0, filters + layers + 1, 2 * channels));
    passes.passes.push(pass("refine", 0, Over::Window(0), 25));
    passes
}

fn too_small(what: &str) -> Error {
    Error::new(ErrorKind::Internal, format!("`learned` needs more of {what}"))
}
