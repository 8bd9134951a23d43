//! The receiver of every cell, found from drainage areas.
//!
//! Drainage areas alone determine the network: the area of a cell is its own area plus the areas of its donors. From the
//! largest area to the smallest, each cell therefore takes, of the neighbours with a larger area, the one of whose area
//! the most has no donor yet. The neighbour with the largest area is not always the receiver: where two rivers run side
//! by side, it may belong to the other river.
//!
//! Areas are f32 and grow by at least one cell a step: at a cell of 60 m this holds up to 60 000 km².

use super::layers::{Water, neighbours};
use orogen::hydrology::direction::NONE;

/// A cell without a receiver in the window.
const MISSING: u32 = u32::MAX;

/// Receivers of the cells of a window.
pub struct Network {
    receivers: Vec<u32>,
    unexplained: Vec<f64>,
    starved: Vec<bool>,
    /// All cells, the largest area first.
    order: Vec<u32>,
}

impl Network {
    /// Reads `receiver` if the world has it, and finds the receivers from `flow` otherwise.
    pub fn new(water: &Water) -> Network {
        let (window, flow) = (water.window(), water.flow.data());
        let mut order: Vec<u32> = (0..flow.len() as u32).collect();
        order.sort_by(|a, b| flow[*b as usize].total_cmp(&flow[*a as usize]).then(a.cmp(b)));
        let own = window.cell * window.cell;
        let mut network = Network {
            receivers: vec![MISSING; flow.len()],
            unexplained: flow.iter().map(|area| f64::from(*area) - own).collect(),
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
                None => network.roomiest(water, cell),
            };
            if let Some(to) = to {
                network.receivers[cell] = to as u32;
                network.starved[cell] = network.unexplained[to] < 0.5 * water.area(cell);
                network.unexplained[to] -= water.area(cell);
            }
        }
        network
    }

    /// The neighbour with a larger area of which the most has no donor yet; of equal ones the one with the largest area.
    fn roomiest(&self, water: &Water, cell: usize) -> Option<usize> {
        let larger = neighbours(water.window(), cell).map(|(_, to)| to).filter(|to| water.area(*to) > water.area(cell));
        // Areas are rounded to f32.
        let enough = |to: &usize| self.unexplained[*to] >= water.area(cell) * 0.999999;
        larger.max_by(|a, b| {
            let (left, right) = (self.unexplained[*a], self.unexplained[*b]);
            let (fits_l, fits_r) = (enough(a), enough(b));
            let by_spare = if fits_l && fits_r { right.total_cmp(&left) } else { left.total_cmp(&right) };
            fits_l.cmp(&fits_r).then(by_spare).then(water.area(*a).total_cmp(&water.area(*b)))
        })
    }

    /// The receiver of a cell.
    pub fn receiver(&self, cell: usize) -> Option<usize> {
        Some(self.receivers[cell]).filter(|to| *to != MISSING).map(|to| to as usize)
    }

    /// Whether the area of a cell does not continue: there is no receiver, or donors with larger areas leave less than
    /// half of the cell's area in it.
    pub fn ends(&self, cell: usize) -> bool {
        self.receivers[cell] == MISSING || self.starved[cell]
    }

    /// The part of a cell's area that comes neither from the cell nor from its donors, in m².
    pub fn unexplained(&self, cell: usize) -> f64 {
        self.unexplained[cell]
    }

    /// Marks everything downstream of the marked cells.
    pub fn spread_downstream(&self, marks: &mut [bool]) {
        for cell in self.order.iter().rev().map(|cell| *cell as usize).filter(|cell| self.receivers[*cell] != MISSING) {
            let marked = marks[cell];
            marks[self.receivers[cell] as usize] |= marked;
        }
    }
}
