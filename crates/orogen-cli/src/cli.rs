//! The command line.

use clap::{CommandFactory, Parser, Subcommand};

use orogen::Level;

use crate::bar::{Mode, set_mode};
use crate::command::{
    analyze, blocks, build, cache, check, compare, completions, devices, explain, export, fit, generate, graph, grow,
    locate, map, new, noise, ops, palettes, presets, refine, render, schema, serve, studio, tilemap, variants,
};
use crate::failure::Failure;

/// Procedural terrain from recipes.
///
/// `orogen generate` makes the default preset in the folder `out`. `orogen presets` lists the other presets, and
/// `orogen new NAME` writes a recipe to edit.
#[derive(Debug, Parser)]
#[command(name = "orogen", version, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// How progress is shown
    #[arg(long, global = true, value_name = "HOW", default_value = "auto")]
    progress: Mode,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Make a terrain: heights, a map and a summary in a folder
    Generate(generate::Args),
    /// Write one layer, or a window of it, to a file
    Export(export::Args),
    /// Build a world of any size as a GeoTIFF, a Zarr group or a folder of tiles; interrupted builds can be resumed
    Build(build::Args),
    /// Measure a terrain: a table with reference values of real land, and a page of charts
    Analyze(analyze::Args),
    /// Find the nearest places of a world that satisfy conditions: ground, summits, lakes, rivers
    Locate(locate::Args),
    /// Find a recipe whose terrain has statistics similar to those of a real place
    Fit(fit::Args),
    /// Refine a file of heights to a smaller cell: its rivers are kept, and valleys and slopes are added between them
    Refine(refine::Args),
    /// Draw the growth of a terrain: frames of uplift and erosion as an animation
    Grow(grow::Args),
    /// Render a perspective view with sun, shadows, sky and water
    Render(render::Args),
    /// Draw a map sheet with relief, contours, rivers, lakes, scale and legend, as PNG, SVG or PDF
    Map(map::Args),
    /// Make a map of tiles for a 2D game: terrain classes drawn with a tileset, for Tiled and for programs
    Tilemap(tilemap::Args),
    /// Make a world of blocks: for Minecraft, Luanti or MagicaVoxel, or a smooth mesh of it
    Blocks(blocks::Args),
    /// Draw variants of a recipe side by side: several seeds, or a range of values of a parameter
    Variants(variants::Args),
    /// Serve map tiles and windows of worlds over HTTP, for map programs, without building them first
    Serve(serve::Args),
    /// Open the studio: a window with live preview, parameters, graph and text of a recipe
    Studio(studio::Args),
    /// Write a new recipe as a starting point
    New(new::Args),
    /// List the built-in presets
    Presets,
    /// List the ops of recipes, or describe one
    Ops(ops::Args),
    /// Draw a noise without a recipe: a picture, an array, an animation or a volume
    Noise(noise::Args),
    /// Draw all noises side by side on one page, as heights and as hillshade
    Compare(compare::Args),
    /// List the palettes, or draw them on one page
    Palettes(palettes::Args),
    /// Print the JSON Schema of recipes, for editors
    Schema,
    /// Print the plan of a recipe: its nodes in order and the memory needed
    Explain(explain::Args),
    /// Check recipes and report all errors, without making anything
    Check(check::Args),
    /// Draw the graph of a recipe: its nodes and the connections between them
    Graph(graph::Args),
    /// List the graphics cards that `--device` can use
    Devices(devices::Args),
    /// List or remove the solutions stored for later runs
    Cache(cache::Args),
    /// Print a shell completion script
    Completions(completions::Args),
}

impl Cli {
    /// Runs the command.
    pub fn run(self) -> Result<(), Failure> {
        // The level is set to find differences between levels, so an unknown level must be an error.
        Level::environment().map_err(|wrong| Failure::Usage(format!("OROGEN_SIMD: {wrong}")))?;
        set_mode(self.progress);
        match self.command {
            Command::Generate(args) => generate::run(&args),
            Command::Export(args) => export::run(&args),
            Command::Build(args) => build::run(&args),
            Command::Analyze(args) => analyze::run(&args),
            Command::Locate(args) => locate::run(&args),
            Command::Fit(args) => fit::run(&args),
            Command::Refine(args) => refine::run(&args),
            Command::Grow(args) => grow::run(&args),
            Command::Render(args) => render::run(&args),
            Command::Map(args) => map::run(&args),
            Command::Tilemap(args) => tilemap::run(&args),
            Command::Blocks(args) => blocks::run(&args),
            Command::Variants(args) => variants::run(&args),
            Command::Serve(args) => serve::run(&args),
            Command::Studio(args) => studio::run(&args),
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
            Command::Devices(args) => devices::run(&args),
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
