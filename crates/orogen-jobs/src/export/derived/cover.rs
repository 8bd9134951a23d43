//! The layers that a recipe's surfaces read, and their cover of the ground.

use super::layer::Around;
use orogen_engine::recipe::document::Recipe;
use orogen_output::map::surface_blend::{SurfaceBlend, SurfaceLayer};

/// The names of the surfaces without duplicates, in the order of first use.
pub fn names(recipe: &Recipe) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for expanded in recipe.expanded() {
        if !names.contains(&expanded.surface.name) {
            names.push(expanded.surface.name.clone());
        }
    }
    names
}

/// The layers with the shares of surfaces.
pub fn shares(recipe: &Recipe) -> Vec<String> {
    recipe.expanded().iter().filter_map(|expanded| expanded.share.clone()).collect()
}

/// The layers with the shares, followed by those with the positions in gradients.
pub fn shares_and_positions(recipe: &Recipe) -> Vec<String> {
    let positions = recipe.expanded().iter().filter_map(|expanded| expanded.position.clone());
    shares(recipe).into_iter().chain(positions).collect()
}

/// The surfaces over a window, from layers in the order of [`shares`] or of [`shares_and_positions`].
pub fn of<'a>(around: &'a Around<'a>) -> SurfaceBlend<'a> {
    let (recipe, names) = (around.recipe, names(around.recipe));
    let count = shares(recipe).len().min(around.layers.len());
    let (mut shares, mut positions) = (around.layers[..count].iter(), around.layers[count..].iter());
    let laid = recipe.expanded().iter().map(|expanded| SurfaceLayer {
        colors: &expanded.colors,
        roughness: expanded.surface.roughness as f32,
        channel: names.iter().position(|name| *name == expanded.surface.name).unwrap_or(0),
        share: expanded.share.as_ref().and_then(|_| shares.next()),
        position: expanded.position.as_ref().and_then(|_| positions.next()),
    });
    SurfaceBlend { surfaces: laid.collect(), heights: around.heights }
}
