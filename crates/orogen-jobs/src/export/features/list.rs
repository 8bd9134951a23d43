//! The list of layers of vector features.

use super::layer::VectorLayer;
use crate::export::vectors;

static ALL: &[&VectorLayer] = include!("../vector_list.rs");

/// All layers, by name.
#[must_use]
pub fn all() -> &'static [&'static VectorLayer] {
    ALL
}

/// The layer with this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static VectorLayer> {
    ALL.iter().copied().find(|layer| layer.name == name)
}

/// The layers of a comma-separated list of names; `None` unless all of them are layers of vector features.
#[must_use]
pub fn listed(names: &str) -> Option<Vec<&'static VectorLayer>> {
    let mut layers: Vec<&VectorLayer> = Vec::new();
    for name in names.split(',') {
        let layer = named(name.trim())?;
        if !layers.iter().any(|known| known.name == layer.name) {
            layers.push(layer);
        }
    }
    Some(layers)
}
