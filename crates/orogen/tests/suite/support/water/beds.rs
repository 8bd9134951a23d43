//! Beds of rivers: checks whether they descend.

use super::layers::{cells_to_edge, neighbors};
use super::network::Network;
use orogen::grid::hydrology::direction::DISTANCES;

/// Drainage area in m² from which a cell belongs to a river.
const RIVER: f64 = 5e6;

/// Statistics of links from the cells of rivers to their receivers.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Beds {
    /// Number of links.
    pub links: usize,
    /// Number of links along which the bed rises.
    pub rising: usize,
    /// The greatest rise, in m.
    pub greatest: f32,
    /// Rivers that end on land: cells without a neighbor downstream, in a lake or in the sea.
    pub ends: usize,
}

/// Compares the bed of every river cell with the bed of its receiver; if the receiver is a lake or the sea, with the
/// water surface. Cells in lakes and the sea have no link. A river that ends on land is linked to the neighbor in the
/// direction of steepest descent.
pub fn measure(network: &Network) -> Beds {
    let water = network.water;
    let (window, bed) = (water.window(), water.bed.data());
    let mut found = Beds::default();
    let rivers = (0..bed.len()).filter(|cell| water.area(*cell) > RIVER && !water.is_standing(*cell));
    for cell in rivers.filter(|cell| cells_to_edge(window, *cell) > 0) {
        let receiver = network.receiver(cell).or_else(|| {
            found.ends += usize::from(neighbors(window, cell).all(|(_, to)| !water.is_standing(to)));
            let drop = |(code, to): (usize, usize)| f64::from(bed[cell] - water.surface(to)) / DISTANCES[code];
            neighbors(window, cell).max_by(|a, b| drop(*a).total_cmp(&drop(*b))).map(|(_, to)| to)
        });
        let Some(receiver) = receiver else { continue };
        let rise = water.surface(receiver) - bed[cell];
        found.links += 1;
        found.rising += usize::from(rise > 0.0);
        found.greatest = found.greatest.max(rise);
    }
    found
}
