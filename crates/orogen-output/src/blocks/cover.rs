//! Ground cover: the uppermost blocks of a column, by terrain class and biome.

use super::hash::hash;
use super::kind::Block;
use orogen_grid::climate::biomes::scheme::Scheme;

/// The ground of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    /// The floor of the sea and of lakes.
    Bed,
    /// Sand above sandstone, at the shore.
    Beach,
    /// Grass above dirt, with few trees.
    Meadow,
    /// Grass above dirt, with many trees.
    Forest,
    /// Stone.
    Rock,
    /// Snow above dirt.
    Snow,
    /// Deep sand.
    Desert,
    /// Dry grass above dirt, with few trees.
    Steppe,
    /// Needles on the ground, with many conifers.
    Taiga,
    /// Snow above ice.
    Glacier,
}

/// Water up to this depth, in blocks, has a sandy floor.
const SHALLOW: i32 = 7;

/// Maximum thickness of a cover, in blocks.
pub const MAX_THICKNESS: i32 = 6;

impl Cover {
    /// The covers of the [standard classes](orogen_engine::recipe::class::standard) of terrain, indexed by class
    /// number.
    pub const OF_CLASSES: [Cover; 6] =
        [Cover::Bed, Cover::Beach, Cover::Meadow, Cover::Forest, Cover::Rock, Cover::Snow];

    /// The cover of this ground in a biome. Water, beaches and rock are the same in all biomes.
    #[must_use]
    pub fn in_biome(self, scheme: Scheme, code: u8) -> Cover {
        let is_bare = matches!(self, Cover::Bed | Cover::Beach | Cover::Rock);
        if is_bare || code == 0 { self } else { of_biome(scheme, code) }
    }

    /// The block `depth` blocks below the surface of a column (0 is the surface itself); `None` below the soil. `water`
    /// is the depth of the water above the surface, in blocks.
    #[must_use]
    pub fn block(self, depth: i32, water: i32, [x, y]: [i64; 2], seed: u64) -> Option<Block> {
        let uneven = (hash(seed ^ 0x51, [x, y, 0]) & 1) as i32;
        let layers: &[(Block, i32)] = match self {
            // The ground below water is a floor, whatever the class of its column.
            Cover::Bed | Cover::Meadow | Cover::Forest | Cover::Steppe | Cover::Taiga | Cover::Beach if water > 0 => {
                let patch = hash(seed ^ 0x52, [(x + 3 * i64::from(uneven)) >> 3, (y - i64::from(uneven)) >> 3, 0]);
                match (water < SHALLOW, patch % 16) {
                    (_, 0) => &[(Block::Clay, 2)],
                    (true, _) => &[(Block::Sand, 2), (Block::Sandstone, 1)],
                    (false, 1..=4) => &[(Block::Sand, 2)],
                    (false, _) => &[(Block::Gravel, 2)],
                }
            }
            Cover::Bed | Cover::Beach => &[(Block::Sand, 3), (Block::Sandstone, 2)],
            Cover::Meadow | Cover::Forest => &[(Block::Grass, 1), (Block::Dirt, 3)],
            Cover::Steppe => &[(Block::DryGrass, 1), (Block::Dirt, 2)],
            Cover::Taiga => &[(Block::Litter, 1), (Block::Dirt, 2)],
            Cover::Snow => &[(Block::Snow, 1), (Block::Dirt, 1)],
            Cover::Desert => &[(Block::Sand, 3), (Block::Sandstone, 3)],
            Cover::Glacier => &[(Block::Snow, 1), (Block::Ice, 4)],
            Cover::Rock => &[],
        };
        // The soil is one block thinner in places; its surface block never changes.
        let mut below = if depth > 0 { depth + uneven } else { 0 };
        for (block, thickness) in layers {
            if below < *thickness {
                return Some(*block);
            }
            below -= thickness;
        }
        None
    }

    /// The share of tree positions that have a tree (0 to 1), and whether the trees are conifers; `None` without trees.
    #[must_use]
    pub fn trees(self) -> Option<(f64, bool)> {
        match self {
            Cover::Forest => Some((0.85, false)),
            Cover::Taiga => Some((0.85, true)),
            Cover::Meadow => Some((0.03, false)),
            Cover::Steppe => Some((0.02, false)),
            _ => None,
        }
    }
}

/// The cover of a biome.
fn of_biome(scheme: Scheme, code: u8) -> Cover {
    match scheme {
        Scheme::Whittaker => match code {
            1 => Cover::Snow,
            2 => Cover::Taiga,
            5 | 6 | 9 => Cover::Forest,
            7 => Cover::Desert,
            10 => Cover::Glacier,
            _ => Cover::Steppe,
        },
        Scheme::Holdridge => match code {
            1 => Cover::Glacier,
            2..=5 => Cover::Snow,
            8..=10 => Cover::Taiga,
            11 | 17 | 18 | 24 | 25 | 31 | 32 => Cover::Desert,
            14..=16 | 21..=23 | 28..=30 | 36..=38 => Cover::Forest,
            13 | 35 => Cover::Meadow,
            _ => Cover::Steppe,
        },
        Scheme::KoppenGeiger => match code {
            1 | 2 | 14 | 15 | 17 | 18 | 21 | 22 | 25 | 26 => Cover::Forest,
            4 | 5 => Cover::Desert,
            8..=13 | 16 => Cover::Meadow,
            19 | 20 | 23 | 24 | 27 | 28 => Cover::Taiga,
            29 => Cover::Snow,
            30 => Cover::Glacier,
            _ => Cover::Steppe,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Cover; 10] = [
        Cover::Bed,
        Cover::Beach,
        Cover::Meadow,
        Cover::Forest,
        Cover::Rock,
        Cover::Snow,
        Cover::Desert,
        Cover::Steppe,
        Cover::Taiga,
        Cover::Glacier,
    ];

    #[test]
    fn covers_end_within_their_thickness() {
        for cover in ALL {
            for water in [0, 3, 30] {
                for place in [[0, 0], [5, -3], [-100, 7], [16, 1]] {
                    let layers: Vec<Option<Block>> = (0..20).map(|depth| cover.block(depth, water, place, 1)).collect();
                    let end = layers.iter().position(Option::is_none).unwrap();
                    assert!(end as i32 <= MAX_THICKNESS && layers[end..].iter().all(Option::is_none), "{cover:?}");
                    assert!(water == 0 || !layers.contains(&Some(Block::Grass)), "{cover:?}");
                }
            }
        }
    }

    #[test]
    fn biomes_change_what_grows_and_not_what_is_bare() {
        assert_eq!(Cover::Meadow.in_biome(Scheme::Whittaker, 7), Cover::Desert);
        assert_eq!(Cover::Snow.in_biome(Scheme::KoppenGeiger, 1), Cover::Forest);
        assert_eq!(Cover::Rock.in_biome(Scheme::Holdridge, 1), Cover::Rock);
        assert_eq!(Cover::Forest.in_biome(Scheme::Holdridge, 0), Cover::Forest);
        for scheme in [Scheme::Whittaker, Scheme::Holdridge, Scheme::KoppenGeiger] {
            for class in &scheme.classes()[1..] {
                let cover = of_biome(scheme, class.code);
                let says = |words: &[&str]| words.iter().any(|word| class.name.contains(word));
                assert!(
                    !says(&["rain forest", "rainforest"]) || matches!(cover, Cover::Forest | Cover::Taiga),
                    "{}",
                    class.name
                );
                assert!(!says(&["tundra"]) || cover == Cover::Snow, "{}", class.name);
            }
        }
    }
}
