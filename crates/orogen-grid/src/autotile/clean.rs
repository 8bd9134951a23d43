//! Clean-up: changes classes where a tileset has no tile, for example at necks of one cell or where two areas touch
//! only at a corner.
//!
//! In each of a fixed number of rounds, every position without a tile proposes the change of one cell that leaves the
//! fewest such positions. Of proposals near each other only the best is applied. Each change therefore has the effect
//! for which it was chosen, and the number of positions without a tile falls with every change. After these rounds some
//! positions may remain in dense noise, and they are filled. For tiles of cells, blocks of 2 x 2 cells get one class,
//! which the smallest common tilesets can draw. For tiles on corners, all corners of the tile are raised to the class
//! that lacks one.
//!
//! Wang tiles usually show only some pairs of classes. Before the other rounds and between the fills, a class that
//! joins both is inserted between two classes that no tile shows together. The fill for wang tiles sets all corners or
//! cells that a missing tile sees to their most frequent class.
//!
//! A round looks at cells up to a fixed distance. If a part of a map is cleaned with its surroundings ([`HALO`]), the
//! result is equal to that part of the cleaned map.

use std::collections::HashMap;

use crate::parallel;

use super::classes::{Classes, hash};
use super::drawable::{Drawable, Gap, MissingTile};
use crate::error::Result;
use crate::progress::Progress;

/// Number of rounds in which classes are inserted between others, for wang tiles.
const BRIDGE_ROUNDS: usize = 6;

/// Number of rounds of single changes.
const ROUNDS: usize = 8;

/// Number of rounds that fill the remaining positions. In white noise each leaves a quarter of the positions without a
/// tile, so that none remains in millions of cells.
const FILL_ROUNDS: usize = 14;

/// Proposals within this distance, in cells along either axis, exclude each other. A change affects tiles one cell
/// away, which see one cell further.
const APART: i64 = 3;

/// Number of cells that a round of single changes depends on: proposals that exclude a change ([`APART`]), the
/// positions that made them (1), and the cells that these see to choose (3).
const ROUND_HALO: usize = APART as usize + 4;

/// Number of cells that a round of fills depends on: a tile that sees the block, and the cells that the tile sees.
const FILL_HALO: usize = 4;

/// Number of cells that a round of insertions depends on: the tiles that see a cell, and the cells that they see.
const BRIDGE_HALO: usize = 2;

/// Number of cells that the clean-up depends on. If a part of a map is grown by this much on all sides and cleaned, it
/// equals that part of the cleaned map.
pub const HALO: usize = BRIDGE_ROUNDS * BRIDGE_HALO + ROUNDS * ROUND_HALO + FILL_ROUNDS * FILL_HALO;

/// The best change for a position without a tile.
#[derive(Debug, Clone, Copy)]
struct Proposal {
    // Change in the number of positions without a tile (lower is better), then the change of class, then a hash.
    rank: (i32, u8, u64),
    class: u8,
}

/// Changes as few classes as possible so that `drawable` has a tile everywhere. Where this fails, positions without a
/// tile remain, and [`Drawable::gaps`] lists them.
///
/// # Errors
/// If `progress` is cancelled.
pub fn clean(classes: &mut Classes, drawable: &Drawable, progress: &Progress) -> Result<()> {
    progress.expect((BRIDGE_ROUNDS + ROUNDS + FILL_ROUNDS) as f64);
    if drawable.is_complete() {
        progress.finish();
        return Ok(());
    }
    let mut gaps = drawable.gaps(classes);
    const FIRST: usize = BRIDGE_ROUNDS;
    const LAST: usize = BRIDGE_ROUNDS + ROUNDS;
    for round in 0..BRIDGE_ROUNDS + ROUNDS + FILL_ROUNDS {
        if !gaps.is_empty() && (round >= FIRST || drawable.is_wang()) {
            let changes = match round {
                0..FIRST => bridges(classes, drawable, &gaps),
                FIRST..LAST => changes(classes, drawable, &gaps),
                _ if drawable.is_wang() && round % 2 == 1 => bridges(classes, drawable, &gaps),
                _ if drawable.is_wang() => majorities(classes, drawable, &gaps),
                _ if drawable.layout().is_on_corners() => raised(classes, drawable, &gaps),
                _ => blocks(classes, drawable, &gaps),
            };
            for (x, y, class) in &changes {
                classes.set(*x, *y, *class);
            }
            gaps = gaps_again(classes, drawable, &gaps, &changes);
        }
        progress.step(1.0)?;
    }
    Ok(())
}

