//! Sponge schematics, version 3: blocks for Minecraft: Java Edition, which WorldEdit and other programs can paste.
//!
//! Follows the Sponge Schematic Specification, version 3 (2021): NBT in gzip. Blocks are indices into a palette of
//! block states, in the order y, z, x. Each index is a varint, which has one byte for the palettes here. x points east,
//! y up and z south.

use std::io::{self, Write};

use orogen_grid::error::{Error, ErrorKind, Result};

use super::gzip;
use super::nbt::{DATA_VERSION, Tags};

/// Maximum number of blocks along a side, because sizes are unsigned 16-bit numbers.
pub const MAX_SIDE: usize = u16::MAX as usize;

/// Maximum number of entries of a palette, so that each index takes one byte.
const MAX_PALETTE: usize = 128;

/// A box of blocks.
#[derive(Debug, Clone, Copy)]
pub struct Schematic<'a> {
    /// Number of blocks to the east, up and to the south.
    pub size: [usize; 3],
    /// Position of the first block relative to the position at which the schematic is pasted.
    pub offset: [i32; 3],
    /// The name of each block state, such as `minecraft:stone`; at most 128 names.
    pub palette: &'a [&'a str],
    /// The index of each block in the palette, in the order y, z, x.
    pub blocks: &'a [u8],
    /// The name of the schematic, in ASCII.
    pub name: &'a str,
}

/// Checks that a schematic can have this size.
///
/// # Errors
/// If a side has more than 65535 blocks, or if there are more than 2^31 - 1 blocks in total.
pub fn check(size: [usize; 3]) -> Result<()> {
    let count = size.iter().fold(1u64, |count, side| count.saturating_mul(*side as u64));
    if size.iter().all(|side| *side <= MAX_SIDE) && count <= i32::MAX as u64 {
        return Ok(());
    }
    let [width, height, length] = size;
    let message = format!(
        "a .schem file holds at most {MAX_SIDE} blocks along each side and 2147483647 in all, and this map has {width} x {length} columns of {height}; \
         use a smaller window or a larger cell"
    );
    Err(Error::new(ErrorKind::Request, message))
}

/// Writes a schematic.
///
/// # Errors
/// If `out` fails, if the schematic is [too large](check), or if the palette or the blocks do not match it.
pub fn write(out: &mut dyn Write, schematic: &Schematic) -> io::Result<()> {
    let Schematic { size, offset, palette, blocks, name } = *schematic;
    check(size)?;
    if blocks.len() != size.iter().product::<usize>() || palette.len() > MAX_PALETTE {
        return Err(io::Error::other("the blocks or the palette do not fit the schematic"));
    }
    let mut packer = gzip::start(out)?;
    let mut tags = Tags::new(&mut packer);
    tags.compound("")?;
    tags.compound("Schematic")?;
    tags.int("Version", 3)?;
    tags.int("DataVersion", DATA_VERSION)?;
    tags.compound("Metadata")?;
    tags.string("Name", name)?;
    tags.end()?;
    for (key, side) in ["Width", "Height", "Length"].into_iter().zip(size) {
        tags.short(key, side as u16)?;
    }
    tags.ints("Offset", &offset)?;
    tags.compound("Blocks")?;
    tags.compound("Palette")?;
    for (number, state) in palette.iter().enumerate() {
        tags.int(state, number as i32)?;
    }
    tags.end()?;
    tags.bytes("Data", blocks)?;
    tags.empty_list("BlockEntities")?;
    tags.end()?;
    tags.end()?;
    tags.end()?;
    gzip::finish(packer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_holds_its_tags() {
        let blocks = [0, 1, 1, 0, 1, 0];
        let palette = ["minecraft:air", "minecraft:stone"];
        let schematic =
            Schematic { size: [3, 2, 1], offset: [-1, 64, 0], palette: &palette, blocks: &blocks, name: "a" };
        let mut bytes = Vec::new();
        write(&mut bytes, &schematic).unwrap();
        let plain = miniz_oxide::inflate::decompress_to_vec(&bytes[10..bytes.len() - 8]).unwrap();
        let holds = |part: &[u8]| plain.windows(part.len()).any(|found| found == part);
        assert!(plain.starts_with(b"\x0a\0\0\x0a\0\x09Schematic\x03\0\x07Version\0\0\0\x03"));
        assert!(
            holds(b"\x02\0\x05Width\0\x03") && holds(b"\x02\0\x06Height\0\x02") && holds(b"\x02\0\x06Length\0\x01")
        );
        assert!(holds(b"\x03\0\x0fminecraft:stone\0\0\0\x01"));
        assert!(holds(b"\x07\0\x04Data\0\0\0\x06\0\x01\x01\0\x01\0\x09"));
        assert!(plain.ends_with(b"\0\0\0\0\0\0\0"), "an empty list and the ends of three compounds");
        assert!(write(&mut Vec::new(), &Schematic { blocks: &blocks[1..], ..schematic }).is_err());
    }

    #[test]
    fn what_is_too_large_is_refused() {
        assert!(check([65535, 10, 3000]).is_ok());
        let error = check([65536, 1, 1]).unwrap_err().to_string();
        assert!(error.contains("65536 x 1 columns of 1;"), "{error}");
        assert!(check([60000, 100, 60000]).is_err());
    }
}
