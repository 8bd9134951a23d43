//! What the colors of a picture show.

use std::sync::Arc;

use orogen::io::palette::Palette;
use orogen::recipe::Recipe;
use serde::{Deserialize, Serialize};

use crate::platform::wire;

/// What the colors show.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Coloring {
    /// The values of the layer, in the layer's own palette.
    #[default]
    Own,
    /// The values of the layer, in a built-in palette.
    Named(String),
    /// The values of the layer, in a palette that is being edited.
    Edited(#[serde(with = "wire::shared")] Arc<Palette>),
    /// The surfaces of the ground: those of the recipe, or the standard surfaces.
    Surfaces,
    /// The biomes of the recipe.
    Biomes,
    /// The terrain classes of the recipe.
    Classes,
}

impl Coloring {
    /// Whether a recipe has what these colors show.
    #[must_use]
    pub fn suits(&self, recipe: &Recipe) -> bool {
        match self {
            Coloring::Biomes => orogen::export::biome_cover::classes(recipe).is_some(),
            Coloring::Classes => !recipe.classes().is_empty(),
            _ => true,
        }
    }

    /// Whether they show the cover of the ground instead of the values of the layer.
    #[must_use]
    pub fn is_cover(&self) -> bool {
        matches!(self, Coloring::Surfaces | Coloring::Biomes | Coloring::Classes)
    }
}
