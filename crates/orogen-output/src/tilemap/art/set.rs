//! The built-in tilesets, which can be drawn in any layout.

use orogen_grid::autotile::flip::{Flip, Flips};
use orogen_grid::autotile::mask::Layout;

use super::ground::{GROUNDS, Texture, VARIANTS};
use crate::tilemap::tileset::{Fit, Rgba, Terrain, Tile, Tileset};

/// A built-in tileset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Set {
    /// The name.
    pub name: &'static str,
    /// A one-line description.
    pub about: &'static str,
    /// Pixels along the side of a tile.
    pub size: usize,
}

/// The sets.
pub const SETS: [Set; 2] = [
    Set { name: "fields-16", about: "Water, sand, grass, forest, rock and snow in tiles of 16 pixels", size: 16 },
    Set { name: "fields-32", about: "The same in tiles of 32 pixels", size: 32 },
];

/// Tiles per row of the picture.
const COLUMNS: usize = 16;

impl Set {
    /// The set with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Set> {
        SETS.iter().find(|set| set.name == name)
    }

    /// Draws the set with the tiles of a layout.
    #[must_use]
    pub fn draw(&self, layout: Layout) -> Tileset {
        let size = self.size;
        let mut tiles = Vec::new();
        let mut add = |fit: Fit, weight: f32| {
            tiles.push(Tile { picture: tiles.len() as u32, flip: Flip::NONE, fit, weight });
        };
        let mut drawn: Vec<Vec<Rgba>> = Vec::new();
        for (class, ground) in GROUNDS.iter().enumerate() {
            let textures: Vec<Texture> =
                (0..VARIANTS.len()).map(|variant| Texture::new(ground, size, variant)).collect();
            for (texture, weight) in textures.iter().zip(VARIANTS) {
                add(Fit::Layer { class: class as u8, mask: layout.full() }, weight);
                drawn.push(pixels(size, |x, y| Some(texture.at(x, y))));
            }
            let borders = if class == 0 { Vec::new() } else { layout.masks() };
            for mask in borders.into_iter().filter(|mask| *mask != layout.full()) {
                add(Fit::Layer { class: class as u8, mask }, 1.0);
                drawn.push(pixels(size, |x, y| {
                    let scale = 16.0 / size as f64;
                    let middle = [x, y].map(|at| (at as f64 + 0.5) * scale);
                    let place = ground.border.place(layout, mask, middle)?;
                    ground.ink(place, textures[0].at(x, y), x)
                }));
            }
        }
        let rows = drawn.len().div_ceil(COLUMNS);
        let mut picture = vec![[0; 4]; rows * COLUMNS * size * size];
        for (n, tile) in drawn.iter().enumerate() {
            for (y, row) in tile.chunks(size).enumerate() {
                let start = ((n / COLUMNS) * size + y) * COLUMNS * size + (n % COLUMNS) * size;
                picture[start..start + size].copy_from_slice(row);
            }
        }
        let terrain = |ground: &super::ground::Ground| Terrain { name: ground.name.into(), color: ground.color() };
        Tileset {
            name: self.name.into(),
            size,
            layout,
            is_wang: false,
            terrains: GROUNDS.iter().map(terrain).collect(),
            count: tiles.len(),
            tiles,
            flips: Flips::default(),
            prefers_unturned: false,
            columns: COLUMNS,
            pixels: picture,
        }
    }
}

/// The pixels of a tile; pixels without an ink are transparent.
fn pixels(size: usize, ink: impl Fn(usize, usize) -> Option<[u8; 3]>) -> Vec<Rgba> {
    let at = |n: usize| match ink(n % size, n / size) {
        Some([red, green, blue]) => [red, green, blue, 255],
        None => [0; 4],
    };
    (0..size * size).map(at).collect()
}
