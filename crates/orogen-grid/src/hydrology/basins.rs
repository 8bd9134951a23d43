//! Basins: sets of cells that drain to one pit, and the passes between them.
//!
//! Filling, carving and lakes all need, for each pit, the level at which water spills and the pass over which it
//! leaves. Instead of flooding cell by cell (Priority-Flood, Barnes, Lehman and Mulla 2014), this module floods the
//! graph of basins, as in Barnes, "Parallel Priority-Flood depression filling for trillion cell digital elevation
//! models" (2016), and Cordonnier, Bovy and Braun, "A versatile, linear complexity algorithm for flow routing in
//! topographies with depressions" (2019). The number of nodes of the graph is a few percent of the number of cells. The
//! water levels have the same bits, because both algorithms compute the minimum, over all paths to an outlet, of the
//! highest cell on the path.

use super::direction::{NONE, neighbor, opposite, strides};
use super::outlets::Outlets;
use super::receivers::Receivers;
use crate::grid::Grid;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::hash::{BuildHasherDefault, Hasher};

/// The label of all cells that drain to an outlet.
pub const OUTSIDE: u32 = 0;

/// The basins of a map, and their spills.
#[derive(Debug, Clone)]
pub struct Basins {
    /// The basin of each cell, row-major; [`OUTSIDE`] for cells that drain to an outlet.
    pub labels: Vec<u32>,
    /// The spill of each basin, indexed by label. The entry of [`OUTSIDE`] has no meaning.
    pub spills: Vec<Spill>,
    /// The labels of all basins except [`OUTSIDE`], each after the basin that it spills into.
    pub order: Vec<u32>,
}

/// The spill of a basin: where and at which level water leaves it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spill {
    /// The water level: the highest cell on the lowest path from the pit to an outlet.
    pub level: f32,
    /// The lowest cell of the basin.
    pub pit: u32,
    /// The last cell of the basin on that path.
    pub last: u32,
    /// The direction of the step from `last` into the next basin.
    pub code: u8,
    /// The basin that it spills into.
    pub next: u32,
}

/// Finds the basins of `receivers` and floods them. Every cell must lead to an outlet or to a single pit (see
/// [`flats::resolve`](super::flats::resolve)).
///
/// Of equally low passes the first in row order is used. `phase` is called after each of the three phases; its error
/// ends the work. The time is O(cells + basins log basins).
pub(super) fn find_basins<E>(
    heights: &Grid,
    outlets: &Outlets,
    receivers: &Receivers,
    phase: &mut impl FnMut() -> Result<(), E>,
) -> Result<Basins, E> {
    let (labels, pits) = label(outlets, receivers);
    phase()?;
    let mut basins = Basins { labels, spills: Vec::with_capacity(pits.len()), order: Vec::with_capacity(pits.len()) };
    for pit in pits {
        basins.spills.push(Spill { level: f32::NEG_INFINITY, pit, last: pit, code: NONE, next: OUTSIDE });
    }
    if basins.spills.len() > 1 {
        let passes = passes(heights, &basins.labels);
        phase()?;
        flood(&passes, &mut basins, &strides(heights.width()));
        phase()?;
    }
    Ok(basins)
}

/// The basin of each cell, and the pit of each basin ([`OUTSIDE`] has none). Only cells that drain to a pit are
/// visited.
fn label(outlets: &Outlets, receivers: &Receivers) -> (Vec<u32>, Vec<u32>) {
    let codes = receivers.codes();
    let mut labels = vec![OUTSIDE; codes.len()];
    let mut pits = vec![u32::MAX];
    pits.extend((0..codes.len()).filter(|c| codes[*c] == NONE && !outlets.at(*c)).map(|c| c as u32));
    if pits.len() == 1 {
        return (labels, pits);
    }
    let (donors, children) = (receivers.donors(), children(receivers.window().width));
    let mut waiting = Vec::new();
    for (label, pit) in pits.iter().enumerate().skip(1) {
        waiting.push(*pit);
        climb(&mut waiting, &donors, &children, |cell| labels[cell as usize] = label as u32);
    }
    (labels, pits)
}

/// For each set of directions: the number of directions and their strides.
type Children = [(u32, [i32; 8]); 256];

/// [`Children`] on a grid with `width` columns.
fn children(width: usize) -> Box<Children> {
    let strides = strides(width);
    let mut table = Box::new([(0, [0; 8]); 256]);
    for (set, (count, steps)) in table.iter_mut().enumerate() {
        for (k, stride) in strides.iter().enumerate() {
            if set & 1 << k != 0 {
                steps[*count as usize] = *stride as i32;
                *count += 1;
            }
        }
    }
    table
}

