//! Rivers as lines: reaches over land that start at sources, confluences and lakes, and end at confluences, lakes, the
//! sea and the border.
//!
//! A reach that meets a shore shares a point with it. Reaches that meet also share a point. Heights never rise along a
//! reach, nor from a reach to the next one.

use std::collections::HashMap;

use super::clip::{Piece, Rectangle};
use super::joints::Joints;
use super::shores::Shores;
use super::water::{Cover, Frame, Water};

/// The start of a reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// A source or a confluence.
    Land,
    /// A lake, by its number from 1.
    Lake(u32),
    /// The border of the frame, or samples without heights.
    Border,
}

/// The end of a reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mouth {
    /// Another reach, by its index.
    Reach(u32),
    /// A lake, by its number from 1.
    Lake(u32),
    /// The sea.
    Sea,
    /// The border of the frame.
    Border,
}

/// A reach over land.
#[derive(Debug, Clone, PartialEq)]
pub struct River {
    /// Column, row and height of each point, downstream.
    pub points: Vec<[f64; 3]>,
    /// Strahler order; 0 if it is unknown because water enters from outside a given network.
    pub order: u8,
    /// Number of samples that drain to the end of the reach.
    pub drained: f64,
    /// The first land sample of the reach.
    pub start: u32,
    /// The last sample that belongs only to this reach; the next one belongs to another reach or to water.
    pub end: u32,
    /// The start of the reach.
    pub source: Source,
    /// The end of the reach.
    pub mouth: Mouth,
    /// The index of the reach in which its water continues, beyond the lake if it ends in one; `None` at the sea and
    /// the border.
    pub downstream: Option<u32>,
}

/// A stretch over land during construction.
struct Stretch {
    cells: Vec<usize>,
    order: u8,
    source: Source,
    mouth: End,
}

/// The end of a stretch, before reaches are numbered.
#[derive(Clone, Copy)]
enum End {
    /// At the first cell of another reach of the network.
    Network(u32),
    Lake(u32),
    Sea,
    Border,
}

/// The number of the sea in shores; lakes are numbered from 1.
const SEA: u32 = 0;

/// The reaches within a frame, smoothed `rounds` times. Their crossings with shores are inserted into `shores`.
pub fn rivers(water: &Water, frame: &Frame, rounds: usize, shores: &mut Shores) -> Vec<River> {
    traced(water, frame, rounds, shores).into_iter().map(|(river, _)| river).collect()
}

/// The reaches of a given network within a rectangle. The lines of the whole grid are smoothed, ended at the shores of
/// the whole grid, and then clipped. Where the rectangles of two windows have a common side, the parts of a reach meet
/// in the same point, as long as both grids extend some samples beyond the side. A reach that leaves and returns gives
/// several parts.
pub fn rivers_within(
    water: &Water,
    frame: &Frame,
    rectangle: &Rectangle,
    rounds: usize,
    shores: &mut Shores,
) -> Vec<River> {
    let all = traced(water, &Frame::whole(water), rounds, shores);
    let mut parts: Vec<River> = Vec::new();
    // The part at the start of each reach, if the start is within the rectangle.
    let mut first: Vec<Option<u32>> = vec![None; all.len()];
    for (k, (river, cells)) in all.iter().enumerate() {
        for piece in rectangle.pieces(&river.points).into_iter().filter(|piece| piece.points.len() > 1) {
            if !piece.enters {
                first[k] = Some(parts.len() as u32);
            }
            parts.push(part(water, frame, river, cells, piece));
        }
    }
    for river in &mut parts {
        if let Mouth::Reach(next) = river.mouth {
            river.downstream = first[next as usize];
            river.mouth = river.downstream.map_or(Mouth::Border, Mouth::Reach);
        }
    }
    parts
}

