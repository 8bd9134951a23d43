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
    /// A file or a preset.
    Named(RecipeSource),
    /// Standard input.
    Stdin,
}

/// The name of standard input in messages.
pub const STDIN: &str = "standard input";

/// The content of standard input, which can be read only once.
static PIPED: OnceLock<Vec<u8>> = OnceLock::new();

impl Source {
    /// The source for `argument`: the file if it exists, otherwise the preset.
    pub fn find(argument: &Path) -> Result<Source, Failure> {
        if argument == Path::new(DASH) {
            return Ok(Source::Stdin);
        }
        let source = RecipeSource::find(argument)?;
        if let (RecipeSource::File(_), Some(preset)) = (&source, argument.to_str().and_then(presets::find)) {
            say::once(&format!(
                "note: reading the file {name}, not the preset of that name; give another folder's path or rename \
                 the file to get the preset",
                name = preset.name
            ));
        }
        Ok(Source::Named(source))
    }

    /// The file of heights, if the source is one.
    pub fn dem(&self) -> Option<&Path> {
        match self {
            Source::Named(RecipeSource::Dem(path)) => Some(path),
            _ => None,
        }
    }

    /// All files that a recipe from this source reads.
    pub fn inputs(&self, recipe: &Recipe) -> Vec<PathBuf> {
        let mut files = recipe.files();
        if let Source::Named(RecipeSource::File(path) | RecipeSource::Dem(path)) = self {
            files.push(path.clone());
        }
        files
    }

    /// Reads the recipe with values for its parameters. The heights of a real place take at most the rest of `budget`.
    pub fn read(&self, budget: &Budget, arguments: &Arguments) -> Result<Recipe, Failure> {
        let set = arguments.values();
        match self {
            Source::Named(source) => Ok(source.read(&set, left(budget), |note| self.tell(note))?),
            Source::Stdin => piped(&set),
        }
    }

    /// [`Source::read`], except that the heights of a large file are read when windows of them are requested.
    pub fn open(&self, budget: &Budget, arguments: &Arguments) -> Result<Recipe, Failure> {
        match self {
            Source::Named(source) => Ok(source.open(&arguments.values(), left(budget), |note| self.tell(note))?),
            Source::Stdin => self.read(budget, arguments),
        }
    }

    fn tell(&self, note: &str) {
        tell(self.dem().unwrap_or(Path::new(STDIN)), note);
    }
}

/// Memory for the heights of a file, in bytes.
fn left(budget: &Budget) -> u64 {
    budget.left().unwrap_or(DEFAULT_MEMORY)
}

/// Prints a note about a file of heights.
fn tell(path: &Path, note: &str) {
    say::once(&format!("note: {}: {note}", path.display()));
}

/// The recipe for heights that were read from a file. Prints notes about them.
pub fn of_dem(path: &Path, ground: PreparedDem) -> Recipe {
    ground.notes.iter().for_each(|note| tell(path, note));
    Recipe::from_dem(path, &Arc::new(ground))
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
