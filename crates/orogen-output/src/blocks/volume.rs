//! All blocks of a window.

use orogen_grid::parallel;

use super::chunk::SIDE;
use super::kind::{Block, KINDS};
use super::land::Land;
use super::levels::Levels;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;

/// The blocks of a window.
#[derive(Debug, Clone)]
pub struct BlockVolume {
    /// The window, with one column of blocks per sample.
    pub window: Window,
    /// The levels.
    pub levels: Levels,
    /// Numbers of kinds: level by level from the bottom, each level row by row from the north.
    pub blocks: Vec<u8>,
    /// The world's sea level, in metres.
    pub sea_level: f64,
    /// The world's seed.
    pub seed: u64,
}

impl BlockVolume {
    /// Memory of the blocks of a window, in bytes.
    #[must_use]
    pub fn memory(window: &Window, levels: Levels) -> u64 {
        let rows = (window.width as u64).saturating_mul(levels.count as u64);
        // All blocks, and the blocks of one row of chunks.
        rows.saturating_mul(window.height as u64).saturating_add(rows.saturating_mul(2 * SIDE as u64))
    }

    /// Computes the blocks of a land. Levels of air at the top are omitted.
    ///
    /// # Errors
    /// If `progress` is cancelled.
    pub fn of(land: &Land, progress: &Progress) -> Result<BlockVolume> {
        let (window, levels) = (land.window, land.levels);
        let layer = window.len();
        let mut blocks = vec![Block::Air as u8; layer * levels.count];
        progress.expect(window.height as f64);
        // Chunks are aligned to a grid of the world, but any division gives the same blocks.
        for top in (0..window.height).step_by(SIDE) {
            progress.check()?;
            let height = SIDE.min(window.height - top);
            let part = |left: usize| {
                let width = SIDE.min(window.width - left);
                Window { x: window.x + left as i64, y: window.y + top as i64, width, height, cell: window.cell }
            };
            let lefts: Vec<usize> = (0..window.width).step_by(SIDE).collect();
            let chunks: Vec<Vec<u8>> = parallel::try_map(&lefts, |left| land.blocks(&part(*left)))?;
            for (left, chunk) in lefts.iter().zip(&chunks) {
                let width = part(*left).width;
                for (k, row) in chunk.chunks(width).enumerate() {
                    let start = k / height * layer + (top + k % height) * window.width + left;
                    blocks[start..start + width].copy_from_slice(row);
                }
            }
            progress.advance(height as f64);
        }
        let used = blocks.iter().rposition(|block| *block != Block::Air as u8).map_or(0, |last| last / layer + 1);
        blocks.truncate(used * layer);
        let levels = Levels { count: used, ..levels };
        Ok(BlockVolume { window, levels, blocks, sea_level: land.sea_level, seed: land.seed })
    }

    /// Number of blocks to the east, up and to the south.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        [self.window.width, self.levels.count, self.window.height]
    }

    /// The block at a column and row of the window and a level above the bottom; air outside.
    #[inline]
    #[must_use]
    pub fn block(&self, [column, row, level]: [i64; 3]) -> Block {
        let [width, count, height] = self.size();
        let is_inside = (0..width as i64).contains(&column)
            && (0..height as i64).contains(&row)
            && (0..count as i64).contains(&level);
        if !is_inside {
            return Block::Air;
        }
        Block::of(self.blocks[(level as usize * height + row as usize) * width + column as usize])
    }

    /// The level above the bottom of the highest solid block of a column that is not part of a tree. Open blocks below
    /// it are in a cave or below an overhang.
    #[must_use]
    pub fn ground(&self, [column, row]: [usize; 2]) -> Option<usize> {
        let is_ground = |level: &usize| {
            let block = self.block([column as i64, row as i64, *level as i64]);
            block.is_solid() && block < Block::Log
        };
        (0..self.levels.count).rev().find(is_ground)
    }

    /// Number of blocks of air in caves and below overhangs.
    #[must_use]
    pub fn enclosed(&self) -> u64 {
        let row = |row: usize| -> u64 {
            let columns = (0..self.window.width).filter_map(|column| Some((column, self.ground([column, row])?)));
            let free = |(column, ground): (usize, usize)| {
                let is_free = |level: &usize| self.block([column as i64, row as i64, *level as i64]) == Block::Air;
                (0..ground).filter(is_free).count() as u64
            };
            columns.map(free).sum()
        };
        parallel::map(0..self.window.height, row).into_iter().sum()
    }

    /// Number of blocks of each kind.
    #[must_use]
    pub fn counts(&self) -> [u64; KINDS.len()] {
        let mut counts = [0; KINDS.len()];
        for block in &self.blocks {
            counts[Block::of(*block) as usize] += 1;
        }
        counts
    }
}
