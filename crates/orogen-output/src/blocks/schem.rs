//! Blocks as a Sponge schematic.

use std::io::{self, Write};

use orogen_io::format::schem::{Schematic, write};

use super::kind::KINDS;
use super::minecraft::placement::Placement;
use super::volume::BlockVolume;

/// Writes the blocks. When the schematic is pasted at 0, 0, 0, the uppermost block of the sea is at `sea_y`.
///
/// # Errors
/// If `out` fails, or there are more blocks than the format can hold.
pub fn write_schem(out: &mut dyn Write, volume: &BlockVolume, sea_y: i32) -> io::Result<()> {
    let placement = Placement::new(volume.sea_level, volume.window.cell, sea_y);
    let palette = KINDS.map(|kind| kind.minecraft);
    let up = volume.levels.bottom.saturating_add(placement.up);
    write(
        out,
        &Schematic {
            size: volume.size(),
            offset: [0, up, 0],
            palette: &palette,
            blocks: &volume.blocks,
            name: "Orogen",
        },
    )
}
