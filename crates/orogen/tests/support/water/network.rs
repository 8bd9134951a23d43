//! The receiver of every cell, found from drainage areas.
//!
//! Drainage areas alone determine the network almost everywhere: the area of a cell is its own area plus the areas of its
//! donors. From the largest area to the smallest, each cell therefore takes, of the neighbours with a larger area, the one
//! whose area without its donors so far fits best. The neighbour with the largest area is often not the receiver: at a bend
//! it is the cell after the receiver, and where two rivers run side by side, it may belong to the other river. One
//! receiver of a river in some thousands is still another one than the world's.
//!
//! Areas are f32 and grow by at least one cell a step: at a cell of 60 m this holds up to 60 000 km².

use super::layers::{Water, neighbours};
use orogen::hydrology::direction::NONE;

/// A cell without a receiver in the window.
const MISSING: u32 = u32::MAX;

/// Receivers of the cells of a window.
pub struct Network<'a> {
    /// The layers.
    pub water: &'a Water,
    receivers: Vec<u32>,
    /// Area of each cell without its own and its donors' areas, in m².
    unexplained: Vec<f64>,
    /// Whether a cell's receiver had less than half of the cell's area left.
    starved: Vec<bool>,
    /// All cells, the largest area first.
    order: Vec<u32>,
}

impl Network<'_> {
    /// Reads `receiver` if the world has it, and finds the receivers from `flow` otherwise.
    pub fn new(water: &Water) -> Network<'_> {
        let (window, flow) = (water.window(), water.flow.data());
        let mut order: Vec<u32> = (0..flow.len() as u32).collect();
        order.sort_by(|a, b| flow[*b as usize].total_cmp(&flow[*a as usize]).then(a.cmp(b)));
        let mut network = Network {
            water,
            receivers: vec![MISSING; flow.len()],
            unexplained: flow.iter().map(|area| f64::from(*area) - own_area(water)).collect(),
            starved: vec![false; flow.len()],
            order,
        };
        for k in 0..network.order.len() {
            let cell = network.order[k] as usize;
            let to = match &water.receiver {
                Some(codes) => {
                    let code = codes.data()[cell] as usize;
                    neighbours(window, cell).find(|(k, _)| *k == code && code < usize::from(NONE)).map(|(_, to)| to)
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

    /// Of the neighbours with a larger area, the one whose unexplained area exceeds that of the cell by the least; if none
    /// does, the one with the largest unexplained area.
    fn best(&self, cell: usize) -> Option<usize> {
        // Areas are rounded to f32.
        let enough = |to: usize| self.unexplained[to] >= self.water.area(cell) * 0.999_999;
        larger(self.water, cell).max_by(|a, b| {
            let (left, right) = (self.unexplained[*a], self.unexplained[*b]);
            if enough(*a) && enough(*b) { right.total_cmp(&left) } else { left.total_cmp(&right) }
        })
    }

    /// The receiver of a cell.
    pub fn receiver(&self, cell: usize) -> Option<usize> {
        Some(self.receivers[cell]).filter(|to| *to != MISSING).map(|to| to as usize)
    }

    /// Whether the area of a cell does not continue: the cell has no receiver, or no neighbour is large enough to hold half
    /// of the area beside its other donors. Where the receivers are not known, those are the cells that have no other
    /// neighbour with a larger area.
    pub fn ends(&self, cell: usize) -> bool {
        let water = self.water;
        if self.receivers[cell] == MISSING || water.receiver.is_some() {
            return self.receivers[cell] == MISSING || self.starved[cell];
        }
        let holds = |to: usize| {
            let sole = |from: usize| larger(water, from).all(|other| other == to);
            let donors = smaller(water, to).filter(|from| *from != cell && sole(*from));
            let others: f64 = donors.map(|from| water.area(from)).sum();
            water.area(to) - own_area(water) - others >= 0.5 * water.area(cell)
        };
        self.starved[cell] && !larger(water, cell).any(holds)
    }

    /// Whether at least half of the area of a cell comes from nowhere: neither from the cell nor from its donors. Where the
    /// receivers are not known, every neighbour with a smaller area may be a donor.
    pub fn begins(&self, cell: usize) -> bool {
        let (water, half) = (self.water, 0.5 * self.water.area(cell));
        let possible = || smaller(water, cell).map(|from| water.area(from)).sum::<f64>();
        self.unexplained[cell] > half && (water.receiver.is_some() || possible() < half)
    }

    /// Marks everything downstream of the marked cells.
    pub fn spread_downstream(&self, marks: &mut [bool]) {
        for cell in self.order.iter().rev().map(|cell| *cell as usize).filter(|cell| self.receivers[*cell] != MISSING) {
            let marked = marks[cell];
            marks[self.receivers[cell] as usize] |= marked;
        }
    }
}

/// The area of one cell, in m².
fn own_area(water: &Water) -> f64 {
    water.window().cell * water.window().cell
}

/// The neighbours with a larger area.
fn larger(water: &Water, cell: usize) -> impl Iterator<Item = usize> + '_ {
    neighbours(water.window(), cell).map(|(_, to)| to).filter(move |to| water.area(*to) > water.area(cell))
}

/// The neighbours with a smaller area.
fn smaller(water: &Water, cell: usize) -> impl Iterator<Item = usize> + '_ {
    neighbours(water.window(), cell).map(|(_, from)| from).filter(move |from| water.area(*from) < water.area(cell))
}