/// The positions without a tile after changes. Only previous ones and those near the changes are tested.
fn gaps_again(classes: &Classes, drawable: &Drawable, gaps: &[Gap], changes: &[(i64, i64, u8)]) -> Vec<Gap> {
    let [width, height] = drawable.tiles(classes).map(|side| side as i64);
    let nearby = changes.iter().flat_map(|(x, y, _)| affected(drawable, *x, *y));
    let mut places: Vec<(i64, i64)> =
        gaps.iter().map(|gap| (gap.y, gap.x)).chain(nearby.map(|(x, y)| (y, x))).collect();
    places.sort_unstable();
    places.dedup();
    let at = |x: i64, y: i64| classes.at(x, y);
    let gap = |(y, x): &(i64, i64)| {
        let tile = drawable.missing(at, *x, *y)?;
        Some(Gap { x: *x, y: *y, tile })
    };
    places.retain(|(y, x)| (0..width).contains(x) && (0..height).contains(y));
    parallel::map(&places, gap).into_iter().flatten().collect()
}

/// The tiles that see a cell.
fn affected(drawable: &Drawable, x: i64, y: i64) -> impl Iterator<Item = (i64, i64)> {
    let after = i64::from(!drawable.layout().is_on_corners());
    (y - 1..=y + after).flat_map(move |row| (x - 1..=x + after).map(move |column| (column, row)))
}

/// The cells that a tile sees.
fn seen(drawable: &Drawable, x: i64, y: i64) -> impl Iterator<Item = (i64, i64)> {
    let before = i64::from(!drawable.layout().is_on_corners());
    (y - before..=y + 1).flat_map(move |row| (x - before..=x + 1).map(move |column| (column, row)))
}

/// The changes of a round: the best proposals that do not exclude each other.
fn changes(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let proposals: Vec<((i64, i64), Proposal)> =
        parallel::map(gaps, |gap| propose(classes, drawable, gap)).into_iter().flatten().collect();
    let mut best: HashMap<(i64, i64), Proposal> = HashMap::with_capacity(proposals.len());
    for (place, proposal) in proposals {
        let kept = best.entry(place).or_insert(proposal);
        if proposal.rank < kept.rank {
            *kept = proposal;
        }
    }
    let is_best = |&(x, y): &(i64, i64), proposal: &Proposal| {
        let mut near =
            (y - APART + 1..y + APART).flat_map(|row| (x - APART + 1..x + APART).map(move |column| (column, row)));
        near.all(|other| other == (x, y) || best.get(&other).is_none_or(|other| proposal.rank < other.rank))
    };
    let done = best.iter().filter(|(place, proposal)| is_best(place, proposal));
    let mut done: Vec<(i64, i64, u8)> = done.map(|((x, y), proposal)| (*x, *y, proposal.class)).collect();
    done.sort_unstable();
    done
}

/// Distance from a position without a tile within which cells affect the choice of a change, in cells.
const SIGHT: i64 = 3;

/// The change of one cell that leaves the fewest missing tiles around it; `None` if that is not fewer than now.
fn propose(classes: &Classes, drawable: &Drawable, gap: &Gap) -> Option<((i64, i64), Proposal)> {
    let [width, height] = [classes.width() as i64, classes.height() as i64];
    let is_inside = |at: i64, side: i64| (SIGHT..side - SIGHT).contains(&at);
    if !is_inside(gap.x, width) || !is_inside(gap.y, height) {
        // Cells outside the window have the class of the nearest cell inside.
        let inside = |(x, y): (i64, i64)| (x.clamp(0, width - 1), y.clamp(0, height - 1));
        return best_change(classes, drawable, gap, |x, y| classes.at(x, y), inside);
    }
    // The classes in sight are read many times, so they are copied.
    const SIDE: usize = 2 * SIGHT as usize + 1;
    let mut seen = [[0; SIDE]; SIDE];
    for (row, y) in seen.iter_mut().zip(gap.y - SIGHT..) {
        row.copy_from_slice(&classes.row(y)[(gap.x - SIGHT) as usize..][..SIDE]);
    }
    let at = |x: i64, y: i64| seen[(y - gap.y + SIGHT) as usize][(x - gap.x + SIGHT) as usize];
    best_change(classes, drawable, gap, at, |place| place)
}