/// Takes cells from the end of a list and appends their donors until the list is empty; calls `visit` for each cell.
///
/// Sixteen cells are taken at a time, and eight donors are always written per cell, which avoids unpredictable
/// branches.
fn climb(waiting: &mut Vec<u32>, donors: &[u8], children: &Children, mut visit: impl FnMut(u32)) {
    const BATCH: usize = 16;
    let mut count = waiting.len();
    while count > 0 {
        let taken = count.min(BATCH);
        let mut batch = [0u32; BATCH];
        count -= taken;
        batch[..taken].copy_from_slice(&waiting[count..count + taken]);
        if waiting.len() < count + 8 * BATCH {
            waiting.resize(2 * (count + 8 * BATCH), 0);
        }
        for cell in &batch[..taken] {
            visit(*cell);
            let (more, steps) = &children[usize::from(donors[*cell as usize])];
            if let Some(places) = waiting[count..].first_chunk_mut::<8>() {
                *places = steps.map(|step| cell.wrapping_add_signed(step));
            }
            count += *more as usize;
        }
    }
    waiting.clear();
}

/// The lowest pass between two basins.
#[derive(Debug, Clone, Copy)]
#[doc(hidden)]
pub struct Pass {
    /// The height of the higher one of the two cells.
    pub height: f32,
    /// The cell from which `code` leads to the other cell.
    pub from: u32,
    /// The direction: east, south-east, south or south-west.
    pub code: u8,
    /// The labels of the two basins; the basin of `from` is the first.
    pub basins: [u32; 2],
}

/// Number of cells of a row that are tested together.
const RUN: usize = 16;

/// A hash with one multiplication. The keys are pairs of labels, which vary enough and are not chosen by an adversary.
#[derive(Default)]
struct PairHasher(u64);

impl Hasher for PairHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(self.0 ^ u64::from(*byte)));
    }
    fn write_u64(&mut self, key: u64) {
        let product = u128::from(key ^ 0x9E37_79B9_7F4A_7C15) * 0xD1B5_4A32_D192_ED03;
        self.0 = (product >> 64) as u64 ^ product as u64;
    }
}

/// The lowest pass between each pair of adjacent basins, in the order in which the pairs occur, row by row.
#[doc(hidden)]
#[must_use]
pub fn passes(heights: &Grid, labels: &[u32]) -> Vec<Pass> {
    let width = heights.width();
    let mut found = Found { passes: Vec::new(), known: HashMap::default(), last_key: u64::MAX, last: 0 };
    for (j, here) in labels.chunks(width.max(1)).enumerate() {
        // The last row is compared with itself, which finds the passes within it a second time.
        let beneath = (j + 1).min(heights.height() - 1);
        let below = &labels[beneath * width..(beneath + 1) * width];
        let (h, h_below) = (heights.row(j), heights.row(beneath));
        let mut i = 0;
        while i < width {
            // Most cells have only neighbors in the same basin.
            if let (Some(run), Some(beneath)) = (here.get(i..=i + RUN), below.get(i.max(1) - 1..=i + RUN))
                && run.iter().chain(beneath).fold(0, |differ, label| differ | (label ^ here[i])) == 0
            {
                i += RUN;
                continue;
            }
            let end = (i + RUN).min(width);
            while i < end {
                found.look([here, below], [h, h_below], i, (j * width) as u32);
                i += 1;
            }
        }
    }
    found.passes
}

struct Found {
    passes: Vec<Pass>,
    known: HashMap<u64, u32, BuildHasherDefault<PairHasher>>,
    /// The last pair. Consecutive passes in a row mostly separate the same two basins.
    last_key: u64,
    last: u32,
}

impl Found {
    /// Compares column `i` of the upper of two rows with its neighbors to the east and below; `start` is the row's
    /// first cell.
    fn look(&mut self, [here, below]: [&[u32]; 2], [h, h_below]: [&[f32]; 2], i: usize, start: u32) {
        let mine = here[i];
        // A missing neighbor counts as a cell of the same basin.
        let (west, east) = (i.max(1) - 1, (i + 1).min(here.len() - 1));
        let or_mine = |there: bool, label: u32| if there { label } else { mine };
        let around = [here[east], or_mine(east > i, below[east]), below[i], or_mine(west < i, below[west])];
        if around.iter().all(|theirs| *theirs == mine) {
            return;
        }
        let heights = [h[east], h_below[east], h_below[i], h_below[west]];
        for (code, (theirs, other)) in around.into_iter().zip(heights).enumerate() {
            if theirs != mine {
                // Adding 0.0 turns -0.0 into 0.0.
                let height = (if other > h[i] { other } else { h[i] }) + 0.0;
                self.add(Pass { height, from: start + i as u32, code: code as u8, basins: [mine, theirs] });
            }
        }
    }

