//! How much ground drains through each cell.

use super::direction::{neighbour, strides};
use super::receivers::Receivers;
use crate::grid::Grid;
use rayon::prelude::*;

/// What drains where: each cell's area, and orders to walk the cells in.
#[derive(Debug, Clone)]
pub struct Accumulation {
    /// Cells that drain through each cell, itself included. Whole numbers: the same whatever order they were added in.
    pub area: Grid<u32>,
    /// Cells that water from other bands runs through, each after its receiver. All that these drain to is here too.
    trunk: Vec<u32>,
    bands: Vec<Band>,
}

/// Rows whose cells, but for the trunk's, can be walked without looking at other bands.
#[derive(Debug, Clone)]
pub(super) struct Band {
    /// Its first cell, and the one after its last.
    pub cells: std::ops::Range<usize>,
    /// Its cells that are not the trunk's, each after its receiver.
    pub order: Vec<u32>,
}

impl Band {
    /// Orders and counts a band's cells, `donors` being its own and `area` all ones.
    ///
    /// Each walk begins where nothing flows in and goes on downstream until it meets a cell that still waits for another inflow,
    /// so every cell is visited once, and cells that lie near each other are near each other in the order.
    fn new(receivers: &Receivers, trunk: &[u32], start: usize, donors: &[u8], area: &mut [u32]) -> Band {
        let cells = start..start + area.len();
        let mut waiting: Vec<u8> = donors.iter().map(|set| set.count_ones() as u8).collect();
        // What is done waits for ever, and so does the trunk: no walk begins or goes on there.
        const DONE: u8 = 255;
        for cell in trunk.iter().map(|cell| *cell as usize).filter(|cell| cells.contains(cell)) {
            waiting[cell - start] = DONE;
        }
        let mut order = Vec::with_capacity(area.len());
        for first in 0..area.len() {
            let mut cell = first;
            while waiting[cell] == 0 {
                waiting[cell] = DONE;
                order.push((start + cell) as u32);
                // Above the band it wraps around, to beyond the band's end.
                let receiver = receivers.of(start + cell).wrapping_sub(start);
                if receiver == cell || waiting.get(receiver).is_none_or(|waits| *waits == DONE) {
                    break;
                }
                area[receiver] += area[cell];
                waiting[receiver] -= 1;
                cell = receiver;
            }
        }
        order.reverse();
        Band { cells, order }
    }
}

impl Accumulation {
    /// Every cell once, each after its receiver.
    pub fn downstream_first(&self) -> impl DoubleEndedIterator<Item = usize> {
        let bands = self.bands.iter().flat_map(|band| &band.order);
        self.trunk.iter().chain(bands).map(|cell| *cell as usize)
    }

    /// Every cell once, each before its receiver.
    pub fn upstream_first(&self) -> impl DoubleEndedIterator<Item = usize> {
        self.downstream_first().rev()
    }

    /// The cells that several bands share, each after its receiver, and the bands.
    pub(super) fn parts(&self) -> (&[u32], &[Band]) {
        (&self.trunk, &self.bands)
    }
}

/// Counts the cells that drain through each cell: O(cells), on as many threads as there are.
///
/// Each thread takes bands of rows. What water from another band runs through is the trunk, a few cells in a hundred; all else
/// is ordered and counted band by band. A cell on a circle of receivers would never be visited; what makes receivers in this
/// room makes no circles.
pub fn accumulate(receivers: &Receivers) -> Accumulation {
    let threads = rayon::current_num_threads();
    // A band for a thread is enough where there is one; more even out what they have to do.
    let bands = if threads == 1 { 1 } else { 3 * threads };
    accumulate_in(receivers, receivers.window().height.div_ceil(bands).max(FEWEST_ROWS))
}

/// Rows of a band at least: the trunk grows with the number of bands.
const FEWEST_ROWS: usize = 128;

/// The same by bands of `rows` rows.
fn accumulate_in(receivers: &Receivers, rows: usize) -> Accumulation {
    let window = *receivers.window();
    let mut area = vec![1u32; window.len()];
    if window.is_empty() {
        return Accumulation { area: Grid::filled(window, 1), trunk: Vec::new(), bands: Vec::new() };
    }
    let size = rows * window.width;
    let donors = receivers.donors();
    let trunk = Trunk::new(receivers, rows);
    let bands: Vec<Band> = area
        .par_chunks_mut(size)
        .zip(donors.par_chunks(size))
        .enumerate()
        .map(|(k, (area, donors))| Band::new(receivers, &trunk.order, k * size, donors, area))
        .collect();
    let strides = strides(window.width);
    for cell in trunk.order.iter().rev().map(|cell| *cell as usize) {
        let flows_in = |k: &usize| donors[cell] & 1 << k != 0;
        area[cell] = 1 + (0..8).filter(flows_in).map(|k| area[neighbour(cell, strides[k])]).sum::<u32>();
    }
    let area = Grid::from_data(window, area).unwrap_or_else(|| Grid::filled(window, 0));
    Accumulation { area, trunk: trunk.order, bands }
}

/// What water from other bands runs through.
struct Trunk {
    /// Each after its receiver.
    order: Vec<u32>,
    /// Whether a cell is among them; empty if there is one band.
    marks: Vec<bool>,
}

impl Trunk {
    fn new(receivers: &Receivers, rows: usize) -> Trunk {
        let (width, height) = (receivers.window().width, receivers.window().height);
        let mut trunk = Trunk { order: Vec::new(), marks: Vec::new() };
        for first in (rows..height).step_by(rows) {
            trunk.marks.resize(width * height, false);
            let (above, below) = ((first - 1) * width, first * width);
            for cell in above..below + width {
                let receiver = receivers.of(cell);
                if (cell < below) != (receiver < below) {
                    trunk.follow(receivers, receiver);
                }
            }
        }
        trunk
    }

    /// Takes in all that lies downstream, down to what has been taken in before.
    fn follow(&mut self, receivers: &Receivers, from: usize) {
        let (start, mut cell) = (self.order.len(), from);
        while !self.marks[cell] {
            self.marks[cell] = true;
            self.order.push(cell as u32);
            cell = receivers.of(cell);
        }
        self.order[start..].reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{flats, samples, steepest};

    #[test]
    fn areas_are_those_of_walking_from_every_cell() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let mut receivers = steepest::receivers(&heights, &outlets, Descent::Steepest);
            flats::resolve(&heights, &outlets, &mut receivers);
            let mut expect = vec![0u32; heights.data().len()];
            for start in 0..expect.len() {
                let mut at = start;
                loop {
                    expect[at] += 1;
                    let next = receivers.of(at);
                    if next == at {
                        break;
                    }
                    at = next;
                }
            }
            for rows in [1, 2, 7, 1000] {
                let got = accumulate_in(&receivers, rows);
                assert_eq!(got.area.data(), expect);
                let mut place = vec![usize::MAX; expect.len()];
                for (k, c) in got.upstream_first().enumerate() {
                    place[c] = k;
                }
                assert_eq!(got.downstream_first().count(), expect.len());
                for c in 0..expect.len() {
                    assert!(place[c] < usize::MAX && (receivers.of(c) == c || place[c] < place[receivers.of(c)]));
                }
            }
        }
    }
}
