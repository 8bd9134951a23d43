//! Options shared by several commands.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use orogen::io::file::OutputPolicy;
use orogen::{Budget, FolderStore, Options, Recipe, SolutionStore, World};

use crate::failure::Failure;
use crate::memory;
use crate::replace::Replace;
use crate::source::Source;
use crate::values::bytes::Bytes;
use crate::view::View;

/// Limits of threads and memory, and the cache.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Limits and cache")]
pub struct Limits {
    /// Number of threads, at most the number of cores [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub threads: Option<u16>,
    /// Memory limit of the whole process, such as 512MiB or 2GiB [default: half of the free memory]
    #[arg(long, value_name = "BYTES")]
    pub memory: Option<Bytes>,
    /// Folder of the cache, where slow solutions and tiles of levels are stored for later runs [default: $OROGEN_CACHE,
    /// else the system's cache folder]
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Size limit of the cache; the least recently used entries are removed first [default: 10GiB]
    #[arg(long, value_name = "BYTES")]
    pub cache_limit: Option<Bytes>,
    /// Do not read or write the cache
    #[arg(long, conflicts_with_all = ["cache", "cache_limit"])]
    pub no_cache: bool,
}

/// How a command runs: which files it may replace, its limits, and whether it prints messages.
#[derive(Debug, Clone, Args)]
pub struct RunOptions {
    #[command(flatten)]
    pub replace: Replace,
    #[command(flatten)]
    pub limits: Limits,
    /// Print no progress and no summary
    #[arg(short, long, help_heading = "Output")]
    pub quiet: bool,
}

/// The inputs that a command reads before it opens a world.
pub struct Opened {
    pub source: Source,
    pub recipe: Recipe,
    pub budget: Budget,
    pub policy: OutputPolicy,
}

impl RunOptions {
    /// Reads the recipe that `argument` names, with the options of its world.
    pub fn read(&self, argument: &Path, view: &View) -> Result<Opened, Failure> {
        let source = Source::find(argument)?;
        let budget = self.limits.budget();
        let recipe = view.recipe(&source, &budget)?;
        let policy = self.replace.policy(source.inputs(&recipe));
        Ok(Opened { source, recipe, budget, policy })
    }
}

/// Options of a command without a world: which files it may replace, and its memory limit.
#[derive(Debug, Clone, Copy, Args)]
pub struct DrawOptions {
    /// Memory limit of the program, such as 512MiB or 2GiB [default: half of the free memory]
    #[arg(long, value_name = "BYTES")]
    pub memory: Option<Bytes>,
    #[command(flatten)]
    pub replace: Replace,
}

impl DrawOptions {
    /// The part of `--memory` that is available for the work on all cores.
    pub fn budget(self) -> Budget {
        memory::budget(self.memory, memory::cores())
    }
}

impl Limits {
    /// Opens the world of a recipe within these limits. The world and the command's own [reservations](Budget::reserve)
    /// share `budget`, which is [`Limits::budget`].
    pub fn open(&self, recipe: Recipe, budget: &Budget) -> Result<World, Failure> {
        Ok(World::with_options(recipe, self.options(budget))?)
    }

    /// The part of `--memory` that is available for the work.
    pub fn budget(&self) -> Budget {
        memory::budget(self.memory, self.threads())
    }

    /// Converts the limits to the library's options.
    pub fn options(&self, budget: &Budget) -> Options {
        let threads = self.threads();
        // For functions on grids. It only fails if it was already set to the same number (with --watch).
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
        Options {
            threads: Some(threads),
            memory: budget.clone(),
            store: self.cache().map(|cache| Arc::new(cache) as Arc<dyn SolutionStore>),
            scratch: None,
            kept_grids: Some(0),
        }
    }

    /// The requested number of threads, at most the number of cores: more threads would only use memory.
    fn threads(&self) -> usize {
        let cores = memory::cores();
        self.threads.map_or(cores, |threads| usize::from(threads).min(cores))
    }

    /// The cache, unless it is disabled.
    fn cache(&self) -> Option<FolderStore> {
        if self.no_cache {
            return None;
        }
        let mut cache = FolderStore::new(cache_folder(self.cache.as_ref())?);
        cache.limit = self.cache_limit.map_or(cache.limit, |bytes| bytes.0);
        Some(cache)
    }
}

/// The folder of the cache: the given one, otherwise from the environment variable, otherwise the system's.
pub fn cache_folder(asked: Option<&PathBuf>) -> Option<PathBuf> {
    asked.cloned().or_else(FolderStore::usual_folder)
}
