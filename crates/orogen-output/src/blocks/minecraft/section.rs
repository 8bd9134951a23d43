//! Sections of chunks: 16 x 16 x 16 blocks, and 4 x 4 x 4 cells of a biome each.

use std::io;

use orogen_io::format::anvil::{packed_longs, palette_bits};
use orogen_io::format::nbt::Tags;

use super::super::kind::KINDS;

/// Number of blocks of a section.
pub const BLOCKS: usize = 4096;

/// The number of bedrock, which is no kind of block of ours.
pub const BEDROCK: u8 = KINDS.len() as u8;

/// Number of cells of a biome along a side of a section.
pub const CELLS: usize = 4;

/// The minimum number of bits of the index of a block.
const MIN_BITS: u32 = 4;

/// The block state of a number.
fn state(number: u8) -> &'static str {
    KINDS.get(usize::from(number)).map_or("minecraft:bedrock", |kind| kind.minecraft)
}

/// Writes the blocks of a section, from the lowest layer, each row by row from the north, as a palette and indices.
pub fn write_blocks(tags: &mut Tags, blocks: &[u8]) -> io::Result<()> {
    let mut index = [None; BEDROCK as usize + 1];
    let mut palette = Vec::new();
    let mut numbers = Vec::with_capacity(BLOCKS);
    for block in blocks {
        let at = *index[usize::from((*block).min(BEDROCK))].get_or_insert_with(|| {
            palette.push(state(*block));
            palette.len() as u16 - 1
        });
        numbers.push(at);
    }
    tags.compound("block_states")?;
    tags.compounds("palette", palette.len())?;
    for state in &palette {
        write_state(tags, state)?;
    }
    if palette.len() > 1 {
        tags.longs("data", &packed_longs(&numbers, palette_bits(palette.len()).max(MIN_BITS)))?;
    }
    tags.end()
}

/// Writes a block state such as `minecraft:water[level=0]` as its name and its properties.
fn write_state(tags: &mut Tags, state: &str) -> io::Result<()> {
    let (name, properties) = state.split_once('[').unwrap_or((state, ""));
    tags.string("Name", name)?;
    if !properties.is_empty() {
        tags.compound("Properties")?;
        for (key, value) in properties.trim_end_matches(']').split(',').filter_map(|part| part.split_once('=')) {
            tags.string(key, value)?;
        }
        tags.end()?;
    }
    tags.end()
}

/// Writes the biomes of a section: the same in all of its layers, for each cell row by row from the north.
pub fn write_biomes(tags: &mut Tags, biomes: &[&'static str; CELLS * CELLS]) -> io::Result<()> {
    let mut palette: Vec<&str> = Vec::new();
    let layer = biomes.map(|biome| {
        let known = palette.iter().position(|entry| *entry == biome);
        known.unwrap_or_else(|| {
            palette.push(biome);
            palette.len() - 1
        }) as u16
    });
    tags.compound("biomes")?;
    tags.strings("palette", &palette)?;
    if palette.len() > 1 {
        tags.longs("data", &packed_longs(&layer.repeat(CELLS), palette_bits(palette.len())))?;
    }
    tags.end()
}
