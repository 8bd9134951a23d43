//! Drainage over flats, where no neighbour is lower.
//!
//! After Barnes, Lehman and Mulla, "An efficient assignment of drainage direction over flat surfaces in raster digital elevation
//! models" (2014): two integer gradients, one towards the flat's lower rim (cells to walk to it, counted twice) and one away
//! from the higher ground around it, are added, and each cell drains down their sum. A step towards the rim lowers the sum by
//! two while the other part changes by at most one, so the sum has no pit of its own. Their algorithm takes the first of equally
//! low neighbours, which draws straight parallel lines over the flat; here a hash of the cell's place chooses, and the lines
//! wander and join.
//!
//! A flat without a lower rim is *closed*: all of it is made to drain to one of its cells, the first in row order, which stays
//! a pit.

use super::direction::{NONE, hashed, neighbour, one_of, strides};
use super::outlets::Outlets;
use super::receivers::Receivers;
use crate::grid::Grid;

/// Gives a receiver to every cell that has none, but for outlets and one cell of each closed flat.
///
/// `receivers` is what [`steepest`](super::steepest) found on the same heights. Costs O(cells in flats) beside one look at each
/// cell.
pub fn resolve(heights: &Grid, outlets: &Outlets, receivers: &mut Receivers) {
    let codes = receivers.codes();
    let flat: Vec<u32> = (0..codes.len()).filter(|c| codes[*c] == NONE && !outlets.at(*c)).map(|c| c as u32).collect();
    if flat.is_empty() {
        return;
    }
    let mut field = Flats {
        heights: heights.data(),
        strides: strides(heights.width()),
        away: vec![0; heights.data().len()],
        toward: vec![0; heights.data().len()],
    };
    field.mark(&flat);
    field.measure_away(&flat);
    field.measure_toward_rims(&flat);
    field.measure_toward_pits(&flat);
    let window = *heights.window();
    let chosen: Vec<u8> = flat
        .iter()
        .map(|c| {
            let c = *c as usize;
            let (x, y) = ((c % window.width) as i64, (c / window.width) as i64);
            field.receiver(c, hashed(window.x + x, window.y + y))
        })
        .collect();
    for (c, code) in flat.iter().zip(chosen) {
        receivers.codes_mut()[*c as usize] = code;
    }
}

/// `away` is 0 outside of flats and before a flat cell is measured it is [`UNMEASURED`].
const UNMEASURED: u32 = u32::MAX;

struct Flats<'a> {
    heights: &'a [f32],
    strides: [isize; 8],
    /// Steps from the higher ground, from 1; 0 where a cell is in no flat.
    away: Vec<u32>,
    /// Steps from the rim, from 1; 0 where not measured.
    toward: Vec<u32>,
}

impl Flats<'_> {
    fn mark(&mut self, flat: &[u32]) {
        for c in flat {
            self.away[*c as usize] = UNMEASURED;
        }
    }

    fn in_flat(&self, cell: usize) -> bool {
        self.away[cell] != 0
    }

    fn measure_away(&mut self, flat: &[u32]) {
        let mut queue = Vec::new();
        for c in flat {
            let cell = *c as usize;
            let h = self.heights[cell];
            if self.strides.iter().any(|stride| self.heights[neighbour(cell, *stride)] > h) {
                self.away[cell] = 1;
                queue.push(*c);
            }
        }
        let mut next = 0;
        while let Some(c) = queue.get(next).copied() {
            next += 1;
            let (cell, steps) = (c as usize, self.away[c as usize] + 1);
            let h = self.heights[cell];
            for stride in self.strides {
                let n = neighbour(cell, stride);
                if self.away[n] == UNMEASURED && self.heights[n] == h {
                    self.away[n] = steps;
                    queue.push(n as u32);
                }
            }
        }
        // A flat that nothing stands above.
        for c in flat {
            let away = &mut self.away[*c as usize];
            if *away == UNMEASURED {
                *away = 1;
            }
        }
    }

    fn measure_toward_rims(&mut self, flat: &[u32]) {
        let rim = |c: &&u32| self.drained_beside(**c as usize) != 0;
        let mut queue: Vec<u32> = flat.iter().filter(rim).copied().collect();
        for c in &queue {
            self.toward[*c as usize] = 1;
        }
        self.spread(&mut queue);
    }

    fn measure_toward_pits(&mut self, flat: &[u32]) {
        for c in flat {
            if self.toward[*c as usize] == 0 {
                self.toward[*c as usize] = 1;
                self.spread(&mut vec![*c]);
            }
        }
    }

    /// Measures steps from the cells in the queue over the flats they lie in.
    fn spread(&mut self, queue: &mut Vec<u32>) {
        let mut next = 0;
        while let Some(c) = queue.get(next).copied() {
            next += 1;
            let (cell, steps) = (c as usize, self.toward[c as usize] + 1);
            let h = self.heights[cell];
            for stride in self.strides {
                let n = neighbour(cell, stride);
                if self.away[n] != 0 && self.toward[n] == 0 && self.heights[n] == h {
                    self.toward[n] = steps;
                    queue.push(n as u32);
                }
            }
        }
    }

    /// The set of directions in which a neighbour as high as `cell` drains by itself.
    fn drained_beside(&self, cell: usize) -> u8 {
        let h = self.heights[cell];
        let mut set = 0;
        for (k, stride) in self.strides.into_iter().enumerate() {
            let n = neighbour(cell, stride);
            // What is as high and in no flat drains or is an outlet.
            if self.heights[n] == h && !self.in_flat(n) {
                set |= 1 << k;
            }
        }
        set
    }

    fn sum(&self, cell: usize) -> i64 {
        2 * i64::from(self.toward[cell]) - i64::from(self.away[cell])
    }

    fn receiver(&self, cell: usize, hash: u32) -> u8 {
        if self.toward[cell] == 1 {
            // At the rim, or the pit of a closed flat, for which the set is empty.
            return one_of(self.drained_beside(cell), hash);
        }
        let h = self.heights[cell];
        let (mut least, mut set) = (self.sum(cell), 0);
        for (k, stride) in self.strides.into_iter().enumerate() {
            let n = neighbour(cell, stride);
            if !self.in_flat(n) || self.heights[n] != h {
                continue;
            }
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

    /// The cells of equal height joined to `start`, by the plainest search.
    fn level_ground(heights: &Grid, start: usize) -> Vec<usize> {
        let (h, strides) = (heights.data(), strides(heights.width()));
        let outlets = Outlets::new(heights, None);
        let mut found = vec![start];
        let mut next = 0;
        while next < found.len() {
            if !outlets.at(found[next]) {
                for stride in strides {
                    let n = neighbour(found[next], stride);
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
                // A pit: nothing on its level ground is an outlet or has a lower neighbour, and it is the only pit there.
                let ground = level_ground(&heights, at);
                for g in &ground {
                    assert!(!outlets.at(*g) && (*g == at || receivers.code(*g) != NONE));
                    let lower = |stride| heights.data()[neighbour(*g, stride)] < heights.data()[at];
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
        // On a wide level plain that drains to one side, equal steps offer three ways each: most cells must not simply go
        // straight.
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
