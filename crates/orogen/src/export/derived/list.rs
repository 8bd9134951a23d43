//! The derived layers there are.

use super::layer::Derived;
use super::{aspect, curvature, hillshade, normal, occlusion, slope, splat};
use crate::recipe::document::Recipe;
use crate::solver::drainage::Drainage;
use crate::world::HEIGHT;

static ALL: [&Derived; 7] = [
    &slope::LAYER,
    &aspect::LAYER,
    &curvature::LAYER,
    &hillshade::LAYER,
    &normal::LAYER,
    &occlusion::LAYER,
    &splat::LAYER,
];

/// The node that tells drainage areas to those that look at them.
pub const FLOW: &str = "drainage-below-height";

/// All derived layers.
pub fn all() -> &'static [&'static Derived] {
    &ALL
}

/// The derived layer of that name.
pub fn named(name: &str) -> Option<&'static Derived> {
    ALL.into_iter().find(|derived| derived.name == name)
}

/// Adds to a recipe what a derived layer looks at beside the heights: call it before the world is opened. A layer that the recipe has itself needs nothing, nor
/// does a world without bounds, whose rivers never end.
pub fn prepare(recipe: &mut Recipe, layer: &str) {
    let has = recipe.outputs().any(|name| name == layer) || recipe.nodes().iter().any(|named| named.name == layer);
    if has || recipe.world.size.is_none() || !named(layer).is_some_and(|derived| derived.flow) {
        return;
    }
    if let Some((_, heights)) = recipe.output_inputs().iter().find(|(name, _)| name == HEIGHT) {
        let source = heights.clone();
        recipe.add(FLOW, Drainage { source, ..Drainage::default() });
    }
}
