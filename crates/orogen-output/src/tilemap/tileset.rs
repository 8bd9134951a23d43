//! Tilesets: the picture of the tiles, and where each tile fits.

use orogen_grid::autotile::choose::{ClassTiles, Tiles, Variant, WangTiles};
use orogen_grid::autotile::drawable::Drawable;
use orogen_grid::autotile::flip::{Flip, Flips};
use orogen_grid::autotile::mask::Layout;

/// A color in sRGB bytes: red, green, blue, opacity (0 or 255).
pub type Rgba = [u8; 4];

/// A terrain class of a tileset.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Terrain {
    /// The name, such as `grass`.
    pub name: String,
    /// The color that represents the class in lists and editors: red, green, blue.
    pub color: [u8; 3],
}

/// A tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tile {
    /// Number of the tile in the picture.
    pub picture: u32,
    /// How the tile is flipped or rotated.
    pub flip: Flip,
    /// Where the tile fits.
    pub fit: Fit,
    /// How often the tile is drawn, relative to the other tiles that fit the same position.
    pub weight: f32,
}

/// The surroundings that a tile is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fit {
    /// A tile of the layer of a class.
    Layer {
        /// The class.
        class: u8,
        /// The reduced mask of the neighbors in which the layer continues: see [`orogen_grid::autotile::mask`].
        mask: u8,
    },
    /// A tile that shows all classes at its position, by its [wang id](Layout::wang_id).
    Wang([u8; 8]),
}

impl Fit {
    /// What the tile fits after a flip or rotation.
    #[must_use]
    pub fn turned(self, flip: Flip) -> Fit {
        match self {
            Fit::Layer { class, mask } => Fit::Layer { class, mask: flip.mask(mask) },
            Fit::Wang(id) => Fit::Wang(flip.turned(id)),
        }
    }
}

/// The flip bits in the number of a tile, as in Tiled maps.
const DIAGONAL: u32 = 1 << 29;
const UPSIDE_DOWN: u32 = 1 << 30;
const MIRRORED: u32 = 1 << 31;

/// Upper limit of tile numbers: tiles of a picture from this number on cannot be used in a map.
pub const MAX_TILES: usize = DIAGONAL as usize;

/// The number of a tile in a map: its number in the picture, with the flips in the upper bits.
#[must_use]
pub fn number(picture: u32, flip: Flip) -> u32 {
    let bit = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
    picture | bit(flip.diagonal, DIAGONAL) | bit(flip.y, UPSIDE_DOWN) | bit(flip.x, MIRRORED)
}

/// The number in the picture and the flips of a tile of a map; the inverse of [`number`].
#[must_use]
pub fn parts(number: u32) -> (u32, Flip) {
    let has = |bit: u32| number & bit != 0;
    (number & (DIAGONAL - 1), Flip { diagonal: has(DIAGONAL), x: has(MIRRORED), y: has(UPSIDE_DOWN) })
}

/// The number in the picture and the flips of a tile in map files, where 0 means no tile, and all other values are 1
/// more than the [number].
#[must_use]
pub fn shown(tile: u32) -> Option<(u32, Flip)> {
    tile.checked_sub(1).map(parts)
}

/// A tileset. Tile n of the picture is in column n % `columns` and row n / `columns`.
#[derive(Debug, Clone, PartialEq)]
pub struct Tileset {
    /// The name.
    pub name: String,
    /// Width and height of a tile, in pixels.
    pub size: usize,
    /// How the tiles depend on their surroundings.
    pub layout: Layout,
    /// Whether the tiles show all classes at their position, so that a map has a single layer.
    pub is_wang: bool,
    /// The terrain classes, bottom to top.
    pub terrains: Vec<Terrain>,
    /// The tiles. A tile that fits several positions is listed once for each.
    pub tiles: Vec<Tile>,
    /// The allowed flips and rotations. [`Tileset::tiles`] already includes them.
    pub flips: Flips,
    /// Whether flipped or rotated tiles are drawn only where no other tile fits.
    pub prefers_unturned: bool,
    /// Number of tiles in the picture.
    pub count: usize,
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
        self.count.div_ceil(self.columns.max(1)) * self.size
    }

    /// The pixel of a flipped or rotated tile.
    #[inline]
    #[must_use]
    pub fn pixel(&self, (picture, flip): (u32, Flip), at: [usize; 2]) -> Rgba {
        let [x, y] = flip.pixel(at, self.size);
        self.row(picture as usize, y)[x]
    }

    /// A row of pixels of a tile of the picture.
    #[must_use]
    pub fn row(&self, tile: usize, y: usize) -> &[Rgba] {
        let start = ((tile / self.columns) * self.size + y) * self.width() + (tile % self.columns) * self.size;
        &self.pixels[start..start + self.size]
    }

    /// The tiles, for [`orogen_grid::autotile::choose::layers`].
    #[must_use]
    pub fn choices(&self) -> Tiles {
        let variant = |tile: &Tile| Variant { tile: number(tile.picture, tile.flip), weight: tile.weight };
        if self.is_wang {
            let tiles = self.tiles.iter().filter_map(|tile| match tile.fit {
                Fit::Wang(id) => Some((id, variant(tile))),
                Fit::Layer { .. } => None,
            });
            return Tiles::Wang(WangTiles::new(&tiles.collect::<Vec<_>>()));
        }
        let of = |class: usize| {
            let tiles = self.tiles.iter().filter_map(|tile| match tile.fit {
                Fit::Layer { class: of, mask } if usize::from(of) == class => Some((mask, variant(tile))),
                _ => None,
            });
            ClassTiles::new(self.layout, &tiles.collect::<Vec<_>>())
        };
        Tiles::Layers((0..self.terrains.len()).map(of).collect())
    }

    /// What the tileset can draw.
    #[must_use]
    pub fn drawable(&self) -> Drawable {
        if self.is_wang {
            let ids = self.tiles.iter().filter_map(|tile| match tile.fit {
                Fit::Wang(id) => Some(id),
                Fit::Layer { .. } => None,
            });
            return Drawable::wang(self.layout, self.terrains.len(), ids);
        }
        let mut masks = vec![Vec::new(); self.terrains.len()];
        for tile in &self.tiles {
            if let Fit::Layer { class, mask } = tile.fit {
                masks[usize::from(class)].push(mask);
            }
        }
        Drawable::new(self.layout, masks.iter().skip(1).map(Vec::as_slice))
    }

    /// Adds the flipped and rotated tiles that `flips` allows. With `prefers_unturned`, adds only tiles that fit where
    /// no other tile does.
    #[must_use]
    pub fn with_flips(mut self, flips: Flips, prefers_unturned: bool) -> Tileset {
        let own = self.tiles.clone();
        for tile in &own {
            for flip in flips.all().into_iter().filter(|flip| *flip != Flip::NONE) {
                let fit = match tile.fit.turned(flip) {
                    Fit::Layer { class, mask } => Fit::Layer { class, mask: self.layout.reduced(mask) },
                    fit => fit,
                };
                if !(prefers_unturned && own.iter().any(|other| other.fit == fit)) {
                    self.tiles.push(Tile { flip, fit, ..*tile });
                }
            }
        }
        Tileset { flips, prefers_unturned, ..self }
    }

    /// The names of the layers of a map, bottom to top.
    #[must_use]
    pub fn layer_names(&self) -> Vec<&str> {
        match self.is_wang {
            true => vec!["terrain"],
            false => self.terrains.iter().map(|terrain| terrain.name.as_str()).collect(),
        }
    }
}
