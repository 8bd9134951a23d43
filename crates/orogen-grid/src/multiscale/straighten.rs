//! Shorter rivers on the finest level: where a river comes back to a cell beside itself, it goes there directly.

use super::carve::{Carved, FREE, UNKNOWN};
use super::stencil::{Extent, code};
use crate::hydrology::direction::{NONE, STEPS};

/// Number of links that are looked ahead.
const AHEAD: usize = 5;

/// Cells that the result of a cell depends on: a river that skips the cell starts at most 3 cells away, and looks at links up to 4 away.
pub const REACH: usize = 7;

/// Replaces loops of rivers by direct links. Cells that are skipped lose their river.
pub fn straighten(extent: Extent, carved: &mut Carved) {
    let width = extent.width;
    let margin = extent.shrunk(AHEAD.saturating_sub(extent.inset));
    let cells = extent.len();
    let (mut had, mut has) = (vec![false; cells], vec![false; cells]);
    let mut skipped = vec![0.0f32; cells];
    let mut changed = Vec::new();
    let river = |q: usize| carved.fixed[q] > FREE && carved.fixed[q] < f32::from(NONE);
    for j in margin.rows() {
        for q in margin.columns().map(|i| j * width + i).filter(|&q| river(q)) {
            let next = |q: usize| {
                let (east, south) = STEPS[carved.fixed[q] as usize & 7];
                (q.wrapping_add_signed(south * width as isize + east), east, south)
            };
            let (first, mut east, mut south) = next(q);
            had[first] = true;
            let mut node = first;
            let mut shortcut = None;
            for link in 1..AHEAD {
                if !river(node) {
                    break;
                }
                let (further, by_east, by_south) = next(node);
                (node, east, south) = (further, east + by_east, south + by_south);
                if east.abs() <= 1 && south.abs() <= 1 && (east, south) != (0, 0) {
                    shortcut = Some((link, node, code(east, south)));
                }
            }
            let Some((links, to, code)) = shortcut else {
                has[first] = true;
                continue;
            };
            has[to] = true;
            changed.push((q, code));
            let mut node = first;
            for _ in 0..links {
                skipped[node] += carved.area[q];
                node = next(node).0;
            }
        }
    }
    for j in extent.rows() {
        for q in extent.columns().map(|i| j * width + i) {
            if !(carved.fixed[q] > FREE && carved.fixed[q] < f32::from(NONE)) {
                continue;
            }
            if had[q] && !has[q] {
                (carved.fixed[q], carved.receiver[q]) = (FREE, f32::from(NONE));
                (carved.height[q], carved.area[q]) = (UNKNOWN, 1.0);
            } else {
                carved.area[q] = (carved.area[q] - skipped[q]).max(1.0);
            }
        }
    }
    for (q, code) in changed {
        if carved.fixed[q] > FREE {
            (carved.fixed[q], carved.receiver[q]) = (f32::from(code), f32::from(code));
        }
    }
}
