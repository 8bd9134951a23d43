//! The positions of boxes and wires.

use super::order::{Columns, Slot};
use orogen_output::sheet::geometry::{Point, Size};

/// The distances of a layout, in its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spacing {
    /// Vertical distance between two boxes of a column.
    pub gap: f32,
    /// Distance between a box and a wire that passes it, and between two such wires.
    pub wire_gap: f32,
    /// Horizontal distance between two columns.
    pub alley: f32,
}

/// A wire between two boxes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The box at its start, and the distance below its top.
    pub from: (usize, f32),
    /// The box at its end, and the distance below its top.
    pub to: (usize, f32),
}

/// The result.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// The size of the drawing.
    pub size: Size,
    /// The upper left corner of each box.
    pub places: Vec<Point>,
    /// For each wire its horizontal parts, [left, right, height]: from its first box, past others, to its last box.
    pub ways: Vec<Vec<[f32; 3]>>,
}

/// Rounds of straightening.
const ROUNDS: usize = 40;

impl Layout {
    /// Lays out boxes and wires. A box must come after the boxes that it reads.
    #[must_use]
    pub fn new(sizes: &[Size], links: &[Link], spacing: Spacing) -> Layout {
        let wires: Vec<(usize, usize)> = links.iter().map(|link| (link.from.0, link.to.0)).collect();
        let columns = Columns::new(sizes.len(), &wires);
        let height = |slot: usize| match columns.slots[slot] {
            Slot::Block(block) => sizes[block].height,
            Slot::Pass(_) => 0.0,
        };
        let apart = |above: usize, below: usize| match (columns.slots[above], columns.slots[below]) {
            (Slot::Block(_), Slot::Block(_)) => spacing.gap,
            _ => spacing.wire_gap,
        };
        // The connections of each slot: (offset below its own top, the other slot, offset below the other slot's top).
        let mut left: Vec<Vec<(f32, usize, f32)>> = vec![Vec::new(); columns.slots.len()];
        let mut right = left.clone();
        for (way, link) in columns.ways.iter().zip(links) {
            let last = way.len() - 1;
            for (k, pair) in way.windows(2).enumerate() {
                let from = if k == 0 { link.from.1 } else { 0.0 };
                let to = if k + 1 == last { link.to.1 } else { 0.0 };
                right[pair[0]].push((from, pair[1], to));
                left[pair[1]].push((to, pair[0], from));
            }
        }
        let mut tops = vec![0.0f32; columns.slots.len()];
        for column in &columns.columns {
            let wanted = vec![0.0; column.len()];
            set(&mut tops, column, &wanted, &height, &apart);
        }
        for round in 0..ROUNDS {
            let rightwards = round % 2 == 0;
            let neighbors = if rightwards { &left } else { &right };
            for k in 0..columns.columns.len() {
                let column = &columns.columns[if rightwards { k } else { columns.columns.len() - 1 - k }];
                let wanted: Vec<f32> = column
                    .iter()
                    .map(|slot| {
                        let mut ends: Vec<f32> =
                            neighbors[*slot].iter().map(|(own, other, at)| tops[*other] + at - own).collect();
                        match ends.is_empty() {
                            true => tops[*slot],
                            false => median(&mut ends),
                        }
                    })
                    .collect();
                set(&mut tops, column, &wanted, &height, &apart);
            }
        }
        let highest = tops.iter().copied().fold(f32::MAX, f32::min);
        tops.iter_mut().for_each(|top| *top -= if highest < f32::MAX { highest } else { 0.0 });
        let widths: Vec<f32> = columns
            .columns
            .iter()
            .map(|column| {
                let widths = column.iter().map(|slot| match columns.slots[*slot] {
                    Slot::Block(block) => sizes[block].width,
                    Slot::Pass(_) => 0.0,
                });
                widths.fold(0.0, f32::max)
            })
            .collect();
        let mut lefts = Vec::new();
        let mut at = 0.0;
        for width in &widths {
            lefts.push(at);
            at += width + spacing.alley;
        }
        let mut column_of = vec![0; columns.slots.len()];
        for (k, column) in columns.columns.iter().enumerate() {
            column.iter().for_each(|slot| column_of[*slot] = k);
        }
        let places: Vec<Point> =
            (0..sizes.len()).map(|block| Point::new(lefts[column_of[block]], tops[block])).collect();
        let ways = (columns.ways.iter().zip(links))
            .map(|(way, link)| {
                way.iter()
                    .enumerate()
                    .map(|(k, slot)| {
                        let (start, width) = (lefts[column_of[*slot]], widths[column_of[*slot]]);
                        match k {
                            // From the box's own side to the side of its column, if the box is narrower.
                            0 => [start + sizes[*slot].width, start + width, tops[*slot] + link.from.1],
                            k if k + 1 == way.len() => [start, start, tops[*slot] + link.to.1],
                            _ => [start, start + width, tops[*slot]],
                        }
                    })
                    .collect()
            })
            .collect();
        let bottom = (0..sizes.len()).map(|block| tops[block] + sizes[block].height).chain(tops.iter().copied());
        let size = Size::new((at - spacing.alley).max(0.0), bottom.fold(0.0, f32::max));
        Layout { size, places, ways }
    }
}