/// The part of a reach that is given by a clipped piece of its line.
fn part(water: &Water, frame: &Frame, river: &River, cells: &[u32], piece: Piece) -> River {
    // Points and nodes have the same indices, but the last points of a line may have been cut off at a shore.
    let at = |k: usize| cells[k.min(cells.len().saturating_sub(1))];
    let own = cells.partition_point(|cell| *cell != river.end).min(cells.len().saturating_sub(1));
    let inner = piece.inner.clone();
    let start = if piece.enters { at(inner.start.saturating_sub(usize::from(inner.is_empty()))) } else { river.start };
    let end = if !piece.leaves {
        river.end
    } else {
        // A smoothed line may leave the frame before or after its nodes do; watersheds need a node inside the frame.
        let last = inner.end.saturating_sub(1).min(own);
        let nodes = cells[inner.start.min(last)..=last].iter().rev().copied();
        nodes.into_iter().find(|cell| frame.holds(water, *cell as usize)).unwrap_or(cells[last])
    };
    River {
        points: piece.points,
        order: river.order,
        drained: water.drained(end as usize),
        start,
        end,
        source: if piece.enters { Source::Border } else { river.source },
        mouth: if piece.leaves { Mouth::Border } else { river.mouth },
        downstream: None,
    }
}

/// The reaches within a frame, each with its nodes.
fn traced(water: &Water, frame: &Frame, rounds: usize, shores: &mut Shores) -> Vec<(River, Vec<u32>)> {
    let mut stretches: Vec<Stretch> = Vec::new();
    // The first stretch of each reach of the network, and the stretch that leaves each lake.
    let mut of_network: HashMap<u32, u32> = HashMap::new();
    let mut of_lake: HashMap<u32, u32> = HashMap::new();
    for (k, reach) in water.reaches.iter().enumerate() {
        let cells: Vec<usize> = reach.cells.iter().map(|cell| *cell as usize).collect();
        for stretch in cut(water, frame, &cells, reach.order, reach.next) {
            let number = stretches.len() as u32;
            match stretch.source {
                Source::Lake(lake) => {
                    of_lake.insert(lake, number);
                }
                _ if stretch.cells[0] == cells[0] => {
                    of_network.insert(k as u32, number);
                }
                _ => {}
            }
            stretches.push(stretch);
        }
    }
    let joints = Joints::new(&shores.lines, &shores.waters);
    let mut joints = if water.network.is_some() { joints.snapped() } else { joints };
    let made: Vec<(River, Vec<u32>)> = (stretches.iter())
        .map(|stretch| {
            let mouth = match stretch.mouth {
                End::Network(next) => of_network.get(&next).map_or(Mouth::Border, |next| Mouth::Reach(*next)),
                End::Lake(lake) => Mouth::Lake(lake),
                End::Sea => Mouth::Sea,
                End::Border => Mouth::Border,
            };
            let downstream = match mouth {
                Mouth::Reach(next) => Some(next),
                Mouth::Lake(lake) => of_lake.get(&lake).copied(),
                Mouth::Sea | Mouth::Border => None,
            };
            let points = line(water, stretch, mouth, rounds, &mut joints);
            let own = last_own(stretch);
            let drained = water.drained(own);
            // Reaches that meet at the border end there together.
            let end = stretch.cells.last().copied().filter(|_| mouth == Mouth::Border).unwrap_or(own) as u32;
            let start = stretch.cells[usize::from(matches!(stretch.source, Source::Lake(_)))] as u32;
            let river =
                River { points, order: stretch.order, drained, start, end, source: stretch.source, mouth, downstream };
            (river, stretch.cells.iter().map(|cell| *cell as u32).collect())
        })
        .collect();
    joints.into_points().insert(&mut shores.lines);
    made
}

/// The last cell that belongs only to the stretch; the next one belongs to the next reach or to water.
fn last_own(stretch: &Stretch) -> usize {
    let count = stretch.cells.len();
    match stretch.mouth {
        End::Border => stretch.cells[count - 1],
        _ => stretch.cells[count.saturating_sub(2)],
    }
}

