//! Blocks as a Luanti (Minetest) world: the map and its settings, and a mod with the nodes.
//!
//! The middle of the window is at x = z = 0, and the surface of the sea below y = 0. The nodes belong to the mod; in
//! games that have equivalent nodes, those are used instead.

use std::io::{self, Write};

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_io::format::luanti::{MAX_COORDINATE, NODES, SIDE, block, key, write_database};
use orogen_io::format::png::{self, Picture, Pixel};

use super::hash::hash;
use super::kind::{Block, KINDS};
use super::levels::Levels;
use super::light::daylight;
use super::volume::BlockVolume;

/// The files of a world, in the order in which they are put in place.
pub const FILES: [&str; 6] = [
    "worldmods/orogen_blocks/textures/orogen_blocks_grain.png",
    "worldmods/orogen_blocks/init.lua",
    "worldmods/orogen_blocks/mod.conf",
    "map_meta.txt",
    "world.mt",
    "map.sqlite",
];

/// A file that Luanti writes when it opens a world.
pub const OPENED: &str = "env_meta.txt";

/// The mod.
const MOD: &str = include_str!("orogen_blocks.lua");

/// Pixels along a side of the texture.
const TEXTURE: usize = 16;

/// A Luanti world with the position of its blocks.
pub struct LuantiWorld<'a> {
    volume: &'a BlockVolume,
    /// The node position of the north-west corner of the lowest level.
    start: [i64; 3],
    /// The map blocks with their keys.
    blocks: Vec<(i64, Vec<u8>)>,
}

