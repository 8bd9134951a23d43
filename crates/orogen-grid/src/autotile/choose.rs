//! The choice of tiles: one layer of tiles for each class, or one layer of wang tiles.

use std::collections::HashMap;

use crate::parallel;

use super::classes::Classes;
use super::drawable::{Drawable, varied};
use super::mask::Layout;
use super::variants::{Group, Variants};
use crate::random::{STEP, mix64};

pub use super::variants::Variant;

/// The tiles of a class.
#[derive(Debug, Clone, Default)]
pub struct ClassTiles {
    // The tiles of each of the 256 masks.
    groups: Vec<Group>,
    variants: Variants,
}

impl ClassTiles {
    /// Tiles with their masks, which are reduced. Tiles with the same reduced mask are variants.
    #[must_use]
    pub fn new(layout: Layout, tiles: &[(u8, Variant)]) -> ClassTiles {
        let mut made = ClassTiles::default();
        for mask in 0..=255 {
            let reduced = layout.reduced(mask);
            let group = tiles.iter().filter(|(of, _)| *of == reduced).map(|(_, variant)| *variant);
            made.groups.push(made.variants.add(group));
        }
        made
    }

    /// The tile for a mask at the column and row `place` of the plane; `None` if there is no tile.
    #[inline]
    #[must_use]
    pub fn choose(&self, mask: u8, place: [i64; 2], seed: u64) -> Option<u32> {
        self.variants.choose(*self.groups.get(usize::from(mask))?, place, seed)
    }
}

/// Wang tiles. Each has a class along its sides, at its corners or both, so one tile shows several classes.
#[derive(Debug, Clone, Default)]
pub struct WangTiles {
    groups: HashMap<[u8; 8], Group>,
    variants: Variants,
}

impl WangTiles {
    /// Tiles with their wang id (see [`Layout::wang_id`]). Tiles with the same wang id are variants.
    #[must_use]
    pub fn new(tiles: &[([u8; 8], Variant)]) -> WangTiles {
        let mut made = WangTiles::default();
        for (id, _) in tiles {
            if !made.groups.contains_key(id) {
                let group = tiles.iter().filter(|(of, _)| of == id).map(|(_, variant)| *variant);
                let group = made.variants.add(group);
                made.groups.insert(*id, group);
            }
        }
        made
    }

    /// The tile with a wang id at the column and row `place` of the plane; `None` if there is no tile.
    #[inline]
    #[must_use]
    pub fn choose(&self, id: &[u8; 8], place: [i64; 2], seed: u64) -> Option<u32> {
        self.variants.choose(*self.groups.get(id)?, place, seed)
    }
}

/// The tiles of a tileset.
#[derive(Debug, Clone)]
pub enum Tiles {
    /// Tiles for one layer per class, in order. Of the first class only the full tile is drawn.
    Layers(Vec<ClassTiles>),
    /// Tiles that show all classes of their cell, for a single layer.
    Wang(WangTiles),
}

/// The tile number where a layer has no tile.
pub const NONE: u32 = u32::MAX;

/// Draws classes with tiles. Returns a layer of tile numbers for each class, row-major, bottom to top, or one layer of
/// wang tiles; [`NONE`] where a layer has no tile. Tiles below a full tile are left out. Any window gives the same
/// tiles at the same positions of the plane, except at sides beyond which the plane continues.
///
/// Positions for which there is no tile are left out (see [`Drawable::gaps`]).
#[must_use]
pub fn layers(classes: &Classes, drawable: &Drawable, tiles: &Tiles, seed: u64) -> Vec<Vec<u32>> {
    match tiles {
        Tiles::Layers(tiles) => class_layers(classes, drawable, tiles, seed),
        Tiles::Wang(tiles) => vec![wang_layer(classes, drawable, tiles, seed)],
    }
}

fn class_layers(classes: &Classes, drawable: &Drawable, tiles: &[ClassTiles], seed: u64) -> Vec<Vec<u32>> {
    let [width, height] = drawable.tiles(classes);
    let mut layers = vec![vec![NONE; width * height]; tiles.len()];
    let mut rows: Vec<Vec<&mut [u32]>> = (0..height).map(|_| Vec::with_capacity(tiles.len())).collect();
    for layer in &mut layers {
        layer.chunks_mut(width.max(1)).zip(&mut rows).for_each(|(row, rows)| rows.push(row));
    }
    let seeds: Vec<u64> =
        (0..tiles.len() as u64).map(|class| mix64(seed.wrapping_add(class.wrapping_mul(STEP)))).collect();
    let layout = drawable.layout();
    parallel::for_each(rows.iter_mut().enumerate(), |(y, layers)| {
        let varied = varied(classes, y as i64, layout.is_on_corners());
        let own = classes.row(y as i64);
        for x in 0..width {
            let (column, row) = (x as i64, y as i64);
            let place = [classes.x + column, classes.y + row];
            let mut draw = |class: u8, mask: u8| {
                let class = usize::from(class);
                if let Some(tile) = tiles.get(class).and_then(|tiles| tiles.choose(mask, place, seeds[class])) {
                    layers[class][x] = tile;
                }
            };
            if !varied[x] {
                draw(own[x], 255);
                continue;
            }
            let (seen, top) = drawable.seen(|x, y| classes.at(x, y), column, row);
            let mut is_covered = false;
            for class in (1..=top).rev() {
                let mask = drawable.mask(&seen, class);
                draw(class, mask);
                is_covered = layout.is_full(mask);
                if is_covered {
                    break;
                }
            }
            if !is_covered {
                draw(0, 255);
            }
        }
    });
    layers
}

fn wang_layer(classes: &Classes, drawable: &Drawable, tiles: &WangTiles, seed: u64) -> Vec<u32> {
    let [width, height] = drawable.tiles(classes);
    let mut layer = vec![NONE; width * height];
    let seed = mix64(seed);
    parallel::for_each(layer.chunks_mut(width.max(1)).enumerate(), |(y, row)| {
        for (x, tile) in row.iter_mut().enumerate() {
            let id = drawable.wang_id(|x, y| classes.at(x, y), x as i64, y as i64);
            let place = [classes.x + x as i64, classes.y + y as i64];
            *tile = tiles.choose(&id, place, seed).unwrap_or(NONE);
        }
    });
    layer
}