/// Splits a reach of the network where it enters or leaves water, and at the frame. Each stretch also contains the
/// first water cell at each of its ends.
fn cut(water: &Water, frame: &Frame, cells: &[usize], order: u8, next: Option<u32>) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let mut part: Vec<usize> = Vec::new();
    let mut source = Source::Land;
    let mut finish = |part: &mut Vec<usize>, source: Source, mouth: End| {
        let cells = std::mem::take(part);
        // Nodes in a lake may be far from the samples that show the lake.
        let in_lake = matches!((source, mouth), (Source::Lake(from), End::Lake(to)) if from == to);
        if cells.len() > 1 && !in_lake {
            stretches.push(Stretch { cells, order, source, mouth });
        }
    };
    for (k, cell) in cells.iter().copied().enumerate() {
        let cover = match frame.holds(water, cell) {
            true => water.node_cover(cell),
            false => Cover::Missing,
        };
        let end = match cover {
            Cover::Land => {
                if part.is_empty() {
                    let before = k.checked_sub(1).map(|k| cells[k]);
                    source = match before.map(|before| (before, water.node_cover(before), frame.holds(water, before))) {
                        None => Source::Land,
                        Some((before, Cover::Lake(lake), true)) => {
                            part.push(before);
                            Source::Lake(lake)
                        }
                        Some(_) => Source::Border,
                    };
                }
                part.push(cell);
                continue;
            }
            _ if part.is_empty() => continue,
            Cover::Lake(lake) => End::Lake(lake),
            Cover::Sea => End::Sea,
            Cover::Missing => End::Border,
        };
        if cover != Cover::Missing {
            part.push(cell);
        }
        finish(&mut part, source, end);
    }
    if !part.is_empty() {
        finish(&mut part, source, next.map_or(End::Border, End::Network));
    }
    stretches
}

/// The line of a stretch, from shore to shore.
fn line(water: &Water, stretch: &Stretch, mouth: Mouth, rounds: usize, joints: &mut Joints) -> Vec<[f64; 3]> {
    let sea_level = f64::from(water.sea_level.unwrap_or_default());
    let level = |lake: u32| water.lakes.get((lake as usize).wrapping_sub(1)).map(|lake| f64::from(lake.level));
    let height = |cell: usize| match water.node_cover(cell) {
        Cover::Sea => sea_level,
        Cover::Lake(lake) if water.network.is_some() => {
            level(lake).unwrap_or_else(|| f64::from(water.surface.data()[cell]))
        }
        _ => f64::from(water.surface.data()[cell]),
    };
    let point = |cell: &usize| {
        let [x, y] = water.node_place(*cell);
        [x, y, height(*cell)]
    };
    let raw: Vec<[f64; 3]> = stretch.cells.iter().map(point).collect();
    let mut points = even(&raw, rounds);
    match mouth {
        Mouth::Lake(lake) => end_at(&mut points, &raw, joints, lake),
        Mouth::Sea => end_at(&mut points, &raw, joints, SEA),
        Mouth::Reach(_) | Mouth::Border => {}
    }
    if let Source::Lake(lake) = stretch.source {
        let raw: Vec<[f64; 3]> = raw.into_iter().rev().collect();
        points.reverse();
        end_at(&mut points, &raw, joints, lake);
        points.reverse();
    }
    points
}

/// Ends a line at the shore of the water that it enters. The height there is that of the water.
fn end_at(points: &mut Vec<[f64; 3]>, raw: &[[f64; 3]], joints: &mut Joints, water: u32) {
    let [.., land, wet] = raw else { return };
    let level = wet[2];
    // Only the part near the end is searched: a smoothed line stays close to its cells.
    const NEAR: usize = 12;
    let start = points.len().saturating_sub(NEAR);
    if let Some((k, along, at)) = joints.entry(&points[start..], water) {
        // At least one point of the line itself remains.
        let keep = (start + k + usize::from(along > 0.0)).max(1);
        points.truncate(keep);
        points.push([at[0], at[1], level]);
        return;
    }
    let straight = joints.entry(&[*land, *wet], water).map(|(_, _, at)| at);
    let at = straight.or_else(|| joints.nearest([land[0], land[1]], water));
    if let Some(at) = at {
        points.pop();
        points.push([at[0], at[1], level]);
    }
}

