//! Finds out which cells a tileset can draw.

use std::collections::HashSet;

use super::classes::Classes;
use super::mask::{CORNERS, Layout, OFFSETS};
use crate::parallel;

/// The tiles of a tileset, as the surroundings of each class that can be drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawable {
    layout: Layout,
    tiles: Present,
}

/// The tiles that exist.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Present {
    /// For each class from the second on, whether there is a tile for each of the 256 masks, so that masks need not be
    /// reduced.
    Layers(Vec<[bool; 256]>),
    /// Tiles that show all classes of their cell.
    Wang(Wang),
}

/// The wang tiles that exist.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Wang {
    classes: usize,
    ids: HashSet<[u8; 8]>,
    /// For each pair of classes, the class after the first one on the shortest path to the second, through classes that
    /// a tile shows together.
    next: Vec<Vec<u8>>,
}

/// A position for which a tileset has no tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// Column of the tile in the window of the classes.
    pub x: i64,
    /// Row of the tile.
    pub y: i64,
    /// The missing tile.
    pub tile: MissingTile,
}

/// A tile that a tileset does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissingTile {
    /// The tile of a class for a reduced mask.
    Layer {
        /// The class whose layer lacks the tile.
        class: u8,
        /// The reduced mask.
        mask: u8,
    },
    /// The tile with a wang id.
    Wang([u8; 8]),
}

impl Drawable {
    /// Tiles of a layout for layers: for each class from the second on, the reduced masks for which there are tiles.
    /// The first class covers everything and needs only a full tile.
    #[must_use]
    pub fn new<'m>(layout: Layout, masks: impl IntoIterator<Item = &'m [u8]>) -> Drawable {
        let present = masks.into_iter().map(|masks| {
            let mut present: [bool; 256] = std::array::from_fn(|mask| masks.contains(&layout.reduced(mask as u8)));
            // A corner tile without a covered corner is not drawn.
            (0..=255).filter(|mask| layout.is_on_corners() && mask & CORNERS == 0).for_each(|mask: u8| {
                present[usize::from(mask)] = true;
            });
            present
        });
        Drawable { layout, tiles: Present::Layers(present.collect()) }
    }

    /// Wang tiles of a layout with this number of classes: the [ids](Layout::wang_id) for which there are tiles.
    #[must_use]
    pub fn wang(layout: Layout, classes: usize, ids: impl IntoIterator<Item = [u8; 8]>) -> Drawable {
        let ids: HashSet<[u8; 8]> = ids.into_iter().collect();
        let mut meet = vec![vec![false; classes]; classes];
        for id in &ids {
            let seen = id.iter().enumerate().filter(|(bit, _)| layout.directions() >> bit & 1 == 1);
            let seen: Vec<usize> = seen.map(|(_, class)| usize::from(*class)).filter(|of| *of < classes).collect();
            seen.iter().for_each(|a| seen.iter().for_each(|b| meet[*a][*b] = true));
        }
        // The distances from each class to the others. The next class on the path to `to` is the first one that is
        // nearest to it.
        let distances: Vec<Vec<usize>> = (0..classes).map(|from| distances(from, &meet)).collect();
        let next = |from: usize, to: usize| {
            let nearer = (0..classes).filter(|class| meet[from][*class]);
            nearer.min_by_key(|class| distances[to][*class]).unwrap_or(to) as u8
        };
        let next = (0..classes).map(|from| (0..classes).map(|to| next(from, to)).collect()).collect();
        Drawable { layout, tiles: Present::Wang(Wang { classes, ids, next }) }
    }

    /// All tiles of a layout for this number of classes.
    #[must_use]
    pub fn complete(layout: Layout, classes: usize) -> Drawable {
        let masks = layout.masks();
        Drawable::new(layout, (1..classes).map(|_| masks.as_slice()))
    }

    /// The layout of the tiles.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Whether all surroundings of all classes can be drawn. Always false for wang tiles, of which there are too many
    /// to count.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        match &self.tiles {
            Present::Layers(layers) => layers.iter().all(|masks| masks.iter().all(|present| *present)),
            Present::Wang(_) => false,
        }
    }

    /// The number of classes.
    #[must_use]
    pub fn classes(&self) -> usize {
        match &self.tiles {
            Present::Layers(layers) => layers.len() + 1,
            Present::Wang(wang) => wang.classes,
        }
    }

    /// Whether the tiles are wang tiles.
    pub(super) fn is_wang(&self) -> bool {
        matches!(self.tiles, Present::Wang(_))
    }

    /// The class to insert between two adjacent classes that no tile shows together. `None` if there is such a tile, or
    /// if no path leads from one class to the other.
    #[inline]
    pub(super) fn between(&self, from: u8, to: u8) -> Option<u8> {
        let Present::Wang(wang) = &self.tiles else { return None };
        let next = *wang.next.get(usize::from(from))?.get(usize::from(to))?;
        (next != to && next != from).then_some(next)
    }

    /// The wang id of the tile in column `x` and row `y`.
    #[inline]
    pub(super) fn wang_id(&self, at: impl Fn(i64, i64) -> u8, x: i64, y: i64) -> [u8; 8] {
        let (seen, own) = self.seen(at, x, y);
        self.layout.wang_id(seen, own)
    }

    /// The classes that a tile sees, clockwise from the north as in masks, and the class of its cell. Tiles on corners
    /// see four classes, of which the north-western one is in column `x` and row `y`; they have no class of their own.
    #[inline]
    pub(super) fn seen(&self, at: impl Fn(i64, i64) -> u8, x: i64, y: i64) -> ([u8; 8], u8) {
        if self.layout.is_on_corners() {
            let [nw, ne, sw, se] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            return ([0, ne, 0, se, 0, sw, 0, nw], ne.max(nw).max(sw).max(se));
        }
        (OFFSETS.map(|[dx, dy]| at(x + dx, y + dy)), at(x, y))
    }

    /// The mask, not reduced, of the layer of `class` for the classes that a tile sees.
    #[inline]
    pub(super) fn mask(&self, seen: &[u8; 8], class: u8) -> u8 {
        seen.iter().enumerate().fold(0, |mask, (bit, other)| mask | (u8::from(*other >= class) << bit))
    }

    /// The missing tile, if there is one. For layers, the uppermost layer that lacks a tile counts.
    #[inline]
    pub(super) fn missing(&self, at: impl Fn(i64, i64) -> u8, x: i64, y: i64) -> Option<MissingTile> {
        let layers = match &self.tiles {
            Present::Layers(layers) => layers,
            Present::Wang(wang) => {
                let id = self.wang_id(at, x, y);
                return (!wang.ids.contains(&id)).then_some(MissingTile::Wang(id));
            }
        };
        let (seen, own) = self.seen(at, x, y);
        for class in (1..=own).rev() {
            let mask = self.mask(&seen, class);
            let present = layers.get(usize::from(class) - 1).is_some_and(|masks| masks[usize::from(mask)]);
            if !present {
                return Some(MissingTile::Layer { class, mask: self.layout.reduced(mask) });
            }
            if self.layout.is_full(mask) {
                break;
            }
        }
        None
    }

    /// The number of tiles per row and the number of rows for a window of classes.
    #[must_use]
    pub fn tiles(&self, classes: &Classes) -> [usize; 2] {
        let fewer = usize::from(self.layout.is_on_corners());
        [classes.width().saturating_sub(fewer), classes.height().saturating_sub(fewer)]
    }

    /// All positions without a tile, row by row.
    #[must_use]
    pub fn gaps(&self, classes: &Classes) -> Vec<Gap> {
        let [width, height] = self.tiles(classes);
        // A tile in the middle of one class needs only a full tile, but that tile may be missing, too.
        let lacks_full = match &self.tiles {
            Present::Layers(layers) => layers.iter().any(|masks| !masks[255]),
            Present::Wang(_) => true,
        };
        let row = |y: usize| {
            let varied = varied(classes, y as i64, self.layout.is_on_corners());
            let gap = |x: usize| {
                let (x, y) = (x as i64, y as i64);
                let tile = self.missing(|x, y| classes.at(x, y), x, y)?;
                Some(Gap { x, y, tile })
            };
            (0..width).filter(|x| lacks_full || varied[*x]).filter_map(gap).collect::<Vec<_>>()
        };
        parallel::map(0..height, row).into_iter().flatten().collect()
    }
}

