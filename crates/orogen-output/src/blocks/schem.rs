//! Blocks as a Sponge schematic.

use std::io::{self, Write};

use orogen_io::format::schem::{Schematic, write};

use super::kind::KINDS;
use super::levels::Levels;
use super::volume::BlockVolume;

/// The Minecraft level whose top is the surface of the sea.
const SEA: i32 = 62;

/// Writes the blocks. When the schematic is pasted at 0, 0, 0, the sea is at Minecraft's sea level.
///
/// # Errors
/// If `out` fails, or there are more blocks than the format can hold.
pub fn write_schem(out: &mut dyn Write, volume: &BlockVolume) -> io::Result<()> {
    let sea = Levels::of(volume.sea_level, volume.window.cell);
    let palette = KINDS.map(|kind| kind.minecraft);
    let up = volume.levels.bottom.saturating_sub(sea).saturating_add(SEA + 1);
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
