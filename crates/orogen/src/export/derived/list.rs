//! The derived layers there are.

use super::layer::Derived;
use super::{albedo, aspect, curvature, hillshade, normal, occlusion, roughness, slope, splat};
use crate::recipe::document::Recipe;

static ALL: [&Derived; 9] = [
    &slope::LAYER,
    &aspect::LAYER,
    &curvature::LAYER,
    &hillshade::LAYER,
    &normal::LAYER,
    &occlusion::LAYER,
    &splat::LAYER,
    &albedo::LAYER,
    &roughness::LAYER,
];

/// All derived layers.
pub fn all() -> &'static [&'static Derived] {
    &ALL
}

/// The derived layer of that name.
pub fn named(name: &str) -> Option<&'static Derived> {
    ALL.into_iter().find(|derived| derived.name == name)
}

/// Adds to a recipe what a derived layer reads beside the heights: call it before the world is opened. A layer that the recipe has itself needs nothing.
pub fn prepare(recipe: &mut Recipe, layer: &str) {
    let has = recipe.outputs().any(|name| name == layer) || recipe.nodes().iter().any(|named| named.name == layer);
    if let Some(derived) = named(layer).filter(|_| !has) {
        (derived.prepare)(recipe);
    }
}
