//! Shorter rivers on the finest level: where a river returns to a cell next to itself, the loop is replaced with a
//! direct link.

use super::carve::{Carved, UNKNOWN};
use super::drainage::FREE;
use super::stencil::{Extent, code};
use crate::grid::Window;
use crate::hydrology::direction::{NONE, STEPS};
use crate::random::mix64;

/// Number of links to look ahead.
const AHEAD: usize = 5;

/// Maximum number of cells that a shortcut skips, and their maximum distance from its start.
const SKIPPED: usize = AHEAD - 1;
const NEAR: usize = 3;

/// Number of cells that the result of a cell depends on. A shortcut over the cell starts at most `NEAR` cells away,
/// competing shortcuts start at most `NEAR` cells further away, and each looks at links up to `SKIPPED` cells away.
pub const REACH: usize = 2 * NEAR + SKIPPED;

/// A direct link that replaces a loop of a river.
struct Shortcut {
    from: usize,
    code: u8,
    /// The skipped cells, in the order of the river.
    skipped: [usize; SKIPPED],
    count: usize,
    /// If one of two shortcuts skips the start of the other, the one with the higher rank is used.
    rank: u64,
}

impl Shortcut {
    fn skipped(&self) -> &[usize] {
        &self.skipped[..self.count]
    }
}

/// Replaces loops of rivers with direct links. Skipped cells lose the water that now bypasses them; cells without any
/// water become free.
pub fn straighten(extent: Extent, window: &Window, carved: &mut Carved) {
    let found = shortcuts(extent, window, carved);
    let mut of_start = vec![u32::MAX; extent.len()];
    for (k, shortcut) in (0..).zip(&found) {
        of_start[shortcut.from] = k;
    }
    let mut beaten = vec![false; found.len()];
    for (k, shortcut) in found.iter().enumerate() {
        for other in shortcut.skipped().iter().map(|&q| of_start[q] as usize).filter(|&other| other < found.len()) {
            let loser = if found[other].rank > shortcut.rank { k } else { other };
            beaten[loser] = true;
        }
    }
    let taken: Vec<&Shortcut> = found.iter().zip(&beaten).filter(|(_, beaten)| !**beaten).map(|(one, _)| one).collect();
    // The starts keep their water, because no used shortcut skips them. What the skipped cells lose is therefore exact.
    for shortcut in &taken {
        for &q in shortcut.skipped() {
            carved.area[q] -= carved.area[shortcut.from];
        }
    }
    for shortcut in &taken {
        let code = f32::from(shortcut.code);
        (carved.fixed[shortcut.from], carved.receiver[shortcut.from]) = (code, code);
    }
    // A skipped cell is dry if no remaining river leads to it.
    for _ in 0..SKIPPED {
        for shortcut in &taken {
            for &q in shortcut.skipped() {
                if carved.fixed[q] > FREE && donors(extent, carved, q).next().is_none() {
                    (carved.fixed[q], carved.receiver[q]) = (FREE, f32::from(NONE));
                    (carved.height[q], carved.area[q]) = (UNKNOWN, 1.0);
                    carved.undraw(q);
                }
            }
        }
    }
    for shortcut in &taken {
        for &q in shortcut.skipped() {
            carved.area[q] = carved.area[q].max(1.0);
        }
    }
}

/// All shortcuts that start in the extent.
fn shortcuts(extent: Extent, window: &Window, carved: &Carved) -> Vec<Shortcut> {
    let width = extent.width;
    let margin = extent.shrunk(SKIPPED.saturating_sub(extent.inset));
    let river = |q: usize| carved.fixed[q] > FREE && carved.fixed[q] < f32::from(NONE);
    let mut found = Vec::new();
    for j in margin.rows() {
        for i in margin.columns() {
            let from = j * width + i;
            let (mut node, mut east, mut south) = (from, 0isize, 0isize);
            let mut way = [0; AHEAD];
            let mut best = None;
            for (link, passed) in way.iter_mut().enumerate() {
                if !river(node) {
                    break;
                }
                let (by_east, by_south) = STEPS[carved.fixed[node] as usize & 7];
                *passed = node;
                node = node.wrapping_add_signed(by_south * width as isize + by_east);
                (east, south) = (east + by_east, south + by_south);
                if link > 0 && east.abs() <= 1 && south.abs() <= 1 && (east, south) != (0, 0) {
                    best = Some((link, code(east, south)));
                }
            }
            let Some((count, code)) = best else { continue };
            let mut skipped = [0; SKIPPED];
            skipped[..count].copy_from_slice(&way[1..=count]);
            let (x, y) = (window.x + i as i64, window.y + j as i64);
            // Every second cell of a staircase has a higher rank, so that the whole staircase becomes a diagonal.
            let even = u64::from((x ^ y) & 1 == 0);
            let chance = mix64(mix64(x as u64) ^ y as u64) >> 8;
            found.push(Shortcut { from, code, skipped, count, rank: (count as u64) << 60 | even << 57 | chance });
        }
    }
    found
}

/// The cells whose river leads to `q`.
fn donors(extent: Extent, carved: &Carved, q: usize) -> impl Iterator<Item = usize> {
    STEPS.iter().enumerate().filter_map(move |(code, (east, south))| {
        let donor = q.wrapping_add_signed(south * extent.width as isize + east);
        // The water of lakes also has receivers.
        let is_river = carved.fixed[donor] > FREE && carved.receiver[donor] == ((code + 4) & 7) as f32;
        is_river.then_some(donor)
    })
}
