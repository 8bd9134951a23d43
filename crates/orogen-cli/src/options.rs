//! Options that several commands share.

use std::path::PathBuf;

use clap::Args;
use orogen::{Cache, Options, Recipe, World};

use crate::failure::Failure;
use crate::memory;
use crate::size::Bytes;

/// What the work may use.
#[derive(Debug, Clone, Args)]
pub struct Limits {
    /// Threads to work with [default: all there are]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Most memory to use, such as 512MiB or 2GiB [default: half of what is free]
    #[arg(long, value_name = "BYTES")]
    pub memory: Option<Bytes>,
    /// Folder in which slow solutions are kept for later runs [default: $OROGEN_CACHE, else the system's folder for caches]
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Most bytes to keep there; the longest unused go first [default: 10GiB]
    #[arg(long, value_name = "BYTES")]
    pub cache_limit: Option<Bytes>,
    /// Neither look for solutions of earlier runs nor keep any
    #[arg(long, conflicts_with_all = ["cache", "cache_limit"])]
    pub no_cache: bool,
}

/// Names the cache's folder; set but empty, it means none.
const CACHE_VARIABLE: &str = "OROGEN_CACHE";

impl Limits {
    /// Opens the world of a recipe within these limits.
    pub fn open(&self, recipe: Recipe) -> Result<World, Failure> {
        Ok(World::with_options(recipe, self.options())?)
    }

    /// The limits as the library takes them.
    pub fn options(&self) -> Options {
        let threads = self.threads.map(usize::from);
        if let Some(threads) = threads {
            // For what is made from grids; fails only if already set, when remaking: then it is the same.
            let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        }
        let memory = self.memory.map(|bytes| bytes.0).or_else(memory::share_of_free);
        Options { threads, memory, cache: self.cache(), scratch: None }
    }

    /// What keeps solutions, if any are kept.
    fn cache(&self) -> Option<Cache> {
        if self.no_cache {
            return None;
        }
        let mut cache = Cache::new(cache_folder(self.cache.as_ref())?);
        cache.limit = self.cache_limit.map_or(cache.limit, |bytes| bytes.0);
        Some(cache)
    }
}

/// Where solutions are kept: what was asked for, else what the environment says, else where the system wants them.
pub fn cache_folder(asked: Option<&PathBuf>) -> Option<PathBuf> {
    match (asked, std::env::var_os(CACHE_VARIABLE)) {
        (Some(folder), _) => Some(folder.clone()),
        (None, Some(folder)) if folder.is_empty() => None,
        (None, Some(folder)) => Some(PathBuf::from(folder)),
        (None, None) => Cache::system_folder(),
    }
}
