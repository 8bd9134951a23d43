//! Hanging valleys: how far the last stretch of a tributary falls more than the stretch above it would let expect.

use orogen::Grid;

use super::network::Network;

/// Minimum drainage area of a tributary, in km².
const TRIBUTARY: f64 = 2.0;

/// Minimum ratio between the areas of the valley that is entered and of the tributary.
const RATIO: f64 = 4.0;

/// Length of each stretch, in metres.
const STRETCH: f64 = 1200.0;

/// For each mouth of a tributary, the fall of the last [`STRETCH`] beyond that of the stretch above it, in metres.
pub fn falls(heights: &Grid, network: &Network) -> Vec<f64> {
    (0..network.area.len()).filter_map(|cell| fall(heights, network, cell)).collect()
}

fn fall(heights: &Grid, network: &Network, cell: usize) -> Option<f64> {
    let to = network.receiver[cell];
    let is_mouth = to != cell
        && network.donor[to] != cell
        && network.area[cell] >= TRIBUTARY
        && network.area[to] >= RATIO * network.area[cell];
    if !is_mouth {
        return None;
    }
    let (middle, last) = network.along(&network.donor, cell, STRETCH)?;
    let (top, above) = network.along(&network.donor, middle, STRETCH)?;
    let at = |cell: usize| f64::from(heights.data()[cell]);
    let fall = (at(middle) - at(to)) - (at(top) - at(middle)) / above * (last + network.length(cell, to));
    fall.is_finite().then_some(fall)
}
