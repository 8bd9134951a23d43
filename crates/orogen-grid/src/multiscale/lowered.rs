//! The parameters of a level for shaders.

use super::children::{FINEST_GEOGRAPHY, amplitude, indent};
use super::creep::Kept;
use super::growth::FLOOR_AREA;
use super::law::{self, has_floors, river_slope};
use super::refine::FREE_AREA;
use super::refinement::Refinement;
use super::{detail, hash, lakes, links};

/// The bits of [`Words::flags`], by their names in shaders.
pub const FLAGS: [(&str, u32); 5] =
    [("FINEST", FINEST), ("DETAIL", DETAIL), ("FLOORS", FLOORS), ("LAKES", LAKES), ("SEA", SEA)];

const FINEST: u32 = 1;
const DETAIL: u32 = 2;
const FLOORS: u32 = 4;
const LAKES: u32 = 8;
const SEA: u32 = 16;

/// The parameters of a level, with their names in shaders.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// Bits for the features of the level (see [`FLAGS`]).
    pub flags: u32,
    /// The start values of hashes.
    pub hashes: [(&'static str, u64); 4],
    /// Numeric parameters.
    pub numbers: [(&'static str, f32); 15],
}

impl Refinement {
    /// Whether a level of [continents](super::continents::Continents) evaluates the geography.
    #[must_use]
    pub fn has_geography(&self, depth: usize) -> bool {
        self.kilometres(depth) >= FINEST_GEOGRAPHY
    }

    /// Whether rivers have beds on level `depth`. On other levels [`Refinement::cut_rivers`] does nothing.
    #[must_use]
    pub fn has_beds(&self, depth: usize) -> bool {
        self.is_detail(depth)
    }

    /// The parameters of [`Refinement::surface_at`]: the position of samples in their cells, and the mean change of
    /// heights by finer levels.
    #[must_use]
    pub fn surface_numbers(&self, depth: usize, share: f32) -> [f32; 2] {
        [self.inside(depth, share), self.mean_change(depth)]
    }

    /// The parameters of level `depth`, at least 1.
    #[must_use]
    pub fn words(&self, depth: usize) -> Words {
        let above = depth.saturating_sub(1);
        let (cell, kilometres) = (self.cell_of(depth), self.kilometres(depth));
        let has = |has: bool, bit: u32| if has { bit } else { 0 };
        let is_detail = self.is_detail(depth);
        let flags = has(self.is_finest(depth), FINEST)
            | has(is_detail, DETAIL)
            | has(has_floors(self, depth), FLOORS)
            | has(self.lakes > 0.0, LAKES)
            | has(self.sea, SEA);
        let start = |depth: usize, stream| hash::start(self.seed, depth, stream);
        let hashes = [
            ("place_hash", start(depth, 0)),
            ("wander_hash", start(depth, 7)),
            ("diagonal_hash", start(depth, 9)),
            ("detail_hash", start(above, 11)),
        ];
        let kept = Kept::on(self, depth);
        let river = |kilometres: f64| river_slope(self, kilometres * kilometres) as f32;
        let numbers = [
            ("wander", links::wander(self, depth)),
            ("amplitude", amplitude(self, depth)),
            ("indent", indent(self, depth)),
            ("kilometres", kilometres as f32),
            ("cell", cell as f32),
            ("least_rise", self.least_rise(depth)),
            ("floor_area", (cell * cell * 1e-6 / FLOOR_AREA) as f32),
            ("river_slope", river(kilometres)),
            ("stable_slope", law::stable_slope(self)),
            ("free_area", if is_detail { detail::free_area(cell) } else { FREE_AREA }),
            ("beside_lakes", lakes::beside(self, above)),
            ("kept_fall", kept.fall),
            // Shaders have no infinite numbers.
            ("cut_area", kept.cut_area.min(f32::MAX)),
            ("river_slope_above", river(self.kilometres(above))),
            ("cell_above", self.cell_of(above) as f32),
        ];
        Words { flags, hashes, numbers }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_hold_all_numbers() {
        let land = Refinement::new(5).with_levels(3).with_details(2).with_lakes(0.5);
        for depth in 1..=5 {
            let words = land.words(depth);
            assert_eq!(words.flags & DETAIL != 0, depth > 3);
            assert_eq!(words.hashes[0], ("place_hash", hash::start(5, depth, 0)));
            assert_eq!(words.numbers[14], ("cell_above", land.cell_of(depth - 1) as f32));
        }
    }
}
