//! Daylight in and around blocks, for files that store it.

use super::kind::Block;
use super::volume::BlockVolume;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;

/// Light in the open, the maximum.
const SUN: u8 = 15;

/// The light of each block, 0 to 15.
pub(super) struct Daylight<'a> {
    volume: &'a BlockVolume,
    light: Vec<u8>,
}

/// Computes the daylight. Light falls from above through air at full strength. From there it spreads in all directions
/// through air, water and leaves, and loses one level per block.
///
/// Fails if `progress` is cancelled.
pub(super) fn daylight<'a>(volume: &'a BlockVolume, progress: &Progress) -> Result<Daylight<'a>> {
    let [width, count, height] = volume.size();
    let layer = width * height;
    let mut light = vec![0u8; volume.blocks.len()];
    let is_clear =
        |at: usize| matches!(Block::of(volume.blocks[at]), Block::Air | Block::Water | Block::Leaves | Block::Needles);
    for column in 0..layer {
        for level in (0..count).rev() {
            let at = level * layer + column;
            if volume.blocks[at] != Block::Air as u8 {
                break;
            }
            light[at] = SUN;
        }
    }
    for level in (1..SUN).rev() {
        progress.check()?;
        for at in 0..light.len() {
            if light[at] > level || !is_clear(at) {
                continue;
            }
            let (x, y) = (at % width, at / width % height);
            let from = |is_inside: bool, there: usize| is_inside && light[there] == level + 1;
            let is_reached = from(x > 0, at.wrapping_sub(1))
                || from(x + 1 < width, at + 1)
                || from(y > 0, at.wrapping_sub(width))
                || from(y + 1 < height, at + width)
                || from(at >= layer, at.wrapping_sub(layer))
                || from(at + layer < light.len(), at + layer);
            if is_reached {
                light[at] = level;
            }
        }
    }
    Ok(Daylight { volume, light })
}

impl Daylight<'_> {
    /// The light of a block, with the coordinates of [`BlockVolume::block`]. Outside the volume it is full light at the
    /// sides and above, and dark below.
    pub(super) fn at(&self, [column, row, level]: [i64; 3]) -> u8 {
        let [width, count, height] = self.volume.size();
        let is_inside = (0..width as i64).contains(&column) && (0..height as i64).contains(&row);
        match level {
            level if level < 0 => 0,
            level if is_inside && level < count as i64 => {
                self.light[(level as usize * height + row as usize) * width + column as usize]
            }
            _ => SUN,
        }
    }
}
