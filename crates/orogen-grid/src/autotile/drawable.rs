//! Which cells a tileset can draw.

use super::classes::Classes;
use super::mask::{CORNERS, Layout, OFFSETS};

/// The tiles of a tileset, as masks: which surroundings of each class can be drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawable {
    layout: Layout,
    // The bits of a tile that is covered as a whole.
    full: u8,
    // For each class from the second on, whether there is a tile for a mask. All 256, so that masks need not be reduced.
    present: Vec<[bool; 256]>,
}

/// A place that a tileset has no tile for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// Column of the tile in the window of the classes.
    pub x: i64,
    /// Row of the tile.
    pub y: i64,
    /// The class whose layer lacks a tile.
    pub class: u8,
    /// The reduced mask that it lacks.
    pub mask: u8,
}

impl Drawable {
    /// Tiles of a layout: for each class from the second on, the masks that there are tiles for. Masks are reduced. The first class covers everything
    /// and needs no other tile than a full one.
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
        Drawable { layout, full: layout.full(), present: present.collect() }
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

    /// Whether every surroundings of every class can be drawn.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.present.iter().all(|masks| masks.iter().all(|present| *present))
    }

    /// The number of classes.
    #[must_use]
    pub fn classes(&self) -> usize {
        self.present.len() + 1
    }

    /// The classes that a tile sees, clockwise from the north as the bits of masks, and the class of its cell. Tiles on corners have the
    /// class of their north-west corner in column `x` and row `y`, see four classes, and no own one.
    #[inline]
    pub(super) fn seen(&self, at: impl Fn(i64, i64) -> u8, x: i64, y: i64) -> ([u8; 8], u8) {
        if self.layout.is_on_corners() {
            let [nw, ne, sw, se] = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            return ([0, ne, 0, se, 0, sw, 0, nw], ne.max(nw).max(sw).max(se));
        }
        (OFFSETS.map(|[dx, dy]| at(x + dx, y + dy)), at(x, y))
    }

    /// The mask of the layer of `class` in what a tile sees: not reduced.
    #[inline]
    pub(super) fn mask(&self, seen: &[u8; 8], class: u8) -> u8 {
        seen.iter().enumerate().fold(0, |mask, (bit, other)| mask | (u8::from(*other >= class) << bit))
    }

    /// The mask that all layers below have, too: nothing of them is seen.
    #[inline]
    pub(super) fn is_full(&self, mask: u8) -> bool {
        mask & self.full == self.full
    }

    /// The uppermost layer for which the tile lacks, with its mask.
    #[inline]
    pub(super) fn missing(&self, at: impl Fn(i64, i64) -> u8, x: i64, y: i64) -> Option<(u8, u8)> {
        let (seen, own) = self.seen(at, x, y);
        for class in (1..=own).rev() {
            let mask = self.mask(&seen, class);
            let present = self.present.get(usize::from(class) - 1).is_some_and(|masks| masks[usize::from(mask)]);
            if !present {
                return Some((class, self.layout.reduced(mask)));
            }
            if self.is_full(mask) {
                break;
            }
        }
        None
    }

    /// The number of tiles per row and of rows for a window of classes.
    #[must_use]
    pub fn tiles(&self, classes: &Classes) -> [usize; 2] {
        let fewer = usize::from(self.layout.is_on_corners());
        [classes.width().saturating_sub(fewer), classes.height().saturating_sub(fewer)]
    }

    /// All places without a tile, row by row.
    #[must_use]
    pub fn gaps(&self, classes: &Classes) -> Vec<Gap> {
        use rayon::prelude::*;
        let [width, height] = self.tiles(classes);
        let row = |y: usize| {
            let varied = varied(classes, y as i64, self.layout.is_on_corners());
            let gap = |x: usize| {
                let (x, y) = (x as i64, y as i64);
                let (class, mask) = self.missing(|x, y| classes.at(x, y), x, y)?;
                Some(Gap { x, y, class, mask })
            };
            (0..width).filter(|x| varied[*x]).filter_map(gap).collect::<Vec<_>>()
        };
        // A tile in the middle of one class needs only a full tile, but that may be missing, too.
        let lacks_full = self.present.iter().any(|masks| !masks[255]);
        match lacks_full {
            false => (0..height).into_par_iter().flat_map_iter(row).collect(),
            true => (0..height as i64)
                .into_par_iter()
                .flat_map_iter(|y| {
                    let gap = move |x: i64| {
                        let (class, mask) = self.missing(|x, y| classes.at(x, y), x, y)?;
                        Some(Gap { x, y, class, mask })
                    };
                    (0..width as i64).filter_map(gap)
                })
                .collect(),
        }
    }
}

/// For each tile of a row, whether it may see two classes. False only where it sees one.
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
