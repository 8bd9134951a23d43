//! Small pictures of a layer with relief shading.

use orogen::layer::LayerKind;
use orogen::world::HEIGHT;
use orogen::{Progress, Result, Window, World};
use serde::{Deserialize, Serialize};

use super::coloring::Coloring;
use super::colors::Colors;
use super::failure;
use crate::platform::wire;

/// A small picture with relief shading.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Picture {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Red, green, blue and 255 for each sample, sRGB.
    #[serde(with = "wire::bytes")]
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Makes the picture of a layer over a window. Layers of heights have the colors of land.
    ///
    /// # Errors
    /// If there is no such layer, or it cannot be computed.
    pub fn of(world: &World, layer: &str, window: &Window, progress: &Progress) -> Result<Picture> {
        let values = world.grids(&[layer], window, progress)?.pop().ok_or_else(failure::nothing)?;
        let (recipe, kind) = (world.recipe(), world.kind(layer)?);
        let colored = if kind == LayerKind::Height { HEIGHT } else { layer };
        let colors = Colors::of(recipe, colored, kind, &Coloring::Own, &values);
        let pixels = world.install(|| colors.shade(&colors.paint(&values), &values, recipe.world.sea_level));
        Ok(Picture { size: [window.width, window.height], pixels })
    }
}
