//! The rivers of heights.

use orogen::Grid;
use orogen::grid::hydrology::steepest::Descent;
use orogen::grid::hydrology::{Outlets, accumulate, route_carving};

/// Who drains where, and how much.
pub struct Network {
    /// Columns of the grid.
    pub width: usize,
    /// The cell in metres.
    pub cell: f64,
    /// The receiver of each cell; the cell itself at an outlet.
    pub receiver: Vec<usize>,
    /// The donor with the largest drainage area; the cell itself at a source.
    pub donor: Vec<usize>,
    /// Drainage area in km².
    pub area: Vec<f64>,
}

impl Network {
    /// The network of heights; what has no value, and the border, are outlets.
    pub fn new(heights: &Grid) -> Network {
        let outlets = Outlets::new(heights, None);
        let drainage = route_carving(heights, &outlets, Descent::Steepest);
        let areas = accumulate(&drainage.receivers).areas();
        let area: Vec<f64> = areas.data().iter().map(|area| f64::from(*area) / 1e6).collect();
        let receiver: Vec<usize> = (0..area.len()).map(|cell| drainage.receivers.of(cell)).collect();
        let mut donor: Vec<usize> = (0..area.len()).collect();
        for (cell, to) in receiver.iter().copied().enumerate().filter(|(cell, to)| cell != to) {
            if donor[to] == to || area[cell] > area[donor[to]] {
                donor[to] = cell;
            }
        }
        Network { width: heights.width(), cell: heights.window().cell, receiver, donor, area }
    }

    /// Column and row of a cell.
    pub fn place(&self, cell: usize) -> [f64; 2] {
        [(cell % self.width) as f64, (cell / self.width) as f64]
    }

    /// The length of the link between two adjacent cells, in metres.
    pub fn length(&self, a: usize, b: usize) -> f64 {
        let ([ax, ay], [bx, by]) = (self.place(a), self.place(b));
        (ax - bx).hypot(ay - by) * self.cell
    }

    /// The cell at a distance along the links from a cell, and the distance in metres; none if they end before it.
    pub fn along(&self, links: &[usize], from: usize, metres: f64) -> Option<(usize, f64)> {
        let (mut cell, mut distance) = (from, 0.0);
        while distance < metres {
            let next = links[cell];
            if next == cell {
                return None;
            }
            distance += self.length(cell, next);
            cell = next;
        }
        Some((cell, distance))
    }
}
