//! Options that several commands share.

use clap::Args;
use orogen::{Options, Recipe, World};

use crate::failure::Failure;
use crate::memory;
use crate::size::{Bytes, Size, cell, seed};

/// Which samples of which world.
#[derive(Debug, Clone, Args)]
pub struct View {
    /// Seed of the world, instead of the recipe's
    #[arg(long, value_name = "N", value_parser = seed, allow_negative_numbers = true)]
    pub seed: Option<u64>,
    /// Samples of the world's longer side, or of both (of the world's own aspect)
    #[arg(long, value_name = "N|WxH", conflicts_with = "cell", allow_negative_numbers = true)]
    pub size: Option<Size>,
    /// Metres from one sample to the next [default: the world's cell]
    #[arg(long, value_name = "M", value_parser = cell, allow_negative_numbers = true)]
    pub cell: Option<f64>,
}

/// What the work may use.
#[derive(Debug, Clone, Args)]
pub struct Limits {
    /// Threads to work with [default: all there are]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Most memory to use, such as 512MiB or 2GiB [default: half of what is free]
    #[arg(long, value_name = "BYTES")]
    pub memory: Option<Bytes>,
}

impl Limits {
    /// Opens the world of a recipe within these limits.
    pub fn open(&self, recipe: Recipe) -> Result<World, Failure> {
        let threads = self.threads.map(usize::from);
        if let Some(threads) = threads {
            // For what is made from grids; fails only if already set, when remaking: then it is the same.
            let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        }
        let memory = self.memory.map(|bytes| bytes.0).or_else(memory::share_of_free);
        Ok(World::with_options(recipe, Options { threads, memory })?)
    }
}
