//! The place where players start.

use orogen_io::format::anvil::COLUMNS;

use super::super::kind::Block;
use super::placement::{BOTTOM, SEA_Y};

/// A column of dry ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spawn {
    /// The square of the distance to the middle of the map, in blocks.
    distance: i64,
    /// The block above the ground: z, x and y.
    at: [i64; 3],
}

impl Spawn {
    /// The dry ground of a chunk that is nearest to the middle. `corner` is the north-west column of the chunk.
    pub(super) fn of(blocks: &[u8], corner: [i64; 2], middle: [i64; 2]) -> Option<Spawn> {
        let layer = COLUMNS * COLUMNS;
        let spawn = |column: usize| {
            let top =
                (0..blocks.len() / layer).rev().find(|level| blocks[level * layer + column] != Block::Air as u8)?;
            let block = Block::of(blocks[top * layer + column]);
            let [x, z] = [corner[0] + (column % COLUMNS) as i64, corner[1] + (column / COLUMNS) as i64];
            let [east, south] = [x - middle[0], z - middle[1]];
            let y = i64::from(BOTTOM) + top as i64 + 1;
            (block.is_solid() && block < Block::Log)
                .then_some(Spawn { distance: east * east + south * south, at: [z, x, y] })
        };
        (0..layer).filter_map(spawn).min()
    }

    /// The position x, y, z of a player, or that above the sea in the middle if there is no dry ground.
    #[must_use]
    pub fn position(spawn: Option<Spawn>, middle: [i64; 2]) -> [i32; 3] {
        let [z, x, y] = spawn.map_or([middle[1], middle[0], i64::from(SEA_Y) + 1], |spawn| spawn.at);
        [x as i32, y as i32, z as i32]
    }
}
