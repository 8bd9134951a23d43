//! The argument RECIPE: a file, the name of a preset, a file of heights, or a recipe on standard input.

use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::recipe::document::LONGEST_TEXT;
use orogen::recipe::{Preset, RecipeSource, presets, source};
use orogen::{Budget, Error, ErrorKind, Recipe};

use crate::failure::Failure;
use crate::say;
use crate::sink::DASH;
use crate::values::arguments::Arguments;

/// The source of a recipe.
#[derive(Debug, Clone)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// A preset.
    Preset(&'static Preset),
    /// A file of heights, as a recipe that consists only of it.
    Dem(PathBuf),
    /// Standard input.
    Stdin,
}

/// The name of standard input in messages.
const STDIN: &str = "standard input";

/// The content of standard input, which can be read only once.
static PIPED: OnceLock<Vec<u8>> = OnceLock::new();

impl Source {
    /// The source for `argument`: the file if it exists, otherwise the preset.
    pub fn find(argument: &Path) -> Result<Source, Failure> {
        if argument == Path::new(DASH) {
            return Ok(Source::Stdin);
        }
        Ok(match RecipeSource::find(argument)? {
            RecipeSource::File(path) => {
                if let Some(preset) = argument.to_str().and_then(presets::find) {
                    say::error(&format!(
                        "note: reading the file {name}, not the preset of that name; give another folder's path or rename \
                         the file to get the preset",
                        name = preset.name
                    ));
                }
                Source::File(path)
            }
            RecipeSource::Preset(preset) => Source::Preset(preset),
            RecipeSource::Dem(path) => Source::Dem(path),
        })
    }

    /// All files that a recipe from this source reads.
    pub fn inputs(&self, recipe: &Recipe) -> Vec<PathBuf> {
        let mut files = recipe.files();
        if let Source::File(path) | Source::Dem(path) = self {
            files.push(path.clone());
        }
        files
    }

    /// Reads the recipe with values for its parameters; the heights of a real place take at most the rest of `budget`.
    pub fn read(&self, budget: &Budget, arguments: &Arguments) -> Result<Recipe, Failure> {
        let set = arguments.values();
        Ok(match self {
            Source::File(path) => Recipe::read_with(path, &set)?,
            Source::Preset(preset) => preset.recipe_with(&set)?,
            Source::Stdin => piped(&set)?,
            Source::Dem(path) => {
                no_values(path, arguments)?;
                let ground = PreparedDem::read(path, None, budget.left().unwrap_or(DEFAULT_MEMORY))?;
                of_dem(path, ground)
            }
        })
    }
}

/// The recipe of heights that were read from a file. Prints their notes.
pub fn of_dem(path: &Path, ground: PreparedDem) -> Recipe {
    ground.notes.iter().for_each(|note| say::once(&format!("note: {}: {note}", path.display())));
    Recipe::from_dem(path, &Arc::new(ground))
}

/// Checks that a file of heights is given no values for parameters.
pub fn no_values(path: &Path, arguments: &Arguments) -> Result<(), Failure> {
    match arguments.values().is_empty() {
        true => Ok(()),
        false => Err(Failure::Usage(format!(
            "--set gives values to a recipe's parameters, and {} is a file of heights, which has none",
            path.display()
        ))),
    }
}

/// The recipe on standard input. Relative paths in it are relative to the working folder.
fn piped(set: &[(String, f64)]) -> Result<Recipe, Failure> {
    let bytes = match PIPED.get() {
        Some(bytes) => bytes,
        None => {
            let mut bytes = Vec::new();
            let read = io::stdin().lock().take(LONGEST_TEXT + 1).read_to_end(&mut bytes);
            read.map_err(|cause| Error::file("read the recipe from", Path::new(STDIN), &cause))?;
            PIPED.get_or_init(|| bytes)
        }
    };
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(Recipe::parse_with(text, STDIN, set)?),
        Err(_) => Err(Error::new(
            ErrorKind::Recipe,
            format!(
                "{STDIN} is not a recipe (TOML or JSON); files of heights cannot be read from standard input, name the file instead"
            ),
        )
        .into()),
    }
}

/// The name of a world from `argument`, for headings.
pub fn title(argument: &Path) -> String {
    if argument == Path::new(DASH) { "Untitled".into() } else { source::title(argument) }
}

/// The preset called `name`, or an error that lists all presets.
pub fn preset(name: &str) -> Result<&'static Preset, Failure> {
    Ok(source::preset(name)?)
}
