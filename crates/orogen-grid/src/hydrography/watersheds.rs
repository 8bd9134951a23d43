//! Watersheds of river mouths, and of the land between them.

use super::rivers::{Mouth, River};
use super::water::{Cover, Frame, Water};
use super::zones::ZoneStats;
use crate::hydrology::receivers::Receivers;
use std::ops::Range;

/// The watershed of each sample of a frame.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Watersheds {
    /// Labels from 1, row-major over the frame; 0 for the sea.
    pub labels: Vec<u32>,
    /// For label k, at index k - 1, the index of the reach that ends at the mouth; `None` for land that no river
    /// drains.
    pub rivers: Vec<Option<u32>>,
}

const UNKNOWN: u32 = u32::MAX;

/// The watersheds of all reaches that end in the sea, at the border of a frame, or in lakes of a given network, in the
/// order of the reaches. The remaining land follows, with one label for each part that is connected by the sides of
/// samples. The time is O(samples).
#[must_use]
pub fn watersheds(water: &Water, frame: &Frame, reaches: &[River]) -> Watersheds {
    let mut found = mouths(water, reaches);
    let mut way = Vec::new();
    for start in 0..found.labels.len() {
        // Land that drains to no mouth has label 0.
        label_way(&water.receivers, start, &mut found.labels, [UNKNOWN, 0], &mut way);
    }
    let is_land = |cell: usize| matches!(water.cover(cell), Cover::Land | Cover::Lake(_));
    let mut out = Vec::with_capacity(frame.columns.len() * frame.rows.len());
    for j in frame.rows.clone() {
        out.extend(frame.columns.clone().map(|i| j * water.heights.width() + i).map(|cell| {
            match found.labels[water.nearest_node(cell)] {
                _ if !is_land(cell) => 0,
                0 => UNKNOWN,
                label => label,
            }
        }));
    }
    found.labels = out;
    found.label_rest(frame.columns.len());
    found
}

/// Labels of the nodes of mouths and of given lakes; other nodes are [`UNKNOWN`].
fn mouths(water: &Water, reaches: &[River]) -> Watersheds {
    let mut labels = vec![UNKNOWN; water.heights.data().len()];
    let mut rivers = Vec::new();
    // The watershed of each lake of a given network, where the water that enters the lake stays.
    let mut of_lake: Vec<Option<u32>> = vec![None; if water.network.is_some() { water.lakes.len() } else { 0 }];
    for (k, reach) in reaches.iter().enumerate() {
        match reach.mouth {
            Mouth::Sea | Mouth::Border => {}
            Mouth::Lake(lake) if water.network.is_some() => {
                if let Some(of_lake) = of_lake.get_mut((lake as usize).wrapping_sub(1)) {
                    let label = *of_lake.get_or_insert(rivers.len() as u32 + 1);
                    let at = label as usize - 1;
                    match rivers.get(at).copied().flatten() {
                        None => rivers.push(Some(k as u32)),
                        Some(other) if reach.drained > reaches[other as usize].drained => rivers[at] = Some(k as u32),
                        Some(_) => {}
                    }
                    continue;
                }
            }
            Mouth::Lake(_) | Mouth::Reach(_) => continue,
        }
        // Another reach that joins at that sample shares its watershed.
        let label = &mut labels[reach.end as usize];
        if *label == UNKNOWN {
            rivers.push(Some(k as u32));
            *label = rivers.len() as u32;
        }
    }
    if of_lake.iter().any(Option::is_some) {
        for (node, label) in labels.iter_mut().enumerate() {
            if let Cover::Lake(lake) = water.node_cover(node)
                && let Some(of_lake) = of_lake.get((lake as usize).wrapping_sub(1)).copied().flatten()
            {
                *label = of_lake;
            }
        }
    }
    Watersheds { labels, rivers }
}

