//! Drainage over flats, where no neighbor is lower.
//!
//! After Barnes, Lehman and Mulla, "An efficient assignment of drainage direction over flat surfaces in raster digital
//! elevation models" (2014). Two integer gradients are added: twice the number of steps to the flat's lower rim, and a
//! gradient away from the higher ground around it. Each cell drains in the direction in which the sum falls. A step
//! towards the rim lowers the sum by two while the other part changes by at most one, so the sum has no pits. Barnes
//! and others take the first of equally low neighbors, which gives straight parallel lines on the flat. Here a hash of
//! the cell's position chooses, so that lines wander and join.
//!
//! A flat without a lower rim is *closed*. All its cells drain to its first cell in row order, which remains a pit.

use super::direction::{NONE, hashed, neighbor, one_of, strides};
use super::outlets::Outlets;
use super::receivers::Receivers;
use crate::grid::Grid;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Gives a receiver to every cell that has none, except outlets and one cell of each closed flat.
///
/// `receivers` must come from [`steepest`](super::steepest) on the same heights. The time is O(cells in flats), plus
/// one test per cell.
pub fn resolve(heights: &Grid, outlets: &Outlets, receivers: &mut Receivers) {
    let codes = receivers.codes();
    let flat: Vec<u32> = (0..codes.len()).filter(|c| codes[*c] == NONE && !outlets.at(*c)).map(|c| c as u32).collect();
    if flat.is_empty() {
        return;
    }
    let mut field = Flats {
        heights: heights.data(),
        strides: strides(heights.width()),
        places: Places::new(&flat, codes.len()),
        away: vec![UNMEASURED; flat.len()],
        toward: vec![0; flat.len()],
        cells: flat,
    };
    field.measure_away();
    field.measure_toward_rims();
    field.measure_toward_pits();
    let window = *heights.window();
    for (place, c) in field.cells.iter().enumerate() {
        let c = *c as usize;
        let (x, y) = ((c % window.width) as i64, (c / window.width) as i64);
        receivers.codes_mut()[c] = field.receiver(place, hashed(window.x + x, window.y + y));
    }
}

/// The index of each flat cell in the list of flat cells. Most terrain has few flat cells, so a table of the whole map
/// would be mostly empty.
enum Places {
    Few(HashMap<u32, u32, BuildHasherDefault<CellHasher>>),
    Many(Vec<u32>),
}

impl Places {
    fn new(flat: &[u32], cells: usize) -> Places {
        let places = flat.iter().copied().zip(0..);
        if flat.len() < cells / 50 {
            return Places::Few(places.collect());
        }
        let mut all = vec![NO_PLACE; cells];
        places.for_each(|(cell, place)| all[cell as usize] = place);
        Places::Many(all)
    }

    #[inline]
    fn of(&self, cell: usize) -> Option<usize> {
        let place = match self {
            Places::Few(places) => places.get(&(cell as u32)).copied(),
            Places::Many(places) => Some(places[cell]).filter(|place| *place != NO_PLACE),
        };
        place.map(|place| place as usize)
    }
}

const NO_PLACE: u32 = u32::MAX;

/// Hashes cells with one multiplication.
#[derive(Default)]
struct CellHasher(u64);

impl Hasher for CellHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u32(self.0 as u32 ^ u32::from(*byte)));
    }
    fn write_u32(&mut self, cell: u32) {
        let product = u128::from(cell) * 0x9E37_79B9_7F4A_7C15_D1B5;
        self.0 = (product >> 32) as u64 ^ product as u64;
    }
}

/// The distance of a flat cell that is not known yet.
const UNMEASURED: u32 = u32::MAX;

struct Flats<'a> {
    heights: &'a [f32],
    strides: [isize; 8],
    /// All cells of flats, in row order.
    cells: Vec<u32>,
    places: Places,
    /// Steps from the higher ground, from 1, by index of the flat cell.
    away: Vec<u32>,
    /// Steps from the rim, from 1, by index of the flat cell; 0 if not computed.
    toward: Vec<u32>,
}

