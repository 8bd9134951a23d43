//! The layers that a recipe's surfaces read, and the cover of the ground by surfaces.

use super::appended::{Appended, AppendedNode};
use orogen_engine::filter::Slope;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::surface::expand::expand;
use orogen_engine::world::HEIGHT;
use orogen_grid::grid::Grid;
use orogen_output::map::surface_blend::{SurfaceBlend, SurfaceLayer};

/// Appends the nodes that compute a recipe's surfaces.
pub fn prepare(to: &mut Appended) {
    expand(to.recipe_mut());
}

/// Like [`prepare`], and appends the nodes of [`slopes`].
pub fn prepare_with_slopes(to: &mut Appended) {
    prepare(to);
    let source = to.extrapolated(1);
    to.add(Slope { source, ..Slope::default() });
}

/// The layers with the slopes to the east and to the south.
pub fn slopes() -> [String; 2] {
    ["east", "south"].map(|layer| AppendedNode::of("slope").name_of(layer))
}

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

/// The heights, followed by the layers with the shares of surfaces.
pub fn shares(recipe: &Recipe) -> Vec<String> {
    let shares = recipe.expanded().iter().filter_map(|expanded| expanded.share.clone());
    [HEIGHT.to_string()].into_iter().chain(shares).collect()
}

/// [`shares`], followed by the layers with the positions in gradients.
pub fn shares_and_positions(recipe: &Recipe) -> Vec<String> {
    let positions = recipe.expanded().iter().filter_map(|expanded| expanded.position.clone());
    shares(recipe).into_iter().chain(positions).collect()
}

/// The surfaces over a window, from layers in the order of [`shares`] or of [`shares_and_positions`]; further layers
/// are ignored.
pub fn of<'a>(recipe: &'a Recipe, layers: &'a [Grid]) -> SurfaceBlend<'a> {
    let names = names(recipe);
    let (mut shares, mut positions) = (layers[1..].iter(), layers[shares(recipe).len()..].iter());
    let laid = recipe.expanded().iter().map(|expanded| SurfaceLayer {
        colors: &expanded.colors,
        roughness: expanded.surface.roughness as f32,
        channel: names.iter().position(|name| *name == expanded.surface.name).unwrap_or(0),
        share: expanded.share.as_ref().and_then(|_| shares.next()),
        position: expanded.position.as_ref().and_then(|_| positions.next()),
    });
    SurfaceBlend { surfaces: laid.collect(), heights: &layers[0] }
}