    fn add(&mut self, pass: Pass) {
        let [a, b] = pass.basins;
        let key = u64::from(a.min(b)) << 32 | u64::from(a.max(b));
        if key != self.last_key {
            self.last_key = key;
            self.last = *self.known.entry(key).or_insert_with(|| {
                self.passes.push(pass);
                self.passes.len() as u32 - 1
            });
        }
        let best = &mut self.passes[self.last as usize];
        if pass.height < best.height {
            *best = pass;
        }
    }
}

/// Floods the graph from the outside, always over the lowest known pass (Prim's algorithm).
fn flood(passes: &[Pass], basins: &mut Basins, strides: &[isize; 8]) {
    // The passes grouped by basin: those of basin b are starts[b] .. starts[b + 1].
    let count = basins.spills.len();
    let mut starts = vec![0u32; count + 1];
    for b in passes.iter().flat_map(|pass| pass.basins) {
        starts[b as usize + 1] += 1;
    }
    for b in 0..count {
        starts[b + 1] += starts[b];
    }
    let mut places = starts.clone();
    let mut beside = vec![0u32; passes.len() * 2];
    for (k, pass) in passes.iter().enumerate() {
        for b in pass.basins {
            beside[places[b as usize] as usize] = k as u32;
            places[b as usize] += 1;
        }
    }
    let mut reached = vec![false; count];
    let mut waiting = BinaryHeap::new();
    let mut newest = OUTSIDE;
    loop {
        reached[newest as usize] = true;
        for k in &beside[starts[newest as usize] as usize..starts[newest as usize + 1] as usize] {
            let pass = &passes[*k as usize];
            if !pass.basins.iter().all(|b| reached[*b as usize]) {
                waiting.push(Reverse((ordered(pass.height), pass.from, pass.code, *k)));
            }
        }
        let next = loop {
            let Some(Reverse((_, _, _, lowest))) = waiting.pop() else { return };
            let pass = &passes[lowest as usize];
            if !pass.basins.iter().all(|b| reached[*b as usize]) {
                break pass;
            }
        };
        let [a, b] = next.basins;
        let (basin, parent, last, code) = match reached[b as usize] {
            true => (a, b, next.from, next.code),
            false => (b, a, neighbor(next.from as usize, strides[usize::from(next.code)]) as u32, opposite(next.code)),
        };
        let below = basins.spills[parent as usize].level;
        let way = &mut basins.spills[basin as usize];
        way.level = if next.height > below { next.height } else { below };
        (way.last, way.code, way.next) = (last, code, parent);
        basins.order.push(basin);
        newest = basin;
    }
}

/// An integer key that sorts like the heights.
#[doc(hidden)]
#[must_use]
pub fn ordered(height: f32) -> u32 {
    let bits = height.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{flats, samples, steepest};

    #[test]
    fn ordered_bits_order_heights() {
        let heights = [f32::NEG_INFINITY, -1e9, -2.5, -1e-40, -0.0, 0.0, 1e-40, 3.0, 1e30, f32::INFINITY];
        for pair in heights.windows(2) {
            assert!(ordered(pair[0]) < ordered(pair[1]), "{pair:?}");
        }
    }

    #[test]
    fn every_way_out_leaves_its_basin_and_ends_outside() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let mut receivers = steepest::receivers(&heights, &outlets, Descent::Steepest);
            flats::resolve(&heights, &outlets, &mut receivers);
            let Ok(basins) =
                find_basins(&heights, &outlets, &receivers, &mut || Ok::<(), std::convert::Infallible>(()));
            let strides = strides(heights.width());
            let count = basins.spills.len();
            assert_eq!(basins.order.len() + 1, count, "every basin is reached");
            let mut reached = vec![false; count];
            reached[0] = true;
            for b in &basins.order {
                let way = &basins.spills[*b as usize];
                assert!(reached[way.next as usize], "parents come first");
                reached[*b as usize] = true;
                assert_eq!(basins.labels[way.last as usize], *b);
                assert_eq!(basins.labels[way.pit as usize], *b);
                let step = neighbor(way.last as usize, strides[usize::from(way.code)]);
                assert_eq!(basins.labels[step], way.next);
                let h = heights.data();
                assert!(way.level >= h[way.last as usize] && way.level >= h[step]);
                assert!(way.level >= basins.spills[way.next as usize].level);
            }
            for c in 0..basins.labels.len() {
                assert_eq!(basins.labels[c], basins.labels[receivers.of(c)]);
            }
        }
    }
}
