//! Blocks as a MagicaVoxel scene.

use std::io::{self, Write};

use orogen_io::format::vox::{Scene, write};

use super::kind::{Block, KINDS};
use super::volume::BlockVolume;

/// Writes the blocks. The color index of a voxel is the number of its kind; x points east, y north and z up.
///
/// # Errors
/// If `out` fails, or the file would exceed 4 GiB.
pub fn write_vox(out: &mut dyn Write, volume: &BlockVolume) -> io::Result<()> {
    let [width, count, height] = volume.size();
    let palette: Vec<[u8; 4]> =
        KINDS[1..].iter().map(|kind| [kind.color[0], kind.color[1], kind.color[2], 255]).collect();
    let voxel = |[x, y, z]: [usize; 3]| match volume.block([x as i64, (height - 1 - y) as i64, z as i64]) {
        Block::Air => 0,
        block => block as u8,
    };
    write(out, &Scene { size: [width, height, count], palette: &palette, voxel: &voxel })
}
