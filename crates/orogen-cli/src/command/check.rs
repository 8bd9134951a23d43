//! `orogen check`.

use std::path::{Path, PathBuf};

use orogen::grid::error::Diagnostic;
use orogen::grid::words::count;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::{Options, World};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::report::report;
use crate::source::Source;
use crate::values::arguments::Arguments;
use crate::values::bytes::Bytes;
use crate::{memory, say};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Recipes to check: files, names of presets, files of heights, or - for standard input
    #[arg(required = true)]
    recipes: Vec<PathBuf>,
    #[command(flatten)]
    arguments: Arguments,
    /// Memory limit for the files of heights that recipes read, such as 512MiB or 2GiB [default: half of the free
    /// memory]
    #[arg(long, value_name = "BYTES")]
    memory: Option<Bytes>,
    /// Print the results as JSON, including errors
    #[arg(long)]
    json: bool,
    /// Print nothing about valid recipes
    #[arg(short, long)]
    quiet: bool,
}

/// Checks each recipe, and reports all errors of all recipes.
pub fn run(args: &Args) -> Result<(), Failure> {
    let found: Vec<(&Path, Result<World, Failure>)> =
        args.recipes.iter().map(|recipe| (recipe.as_path(), check(recipe, args))).collect();
    let faulty = found.iter().filter(|(_, found)| found.is_err()).count();
    if args.json {
        let all: Vec<Value> = found.iter().map(|(recipe, found)| described(recipe, found)).collect();
        // A tree of numbers and strings can always be serialized.
        say::out(&(serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"))?;
    } else {
        for (recipe, found) in &found {
            match found {
                Ok(_) if args.quiet => {}
                Ok(world) => say::out(&words(recipe, world))?,
                Err(failure) => report(failure),
            }
        }
    }
    if faulty == 0 { Ok(()) } else { Err(Failure::Told) }
}

/// Reads a recipe and all files that it names, and plans each of its layers.
fn check(recipe: &Path, args: &Args) -> Result<World, Failure> {
    let memory = memory::budget(args.memory, memory::cores());
    let recipe = Source::find(recipe)?.read(&memory, &args.arguments)?;
    let allowed = memory.left().unwrap_or(DEFAULT_MEMORY);
    let world = World::with_options(recipe, Options { memory, ..Options::default() })?;
    world.recipe().with_whole_files(allowed)?;
    let cell = world.recipe().world.cell;
    let window = orogen::Window::new(1, 1, cell);
    let layers: Vec<&str> = world.recipe().outputs().collect();
    world.plan(&layers, &window)?;
    Ok(world)
}

fn words(recipe: &Path, world: &World) -> String {
    let outputs: Vec<&str> = world.recipe().outputs().collect();
    let outputs =
        if outputs.len() == 1 { format!("output {}", outputs[0]) } else { format!("outputs {}", outputs.join(", ")) };
    format!("{}: valid, {}, {outputs}\n", recipe.display(), count(world.recipe().nodes().len(), "node"))
}

fn described(recipe: &Path, found: &Result<World, Failure>) -> Value {
    let name = recipe.display().to_string();
    match found {
        Ok(world) => json!({
            "recipe": name,
            "valid": true,
            "nodes": world.recipe().nodes().len(),
            "outputs": world.recipe().outputs().collect::<Vec<_>>(),
            "errors": [],
        }),
        Err(failure) => {
            let errors: Vec<Value> = match failure {
                Failure::Engine(error) => error.diagnostics().iter().map(fault).collect(),
                Failure::Usage(message) | Failure::Interrupted { message, .. } => vec![json!({ "message": message })],
                Failure::CommandLine(_) | Failure::Told | Failure::BrokenPipe => Vec::new(),
            };
            json!({ "recipe": name, "valid": false, "errors": errors })
        }
    }
}

/// An error with its position: line and column from 1, and the number of characters.
fn fault(Diagnostic { message, place, .. }: &Diagnostic) -> Value {
    match place {
        None => json!({ "message": message }),
        Some(place) => json!({
            "message": message,
            "file": place.file,
            "line": place.line,
            "column": place.column,
            "length": place.length,
        }),
    }
}
