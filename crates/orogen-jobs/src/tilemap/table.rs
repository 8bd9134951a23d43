//! The classes of a tilemap as numbers, and a summary of the map.

use std::io::{self, Write};

use orogen_grid::autotile::drawable::MissingTile as Missing;
use serde::Serialize;

use super::map::Tilemap;
use orogen_output::tilemap::rows::listed;

/// `tilemap.json`. Keys have the order of the fields.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct Summary {
    /// The program and its version.
    pub made_by: String,
    /// The world's seed.
    pub seed: u64,
    /// Tiles per row.
    pub width: usize,
    /// Rows of tiles.
    pub height: usize,
    /// Distance between cells, in metres.
    pub cell: f64,
    /// Column and row of the first cell in the world.
    pub origin: [i64; 2],
    /// The name of the tileset.
    pub tileset: String,
    /// The layout of its tiles.
    pub layout: &'static str,
    /// Pixels along the side of a tile.
    pub tile: usize,
    /// The classes, bottom to top.
    pub classes: Vec<ClassCount>,
    /// Number of positions without a tile before the clean-up.
    pub without_tile_before: u64,
    /// Number of cells that the clean-up changed.
    pub changed: u64,
    /// Positions without a tile in the map, at most 1000.
    pub without_tile: Vec<MissingTile>,
}

/// A class and its number of cells.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct ClassCount {
    /// The name of the class.
    pub name: String,
    /// The number of cells.
    pub cells: u64,
}

/// A position without a tile.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct MissingTile {
    /// Column of the tile.
    pub x: i64,
    /// Row of the tile.
    pub y: i64,
    /// The class whose layer has no tile there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class: Option<String>,
    /// The mask for which there is no tile: N 1, NE 2, E 4, SE 8, S 16, SW 32, W 64, NW 128.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mask: Option<u8>,
    /// The classes along the sides and at the corners of the missing wang tile, clockwise from the north; 0 where its
    /// layout does not distinguish classes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wang: Option<[u8; 8]>,
}

impl Tilemap {
    /// The summary of the map.
    #[must_use]
    pub fn summary(&self, made_by: &str) -> Summary {
        let terrains = &self.tileset.terrains;
        let name = |class: u8| terrains.get(usize::from(class)).map_or(String::new(), |terrain| terrain.name.clone());
        Summary {
            made_by: made_by.into(),
            seed: self.seed,
            width: self.width,
            height: self.height,
            cell: self.window.cell,
            origin: [self.window.x, self.window.y],
            tileset: self.tileset.name.clone(),
            layout: self.tileset.layout.name(),
            tile: self.tileset.size,
            classes: (terrains.iter().enumerate())
                .map(|(n, terrain)| ClassCount {
                    name: terrain.name.clone(),
                    cells: self.class_counts.get(n).copied().unwrap_or_default(),
                })
                .collect(),
            without_tile_before: self.gaps_before,
            changed: self.changed,
            without_tile: (self.gaps.iter())
                .map(|gap| {
                    let (class, mask, wang) = match gap.tile {
                        Missing::Layer { class, mask } => (Some(name(class)), Some(mask), None),
                        Missing::Wang(id) => (None, None, Some(id)),
                    };
                    MissingTile { x: gap.x, y: gap.y, class, mask, wang }
                })
                .collect(),
        }
    }

    /// Writes the class of every cell as rows of numbers separated by commas.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let (mut reader, mut row) = (self.classes.reader(), Vec::new());
        loop {
            reader.read(self.class_columns(), &mut row)?;
            if row.is_empty() {
                return Ok(());
            }
            let numbers: Vec<u32> = row.iter().map(|class| u32::from(*class)).collect();
            out.write_all((listed(&numbers) + "\n").as_bytes())?;
        }
    }
}
