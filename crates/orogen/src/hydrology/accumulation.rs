//! How much ground drains through each cell.

use super::receivers::Receivers;
use crate::grid::Grid;

/// What drains where: each cell's area, and an order to walk the cells in.
#[derive(Debug, Clone)]
pub struct Accumulation {
    /// Cells that drain through each cell, itself included. Whole numbers: the same whatever order they were added in.
    pub area: Grid<u32>,
    /// Every cell once, each before its receiver.
    pub order: Vec<u32>,
}

/// Counts the cells that drain through each cell.
///
/// Each walk begins where nothing flows in and goes on downstream until it meets a cell that still waits for another inflow,
/// so every cell is visited once: O(cells). A cell on a circle of receivers would never be visited; what makes receivers in
/// this room makes no circles.
pub fn accumulate(receivers: &Receivers) -> Accumulation {
    let window = *receivers.window();
    let mut waiting = inflows(receivers);
    let mut area = vec![1u32; window.len()];
    let mut order = Vec::with_capacity(window.len());
    for start in 0..window.len() {
        let mut cell = start;
        while waiting[cell] == 0 {
            waiting[cell] = DONE;
            order.push(cell as u32);
            let receiver = receivers.of(cell);
            if receiver == cell {
                break;
            }
            area[receiver] += area[cell];
            waiting[receiver] -= 1;
            cell = receiver;
        }
    }
    let area = Grid::from_data(window, area).unwrap_or_else(|| Grid::filled(window, 0));
    Accumulation { area, order }
}

const DONE: u8 = 255;

/// For the rows above, here and below: the codes by which the cell to the west, in the same column and to the east drains here.
const POINTING_HERE: [(isize, u8, u8, u8); 3] = [(-1, 1, 2, 3), (0, 0, NO_CODE, 4), (1, 7, 6, 5)];
const NO_CODE: u8 = 255;

/// How many neighbours drain into each cell.
fn inflows(receivers: &Receivers) -> Vec<u8> {
    let (width, height) = (receivers.window().width, receivers.window().height);
    let mut inflows = vec![0u8; width * height];
    if width == 0 {
        return inflows;
    }
    let codes = receivers.grid();
    for (j, row) in inflows.chunks_mut(width).enumerate() {
        for (south, from_west, straight, from_east) in POINTING_HERE {
            let Some(from) = j.checked_add_signed(south).filter(|from| *from < height) else { continue };
            let from = codes.row(from);
            row[1..].iter_mut().zip(from).for_each(|(n, code)| *n += u8::from(*code == from_west));
            row.iter_mut().zip(from).for_each(|(n, code)| *n += u8::from(*code == straight));
            row.iter_mut().zip(&from[1..]).for_each(|(n, code)| *n += u8::from(*code == from_east));
        }
    }
    inflows
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
            let got = accumulate(&receivers);
            assert_eq!(got.area.data(), expect);
            let mut place = vec![usize::MAX; expect.len()];
            for (k, c) in got.order.iter().enumerate() {
                place[*c as usize] = k;
            }
            assert_eq!(got.order.len(), expect.len());
            for c in 0..expect.len() {
                assert!(place[c] < usize::MAX && (receivers.of(c) == c || place[c] < place[receivers.of(c)]));
            }
        }
    }
}
