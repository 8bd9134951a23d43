//! The blocks of columns: surface, soil, stone, ore, water and trees.

use super::cover::{Cover, MAX_THICKNESS};
use super::hash::{hash, share};
use super::kind::Block;
use super::land::{Column, Land};
use super::levels::Levels;
use super::reach::{ABOVE, CEILING, SOIL_REACH};
use super::solid::Solid;
use super::trees;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;

/// Columns along a side of a chunk.
pub const SIDE: usize = 16;

/// How far below the ground, in blocks, open space is filled with water.
const WATER_REACH: i32 = 4;

/// Ores: the block, the share of veins (0 to 1), and the minimum depth below the ground in blocks.
const ORES: [(Block, f64, i32); 3] = [(Block::Coal, 0.012, 4), (Block::Iron, 0.008, 12), (Block::Gold, 0.003, 28)];

/// Share of the blocks of a vein that are ore, in quarters.
const RICH: u64 = 3;

impl Land {
    /// The blocks of a part of the window, as numbers of kinds: level by level from the bottom, each level row by row
    /// from the north.
    ///
    /// They are the same in any land that contains the part, whatever the levels of that land.
    ///
    /// # Errors
    /// If the part is not in the window.
    pub fn blocks(&self, part: &Window) -> Result<Vec<u8>> {
        if !self.window.contains(part) {
            return Err(Error::new(ErrorKind::Request, "the part is not inside the window of this land"));
        }
        Ok(fill(self, part))
    }
}

/// The blocks of a part of a land.
pub(super) fn fill(land: &Land, part: &Window) -> Vec<u8> {
    let levels = land.levels;
    let layer = part.width * part.height;
    let mut blocks = vec![Block::Air as u8; layer * levels.count];
    let mut solid = Solid::default();
    for row in 0..part.height {
        for across in 0..part.width {
            let at = [part.x + across as i64, part.y + row as i64];
            let place = row * part.width + across;
            each(land, at, &mut solid, |level, block| {
                blocks[(level - levels.bottom) as usize * layer + place] = block as u8;
            });
        }
    }
    for tree in trees::around(land, part) {
        tree.each(|[x, y], level, block| {
            let (x, y, z) = (x - part.x, y - part.y, i64::from(level) - i64::from(levels.bottom));
            let is_inside = (0..part.width as i64).contains(&x)
                && (0..part.height as i64).contains(&y)
                && (0..levels.count as i64).contains(&z);
            if is_inside {
                let there = &mut blocks[z as usize * layer + y as usize * part.width + x as usize];
                // Where two crowns meet, logs are kept.
                if *there == Block::Air as u8
                    || block == Block::Log && *there != Block::Log as u8 && *there >= Block::Leaves as u8
                {
                    *there = block as u8;
                }
            }
        });
    }
    blocks
}

/// Calls a function for each block of a column that is not air, from the top. Trees are not included.
fn each<'a>(land: &'a Land, at: [i64; 2], solid: &mut Solid<'a>, mut visit: impl FnMut(i32, Block)) {
    let Some(column) = land.column(at[0], at[1]) else { return };
    if column.height.is_nan() {
        return;
    }
    let (levels, cell) = (land.levels, land.window.cell);
    let ground = column.ground(cell);
    solid.begin(land, column, at);
    // Counters from the top: depth below the current surface, open levels above it, and levels of water.
    let (mut depth, mut free, mut water) = (0, CEILING, 0);
    let mut has_soil = false;
    for level in (levels.bottom..levels.top() + ABOVE).rev() {
        if !solid.at(level) {
            let is_wet = Levels::middle(level, cell) < f64::from(column.water) && level >= ground - WATER_REACH;
            water = if is_wet { water + 1 } else { 0 };
            (depth, free) = (0, free + 1);
            if is_wet && level < levels.top() {
                visit(level, Block::Water);
            }
            continue;
        }
        if depth == 0 {
            has_soil = free >= CEILING && level >= ground - SOIL_REACH;
            water = water_above(water, level, column, cell);
        }
        if level < levels.top() {
            let soil = if has_soil && depth < MAX_THICKNESS { column.block(depth, water, at, land.seed) } else { None };
            visit(level, soil.unwrap_or_else(|| rock(land.seed, at, level, ground - level)));
        }
        (depth, free) = (depth + 1, 0);
    }
}

/// The depth of the water above a surface, in blocks: 0 if `counted` is 0, otherwise at least 1, computed from the
/// water level instead of from the counted levels.
fn water_above(counted: i32, surface: i32, column: &Column, cell: f64) -> i32 {
    if counted == 0 { 0 } else { (Levels::of(f64::from(column.water), cell) - surface).max(1) }
}

impl Column {
    /// The block of the soil `depth` blocks below the surface; `None` below the soil.
    fn block(&self, depth: i32, water: i32, at: [i64; 2], seed: u64) -> Option<Block> {
        // Rocks that rise out of the water are bare.
        let cover = match self.cover {
            Cover::Bed if water == 0 && self.height < self.water => Cover::Beach,
            cover => cover,
        };
        cover.block(depth, water, at, seed)
    }
}

/// Stone, or ore in veins of two blocks along a side.
fn rock(seed: u64, [x, y]: [i64; 2], level: i32, depth: i32) -> Block {
    let z = i64::from(level);
    let vein = share(hash(seed ^ 0x0E, [x >> 1, y >> 1, z >> 1]));
    let mut from = 0.0;
    for (ore, part, least) in ORES {
        if vein < from + part {
            let is_ore = depth >= least && hash(seed ^ 0x0F, [x, y, z]) & 3 < RICH;
            return if is_ore { ore } else { Block::Stone };
        }
        from += part;
    }
    Block::Stone
}
