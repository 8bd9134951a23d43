//! What the command line may say.

use clap::{CommandFactory, Parser, Subcommand};

use orogen::Level;

use crate::bar::{Mode, set_mode};
use crate::command::{
    analyze, build, cache, check, compare, completions, explain, export, fit, generate, graph, grow, map, new, noise,
    ops, palettes, presets, render, schema, variants,
};
use crate::failure::Failure;

/// Procedural terrain: a recipe describes a world, orogen makes it.
///
/// Begin with `orogen generate`: it makes the default preset into the folder `out`. `orogen presets` lists what else there is,
/// `orogen new NAME` writes a recipe of your own to change.
#[derive(Debug, Parser)]
#[command(name = "orogen", version, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// How progress is shown: a bar on a terminal, or lines on standard error
    #[arg(long, global = true, value_name = "HOW", default_value = "auto")]
    progress: Mode,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Make a terrain: heights, a map and a summary in a folder.
    Generate(generate::Args),
    /// Write one layer, or a window of it, to a file.
    Export(export::Args),
    /// Build a world of any size into a GeoTIFF, a Zarr or a folder of tiles, and go on where it was interrupted.
    Build(build::Args),
    /// Measure a terrain: a table beside what real land is like, and a page with its charts.
    Analyze(analyze::Args),
    /// Find a recipe whose land is like a real place, without holding the place.
    Fit(fit::Args),
    /// Draw a terrain growing: frames of uplift and erosion as a moving picture.
    Grow(grow::Args),
    /// Draw a terrain as it would be seen: a perspective picture with sun, shadows, sky and water.
    Render(render::Args),
    /// Draw a map sheet: relief, contours, rivers, lakes, scale and legend, as a picture, SVG or PDF.
    Map(map::Args),
    /// Draw variants of a recipe side by side: other seeds, or a parameter from one value to another.
    Variants(variants::Args),
    /// Write a new recipe to start from.
    New(new::Args),
    /// List the built-in presets.
    Presets,
    /// List the ops that recipes are made of, or tell all about one.
    Ops(ops::Args),
    /// Draw one noise without a recipe: a picture, an array, an animation or a block.
    Noise(noise::Args),
    /// Draw the noises side by side on one page, as heights and as hillshade.
    Compare(compare::Args),
    /// List the palettes for maps, or draw them all on one page.
    Palettes(palettes::Args),
    /// Print the JSON Schema of recipes, for editors.
    Schema,
    /// Show how a recipe would be made: its nodes in order, and the memory it takes.
    Explain(explain::Args),
    /// Check recipes and tell every fault, without making anything.
    Check(check::Args),
    /// Draw a recipe's graph: its nodes as boxes, and the wires between them.
    Graph(graph::Args),
    /// List or clear the solutions that are kept for later runs.
    Cache(cache::Args),
    /// Print the completion script of a shell.
    Completions(completions::Args),
}

impl Cli {
    /// Does what was asked.
    pub fn run(self) -> Result<(), Failure> {
        // Somebody who forces a level is hunting a difference between levels: never quietly take another.
        Level::environment().map_err(|wrong| Failure::Usage(format!("OROGEN_SIMD: {wrong}")))?;
        set_mode(self.progress);
        match self.command {
            Command::Generate(args) => generate::run(&args),
            Command::Export(args) => export::run(&args),
            Command::Build(args) => build::run(&args),
            Command::Analyze(args) => analyze::run(&args),
            Command::Fit(args) => fit::run(&args),
            Command::Grow(args) => grow::run(&args),
            Command::Render(args) => render::run(&args),
            Command::Map(args) => map::run(&args),
            Command::Variants(args) => variants::run(&args),
            Command::New(args) => new::run(&args),
            Command::Presets => presets::run(),
            Command::Ops(args) => ops::run(&args),
            Command::Noise(args) => noise::run(&args),
            Command::Compare(args) => compare::run(&args),
            Command::Palettes(args) => palettes::run(&args),
            Command::Schema => schema::run(),
            Command::Explain(args) => explain::run(&args),
            Command::Check(args) => check::run(&args),
            Command::Graph(args) => graph::run(&args),
            Command::Cache(args) => cache::run(&args),
            Command::Completions(args) => completions::run(&args, Cli::command()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_declarations_agree_with_each_other() {
        Cli::command().debug_assert();
    }
}
