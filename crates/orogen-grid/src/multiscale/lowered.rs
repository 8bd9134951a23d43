//! What a graphics card has to know of a level: numbers, and how often each pass runs.

use super::children::{FINEST_GEOGRAPHY, amplitude, indent};
use super::creep::{self, Kept};
use super::growth::{FLOOR_AREA, least_rise};
use super::law::{self, has_floors, river_slope};
use super::refine::{
    AREA_PASSES, BANK_PASSES, BANK_ROUNDS, CARVED, FIRST_PASSES, FREE_AREA, LIMIT_PASSES, RAISE_PASSES, ROUNDS,
    last_area_passes,
};
use super::refinement::Refinement;
use super::straighten;
use super::{detail, hash, lake_shores, lakes, links};

/// How often the passes of a level run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Schedule {
    /// Whether the nodes are on the lattice, and rivers are straightened.
    pub is_finest: bool,
    /// Whether the nodes of the level above are first turned into those that detail levels begin with.
    pub begins_details: bool,
    /// Whether land around lakes has a smallest height, and the number of cells around a lake that have it.
    pub rims: Option<usize>,
    /// Cells at the edge of the children whose rivers are not exact.
    pub carved: usize,
    /// Cells beyond that on which the straightened rivers of a cell depend.
    pub straightened: usize,
    /// Passes of heights before drainage areas change.
    pub first_passes: usize,
    /// Rounds of areas and heights after.
    pub rounds: usize,
    /// Passes of areas in a round.
    pub area_passes: usize,
    /// Passes of creep.
    pub creep_passes: usize,
    /// Rounds of banks; nodes choose their receivers again after each.
    pub bank_rounds: usize,
    /// Passes that raise banks in a round.
    pub bank_passes: usize,
    /// Passes of areas at the end.
    pub last_area_passes: usize,
    /// Passes in which areas rise along the receivers.
    pub raise_passes: usize,
    /// Passes in which areas fall against the receivers.
    pub limit_passes: usize,
}

/// The bits of [`Words::flags`], by their names in shaders.
pub const FLAGS: [(&str, u32); 5] =
    [("FINEST", FINEST), ("DETAIL", DETAIL), ("FLOORS", FLOORS), ("LAKES", LAKES), ("SEA", SEA)];

const FINEST: u32 = 1;
const DETAIL: u32 = 2;
const FLOORS: u32 = 4;
const LAKES: u32 = 8;
const SEA: u32 = 16;

/// The numbers of a level, by their names in shaders.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// Bits of what the level has.
    pub flags: u32,
    /// The starts of hashes.
    pub hashes: [(&'static str, u64); 4],
    /// Numbers.
    pub numbers: [(&'static str, f32); 15],
}

impl Refinement {
    /// Whether rivers of the level above become lakes with an outlet, whose shapes level `depth` is made with.
    #[must_use]
    pub fn begins_lakes(&self, depth: usize) -> bool {
        lakes::begin_at(self, depth.saturating_sub(1))
    }

    /// Whether a level of [continents](super::continents::Continents) evaluates their geography.
    #[must_use]
    pub fn has_geography(&self, depth: usize) -> bool {
        self.kilometres(depth) >= FINEST_GEOGRAPHY
    }

    /// How often the passes of level `depth`, at least 1, run.
    #[must_use]
    pub fn schedule(&self, depth: usize) -> Schedule {
        let is_finest = self.is_finest(depth);
        let finest = |count: usize| if is_finest { count } else { 0 };
        let details = if self.is_detail(depth) { detail::creep_passes(self) } else { 0 };
        Schedule {
            is_finest,
            begins_details: self.is_finest(depth.saturating_sub(1)),
            rims: (self.lakes > 0.0).then_some(lake_shores::RIM),
            carved: CARVED,
            straightened: finest(straighten::REACH),
            first_passes: FIRST_PASSES,
            rounds: ROUNDS,
            area_passes: AREA_PASSES,
            creep_passes: finest(creep::creep_passes(self.creep)) + details,
            bank_rounds: finest(BANK_ROUNDS),
            bank_passes: BANK_PASSES,
            last_area_passes: last_area_passes(is_finest),
            raise_passes: RAISE_PASSES,
            limit_passes: LIMIT_PASSES,
        }
    }

    /// Whether rivers have beds in level `depth`: [`Refinement::cut_rivers`] does nothing in others.
    #[must_use]
    pub fn has_beds(&self, depth: usize) -> bool {
        self.is_detail(depth)
    }

    /// The numbers of [`Refinement::surface_at`]: where samples are in their cells, and the mean change of heights by
    /// finer levels.
    #[must_use]
    pub fn surface_numbers(&self, depth: usize, share: f32) -> [f32; 2] {
        [self.inside(depth, share), self.mean_change(depth)]
    }

    /// The numbers of level `depth`, at least 1.
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
        let kept = if is_detail { Kept::details(least_rise(self, depth)) } else { Kept::VALLEYS };
        let river = |kilometres: f64| river_slope(self, kilometres * kilometres) as f32;
        let numbers = [
            ("wander", links::wander(self, depth)),
            ("amplitude", amplitude(self, depth)),
            ("indent", indent(self, depth)),
            ("kilometres", kilometres as f32),
            ("cell", cell as f32),
            ("least_rise", least_rise(self, depth)),
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
    fn words_hold_all_numbers_and_schedules_stay_within_the_reach() {
        let land = Refinement::new(5).with_levels(3).with_details(2).with_lakes(0.5);
        for depth in 1..=5 {
            let words = land.words(depth);
            assert_eq!(words.flags & DETAIL != 0, depth > 3);
            assert_eq!(words.hashes[0], ("place_hash", hash::start(5, depth, 0)));
            assert_eq!(words.numbers[14], ("cell_above", land.cell_of(depth - 1) as f32));
            let s = land.schedule(depth);
            let passes = s.first_passes + s.rounds * (s.area_passes + 1) + s.creep_passes;
            let passes = passes + s.bank_rounds * (s.bank_passes + 1);
            let passes = passes + s.last_area_passes + s.raise_passes + s.limit_passes;
            let inset = s.carved + s.straightened + s.rims.map_or(0, |rim| rim + 1) + passes;
            assert!(inset <= 2 * land.reach(depth) && (land.begins_lakes(depth) || inset + 1 >= 2 * land.reach(depth)));
        }
    }
}
