//! The recipes that come with the program: plain files in `recipes/`, embedded.

use super::document::Recipe;
use orogen_grid::error::Result;

/// A recipe that comes with the program.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// What it is called.
    pub name: &'static str,
    /// Its recipe, TOML.
    pub text: &'static str,
}

impl Preset {
    /// Reads it.
    ///
    /// # Errors
    /// None in a release: a test reads every preset.
    pub fn recipe(&self) -> Result<Recipe> {
        self.recipe_with(&[])
    }

    /// Reads it with other values for some of its parameters.
    ///
    /// # Errors
    /// If a parameter is not there or may not have that value.
    pub fn recipe_with(&self, set: &[(String, f64)]) -> Result<Recipe> {
        Recipe::parse_preset(self.name, self.text, set)
    }
}

macro_rules! presets {
    ($($name:literal,)*) => {
        &[$( Preset { name: $name, text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/recipes/", $name, ".toml")) }, )*]
    };
}

static PRESETS: &[Preset] = presets![
    "alpine",
    "archipelago",
    "badlands",
    "canyon",
    "classic",
    "dla-peaks",
    "endless",
    "fjords",
    "hills",
    "himalaya",
    "island",
    "mesa",
    "rolling",
    "volcano",
];

/// The preset that is made if nobody asks for another.
pub const DEFAULT: &str = "alpine";

/// All of them, by name.
pub fn all() -> &'static [Preset] {
    PRESETS
}

/// The preset of that name.
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}