impl Flats<'_> {
    /// The flat cells next to a cell with the same height: their direction and index.
    fn beside(&self, cell: usize) -> impl Iterator<Item = (usize, usize)> {
        let h = self.heights[cell];
        let level = move |(k, stride): (usize, &isize)| {
            let n = neighbor(cell, *stride);
            if self.heights[n] == h { Some((k, self.places.of(n)?)) } else { None }
        };
        self.strides.iter().enumerate().filter_map(level)
    }

    fn measure_away(&mut self) {
        let mut queue = Vec::new();
        for (place, c) in self.cells.iter().enumerate() {
            let cell = *c as usize;
            let h = self.heights[cell];
            if self.strides.iter().any(|stride| self.heights[neighbor(cell, *stride)] > h) {
                self.away[place] = 1;
                queue.push(place as u32);
            }
        }
        let mut next = 0;
        while let Some(place) = queue.get(next).map(|place| *place as usize) {
            next += 1;
            let steps = self.away[place] + 1;
            let mut near = [NO_PLACE; 8];
            self.beside(self.cells[place] as usize).for_each(|(k, place)| near[k] = place as u32);
            for n in near {
                if n != NO_PLACE && self.away[n as usize] == UNMEASURED {
                    self.away[n as usize] = steps;
                    queue.push(n);
                }
            }
        }
        // A flat without higher ground around it.
        self.away.iter_mut().filter(|away| **away == UNMEASURED).for_each(|away| *away = 1);
    }

    fn measure_toward_rims(&mut self) {
        let rim = |place: &u32| self.drained_beside(self.cells[*place as usize] as usize) != 0;
        let mut queue: Vec<u32> = (0..self.cells.len() as u32).filter(rim).collect();
        for place in &queue {
            self.toward[*place as usize] = 1;
        }
        self.spread(&mut queue);
    }

    fn measure_toward_pits(&mut self) {
        for place in 0..self.cells.len() {
            if self.toward[place] == 0 {
                self.toward[place] = 1;
                self.spread(&mut vec![place as u32]);
            }
        }
    }

    /// Computes distances from the cells in the queue, within their flats.
    fn spread(&mut self, queue: &mut Vec<u32>) {
        let mut next = 0;
        while let Some(place) = queue.get(next).map(|place| *place as usize) {
            next += 1;
            let steps = self.toward[place] + 1;
            let mut near = [NO_PLACE; 8];
            self.beside(self.cells[place] as usize).for_each(|(k, place)| near[k] = place as u32);
            for n in near {
                if n != NO_PLACE && self.toward[n as usize] == 0 {
                    self.toward[n as usize] = steps;
                    queue.push(n);
                }
            }
        }
    }

    /// The set of directions with a neighbor as high as `cell` that has a receiver.
    fn drained_beside(&self, cell: usize) -> u8 {
        let h = self.heights[cell];
        let mut set = 0;
        for (k, stride) in self.strides.into_iter().enumerate() {
            let n = neighbor(cell, stride);
            // A cell of the same height outside all flats drains or is an outlet.
            if self.heights[n] == h && self.places.of(n).is_none() {
                set |= 1 << k;
            }
        }
        set
    }

    fn sum(&self, place: usize) -> i64 {
        2 * i64::from(self.toward[place]) - i64::from(self.away[place])
    }

    fn receiver(&self, place: usize, hash: u32) -> u8 {
        let cell = self.cells[place] as usize;
        if self.toward[place] == 1 {
            // The cell is at the rim, or it is the pit of a closed flat, where the set is empty.
            return one_of(self.drained_beside(cell), hash);
        }
        let (mut least, mut set) = (self.sum(place), 0);
        for (k, n) in self.beside(cell) {
            let sum = self.sum(n);
            if sum < least {
                (least, set) = (sum, 1 << k);
            } else if sum == least && set != 0 {
                set |= 1 << k;
            }
        }
        one_of(set, hash)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{samples, steepest};

    fn resolved(heights: &Grid) -> (Outlets, Receivers) {
        let outlets = Outlets::new(heights, None);
        let mut receivers = steepest::receivers(heights, &outlets, Descent::Steepest);
        resolve(heights, &outlets, &mut receivers);
        (outlets, receivers)
    }

    /// The cells of equal height that are connected to `start`, by a simple search.
    fn level_ground(heights: &Grid, start: usize) -> Vec<usize> {
        let (h, strides) = (heights.data(), strides(heights.width()));
        let outlets = Outlets::new(heights, None);
        let mut found = vec![start];
        let mut next = 0;
        while next < found.len() {
            if !outlets.at(found[next]) {
                for stride in strides {
                    let n = neighbor(found[next], stride);
                    if h[n] == h[start] && !found.contains(&n) {
                        found.push(n);
                    }
                }
            }
            next += 1;
        }
        found
    }

    #[test]
    fn water_never_rises_and_stays_only_where_nothing_leads_on() {
        for heights in samples::grids() {
            let (outlets, receivers) = resolved(&heights);
            for c in 0..heights.data().len() {
                let mut at = c;
                for _ in 0..heights.data().len() {
                    let next = receivers.of(at);
                    assert!(outlets.at(at) || heights.data()[next] <= heights.data()[at]);
                    at = next;
                }
                assert_eq!(receivers.code(at), NONE, "no circles");
                if outlets.at(at) {
                    continue;
                }
                // In a pit, the level ground has no outlet and no lower neighbor, and this is the only pit on it.
                let ground = level_ground(&heights, at);
                for g in &ground {
                    assert!(!outlets.at(*g) && (*g == at || receivers.code(*g) != NONE));
                    let lower = |stride| heights.data()[neighbor(*g, stride)] < heights.data()[at];
                    assert!(!strides(heights.width()).into_iter().any(lower));
                }
            }
        }
    }

    #[test]
    fn a_valley_floor_drains_along_its_middle() {
        // A level floor 9 cells wide between walls, open to the east.
        let mut heights = Grid::filled(Window::new(40, 13, 1.0), 10.0);
        for j in 2..11 {
            heights.row_mut(j)[2..].fill(1.0);
        }
        heights.row_mut(6)[39] = 0.0;
        let (_, receivers) = resolved(&heights);
        let mut inflow = [0u32; 13];
        for j in 2..11 {
            for i in 2..39 {
                let mut at = j * 40 + i;
                while at % 40 < 20 && receivers.code(at) != NONE {
                    at = receivers.of(at);
                }
                inflow[at / 40] += u32::from(i < 20);
            }
        }
        let middle: u32 = inflow[5..8].iter().sum();
        assert!(middle * 10 > inflow.iter().sum::<u32>() * 9, "{inflow:?}");
    }

    #[test]
    fn lines_over_a_flat_do_not_run_parallel() {
        // On a wide level plain that drains to one side, three directions are equally good at each cell, and most cells
        // must not go straight.
        let mut heights = Grid::filled(Window::new(102, 102, 1.0), 1.0);
        heights.row_mut(101).fill(0.0);
        let (_, receivers) = resolved(&heights);
        let mut counts = [0u32; 9];
        for j in 50..95 {
            for i in 60..62 {
                counts[usize::from(receivers.code(j * 102 + i))] += 1;
            }
        }
        assert!(counts[2] < 60, "{counts:?}");
    }
}
