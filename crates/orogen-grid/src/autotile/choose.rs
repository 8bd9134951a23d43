//! The choice of tiles: one layer of tiles for each class.

use rayon::prelude::*;

use super::classes::Classes;
use super::drawable::{Drawable, varied};
use super::mask::Layout;
use crate::random::{STEP, mix64};

/// A tile that may be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// Its number in the tileset.
    pub tile: u32,
    /// How often it is drawn, compared with the others for the same mask: above 0.
    pub weight: f32,
}

/// The tiles of a class.
#[derive(Debug, Clone, Default)]
pub struct ClassTiles {
    // For each of the 256 masks where its variants begin, and how many they are.
    places: Vec<[u32; 2]>,
    variants: Vec<Variant>,
    // The part of the draw below which each variant is chosen.
    bounds: Vec<f32>,
}

impl ClassTiles {
    /// Tiles by their reduced mask. Variants of a mask are tiles with the same one.
    #[must_use]
    pub fn new(layout: Layout, tiles: &[(u8, Variant)]) -> ClassTiles {
        let mut made = ClassTiles::default();
        for mask in 0..=255 {
            let first = made.variants.len();
            let reduced = layout.reduced(mask);
            made.variants.extend(tiles.iter().filter(|(of, _)| *of == reduced).map(|(_, variant)| *variant));
            let added = &made.variants[first..];
            let all: f32 = added.iter().map(|variant| variant.weight).sum();
            let mut sum = 0.0;
            made.bounds.extend(added.iter().map(|variant| {
                sum += variant.weight;
                sum / all
            }));
            made.places.push([first as u32, added.len() as u32]);
        }
        made
    }

    /// The tile for a mask at the position (x, y) of the plane; `None` if there is no tile.
    #[inline]
    #[must_use]
    pub fn choose(&self, mask: u8, [x, y]: [i64; 2], seed: u64) -> Option<u32> {
        let [first, count] = (*self.places.get(usize::from(mask))?).map(|at| at as usize);
        if count < 2 {
            return self.variants[first..].first().filter(|_| count == 1).map(|variant| variant.tile);
        }
        let hash = mix64(mix64(seed ^ (x as u64).wrapping_mul(STEP)) ^ (y as u64).wrapping_mul(0xD1B5_4A32_D192_ED03));
        let draw = (hash >> 40) as f32 / (1u64 << 24) as f32;
        let bounds = &self.bounds[first..first + count];
        let nth = bounds.iter().position(|bound| draw < *bound).unwrap_or(count - 1);
        Some(self.variants[first + nth].tile)
    }
}

/// The number of a place without a tile in a layer of tiles.
pub const NONE: u32 = u32::MAX;

/// Draws classes with tiles: for each class a layer of tile numbers, row-major, bottom to top; [`NONE`] where a layer has no tile. Tiles below a full
/// tile are left out. The same tiles at the same positions of the plane for any window, except beside sides at which the plane goes on.
///
/// `tiles` are those of all classes; of the first only the full tile is drawn. Masks without a tile are left out: see [`Drawable::gaps`].
#[must_use]
pub fn layers(classes: &Classes, drawable: &Drawable, tiles: &[ClassTiles], seed: u64) -> Vec<Vec<u32>> {
    let [width, height] = drawable.tiles(classes);
    let mut layers = vec![vec![NONE; width * height]; tiles.len()];
    let mut rows: Vec<Vec<&mut [u32]>> = (0..height).map(|_| Vec::with_capacity(tiles.len())).collect();
    for layer in &mut layers {
        layer.chunks_mut(width.max(1)).zip(&mut rows).for_each(|(row, rows)| rows.push(row));
    }
    let seeds: Vec<u64> =
        (0..tiles.len() as u64).map(|class| mix64(seed.wrapping_add(class.wrapping_mul(STEP)))).collect();
    rows.par_iter_mut().enumerate().for_each(|(y, layers)| {
        let varied = varied(classes, y as i64, drawable.layout().is_on_corners());
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
                is_covered = drawable.is_full(mask);
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