/// [`propose`] with a function that reads classes, and a function that returns the cell of the window that counts at a
/// position.
#[inline(always)]
fn best_change(
    classes: &Classes,
    drawable: &Drawable,
    gap: &Gap,
    at: impl Fn(i64, i64) -> u8,
    inside: impl Fn((i64, i64)) -> (i64, i64),
) -> Option<((i64, i64), Proposal)> {
    let [width, height] = [classes.width() as i64, classes.height() as i64];
    let [columns, rows] = drawable.tiles(classes).map(|side| side as i64);
    let mut best: Option<((i64, i64), Proposal)> = None;
    for (x, y) in seen(drawable, gap.x, gap.y) {
        if !(0..width).contains(&x) || !(0..height).contains(&y) {
            continue;
        }
        let own = at(x, y);
        let missing = |class: u8| {
            let changed = |column: i64, row: i64| {
                if inside((column, row)) == (x, y) { class } else { at(column, row) }
            };
            let tiles = affected(drawable, x, y);
            let tiles = tiles.filter(|(column, row)| (0..columns).contains(column) && (0..rows).contains(row));
            tiles.filter(|(column, row)| drawable.missing(changed, *column, *row).is_some()).count() as i32
        };
        let now = missing(own);
        let mut tried = [u8::MAX; 10];
        tried[0] = own;
        let mut count = 1;
        for (column, row) in (y - 1..=y + 1).flat_map(|row| (x - 1..=x + 1).map(move |column| (column, row))) {
            let class = at(column, row);
            if tried[..count].contains(&class) {
                continue;
            }
            tried[count] = class;
            count += 1;
            let gained = missing(class) - now;
            let rank = (gained, own.abs_diff(class), hash([classes.x + x, classes.y + y], u64::from(class)));
            if gained < 0 && best.is_none_or(|(_, best)| rank < best.rank) {
                best = Some(((x, y), Proposal { rank, class }));
            }
        }
    }
    best
}

/// Changes to blocks of 2 x 2 cells, at even positions of the plane, that a position without a tile sees: all cells get
/// the most frequent class of the block, or the lowest one of several.
fn blocks(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let mut corners: Vec<(i64, i64)> = gaps
        .iter()
        .flat_map(|gap| seen(drawable, gap.x, gap.y))
        .map(|(x, y)| (x - (classes.x + x).rem_euclid(2), y - (classes.y + y).rem_euclid(2)))
        .collect();
    corners.sort_unstable();
    corners.dedup();
    let block = |(x, y): (i64, i64)| {
        let cells = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        let found = cells.map(|(x, y)| classes.at(x, y));
        let class = majority(&found);
        cells.map(|(x, y)| (x, y, class))
    };
    corners.into_iter().flat_map(block).collect()
}

/// The most frequent class, or the lowest one of several.
fn majority(found: &[u8]) -> u8 {
    let often = |class: u8| found.iter().filter(|other| **other == class).count();
    found.iter().copied().max_by_key(|class| (often(*class), std::cmp::Reverse(*class))).unwrap_or_default()
}

/// Changes to all cells that missing tiles see: they get their most frequent class. If a cell would get several
/// classes, it gets the lowest.
fn majorities(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let cells = gaps.iter().flat_map(|gap| {
        let found: Vec<u8> = seen(drawable, gap.x, gap.y).map(|(x, y)| classes.at(x, y)).collect();
        let class = majority(&found);
        seen(drawable, gap.x, gap.y).map(move |(x, y)| (x, y, class))
    });
    lowest(cells.collect())
}

/// Changes to cells next to a lower class that no tile shows together with their own: they get a class that joins both.
fn bridges(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let cells = gaps.iter().flat_map(|gap| {
        let found: Vec<u8> = seen(drawable, gap.x, gap.y).map(|(x, y)| classes.at(x, y)).collect();
        let bridge = move |(x, y): (i64, i64)| {
            let own = classes.at(x, y);
            let lower = found.iter().filter(|other| **other < own);
            let between = lower.filter_map(|other| drawable.between(own, *other)).min()?;
            Some((x, y, between))
        };
        seen(drawable, gap.x, gap.y).filter_map(bridge)
    });
    lowest(cells.collect())
}

/// One change for each cell: the one to the lowest class.
fn lowest(mut changes: Vec<(i64, i64, u8)>) -> Vec<(i64, i64, u8)> {
    changes.sort_unstable();
    changes.dedup_by_key(|(x, y, _)| (*x, *y));
    changes
}

/// Changes to the corners of missing tiles: they are raised to the class whose layer lacks the tile. Layers only grow
/// by this, so it terminates.
fn raised(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let corners = gaps.iter().flat_map(|gap| {
        let least = match gap.tile {
            MissingTile::Layer { class, .. } => class,
            MissingTile::Wang(_) => 0,
        };
        let raised = move |(x, y)| (x, y, classes.at(x, y).max(least));
        seen(drawable, gap.x, gap.y).map(raised)
    });
    // A corner that several tiles raise gets the highest class, which is the last one.
    let mut corners: Vec<(i64, i64, u8)> = corners.collect();
    corners.sort_unstable();
    corners
}
