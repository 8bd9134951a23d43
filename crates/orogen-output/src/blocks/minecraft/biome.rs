//! The biomes of Minecraft that resemble the cover of columns.

use super::super::cover::Cover;
use super::super::land::Column;

/// Depth of water, in blocks, from which the sea is deep.
const DEEP: i32 = 24;

/// The biome outside of the land.
pub const VOID: &str = "minecraft:the_void";

/// The biome of a column.
pub fn biome(column: Option<&Column>, cell: f64, sea_level: f64) -> &'static str {
    let Some(column) = column.filter(|column| column.height.is_finite()) else { return VOID };
    let depth = (f64::from(column.water) - f64::from(column.height)) / cell;
    let is_sea = depth > 0.0 && f64::from(column.water) <= sea_level;
    match column.cover {
        _ if is_sea && depth >= f64::from(DEEP) => "minecraft:deep_ocean",
        _ if is_sea => "minecraft:ocean",
        Cover::Bed => "minecraft:river",
        Cover::Beach => "minecraft:beach",
        Cover::Meadow => "minecraft:plains",
        Cover::Forest => "minecraft:forest",
        Cover::Rock => "minecraft:stony_peaks",
        Cover::Snow => "minecraft:snowy_plains",
        Cover::Desert => "minecraft:desert",
        Cover::Steppe => "minecraft:savanna",
        Cover::Taiga => "minecraft:taiga",
        Cover::Glacier => "minecraft:frozen_peaks",
    }
}
