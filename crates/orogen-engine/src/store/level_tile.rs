//! The names of tiles of levels.

use super::entry_key::EntryKey;
use super::grids::GridKey;
use crate::plan::key::Key;
use orogen_grid::grid::Window;
use sha2::{Digest, Sha256};

/// Names a tile of a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelTile {
    /// The content key of the levelled op.
    pub node: Key,
    /// The level.
    pub level: usize,
    /// Number of planes.
    pub planes: usize,
    /// Its samples.
    pub window: Window,
}

impl LevelTile {
    /// The key under which it is stored for later runs.
    pub fn entry_key(&self) -> EntryKey {
        let Window { x, y, width, height, cell } = self.window;
        let mut hash = Sha256::new();
        hash.update(b"tile of a level");
        hash.update(self.node);
        for number in [self.level as u64, x as u64, y as u64, width as u64, height as u64, cell.to_bits()] {
            hash.update(number.to_le_bytes());
        }
        EntryKey::of(&hash.finalize().into())
    }

    /// The keys of its planes.
    pub fn grids(&self) -> Vec<GridKey> {
        (0..self.planes).map(|plane| GridKey::new(self.node, plane, &self.window)).collect()
    }

    /// The key of the tile while it is made.
    pub fn mark(&self) -> GridKey {
        GridKey::new(self.node, 0, &self.window)
    }
}
