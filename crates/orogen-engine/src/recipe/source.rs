//! Sources of recipes: a recipe file, a preset, or a file of heights.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::document::Recipe;
use super::presets::{self, Preset};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::nearest;
use orogen_io::dem::dem_file::DemFile;
use orogen_io::dem::{PreparedDem, open};
use orogen_io::format::content;
use orogen_io::format::foreign::foreign;
use orogen_io::fs;

/// The source of a recipe.
#[derive(Debug, Clone)]
pub enum RecipeSource {
    /// A recipe file.
    File(PathBuf),
    /// A preset.
    Preset(&'static Preset),
    /// A file of heights, as a recipe that consists only of it.
    Dem(PathBuf),
}

impl RecipeSource {
    /// The source for `argument`: the file if it exists, otherwise the preset.
    ///
    /// # Errors
    /// If there is neither: the message suggests the closest name.
    pub fn find(argument: &Path) -> Result<RecipeSource> {
        match argument.to_str().and_then(presets::find) {
            Some(preset) if !fs::is_file(argument) => Ok(RecipeSource::Preset(preset)),
            None if open::is_dem(argument) => Ok(RecipeSource::Dem(argument.to_path_buf())),
            // The error of reading it says how to convert it.
            None if fs::is_file(argument) && (foreign(argument).is_some() || content::of_file(argument).is_some()) => {
                Ok(RecipeSource::Dem(argument.to_path_buf()))
            }
            None if !fs::is_present(argument) && !looks_like_a_path(argument) => {
                Err(Error::new(ErrorKind::Request, unknown(argument)))
            }
            _ => Ok(RecipeSource::File(argument.to_path_buf())),
        }
    }

    /// [`RecipeSource::read`], except that the heights of a large file are read when windows of them are requested.
    ///
    /// # Errors
    /// The errors of [`RecipeSource::read`].
    #[doc(hidden)]
    pub fn open(&self, set: &[(String, f64)], memory: u64, note: impl FnMut(&String)) -> Result<Recipe> {
        if let RecipeSource::Dem(path) = self
            && set.is_empty()
            && let Some(file) = DemFile::open(path, None, memory)?
        {
            file.place().notes.iter().for_each(note);
            return Ok(Recipe::from_dem_file(path, &Arc::new(file)));
        }
        self.read(set, memory, note)
    }

    /// Reads the recipe with these values of its parameters. A file of heights takes at most `memory` bytes; `note`
    /// gets remarks about it.
    ///
    /// # Errors
    /// If it cannot be read, is not valid, or lacks a parameter.
    pub fn read(&self, set: &[(String, f64)], memory: u64, note: impl FnMut(&String)) -> Result<Recipe> {
        match self {
            RecipeSource::File(path) => Recipe::read_with(path, set),
            RecipeSource::Preset(preset) => preset.recipe_with(set),
            RecipeSource::Dem(path) if set.is_empty() => {
                let ground = PreparedDem::read(path, None, memory)?;
                ground.notes.iter().for_each(note);
                Ok(Recipe::from_dem(path, &Arc::new(ground)))
            }
            RecipeSource::Dem(path) => Err(Error::new(
                ErrorKind::Request,
                format!("{} is a file of heights, which has no parameters to set", path.display()),
            )),
        }
    }
}

/// The name of a world from the argument that names its recipe, for headings.
#[must_use]
pub fn title(argument: &Path) -> String {
    argument.file_stem().unwrap_or(argument.as_os_str()).to_string_lossy().into_owned()
}

/// The preset called `name`.
///
/// # Errors
/// If there is none: the message suggests the closest name, or lists all presets.
pub fn preset(name: &str) -> Result<&'static Preset> {
    let missing = || Error::new(ErrorKind::Request, format!("no preset is called `{name}`; {}", hint(name)));
    presets::find(name).ok_or_else(missing)
}

fn looks_like_a_path(argument: &Path) -> bool {
    argument.extension().is_some() || argument.components().count() > 1
}

fn unknown(argument: &Path) -> String {
    let name = argument.to_string_lossy();
    for extension in ["toml", "json"] {
        let file = argument.with_extension(extension);
        if fs::is_file(&file) {
            return format!("no preset or file is called `{name}`; did you mean `{0}`?", file.display());
        }
    }
    format!("no preset or file is called `{name}`; {}", hint(&name))
}

fn hint(name: &str) -> String {
    let names = || presets::all().iter().map(|preset| preset.name);
    match nearest(name, names()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("available presets: {}", names().collect::<Vec<_>>().join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_io::test_folder::TestFolder;

    #[test]
    fn files_come_before_presets_and_what_is_neither_is_a_message() {
        let folder = TestFolder::new("recipe-source").unwrap();
        let path = folder.join("classic");
        assert!(
            matches!(RecipeSource::find(Path::new("classic")), Ok(RecipeSource::Preset(preset)) if preset.name == "classic")
        );
        fs::write(&path, "orogen = 1").unwrap();
        assert!(matches!(RecipeSource::find(&path), Ok(RecipeSource::File(found)) if found == path));
        // The error of reading it says what is wrong.
        assert!(matches!(RecipeSource::find(&folder.join("none.toml")), Ok(RecipeSource::File(_))));
        assert!(matches!(RecipeSource::find(Path::new("none.asc")), Ok(RecipeSource::Dem(_) | RecipeSource::File(_))));
        for (name, expect) in [("alpin", "did you mean `alpine`?"), ("zzzzzzzz", "available presets: ")] {
            let error = RecipeSource::find(Path::new(name)).unwrap_err();
            assert!(error.to_string().contains(expect), "{error}");
            assert!(preset(name).unwrap_err().to_string().contains(expect));
        }
        assert_eq!(title(Path::new("a/b.toml")), "b");
    }
}
