//! `level.dat`: the settings of a save.

use std::io::{self, Write};

use orogen_io::format::gzip;
use orogen_io::format::nbt::{DATA_VERSION, GAME_VERSION, Tags};

use super::biome::VOID;

/// The version of the layout of a save: Anvil.
const ANVIL: i32 = 19133;

/// Noon, in ticks of a day.
const NOON: i64 = 6000;

/// The settings of a save.
#[derive(Debug, Clone, Copy)]
pub struct LevelSettings<'a> {
    /// The name of the world; one that is not ASCII is replaced.
    pub name: &'a str,
    /// The seed.
    pub seed: u64,
    /// Where players start.
    pub spawn: [i32; 3],
}

/// Writes `level.dat`: creative mode, and a flat world without layers around the land.
///
/// # Errors
/// If `out` fails.
pub fn write_level(out: &mut dyn Write, level: &LevelSettings) -> io::Result<()> {
    let mut packer = gzip::start(out)?;
    let mut tags = Tags::new(&mut packer);
    tags.compound("")?;
    tags.compound("Data")?;
    tags.int("version", ANVIL)?;
    tags.int("DataVersion", DATA_VERSION)?;
    tags.compound("Version")?;
    tags.int("Id", DATA_VERSION)?;
    tags.string("Name", GAME_VERSION)?;
    tags.string("Series", "main")?;
    tags.byte("Snapshot", 0)?;
    tags.end()?;
    tags.string("LevelName", if level.name.is_ascii() { level.name } else { "Orogen" })?;
    tags.int("GameType", 1)?;
    tags.byte("Difficulty", 2)?;
    for (name, is_set) in
        [("DifficultyLocked", 0), ("hardcore", 0), ("allowCommands", 1), ("initialized", 1), ("WasModded", 0)]
    {
        tags.byte(name, is_set)?;
    }
    for (name, at) in ["SpawnX", "SpawnY", "SpawnZ"].into_iter().zip(level.spawn) {
        tags.int(name, at)?;
    }
    tags.float("SpawnAngle", 0.0)?;
    tags.long("Time", 0)?;
    tags.long("DayTime", NOON)?;
    tags.long("LastPlayed", 0)?;
    for name in ["clearWeatherTime", "rainTime", "thunderTime"] {
        tags.int(name, 0)?;
    }
    tags.byte("raining", 0)?;
    tags.byte("thundering", 0)?;
    tags.compound("GameRules")?;
    tags.end()?;
    tags.compound("DataPacks")?;
    tags.strings("Enabled", &["vanilla"])?;
    tags.strings("Disabled", &[])?;
    tags.end()?;
    write_generators(&mut tags, level.seed)?;
    tags.end()?;
    tags.end()?;
    gzip::finish(packer)
}

/// Writes how the game makes chunks that the save does not have.
fn write_generators(tags: &mut Tags, seed: u64) -> io::Result<()> {
    tags.compound("WorldGenSettings")?;
    tags.long("seed", seed as i64)?;
    tags.byte("generate_features", 0)?;
    tags.byte("bonus_chest", 0)?;
    tags.compound("dimensions")?;
    tags.compound("minecraft:overworld")?;
    tags.string("type", "minecraft:overworld")?;
    tags.compound("generator")?;
    tags.string("type", "minecraft:flat")?;
    tags.compound("settings")?;
    tags.string("biome", VOID)?;
    tags.byte("features", 0)?;
    tags.byte("lakes", 0)?;
    tags.strings("structure_overrides", &[])?;
    tags.compounds("layers", 1)?;
    tags.string("block", "minecraft:air")?;
    tags.int("height", 1)?;
    (0..4).try_for_each(|_| tags.end())?;
    // The other dimensions are the game's own.
    for (name, source, preset) in
        [("the_nether", "multi_noise", Some("minecraft:nether")), ("the_end", "the_end", None)]
    {
        let settings = if preset.is_some() { "minecraft:nether" } else { "minecraft:end" };
        tags.compound(&format!("minecraft:{name}"))?;
        tags.string("type", &format!("minecraft:{name}"))?;
        tags.compound("generator")?;
        tags.string("type", "minecraft:noise")?;
        tags.string("settings", settings)?;
        tags.compound("biome_source")?;
        tags.string("type", &format!("minecraft:{source}"))?;
        if let Some(preset) = preset {
            tags.string("preset", preset)?;
        }
        (0..3).try_for_each(|_| tags.end())?;
    }
    tags.end()?;
    tags.end()
}
