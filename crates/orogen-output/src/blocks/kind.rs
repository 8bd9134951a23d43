//! The kinds of blocks.

/// A kind of block. Files store its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Block {
    Air,
    Water,
    Ice,
    Snow,
    Grass,
    DryGrass,
    Litter,
    Dirt,
    Sand,
    Sandstone,
    Gravel,
    Clay,
    Stone,
    Coal,
    Iron,
    Gold,
    Log,
    Leaves,
    Needles,
}

/// How a kind of block is represented in files.
#[derive(Debug, Clone, Copy)]
pub struct BlockKind {
    /// The kind.
    pub block: Block,
    /// Its name in texts, and its node name after `orogen_blocks:` in Luanti.
    pub name: &'static str,
    /// Its color, sRGB.
    pub color: [u8; 3],
    /// Its block state in Minecraft: Java Edition.
    pub minecraft: &'static str,
    /// Equivalent nodes of Luanti games, in order of preference: the first that exists is used, otherwise a node of
    /// this color.
    pub luanti: &'static [&'static str],
}

const fn kind(
    block: Block,
    name: &'static str,
    color: [u8; 3],
    minecraft: &'static str,
    luanti: &'static [&'static str],
) -> BlockKind {
    BlockKind { block, name, color, minecraft, luanti }
}

/// All kinds, indexed by their numbers.
pub const KINDS: [BlockKind; 19] = [
    kind(Block::Air, "air", [255, 255, 255], "minecraft:air", &[]),
    kind(
        Block::Water,
        "water",
        [58, 110, 176],
        "minecraft:water[level=0]",
        &["default:water_source", "mcl_core:water_source"],
    ),
    kind(Block::Ice, "ice", [165, 205, 235], "minecraft:packed_ice", &["default:ice", "mcl_core:ice"]),
    kind(Block::Snow, "snow", [242, 246, 250], "minecraft:snow_block", &["default:snowblock", "mcl_core:snowblock"]),
    kind(
        Block::Grass,
        "grass",
        [104, 158, 66],
        "minecraft:grass_block[snowy=false]",
        &["default:dirt_with_grass", "mcl_core:dirt_with_grass"],
    ),
    kind(
        Block::DryGrass,
        "dry_grass",
        [176, 160, 84],
        "minecraft:coarse_dirt",
        &["default:dry_dirt_with_dry_grass", "mcl_core:coarse_dirt"],
    ),
    kind(
        Block::Litter,
        "litter",
        [104, 92, 50],
        "minecraft:podzol[snowy=false]",
        &["default:dirt_with_coniferous_litter", "mcl_core:podzol"],
    ),
    kind(Block::Dirt, "dirt", [124, 90, 60], "minecraft:dirt", &["default:dirt", "mcl_core:dirt"]),
    kind(Block::Sand, "sand", [222, 206, 150], "minecraft:sand", &["default:sand", "mcl_core:sand"]),
    kind(
        Block::Sandstone,
        "sandstone",
        [200, 180, 120],
        "minecraft:sandstone",
        &["default:sandstone", "mcl_core:sandstone"],
    ),
    kind(Block::Gravel, "gravel", [138, 132, 126], "minecraft:gravel", &["default:gravel", "mcl_core:gravel"]),
    kind(Block::Clay, "clay", [158, 164, 176], "minecraft:clay", &["default:clay", "mcl_core:clay"]),
    kind(Block::Stone, "stone", [126, 124, 122], "minecraft:stone", &["default:stone", "mcl_core:stone"]),
    kind(
        Block::Coal,
        "coal_ore",
        [62, 62, 64],
        "minecraft:coal_ore",
        &["default:stone_with_coal", "mcl_core:stone_with_coal"],
    ),
    kind(
        Block::Iron,
        "iron_ore",
        [176, 132, 108],
        "minecraft:iron_ore",
        &["default:stone_with_iron", "mcl_core:stone_with_iron"],
    ),
    kind(
        Block::Gold,
        "gold_ore",
        [226, 188, 64],
        "minecraft:gold_ore",
        &["default:stone_with_gold", "mcl_core:stone_with_gold"],
    ),
    kind(Block::Log, "log", [104, 78, 48], "minecraft:oak_log[axis=y]", &["default:tree", "mcl_core:tree"]),
    kind(
        Block::Leaves,
        "leaves",
        [66, 118, 44],
        "minecraft:oak_leaves[distance=1,persistent=true,waterlogged=false]",
        &["default:leaves", "mcl_core:leaves"],
    ),
    kind(
        Block::Needles,
        "needles",
        [46, 86, 56],
        "minecraft:spruce_leaves[distance=1,persistent=true,waterlogged=false]",
        &["default:pine_needles", "mcl_core:spruceleaves"],
    ),
];

impl Block {
    /// The kind with this number; air if there is none.
    #[must_use]
    pub fn of(number: u8) -> Block {
        KINDS.get(usize::from(number)).map_or(Block::Air, |kind| kind.block)
    }

    /// Its representation in files.
    #[must_use]
    pub fn kind(self) -> &'static BlockKind {
        &KINDS[self as usize]
    }

    /// Whether it is neither air nor water.
    #[must_use]
    pub fn is_solid(self) -> bool {
        !matches!(self, Block::Air | Block::Water)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn numbers_are_indices_and_names_are_distinct() {
        assert!((0..).zip(KINDS).all(|(number, kind)| Block::of(number) == kind.block && kind.block as u8 == number));
        assert_eq!(Block::of(200), Block::Air);
        let [names, states, colors] = [
            KINDS.iter().map(|kind| kind.name.to_string()).collect::<HashSet<_>>(),
            KINDS.iter().map(|kind| kind.minecraft.to_string()).collect(),
            KINDS.iter().map(|kind| format!("{:?}", kind.color)).collect(),
        ];
        assert_eq!([names.len(), states.len(), colors.len()], [KINDS.len(); 3]);
    }
}
