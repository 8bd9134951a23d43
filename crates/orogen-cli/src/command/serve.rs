//! `orogen serve`.

use crate::failure::Failure;

#[cfg(feature = "serve")]
pub use with_server::{Args, run};

#[cfg(not(feature = "serve"))]
pub use without_server::{Args, run};

#[cfg(feature = "serve")]
mod with_server {
    use std::path::{Path, PathBuf};

    use orogen::io::dem::open;
    use orogen::options::OptionSpec;
    use orogen::{Budget, Session};
    use orogen_serve::Server;

    use super::Failure;
    use crate::declared::{Declares, OptionsOf};
    use crate::options::Limits;
    use crate::source::{Source, title};
    use crate::values::arguments::Arguments;
    use crate::{interrupt, say};

    /// Arguments of the command.
    #[derive(Debug, Clone, clap::Args)]
    #[command(after_help = "Ctrl-C ends the server. docs/serve.md describes the requests.")]
    pub struct Args {
        /// Recipe files, names of presets, files of heights (GeoTIFF, .asc, .hgt, ...), or folders of them. If there
        /// are several, the paths of requests begin with their names
        #[arg(value_name = "RECIPE", default_value = orogen::recipe::presets::DEFAULT)]
        recipes: Vec<PathBuf>,
        #[command(flatten)]
        options: OptionsOf<Serving>,
        /// Seed of the worlds, instead of the recipes'
        #[arg(long, value_name = "N", help_heading = "World and window")]
        seed: Option<u64>,
        #[command(flatten)]
        arguments: Arguments,
        #[command(flatten)]
        limits: Limits,
        /// Print no line for each request
        #[arg(short, long, help_heading = "Output")]
        quiet: bool,
    }

    /// The source of the server's options.
    #[derive(Debug, Clone)]
    struct Serving;

    impl Declares for Serving {
        fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
            Server::OPTIONS.iter().map(|spec| (spec, Vec::new())).collect()
        }
    }

    /// Serves the worlds until the command is interrupted.
    pub fn run(args: &Args) -> Result<(), Failure> {
        let stop = interrupt::flag();
        let budget = args.limits.budget();
        let mut options = args.limits.options(&budget);
        // Requests for tiles beside each other read the same grids.
        options.kept_grids = None;
        let mut server = Server::new(Session::new(options)?, &args.options.read()?)?;
        for argument in &args.recipes {
            match listed(argument)? {
                Some(files) => add_all(args, &mut server, &budget, argument, &files)?,
                None => add(args, &mut server, &budget, argument)?,
            }
        }
        let address = server.bind()?;
        let names: Vec<&str> = server.names().collect();
        say::out(&format!("serving {} at http://{address}/\n", names.join(", ")))?;
        let is_quiet = args.quiet;
        server.run(&stop, move |line| {
            if !is_quiet {
                say::error(line);
            }
        })?;
        Ok(())
    }

    /// Adds the world of a recipe, a preset or a file of heights.
    fn add(args: &Args, server: &mut Server, budget: &Budget, argument: &Path) -> Result<(), Failure> {
        let source = Source::find(argument)?;
        let mut recipe = source.open(budget, &args.arguments)?;
        recipe.world.seed = args.seed.unwrap_or(recipe.world.seed);
        Ok(server.add(&name(argument), recipe, source.dem().is_some())?)
    }

    /// Adds all worlds of a folder. Those that cannot be served are reported and left out.
    fn add_all(
        args: &Args,
        server: &mut Server,
        budget: &Budget,
        folder: &Path,
        files: &[PathBuf],
    ) -> Result<(), Failure> {
        let before = server.names().count();
        for file in files {
            match add(args, server, budget, file) {
                Ok(()) => {}
                Err(Failure::Engine(error)) => say::error(&format!("note: {} is left out: {error}", file.display())),
                Err(failure) => return Err(failure),
            }
        }
        match server.names().count() > before {
            true => Ok(()),
            false => Err(Failure::Usage(format!(
                "the folder {} has no recipe (.toml) and no file of heights that can be served",
                folder.display()
            ))),
        }
    }

    /// The recipes and files of heights in a folder, by name; `None` if the path is no folder, or a folder without
    /// recipes that is one elevation model in tiles.
    fn listed(argument: &Path) -> Result<Option<Vec<PathBuf>>, Failure> {
        if !argument.is_dir() {
            return Ok(None);
        }
        let failed = |cause: std::io::Error| orogen::Error::file("read the folder", argument, &cause);
        let mut files = Vec::new();
        for entry in std::fs::read_dir(argument).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
            // Most pictures are no heights.
            let is_world = match extension.as_deref() {
                Some("toml") => true,
                Some("png" | "json") | None => false,
                Some(_) => open::is_dem(&path),
            };
            if is_world && path.is_file() {
                files.push(path);
            }
        }
        files.sort();
        let has_recipe = files.iter().any(|file| file.extension().is_some_and(|extension| extension == "toml"));
        Ok(if !has_recipe && open::is_dem(argument) { None } else { Some(files) })
    }

    /// The name of a world in requests: that of its file, with `-` in place of other characters.
    fn name(argument: &Path) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
        title(argument).chars().map(plain).collect()
    }
}

#[cfg(not(feature = "serve"))]
mod without_server {
    use std::ffi::OsString;

    use super::Failure;

    /// Arguments of the command.
    #[derive(Debug, Clone, clap::Args)]
    #[command(disable_help_flag = true)]
    pub struct Args {
        /// Recipes, presets, files of heights or folders, and options
        #[arg(value_name = "RECIPE", trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<OsString>,
    }

    /// Says how to get the server.
    pub fn run(_: &Args) -> Result<(), Failure> {
        let message = "this program was built without the server; `cargo build --release -p orogen-cli --features serve` builds it with it";
        Err(Failure::Usage(message.into()))
    }
}