/// Sets the tops of a column's slots as close to the wanted positions as their order and distances allow: least
/// squares, by pooling adjacent slots that are too close (the pool-adjacent-violators algorithm of isotonic
/// regression).
fn set(
    tops: &mut [f32],
    column: &[usize],
    wanted: &[f32],
    height: &impl Fn(usize) -> f32,
    apart: &impl Fn(usize, usize) -> f32,
) {
    // The minimum offset of each slot below the first.
    let mut below = vec![0.0f32; column.len()];
    for k in 1..column.len() {
        below[k] = below[k - 1] + height(column[k - 1]) + apart(column[k - 1], column[k]);
    }
    // Pools of adjacent slots: the sum of wanted positions of the pool's first slot, and the number of slots.
    let mut pools: Vec<(f32, usize)> = Vec::new();
    for (wanted, below) in wanted.iter().zip(&below) {
        pools.push((wanted - below, 1));
        while let [.., (sum, count), (last, last_count)] = pools[..] {
            if sum / count as f32 <= last / last_count as f32 {
                break;
            }
            pools.pop();
            if let Some(pool) = pools.last_mut() {
                *pool = (sum + last, count + last_count);
            }
        }
    }
    let firsts = pools.iter().flat_map(|(sum, count)| std::iter::repeat_n(sum / *count as f32, *count));
    for ((slot, first), below) in column.iter().zip(firsts).zip(&below) {
        tops[*slot] = first + below;
    }
}

fn median(values: &mut [f32]) -> f32 {
    values.sort_by(f32::total_cmp);
    let half = values.len() / 2;
    if values.len().is_multiple_of(2) { (values[half - 1] + values[half]) / 2.0 } else { values[half] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPACING: Spacing = Spacing { gap: 6.0, wire_gap: 3.0, alley: 16.0 };

    /// Boxes with random edges from a seeded generator.
    fn random(count: usize, seed: u64) -> (Vec<Size>, Vec<Link>) {
        let mut state = seed;
        let mut next = move |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        let sizes: Vec<Size> =
            (0..count).map(|_| Size { width: 20.0 + next(30) as f32, height: 10.0 + next(20) as f32 }).collect();
        let links = (1..count)
            .flat_map(|to| {
                (0..=next(2))
                    .map(|_| Link { from: (next(to), 4.0), to: (to, 4.0 + next(6) as f32) })
                    .collect::<Vec<_>>()
            })
            .collect();
        (sizes, links)
    }

    #[test]
    fn nothing_overlaps_and_wires_run_to_the_right() {
        for seed in 0..20 {
            let (sizes, links) = random(3 + 4 * seed as usize, seed);
            let layout = Layout::new(&sizes, &links, SPACING);
            let area = |k: usize| {
                let Point { x, y } = layout.places[k];
                [x, y, x + sizes[k].width, y + sizes[k].height]
            };
            for a in 0..sizes.len() {
                let one = area(a);
                assert!(
                    one[0] >= 0.0
                        && one[1] >= -1e-3
                        && one[2] <= layout.size.width + 1e-3
                        && one[3] <= layout.size.height + 1e-3
                );
                for b in 0..a {
                    let other = area(b);
                    let apart = one[0] >= other[2]
                        || other[0] >= one[2]
                        || one[1] >= other[3] - 1e-3
                        || other[1] >= one[3] - 1e-3;
                    assert!(apart, "{seed}: {a} {one:?} over {b} {other:?}");
                }
            }
            for (way, link) in layout.ways.iter().zip(&links) {
                assert!(way.windows(2).all(|pair| pair[0][1] < pair[1][0]), "{way:?}");
                let from = area(link.from.0);
                assert_eq!([way[0][0], way[0][2]], [from[2], from[1] + link.from.1]);
            }
            assert_eq!(layout, Layout::new(&sizes, &links, SPACING));
        }
    }

    #[test]
    fn a_chain_is_level() {
        let sizes = [Size { width: 20.0, height: 10.0 }; 4];
        let links: Vec<Link> = (0..3).map(|k| Link { from: (k, 4.0), to: (k + 1, 4.0) }).collect();
        let layout = Layout::new(&sizes, &links, SPACING);
        assert!(layout.places.iter().all(|place| place.y == 0.0), "{:?}", layout.places);
    }
}
