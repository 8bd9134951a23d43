//! Clean-up: changes of classes where a tileset has no tile, for example at necks of one cell or where two areas touch
//! at a corner only.
//!
//! In each of a fixed number of rounds, every place without a tile proposes the change of one cell that leaves the
//! fewest such places. Of proposals near each other the best is done, so each change has the effect that it was chosen
//! for, and the number of places without a tile falls with every change. What is left after these rounds, in the middle
//! of dense noise, is filled: for tiles of cells by blocks of 2 x 2 cells of one class, which the smallest common
//! tilesets can draw; for tiles on corners by raising all corners of the tile to the class that lacks one.
//!
//! Wang tiles usually show some pairs of classes only. There, before all else and between the fills, a class that joins
//! both is put between two that no tile shows together. Their fills give the corners or cells that a missing tile sees
//! the class that most of them have.
//!
//! A round looks at a fixed distance, so a part of a map that is cleaned with its surroundings ([`HALO`]) is the part
//! of the cleaned map.

use std::collections::HashMap;

use crate::parallel;

use super::classes::{Classes, hash};
use super::drawable::{Drawable, Gap, MissingTile};
use crate::error::Result;
use crate::progress::Progress;

/// Rounds in which classes are put between others, for wang tiles.
const BRIDGE_ROUNDS: usize = 6;

/// Rounds of single changes.
const ROUNDS: usize = 8;

/// Rounds in which what is left is filled. In white noise each leaves a quarter of the places without a tile that there
/// were before it, so that no place is left in millions of cells.
const FILL_ROUNDS: usize = 14;

/// Proposals within this distance, in cells along either axis, exclude each other: a change affects tiles one cell
/// away, which see one cell further.
const APART: i64 = 3;

/// How far a round of single changes looks: to proposals that exclude a change ([`APART`]), the places they come from
/// (1), and what those see to choose (3).
const ROUND_HALO: usize = APART as usize + 4;

/// How far a round of fills looks: to a tile that sees the block, and what it sees.
const FILL_HALO: usize = 4;

/// How far a round looks that puts classes between others: to the tiles that see a cell, and what they see.
const BRIDGE_HALO: usize = 2;

/// How far the clean-up looks, in cells: a part grown by this much on all sides and cleaned is the part of the whole.
pub const HALO: usize = BRIDGE_ROUNDS * BRIDGE_HALO + ROUNDS * ROUND_HALO + FILL_ROUNDS * FILL_HALO;

/// The best change for a place without a tile.
#[derive(Debug, Clone, Copy)]
struct Proposal {
    // Change in the number of places without a tile: the lower the better. Then the change of class, and a hash.
    rank: (i32, u8, u64),
    class: u8,
}

/// Changes as few classes as it finds necessary for `drawable` to have a tile everywhere. Where that fails, the places
/// remain, as [`Drawable::gaps`] lists them.
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

/// The places without a tile after changes: those before, and those beside the changes.
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

/// The changes of a round: the best proposals.
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

/// How far the choice of a change looks from a place without a tile, in cells.
const SIGHT: i64 = 3;

/// The change of one cell after which the fewest tiles around it are missing, if that is fewer than now.
fn propose(classes: &Classes, drawable: &Drawable, gap: &Gap) -> Option<((i64, i64), Proposal)> {
    let [width, height] = [classes.width() as i64, classes.height() as i64];
    let is_inside = |at: i64, side: i64| (SIGHT..side - SIGHT).contains(&at);
    if !is_inside(gap.x, width) || !is_inside(gap.y, height) {
        // Cells beyond the sides are the nearest in the window.
        let inside = |(x, y): (i64, i64)| (x.clamp(0, width - 1), y.clamp(0, height - 1));
        return best_change(classes, drawable, gap, |x, y| classes.at(x, y), inside);
    }
    // The classes in sight are read many times.
    const SIDE: usize = 2 * SIGHT as usize + 1;
    let mut seen = [[0; SIDE]; SIDE];
    for (row, y) in seen.iter_mut().zip(gap.y - SIGHT..) {
        row.copy_from_slice(&classes.row(y)[(gap.x - SIGHT) as usize..][..SIDE]);
    }
    let at = |x: i64, y: i64| seen[(y - gap.y + SIGHT) as usize][(x - gap.x + SIGHT) as usize];
    best_change(classes, drawable, gap, at, |place| place)
}

/// [`propose`] with a function that reads classes, and one that tells which cell of the window counts at a position.
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

/// The blocks of 2 x 2 cells, at even positions of the plane, that a place without a tile sees: all cells get the most
/// frequent class of the block, or the lowest of those.
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

/// The most frequent class, or the lowest of those.
fn majority(found: &[u8]) -> u8 {
    let often = |class: u8| found.iter().filter(|other| **other == class).count();
    found.iter().copied().max_by_key(|class| (often(*class), std::cmp::Reverse(*class))).unwrap_or_default()
}

/// What missing tiles see gets the most frequent class of it. Of several classes for a cell the lowest counts.
fn majorities(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let cells = gaps.iter().flat_map(|gap| {
        let found: Vec<u8> = seen(drawable, gap.x, gap.y).map(|(x, y)| classes.at(x, y)).collect();
        let class = majority(&found);
        seen(drawable, gap.x, gap.y).map(move |(x, y)| (x, y, class))
    });
    lowest(cells.collect())
}

/// Cells beside a lower class that no tile shows with theirs, with a class for them that joins both.
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

/// One change for each cell: that to the lowest class.
fn lowest(mut changes: Vec<(i64, i64, u8)>) -> Vec<(i64, i64, u8)> {
    changes.sort_unstable();
    changes.dedup_by_key(|(x, y, _)| (*x, *y));
    changes
}

/// The corners of tiles that are missing, raised to the class whose layer lacks them. Layers only grow by this, so that
/// it ends.
fn raised(classes: &Classes, drawable: &Drawable, gaps: &[Gap]) -> Vec<(i64, i64, u8)> {
    let corners = gaps.iter().flat_map(|gap| {
        let least = match gap.tile {
            MissingTile::Layer { class, .. } => class,
            MissingTile::Wang(_) => 0,
        };
        let raised = move |(x, y)| (x, y, classes.at(x, y).max(least));
        seen(drawable, gap.x, gap.y).map(raised)
    });
    // A corner that several tiles raise gets the highest class, which is the last.
    let mut corners: Vec<(i64, i64, u8)> = corners.collect();
    corners.sort_unstable();
    corners
}