/// Smooths a line with weighted means of three points (1, 2, 1). Its ends do not move. A descending line stays
/// descending.
#[must_use]
pub fn even(points: &[[f64; 3]], rounds: usize) -> Vec<[f64; 3]> {
    let mut points = points.to_vec();
    for _ in 0..rounds {
        let before = points.clone();
        for (point, three) in points.iter_mut().skip(1).zip(before.windows(3)) {
            *point = [0, 1, 2].map(|c| (three[0][c] + 2.0 * three[1][c] + three[2][c]) / 4.0);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Grid, Window};
    use crate::hydrography::water::Least;
    use crate::hydrology::samples;
    use crate::progress::Progress;

    fn found(heights: Grid, sea: Option<f32>, frame: Option<Frame>, rounds: usize) -> (Water, Shores, Vec<River>) {
        let least = Least { spring: 6, lake: 3, depth: 0.0, scattered: false };
        let window = Window::new(heights.width(), heights.height(), 1.0);
        let heights = Grid::from_data(window, heights.into_data()).unwrap();
        let water = Water::of(heights, sea, least, &Progress::none()).unwrap();
        let frame = frame.unwrap_or_else(|| Frame::whole(&water));
        let mut shores = Shores::of(&water, &frame, 1).unwrap();
        let rivers = rivers(&water, &frame, rounds, &mut shores);
        (water, shores, rivers)
    }

    /// Checks the invariants of all rivers.
    fn check(water: &Water, shores: &Shores, rivers: &[River]) {
        let on_shore = |at: [f64; 3], of: u32| {
            let lines = shores.lines.iter().zip(&shores.waters).filter(|(_, water)| **water == of);
            lines.into_iter().any(|(line, _)| line.contains(&[at[0], at[1]]))
        };
        for (k, river) in rivers.iter().enumerate() {
            assert!(river.points.len() > 1, "{river:?}");
            assert!(river.points.windows(2).all(|pair| pair[1][2] <= pair[0][2]), "rises: {river:?}");
            let (first, last) = (river.points[0], river.points[river.points.len() - 1]);
            if let Source::Lake(lake) = river.source {
                assert!(on_shore(first, lake), "{river:?}");
                assert_eq!(first[2], f64::from(water.lakes[lake as usize - 1].level));
            }
            match river.mouth {
                Mouth::Reach(next) => {
                    assert_eq!(rivers[next as usize].points[0], last);
                    assert_eq!(river.downstream, Some(next));
                }
                Mouth::Lake(lake) => {
                    assert!(on_shore(last, lake), "{river:?}");
                    let next = river.downstream.expect("a lake that rivers run into has one that leaves it");
                    assert_eq!(rivers[next as usize].source, Source::Lake(lake));
                }
                Mouth::Sea => assert!(on_shore(last, 0), "{river:?}"),
                Mouth::Border => assert_eq!(river.downstream, None),
            }
            if let Some(next) = river.downstream.map(|next| &rivers[next as usize]) {
                assert!(next.points[0][2] <= last[2] && next.order >= river.order && next.drained > river.drained);
            }
            // The downstream path ends.
            let (mut at, mut steps) = (k, 0);
            while let Some(next) = rivers[at].downstream {
                at = next as usize;
                steps += 1;
                assert!(steps <= rivers.len());
            }
        }
    }

    #[test]
    fn reaches_fall_and_join_on_every_kind_of_ground() {
        let mut count = 0;
        for heights in samples::grids() {
            for (sea, rounds) in [(None, 3), (Some(300.0), 0), (Some(300.0), 3), (Some(550.0), 6)] {
                let (water, shores, rivers) = found(heights.clone(), sea, None, rounds);
                if heights.data().iter().all(|height| height.is_finite()) {
                    check(&water, &shores, &rivers);
                }
                count += rivers.len();
            }
        }
        assert!(count > 300, "{count}");
    }

    #[test]
    fn a_part_of_the_ground_has_the_rivers_of_the_whole() {
        for seed in 0..6 {
            let heights = samples::hills(70, 60, seed);
            let (_, _, whole) = found(heights.clone(), Some(200.0), None, 3);
            let frame = Frame { columns: 13..52, rows: 9..44 };
            let (water, shores, part) = found(heights, Some(200.0), Some(frame.clone()), 3);
            for river in &part {
                for [x, y, _] in &river.points {
                    assert!((13.0..=51.0).contains(x) && (9.0..=43.0).contains(y));
                }
            }
            let same = part.iter().filter(|river| whole.iter().any(|other| other.points == river.points));
            for river in same.clone() {
                let other = whole.iter().find(|other| other.points == river.points).unwrap();
                assert_eq!((river.drained, river.order), (other.drained, other.order));
            }
            assert!(same.count() * 3 > part.len(), "seed {seed}");
            // Clipped lakes are closed along the frame, and their outlets may be outside.
            for area in shores.areas() {
                for ring in area.parts.iter().flatten() {
                    assert_eq!(ring.first(), ring.last());
                }
            }
            assert!(part.iter().all(|river| river.points.windows(2).all(|pair| pair[1][2] <= pair[0][2])));
            assert!(water.lakes.len() >= shores.areas().len());
        }
    }
}
