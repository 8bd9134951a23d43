//! Blocks as a Sponge schematic.

use std::io::{self, Write};

use orogen_io::format::schem::{Schematic, write};

use super::kind::KINDS;
use super::levels::Levels;
use super::volume::BlockVolume;

/// The level of Minecraft whose top is the surface of the sea.
const SEA: i32 = 62;

/// Writes the blocks. Pasted at 0, 0, 0, the sea has the level of the seas of Minecraft.
///
/// # Errors
/// If `out` fails, or it has more blocks than the format holds.
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
