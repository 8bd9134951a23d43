//! Tilesets: the picture of the tiles, and what each tile is for.

use orogen_grid::autotile::choose::{ClassTiles, Variant};
use orogen_grid::autotile::drawable::Drawable;
use orogen_grid::autotile::mask::Layout;

/// A colour in sRGB bytes: red, green, blue, opacity (0 or 255).
pub type Rgba = [u8; 4];

/// A terrain class of a tileset.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Terrain {
    /// Its name, such as `grass`.
    pub name: String,
    /// The colour that stands for it in lists and editors: red, green, blue.
    pub color: [u8; 3],
}

/// A tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    /// The class whose layer it is for.
    pub class: u8,
    /// The reduced mask of where the layer goes on: see [`orogen_grid::autotile::mask`].
    pub mask: u8,
    /// How often it is drawn, compared with the other tiles for the same class and mask.
    pub weight: f32,
}

/// A tileset. Tile n is in column n % `columns` and row n / `columns` of the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Tileset {
    /// Its name.
    pub name: String,
    /// Width and height of a tile, in pixels.
    pub size: usize,
    /// How its tiles follow their surroundings.
    pub layout: Layout,
    /// The terrain classes, bottom to top.
    pub terrains: Vec<Terrain>,
    /// The tiles.
    pub tiles: Vec<Tile>,
    /// Tiles per row of the picture.
    pub columns: usize,
    /// The pixels of the picture, row-major.
    pub pixels: Vec<Rgba>,
}

impl Tileset {
    /// Width of the picture in pixels.
    #[must_use]
    pub fn width(&self) -> usize {
        self.columns * self.size
    }

    /// Height of the picture in pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.tiles.len().div_ceil(self.columns.max(1)) * self.size
    }

    /// A row of pixels of a tile.
    #[must_use]
    pub fn row(&self, tile: usize, y: usize) -> &[Rgba] {
        let start = ((tile / self.columns) * self.size + y) * self.width() + (tile % self.columns) * self.size;
        &self.pixels[start..start + self.size]
    }

    /// The tiles of each class, for [`orogen_grid::autotile::choose::layers`].
    #[must_use]
    pub fn class_tiles(&self) -> Vec<ClassTiles> {
        let of = |class: usize| {
            let tiles = self.tiles.iter().enumerate().filter(|(_, tile)| usize::from(tile.class) == class);
            let variants = tiles.map(|(n, tile)| (tile.mask, Variant { tile: n as u32, weight: tile.weight }));
            ClassTiles::new(self.layout, &variants.collect::<Vec<_>>())
        };
        (0..self.terrains.len()).map(of).collect()
    }

    /// What it can draw.
    #[must_use]
    pub fn drawable(&self) -> Drawable {
        let of = |class: usize| -> Vec<u8> {
            self.tiles.iter().filter(|tile| usize::from(tile.class) == class).map(|tile| tile.mask).collect()
        };
        let masks: Vec<Vec<u8>> = (1..self.terrains.len()).map(of).collect();
        Drawable::new(self.layout, masks.iter().map(Vec::as_slice))
    }
}
