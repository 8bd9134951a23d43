//! Water of a level: seas and lakes inherit their place from the level above, and their shores gain detail.

use super::children::{Children, heir};
use super::level::Level;
use super::links::{Child, Links};
use crate::hydrology::direction::NONE;

/// What links say about a child.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Held {
    /// Nothing.
    Free,
    /// A river passes: land.
    River,
    /// A river ends here: water.
    Mouth,
}

/// Cells without water in [`water_levels`].
pub const LAND: f32 = f32::INFINITY;

/// The water level of each child, in metres; [`LAND`] on land. Updates the children's distances to the shore.
pub fn water_levels(parent: &Level, links: &Links, children: &mut Children) -> Vec<f32> {
    let held = held(parent, links);
    let (width, parents) = (children.extent.width, links.size.0);
    let mut levels = vec![LAND; held.len()];
    for (j, row) in levels.chunks_mut(width.max(1)).enumerate() {
        for (i, level) in row.iter_mut().enumerate() {
            let (q, p) = (j * width + i, j / 2 * parents + i / 2);
            let flooded = held[q] == Held::Mouth || (held[q] == Held::Free && children.shore[q] < 0.0);
            if parent.receiver[p] >= NONE && flooded {
                *level = parent.height[p];
            }
        }
    }
    // Water spreads by one cell into low land.
    let mut gained = Vec::new();
    let inner = children.extent.shrunk(1);
    for j in inner.rows() {
        for i in inner.columns() {
            let (q, p) = (j * width + i, j / 2 * parents + i / 2);
            if parent.receiver[p] < NONE && held[q] == Held::Free && children.shore[q] < 0.0 {
                let around = [q - 1, q + 1, q - width, q + width].map(|o| levels[o]);
                gained.extend(around.into_iter().find(|&level| level < LAND).map(|level| (q, level)));
            }
        }
    }
    for (q, level) in gained {
        levels[q] = level;
    }
    for ((shore, &level), &held) in children.shore.iter_mut().zip(&levels).zip(&held) {
        *shore = match held {
            _ if level < LAND => shore.min(-0.5 * children.indent),
            Held::River => shore.max(0.8 * children.indent),
            _ => shore.max(0.3 * children.indent),
        };
    }
    levels
}

/// What the kept links say about each child.
fn held(parent: &Level, links: &Links) -> Vec<Held> {
    let parents = links.size.0;
    let mut held = vec![Held::Free; 4 * links.list.len()];
    for q in links.inner() {
        let link = links.list[q];
        let own = |corner| Child { parent: q, corner }.index(parents);
        let start = own(heir(parent, q));
        if !link.kept {
            continue;
        }
        if parent.receiver[q] >= NONE {
            if link.fed && held[start] == Held::Free {
                held[start] = Held::Mouth;
            }
            continue;
        }
        (held[start], held[own(link.exit)]) = (Held::River, Held::River);
        if let Some(via) = links.via(parent, q) {
            held[via.index(parents)] = Held::River;
        }
        let target = links.target(parent, q);
        if parent.receiver[target] < NONE {
            held[Child { parent: target, corner: link.entry }.index(parents)] = Held::River;
        }
    }
    held
}
