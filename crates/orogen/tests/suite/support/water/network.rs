//! The receiver of every cell, found from drainage areas.
//!
//! Drainage areas alone determine the network almost everywhere: the area of a cell is its own area plus the areas of
//! its donors. Cells are processed from the largest area to the smallest. Each takes the neighbor downstream whose area
//! minus its donors so far fits best. The neighbor with the largest area is often not the receiver: at a bend it is the
//! cell after the receiver, and where two rivers run side by side, it may belong to the other river. In some thousands
//! of river cells, one receiver still differs from the world's.
//!
//! Of two neighbors with the same area, the one with the lower surface is downstream.

use super::layers::{Water, neighbors};
use orogen::grid::hydrology::direction::NONE;
use std::cmp::Ordering;

/// A cell without a receiver in the window.
const MISSING: u32 = u32::MAX;

/// Receivers of the cells of a window.
pub struct Network<'a> {
    /// The layers.
    pub water: &'a Water,
    receivers: Vec<u32>,
    /// Area of each cell minus its own area and the areas of its donors, in m².
    unexplained: Vec<f64>,
    /// Whether a cell's receiver had less than half of the cell's area left.
    starved: Vec<bool>,
}

impl Network<'_> {
    /// Reads `receiver` if the world has it, and finds the receivers from `flow` otherwise.
    pub fn new(water: &Water) -> Network<'_> {
        let (window, flow) = (water.window(), water.flow.data());
        // Sorted such that each cell comes after the cells downstream of it.
        let mut order: Vec<u32> = (0..flow.len() as u32).collect();
        order.sort_unstable_by(|a, b| compare(water, *a as usize, *b as usize).then(a.cmp(b)));
        let mut network = Network {
            water,
            receivers: vec![MISSING; flow.len()],
            unexplained: flow.iter().map(|area| f64::from(*area) - own_area(water)).collect(),
            starved: vec![false; flow.len()],
        };
        for cell in order.into_iter().map(|cell| cell as usize) {
            let to = match &water.receiver {
                Some(codes) => {
                    let code = codes.data()[cell] as usize;
                    neighbors(window, cell).find(|(k, _)| *k == code && code < usize::from(NONE)).map(|(_, to)| to)
                }
                None => network.best(cell),
            };
            if let Some(to) = to {
                network.receivers[cell] = to as u32;
                network.starved[cell] = network.unexplained[to] < 0.5 * water.area(cell);
                network.unexplained[to] -= water.area(cell);
            }
        }
        network
    }

    /// The neighbor downstream whose unexplained area exceeds the area of the cell by the least; if there is none, the
    /// one with the largest unexplained area.
    fn best(&self, cell: usize) -> Option<usize> {
        // Areas are rounded to f32.
        let enough = |to: usize| self.unexplained[to] >= self.water.area(cell) * 0.999_999;
        downstream(self.water, cell).max_by(|a, b| {
            let (left, right) = (self.unexplained[*a], self.unexplained[*b]);
            if enough(*a) && enough(*b) { right.total_cmp(&left) } else { left.total_cmp(&right) }
        })
    }

    /// The receiver of a cell.
    pub fn receiver(&self, cell: usize) -> Option<usize> {
        Some(self.receivers[cell]).filter(|to| *to != MISSING).map(|to| to as usize)
    }

    /// Whether the area of a cell does not continue: the cell has no receiver, or no neighbor is large enough to hold
    /// half of the area in addition to its other donors. If the receivers are not known, these are the cells without
    /// another neighbor downstream.
    pub fn ends(&self, cell: usize) -> bool {
        let water = self.water;
        if self.receivers[cell] == MISSING || water.receiver.is_some() {
            return self.receivers[cell] == MISSING || self.starved[cell];
        }
        let holds = |to: usize| {
            let sole = |from: usize| downstream(water, from).all(|other| other == to);
            let donors = upstream(water, to).filter(|from| *from != cell && sole(*from));
            let others: f64 = donors.map(|from| water.area(from)).sum();
            water.area(to) - own_area(water) - others >= 0.5 * water.area(cell)
        };
        self.starved[cell] && !downstream(water, cell).any(holds)
    }

    /// Whether at least half of the area of a cell has no source: neither the cell nor its donors. If the receivers are
    /// not known, every neighbor upstream may be a donor.
    pub fn begins(&self, cell: usize) -> bool {
        let (water, half) = (self.water, 0.5 * self.water.area(cell));
        let possible = || upstream(water, cell).map(|from| water.area(from)).sum::<f64>();
        self.unexplained[cell] > half && (water.receiver.is_some() || possible() < half)
    }

    /// Marks everything downstream of the marked cells, also where areas fall.
    pub fn spread_downstream(&self, marks: &mut [bool]) {
        for cell in (0..marks.len()).filter(|cell| marks[*cell]).collect::<Vec<_>>() {
            let mut at = cell;
            while let Some(to) = self.receiver(at).filter(|to| !marks[*to]) {
                marks[to] = true;
                at = to;
            }
        }
    }
}

/// The area of one cell, in m².
fn own_area(water: &Water) -> f64 {
    water.window().cell * water.window().cell
}

/// Whether water may flow from one cell to another: the area is larger there, or it is the same and the surface is
/// lower.
fn is_downstream(water: &Water, from: usize, to: usize) -> bool {
    compare(water, from, to).is_gt()
}

/// The order from downstream to upstream.
fn compare(water: &Water, a: usize, b: usize) -> Ordering {
    water.area(b).total_cmp(&water.area(a)).then_with(|| water.surface(a).total_cmp(&water.surface(b)))
}

/// The neighbors to which a cell may drain.
fn downstream(water: &Water, cell: usize) -> impl Iterator<Item = usize> + '_ {
    neighbors(water.window(), cell).map(|(_, to)| to).filter(move |to| is_downstream(water, cell, *to))
}

/// The neighbors that may drain to a cell.
fn upstream(water: &Water, cell: usize) -> impl Iterator<Item = usize> + '_ {
    neighbors(water.window(), cell).map(|(_, from)| from).filter(move |from| is_downstream(water, *from, cell))
}
