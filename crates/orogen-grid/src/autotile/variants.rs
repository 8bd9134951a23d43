//! Groups of tiles from which one is drawn at random.

use super::classes::hash;

/// A tile that may be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// The number of the tile in the tileset.
    pub tile: u32,
    /// Relative frequency among the variants for the same surroundings; above 0.
    pub weight: f32,
}

/// Groups of tiles. One tile of each group is drawn.
#[derive(Debug, Clone, Default)]
pub(super) struct Variants {
    variants: Vec<Variant>,
    // The upper bound of the random number for each variant.
    bounds: Vec<f32>,
}

/// A group: the index of its first variant, and the number of variants.
pub(super) type Group = [u32; 2];

impl Variants {
    /// Adds a group.
    pub(super) fn add(&mut self, group: impl Iterator<Item = Variant>) -> Group {
        let first = self.variants.len();
        self.variants.extend(group);
        let added = &self.variants[first..];
        let all: f32 = added.iter().map(|variant| variant.weight).sum();
        let mut sum = 0.0;
        self.bounds.extend(added.iter().map(|variant| {
            sum += variant.weight;
            sum / all
        }));
        [first as u32, added.len() as u32]
    }

    /// The tile of a group at a column and row of the plane; `None` if the group is empty.
    #[inline]
    pub(super) fn choose(&self, group: Group, place: [i64; 2], seed: u64) -> Option<u32> {
        let [first, count] = group.map(|at| at as usize);
        if count < 2 {
            return self.variants[first..].first().filter(|_| count == 1).map(|variant| variant.tile);
        }
        let draw = (hash(place, seed) >> 40) as f32 / (1u64 << 24) as f32;
        let bounds = &self.bounds[first..first + count];
        let nth = bounds.iter().position(|bound| draw < *bound).unwrap_or(count - 1);
        Some(self.variants[first + nth].tile)
    }
}
