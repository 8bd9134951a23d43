//! Depressions outside lakes and the sea.

use super::layers::Water;
use orogen::grid::hydrology::{Outlets, fill};

/// Statistics of depressions of the bed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Depressions {
    /// Number of cells outside lakes and the sea.
    pub land: usize,
    /// Number of these cells that are in depressions.
    pub cells: usize,
    /// Depth of the deepest, in m.
    pub deepest: f32,
}

/// Floods the bed from the window's edge, the lakes and the sea. A cell that the flood raises is in a depression.
pub fn measure(water: &Water) -> Depressions {
    // The lowest height marks lakes and sea as outlets.
    let mut land = water.bed.clone();
    for (cell, height) in land.data_mut().iter_mut().enumerate() {
        if water.is_standing(cell) {
            *height = f32::MIN;
        }
    }
    let filled = fill(&land, &Outlets::new(&land, Some(f32::MIN)));
    let mut found = Depressions::default();
    for (height, level) in land.data().iter().zip(filled.data()).filter(|(height, _)| **height > f32::MIN) {
        found.land += 1;
        if level > height {
            found.cells += 1;
            found.deepest = found.deepest.max(level - height);
        }
    }
    found
}