/// Follows the receivers from a node to the first node that has a label, and gives that label to all nodes on the path,
/// or `none` if there is none. `way` is scratch memory.
pub(super) fn label_way(
    receivers: &Receivers,
    start: usize,
    labels: &mut [u32],
    [unknown, none]: [u32; 2],
    way: &mut Vec<u32>,
) {
    let mut at = start;
    while labels[at] == unknown {
        way.push(at as u32);
        let next = receivers.of(at);
        if next == at {
            labels[at] = none;
            break;
        }
        at = next;
    }
    let label = labels[at];
    way.drain(..).for_each(|node| labels[node as usize] = label);
}

impl Watersheds {
    /// Labels the parts of unknown land, in rows of `across` columns.
    fn label_rest(&mut self, across: usize) {
        let count = self.labels.len();
        let mut waiting = Vec::new();
        for start in 0..count {
            if self.labels[start] != UNKNOWN {
                continue;
            }
            self.rivers.push(None);
            let label = self.rivers.len() as u32;
            self.labels[start] = label;
            waiting.push(start);
            while let Some(at) = waiting.pop() {
                let i = at % across;
                let beside = [
                    (i > 0, 1, 0),
                    (i + 1 < across, 0, 1),
                    (at >= across, across, 0),
                    (at + across < count, 0, across),
                ];
                for other in beside.into_iter().filter(|(there, ..)| *there).map(|(_, back, on)| at + on - back) {
                    if self.labels[other] == UNKNOWN {
                        self.labels[other] = label;
                        waiting.push(other);
                    }
                }
            }
        }
    }

    /// The labels of some columns and rows of the water's grid, and the heights of each label. Samples outside the
    /// frame get the label at its edge.
    #[must_use]
    pub fn sampled(
        &self,
        water: &Water,
        frame: &Frame,
        columns: &[usize],
        rows: &[usize],
    ) -> (Vec<u32>, Vec<ZoneStats>) {
        let mut grounds = vec![ZoneStats::EMPTY; self.rivers.len() + 1];
        let within = |at: usize, range: &Range<usize>| at.clamp(range.start, range.end - 1);
        let columns: Vec<usize> = columns.iter().map(|column| within(*column, &frame.columns)).collect();
        let mut labels = Vec::with_capacity(columns.len() * rows.len());
        for y in rows.iter().map(|row| within(*row, &frame.rows)) {
            let first = (y - frame.rows.start) * frame.columns.len();
            for x in &columns {
                let label = self.labels[first + x - frame.columns.start];
                labels.push(label);
                if label != 0 {
                    grounds[label as usize].add(water.heights[(*x, y)]);
                }
            }
        }
        (labels, grounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrography::rivers::rivers;
    use crate::hydrography::shores::Shores;
    use crate::hydrography::water::Least;
    use crate::hydrology::samples;
    use crate::progress::Progress;

    #[test]
    fn all_land_has_a_watershed_and_rivers_stay_in_theirs() {
        for seed in 0..5 {
            let least = Least { spring: 12, lake: 4, depth: 0.0, scattered: false };
            let water = Water::of(samples::hills(60, 50, seed), Some(250.0), least, &Progress::none()).unwrap();
            let frame = Frame { columns: 5..55, rows: 4..50 };
            let mut shores = Shores::of(&water, &frame, 1).unwrap();
            let reaches = rivers(&water, &frame, 3, &mut shores);
            let found = watersheds(&water, &frame, &reaches);
            let mut counts = vec![0; found.rivers.len() + 1];
            for (k, label) in found.labels.iter().enumerate() {
                let cell = (4 + k / 50) * 60 + 5 + k % 50;
                assert_eq!(*label == 0, water.cover(cell) == Cover::Sea);
                counts[*label as usize] += 1;
            }
            assert!(counts[1..].iter().all(|count| *count > 0), "{counts:?}");
            let label = |cell: u32| {
                let (i, j) = (cell as usize % 60, cell as usize / 60);
                found.labels[(j - 4) * 50 + i - 5]
            };
            for (k, river) in found.rivers.iter().enumerate() {
                let Some(river) = river else { continue };
                assert_eq!(label(reaches[*river as usize].end), k as u32 + 1);
            }
            for reach in reaches.iter() {
                if let Some(next) = reach.downstream {
                    assert_eq!(label(reach.end), label(reaches[next as usize].end), "seed {seed}");
                }
            }
        }
    }
}
