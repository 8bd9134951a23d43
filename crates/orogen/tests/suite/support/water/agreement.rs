//! Agreement of the heights with the drainage areas: whether D8 on the heights gives the rivers of `flow`.

use super::layers::{cells_to_edge, neighbors};
use super::network::Network;
use orogen::grid::hydrology::steepest::Descent;
use orogen::grid::hydrology::{Outlets, accumulate, route_carving};

/// Maximum difference between the areas of a cell that agrees, relative to the area in `flow`.
const TOLERANCE: f64 = 0.2;

/// Drainage area in m² from which rivers that enter the window are followed.
const RIVER: f64 = 1e6;

/// Cells of rivers whose areas are in one range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// The range of areas in m²: the lower end is included, the upper end is not.
    pub range: [f64; 2],
    /// Cells whose catchment lies in the window.
    pub cells: usize,
    /// Number of these cells with a D8 area within 20 % of the area in `flow`, at most one cell away.
    pub agree: usize,
}

/// Routes the bed by steepest descent, with depressions carved, and compares drainage areas in each range.
///
/// A catchment lies in the window if no water enters it from the edge, neither by D8 on the heights nor in rivers of
/// `flow`. By D8, water enters wherever the catchment touches the row of cells next to the edge. Cells next to one with
/// water from the edge are excluded too, and so are rivers below a lake that crosses the edge, because its water leaves
/// there. Cells in lakes and the sea are not compared.
pub fn measure(network: &Network, ranges: &[[f64; 2]]) -> Vec<Agreement> {
    let water = network.water;
    let window = water.window();
    let outlets = Outlets::new(&water.bed, Some(water.sea_level));
    let receivers = route_carving(&water.bed, &outlets, Descent::Steepest).receivers;
    let accumulation = accumulate(&receivers);
    let near_edge = |cell: usize| cells_to_edge(window, cell) < 2;
    let mut entered: Vec<bool> = (0..window.len()).map(near_edge).collect();
    for cell in accumulation.upstream_first() {
        let marked = entered[cell];
        entered[receivers.of(cell)] |= marked;
    }
    let mut rivers_entered: Vec<bool> = (0..window.len())
        .map(|cell| near_edge(cell) && (water.area(cell) >= RIVER || water.is_standing(cell)))
        .collect();
    let mut crossing: Vec<usize> =
        (0..window.len()).filter(|cell| rivers_entered[*cell] && water.is_standing(*cell)).collect();
    while let Some(cell) = crossing.pop() {
        for (_, near) in neighbors(window, cell).filter(|(_, near)| water.is_standing(*near)) {
            if !std::mem::replace(&mut rivers_entered[near], true) {
                crossing.push(near);
            }
        }
    }
    network.spread_downstream(&mut rivers_entered);

    let own = window.cell * window.cell;
    let mut found: Vec<Agreement> =
        ranges.iter().map(|range| Agreement { range: *range, cells: 0, agree: 0 }).collect();
    for cell in (0..window.len()).filter(|cell| !water.is_standing(*cell) && !rivers_entered[*cell]) {
        let area = water.area(cell);
        let mut matching = found.iter_mut().filter(|part| part.range[0] <= area && area < part.range[1]).peekable();
        let around = || neighbors(window, cell).map(|(_, near)| near).chain([cell]);
        if matching.peek().is_none() || around().any(|near| entered[near]) {
            continue;
        }
        let off = |near: usize| (f64::from(accumulation.area.data()[near]) * own - area).abs();
        let agrees = around().any(|near| off(near) <= TOLERANCE * area);
        matching.for_each(|part| {
            part.cells += 1;
            part.agree += usize::from(agrees);
        });
    }
    found
}
