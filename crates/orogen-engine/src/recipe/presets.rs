//! Built-in recipes: files in `recipes/`, embedded.

use super::document::Recipe;
use orogen_grid::error::Result;

/// A built-in recipe.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Preset {
    /// The name.
    pub name: &'static str,
    /// The recipe in TOML.
    pub text: &'static str,
}

impl Preset {
    /// Parses the recipe.
    ///
    /// # Errors
    /// None in a release: a test parses every preset.
    pub fn recipe(&self) -> Result<Recipe> {
        self.recipe_with(&[])
    }

    /// Parses the recipe with other values for some of its parameters.
    ///
    /// # Errors
    /// If a parameter does not exist or the value is out of range.
    pub fn recipe_with(&self, set: &[(String, f64)]) -> Result<Recipe> {
        Recipe::parse_preset(self.name, self.text, set)
    }
}

static PRESETS: &[Preset] = include!("preset_list.rs");

/// The default preset.
pub const DEFAULT: &str = "alpine";

/// All presets, by name.
#[must_use]
pub fn all() -> &'static [Preset] {
    PRESETS
}

/// The preset with this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
