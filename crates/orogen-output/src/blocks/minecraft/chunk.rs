//! Chunks: 16 x 16 columns of blocks as NBT.

use std::io;

use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_io::format::anvil::{COLUMNS, PackedChunk, packed_longs};
use orogen_io::format::nbt::{DATA_VERSION, Tags};

use super::super::kind::{Block, KINDS};
use super::super::land::Land;
use super::super::volume::BlockVolume;
use super::biome::biome;
use super::placement::{BOTTOM, TOP};
use super::section::{BEDROCK, BLOCKS, CELLS, write_biomes, write_blocks};
use super::spawn::Spawn;

/// Number of columns of a chunk.
const LAYER: usize = COLUMNS * COLUMNS;

/// Number of blocks above each other.
const HEIGHT: usize = (TOP - BOTTOM) as usize;

/// Bits of an entry of a height map.
const HEIGHT_BITS: u32 = 9;

/// Memory for making a chunk, in bytes: its blocks three times, and its NBT.
pub const CHUNK_BYTES: u64 = (4 * LAYER * HEIGHT) as u64;

/// A chunk that is made.
pub struct MinecraftChunk {
    /// The chunk as it is stored.
    pub packed: PackedChunk,
    /// Number of blocks of each kind.
    pub counts: [u64; KINDS.len()],
    /// Number of blocks of air in caves and below overhangs.
    pub enclosed: u64,
    /// The best place of the chunk to start at.
    pub spawn: Option<Spawn>,
}

impl MinecraftChunk {
    /// Makes the chunk at a position in chunks. Columns outside the window of the land have no blocks. The land must
    /// have the levels of a [`Placement`](super::placement::Placement). `middle` is the column that players start near.
    ///
    /// # Errors
    /// If the chunk has no column in the window, or is too large for a region file.
    pub fn of(land: &Land, [x, z]: [i64; 2], middle: [i64; 2]) -> Result<io::Result<MinecraftChunk>> {
        let side = COLUMNS as i64;
        let [left, top] = [x * side, z * side];
        let [from, to] = [
            [left.max(land.window.x), top.max(land.window.y)],
            [
                (left + side).min(land.window.x + land.window.width as i64),
                (top + side).min(land.window.y + land.window.height as i64),
            ],
        ];
        let part = Window {
            x: from[0],
            y: from[1],
            width: (to[0] - from[0]) as usize,
            height: (to[1] - from[1]) as usize,
            ..land.window
        };
        let volume = BlockVolume {
            window: part,
            levels: land.levels,
            blocks: land.blocks(&part)?,
            sea_level: land.sea_level,
            seed: land.seed,
        };
        let mut blocks = vec![Block::Air as u8; LAYER * HEIGHT];
        let start = (from[1] - top) as usize * COLUMNS + (from[0] - left) as usize;
        for (row, own) in volume.blocks.chunks(part.width).enumerate() {
            let at = row / part.height * LAYER + row % part.height * COLUMNS + start;
            blocks[at..at + part.width].copy_from_slice(own);
        }
        let spawn = Spawn::of(&blocks, [left, top], middle);
        for block in blocks[..LAYER].iter_mut().filter(|block| Block::of(**block).is_solid()) {
            *block = BEDROCK;
        }
        Ok(tags(land, [x, z], &blocks).and_then(|tags| {
            Ok(MinecraftChunk {
                packed: PackedChunk::of(&tags)?,
                counts: volume.counts(),
                enclosed: volume.enclosed(),
                spawn,
            })
        }))
    }
}

/// The tags of a chunk.
fn tags(land: &Land, [x, z]: [i64; 2], blocks: &[u8]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut tags = Tags::new(&mut bytes);
    tags.compound("")?;
    tags.int("DataVersion", DATA_VERSION)?;
    tags.int("xPos", x as i32)?;
    tags.int("yPos", BOTTOM / COLUMNS as i32)?;
    tags.int("zPos", z as i32)?;
    tags.string("Status", "minecraft:full")?;
    tags.long("LastUpdate", 0)?;
    tags.long("InhabitedTime", 0)?;
    // The game computes the light.
    tags.byte("isLightOn", 0)?;
    let biomes: [&str; CELLS * CELLS] = std::array::from_fn(|at| {
        let cell = |index: usize| (index * CELLS + CELLS / 2) as i64;
        let column = land.column(x * COLUMNS as i64 + cell(at % CELLS), z * COLUMNS as i64 + cell(at / CELLS));
        biome(column, land.window.cell, land.sea_level)
    });
    tags.compounds("sections", HEIGHT / COLUMNS)?;
    for (section, blocks) in (BOTTOM / COLUMNS as i32..).zip(blocks.chunks(BLOCKS)) {
        tags.byte("Y", section as u8)?;
        write_blocks(&mut tags, blocks)?;
        write_biomes(&mut tags, &biomes)?;
        tags.end()?;
    }
    tags.compound("Heightmaps")?;
    for (name, counts) in HEIGHT_MAPS {
        tags.longs(name, &packed_longs(&height_map(blocks, counts), HEIGHT_BITS))?;
    }
    tags.end()?;
    for name in ["block_entities", "block_ticks", "fluid_ticks"] {
        tags.empty_list(name)?;
    }
    tags.compound("structures")?;
    for name in ["References", "starts"] {
        tags.compound(name)?;
        tags.end()?;
    }
    tags.end()?;
    tags.end()?;
    Ok(bytes)
}

/// Whether a block stops what a height map is of.
type Stops = fn(Block) -> bool;

/// The height maps, with the blocks that count in each; bedrock counts like stone.
const HEIGHT_MAPS: [(&str, Stops); 4] = [
    ("MOTION_BLOCKING", |block| block != Block::Air),
    ("MOTION_BLOCKING_NO_LEAVES", |block| !matches!(block, Block::Air | Block::Leaves | Block::Needles)),
    ("OCEAN_FLOOR", Block::is_solid),
    ("WORLD_SURFACE", |block| block != Block::Air),
];

/// For each column, the number of blocks from the bottom of the world to the highest block that counts.
fn height_map(blocks: &[u8], counts: fn(Block) -> bool) -> Vec<u16> {
    let is_counted = |block: u8| counts(if block == BEDROCK { Block::Stone } else { Block::of(block) });
    let height = |column: usize| (0..HEIGHT).rev().find(|level| is_counted(blocks[level * LAYER + column]));
    (0..LAYER).map(|column| height(column).map_or(0, |level| level as u16 + 1)).collect()
}