/// The number of steps from a class to each class through classes that a tile shows together; the number of classes if
/// there is no path.
fn distances(from: usize, meet: &[Vec<bool>]) -> Vec<usize> {
    let mut distances = vec![meet.len(); meet.len()];
    distances[from] = 0;
    let mut reached = vec![from];
    for step in 1..meet.len() {
        let is_new = |class: &usize| distances[*class] == meet.len() && reached.iter().any(|of| meet[*of][*class]);
        reached = (0..meet.len()).filter(is_new).collect();
        reached.iter().for_each(|class| distances[*class] = step);
    }
    distances
}

/// For each tile of a row, whether it may see two classes. False only for tiles that see one class.
pub(super) fn varied(classes: &Classes, y: i64, is_on_corners: bool) -> Vec<bool> {
    let [above, own, below] = match is_on_corners {
        true => [classes.row(y), classes.row(y), classes.row(y + 1)],
        false => [classes.row(y - 1), classes.row(y), classes.row(y + 1)],
    };
    let width = own.len();
    let mut differs = vec![0; width];
    for (x, differs) in differs.iter_mut().enumerate() {
        let next = own[(x + 1).min(width - 1)];
        *differs = (own[x] ^ above[x]) | (own[x] ^ below[x]) | (own[x] ^ next);
    }
    let at = |x: usize| differs[x.min(width - 1)];
    (0..width).map(|x| (at(x.saturating_sub(1)) | at(x) | at(x + 1)) != 0).collect()
}
