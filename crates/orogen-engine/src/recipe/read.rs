//! Reading recipes from files and texts.

use super::document::Recipe;
use super::parse::parse;
use super::subgraph::{Origin, Shared};
use super::text::{LONGEST_TEXT, text_of, too_long};
use crate::registry::Registry;
use orogen_grid::error::Result;
use orogen_io::open;
use std::path::Path;

impl Registry {
    /// Reads a recipe of these ops from a file, TOML or JSON.
    ///
    /// # Errors
    /// If the file cannot be read, is not text, or is not a valid recipe. Every diagnostic of a recipe has its line and
    /// column.
    pub fn read(&self, path: &Path) -> Result<Recipe> {
        self.read_with(path, &[])
    }

    /// [`Registry::read`] with other values for some of the recipe's parameters.
    ///
    /// # Errors
    /// As [`Registry::read`], and if a parameter does not exist or its value is out of range.
    pub fn read_with(&self, path: &Path, set: &[(String, f64)]) -> Result<Recipe> {
        let doing = "read the recipe";
        let Some(bytes) = open::bytes(path, doing, LONGEST_TEXT)? else {
            return Err(too_long(&path.display().to_string()));
        };
        let shared = Shared::new(self, parse);
        parse(&text_of(bytes, path)?, &path.display().to_string(), set, &Origin::file(path, &shared))
    }

    /// Reads a recipe of these ops from a text in place of the content of a file, for example while the file is edited.
    /// Relative paths in it start at the file's folder. Diagnostics name the file, which need not exist.
    ///
    /// # Errors
    /// As [`Registry::parse`].
    pub fn parse_as(&self, text: &str, path: &Path) -> Result<Recipe> {
        let shared = Shared::new(self, parse);
        parse(text, &path.display().to_string(), &[], &Origin::file(path, &shared))
    }

    /// Reads a recipe of these ops from a text: JSON if it begins with a brace, otherwise TOML. `name` is the name of
    /// the text in diagnostics.
    ///
    /// # Errors
    /// If it is not a valid recipe. All diagnostics are reported at once, in the order of the text.
    pub fn parse(&self, text: &str, name: &str) -> Result<Recipe> {
        self.parse_with(text, name, &[])
    }

    /// [`Registry::parse`] for a text from anywhere: it must not name files, neither in parameters nor in surfaces nor
    /// as recipes that it uses, and has at most `nodes` nodes, also with the presets that it uses. No file is opened or
    /// looked up.
    ///
    /// # Errors
    /// As [`Registry::parse`], and if it names a file.
    #[doc(hidden)]
    pub fn parse_without_files(&self, text: &str, name: &str, nodes: usize) -> Result<Recipe> {
        let shared = Shared::without_files(self, parse, nodes);
        parse(text, name, &[], &Origin::text(&shared))
    }

    /// [`Registry::parse`] with other values for some of the recipe's parameters.
    ///
    /// # Errors
    /// As [`Registry::parse`], and if a parameter does not exist or its value is out of range.
    pub fn parse_with(&self, text: &str, name: &str, set: &[(String, f64)]) -> Result<Recipe> {
        let shared = Shared::new(self, parse);
        parse(text, name, set, &Origin::text(&shared))
    }
}

impl Recipe {
    /// Reads a recipe of built-in ops from a file, TOML or JSON.
    ///
    /// # Errors
    /// As [`Registry::read`].
    pub fn read(path: &Path) -> Result<Recipe> {
        Recipe::read_with(path, &[])
    }

    /// [`Recipe::read`] with other values for some of its parameters.
    ///
    /// # Errors
    /// As [`Registry::read_with`].
    pub fn read_with(path: &Path, set: &[(String, f64)]) -> Result<Recipe> {
        Registry::new().read_with(path, set)
    }

    /// Reads a preset.
    pub(super) fn parse_preset(name: &str, text: &str, set: &[(String, f64)]) -> Result<Recipe> {
        let registry = Registry::new();
        let shared = Shared::new(&registry, parse);
        parse(text, &format!("recipes/{name}.toml"), set, &Origin::preset(name, &shared))
    }

    /// Reads a recipe of built-in ops from a text: JSON if it begins with a brace, otherwise TOML. `name` is the name
    /// of the text in diagnostics.
    ///
    /// # Errors
    /// As [`Registry::parse`].
    pub fn parse(text: &str, name: &str) -> Result<Recipe> {
        Recipe::parse_with(text, name, &[])
    }

    /// [`Recipe::parse`] with other values for some of its parameters.
    ///
    /// # Errors
    /// As [`Registry::parse_with`].
    pub fn parse_with(text: &str, name: &str, set: &[(String, f64)]) -> Result<Recipe> {
        Registry::new().parse_with(text, name, set)
    }
}