impl<'a> LuantiWorld<'a> {
    /// Creates the world of these blocks.
    ///
    /// # Errors
    /// If the blocks do not fit into a Luanti world, or `progress` is cancelled.
    pub fn new(volume: &'a BlockVolume, progress: &Progress) -> Result<LuantiWorld<'a>> {
        let start = LuantiWorld::start(volume.size(), volume.levels, volume.sea_level, volume.window.cell)?;
        let mut world = LuantiWorld { volume, start, blocks: Vec::new() };
        world.blocks = world.map_blocks(progress)?;
        Ok(world)
    }

    /// The node position of the north-west corner of the lowest level, for a volume of this many blocks to the east, up
    /// and to the south.
    ///
    /// # Errors
    /// If the blocks do not fit into a Luanti world.
    pub fn start([width, count, height]: [usize; 3], levels: Levels, sea_level: f64, cell: f64) -> Result<[i64; 3]> {
        let bottom = i64::from(levels.bottom) - i64::from(Levels::of(sea_level, cell));
        let start = [-(width as i64 / 2), bottom, height as i64 - 1 - height as i64 / 2];
        let ends = [start[0] + width as i64, bottom + count as i64, height as i64];
        let is_inside = |at: &i64| at.abs() <= MAX_COORDINATE;
        if start.iter().chain(&ends).all(is_inside) {
            return Ok(start);
        }
        let message = format!(
            "a world of Luanti ends {MAX_COORDINATE} blocks from its middle, and this map has {width} x {height} columns from {bottom} to {} blocks above \
             the sea; use a smaller window or a larger cell",
            bottom + count as i64
        );
        Err(Error::new(ErrorKind::Request, message))
    }

    /// Memory for writing the world in addition to the blocks, in bytes: their light, and the map blocks.
    #[must_use]
    pub fn memory(blocks: u64) -> u64 {
        blocks.saturating_mul(2)
    }

    /// Writes one of the [`FILES`].
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write(&self, file: &str, out: &mut dyn Write, software: &str) -> io::Result<()> {
        match file.rsplit('/').next() {
            Some("map.sqlite") => write_database(out, &self.blocks),
            Some("world.mt") => write!(
                out,
                "# {software}\nbackend = sqlite3\nplayer_backend = sqlite3\nauth_backend = sqlite3\nmod_storage_backend = sqlite3\n\
                 world_name = Orogen\ngameid = minetest_game\ncreative_mode = true\nenable_damage = false\n\
                 load_mod_orogen_blocks = true\n"
            ),
            Some("map_meta.txt") => write!(
                out,
                "# {software}\nmg_name = singlenode\nseed = {}\nwater_level = 0\nmg_flags = light, nocaves, nodungeons, nodecorations, nobiomes, noores\nchunksize = 5\n[end_of_params]\n",
                self.volume.seed
            ),
            Some("mod.conf") => {
                write!(
                    out,
                    "# {software}\nname = orogen_blocks\ndescription = Blocks of a map of Orogen\noptional_depends = default, mcl_core\n"
                )
            }
            Some("init.lua") => self.write_mod(out, software),
            _ => write_texture(out),
        }
    }

    /// The node position of a block, with the coordinates of [`BlockVolume::block`].
    fn node(&self, [column, row, level]: [i64; 3]) -> [i64; 3] {
        [self.start[0] + column, self.start[1] + level, self.start[2] - row]
    }

    fn map_blocks(&self, progress: &Progress) -> Result<Vec<(i64, Vec<u8>)>> {
        let [width, count, height] = self.volume.size();
        let light = daylight(self.volume, progress)?;
        let side = SIDE as i64;
        let [low, high] = [self.node([0, height as i64 - 1, 0]), self.node([width as i64 - 1, 0, count as i64 - 1])];
        let blocks = |axis: usize| low[axis].div_euclid(side)..=high[axis].div_euclid(side);
        let places: Vec<[i64; 3]> =
            blocks(2).flat_map(|z| blocks(1).flat_map(move |y| blocks(0).map(move |x| [x, y, z]))).collect();
        let name = |node: u8| NAMES[usize::from(node)];
        progress.expect(places.len() as f64);
        let mut blocks: Vec<(i64, Vec<u8>)> = parallel::try_map(&places, |place| -> Result<(i64, Vec<u8>)> {
            let (mut nodes, mut lights) = ([Block::Air as u8; NODES], [15; NODES]);
            let mut is_underground = true;
            for at in 0..NODES {
                let [x, y, z] = [at % SIDE, at / SIDE % SIDE, at / SIDE / SIDE];
                let node = [0, 1, 2].map(|axis| place[axis] * side + [x, y, z][axis] as i64);
                let from = [node[0] - self.start[0], self.start[2] - node[2], node[1] - self.start[1]];
                nodes[at] = self.volume.block(from) as u8;
                lights[at] = light.at(from);
                is_underground &= lights[at] == 0;
            }
            progress.step(1.0)?;
            Ok((key(*place), block(&nodes, &lights, is_underground, &name)))
        })?;
        blocks.sort_unstable_by_key(|(key, _)| *key);
        Ok(blocks)
    }

    fn write_mod(&self, out: &mut dyn Write, software: &str) -> io::Result<()> {
        writeln!(out, "-- {software}\nlocal kinds = {{")?;
        for kind in &KINDS[1..] {
            let games: Vec<String> = kind.luanti.iter().map(|name| format!("{name:?}")).collect();
            let [red, green, blue] = kind.color;
            writeln!(
                out,
                "    {{ name = {:?}, color = \"#{red:02x}{green:02x}{blue:02x}\", games = {{ {} }} }},",
                kind.name,
                games.join(", ")
            )?;
        }
        let [x, y, z] = self.spawn();
        writeln!(out, "}}\nlocal spawn = {{ x = {x}, y = {y}, z = {z} }}\n{MOD}")
    }

    /// The start position of players: above the dry ground nearest to the middle of the map, or above the middle if all
    /// ground is wet.
    fn spawn(&self) -> [i64; 3] {
        let [width, count, height] = self.volume.size().map(|side| side as i64);
        let top = |column: i64, row: i64| {
            let level = (0..count).rev().find(|level| self.volume.block([column, row, *level]) != Block::Air)?;
            let block = self.volume.block([column, row, level]);
            (!matches!(block, Block::Water | Block::Leaves | Block::Needles)).then_some(level)
        };
        let middle = [width / 2, height / 2];
        let rings = 0..width.max(height);
        let near = rings.step_by(4).flat_map(|ring| {
            let steps = [
                [ring, 0],
                [-ring, 0],
                [0, ring],
                [0, -ring],
                [ring, ring],
                [-ring, ring],
                [ring, -ring],
                [-ring, -ring],
            ];
            steps.map(|[east, south]| [middle[0] + east, middle[1] + south])
        });
        let found = near.filter_map(|[column, row]| Some([column, row, top(column, row)?])).next();
        let [x, y, z] = self.node(found.unwrap_or([middle[0], middle[1], count]));
        [x, y + 1, z]
    }
}

/// Node names, indexed by number.
const NAMES: [&str; KINDS.len()] = [
    "air",
    "orogen_blocks:water",
    "orogen_blocks:ice",
    "orogen_blocks:snow",
    "orogen_blocks:grass",
    "orogen_blocks:dry_grass",
    "orogen_blocks:litter",
    "orogen_blocks:dirt",
    "orogen_blocks:sand",
    "orogen_blocks:sandstone",
    "orogen_blocks:gravel",
    "orogen_blocks:clay",
    "orogen_blocks:stone",
    "orogen_blocks:coal_ore",
    "orogen_blocks:iron_ore",
    "orogen_blocks:gold_ore",
    "orogen_blocks:log",
    "orogen_blocks:leaves",
    "orogen_blocks:needles",
];

/// Writes the texture of all nodes: grain, which the mod multiplies by the color of each node.
fn write_texture(out: &mut dyn Write) -> io::Result<()> {
    let grain = |at: usize| 255 - (hash(9, [(at % TEXTURE) as i64, (at / TEXTURE) as i64, 0]) % 48) as u8;
    png::write(out, &Picture::new(TEXTURE, TEXTURE, Pixel::Grey8), |rows, bytes| {
        let first = rows.start * TEXTURE;
        bytes.iter_mut().enumerate().for_each(|(k, byte)| *byte = grain(first + k));
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_kinds() {
        assert_eq!(NAMES[0], KINDS[0].name);
        for (name, kind) in NAMES.iter().zip(KINDS).skip(1) {
            assert_eq!(*name, format!("orogen_blocks:{}", kind.name));
        }
    }
}
