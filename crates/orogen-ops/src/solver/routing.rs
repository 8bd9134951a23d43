//! Drainage on a graphics card: the passes of `routing.wgsl`.
//!
//! Depressions are drained over the passes between basins, as on the processor. The spanning tree of basins is found by
//! Boruvka's algorithm, whose rounds run for all basins at once (compare Jain, Kerbl, Gain, Finley and Cordonnier,
//! "FastFlow: GPU acceleration of flow and depression routing for landscape simulation", 2024). Paths are followed by
//! pointer doubling.

use crate::lower::{Extent, Passes};
use orogen_grid::grid::Window;

/// Number of planes with the sums of the rain.
const RAIN_PLANES: usize = 6;

/// Maximum number of cells over which rain can be summed: each partial sum must fit into 32 bits.
const MAX_RAINY: usize = 1 << 22;

/// Number of planes of the routing.
const PLANES: usize = 8;

/// Constants of the shaders, by name.
const CONSTANTS: [(&str, u32); 6] = [
    ("HOPS", HOPS as u32),
    ("GATHERED_HOPS", GATHERED_HOPS as u32),
    ("ALL_COUNTERS", COUNTERS as u32),
    ("LAST", LAST),
    ("SCATTERED", SCATTERED),
    ("BETWEEN_POINTS", BETWEEN_POINTS),
];

/// The bit that marks the last routing of a run, which is on the lattice.
pub(crate) const LAST: u32 = 1 << 31;

/// Number of counters.
const COUNTERS: usize = 8;

/// Number of cells over which one pass follows receivers.
const HOPS: usize = 16;
/// Number of cells over which one pass of the accumulation follows receivers.
const GATHERED_HOPS: usize = 8;

/// Choice of receivers as a word; 0 is steepest descent.
const SCATTERED: u32 = 1;
const BETWEEN_POINTS: u32 = 2;

/// The choice of receivers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Descent {
    /// Steepest descent.
    Steepest,
    /// Steepest descent with random lengths of diagonals. The salt is the sum of this number and the number of the
    /// step.
    Scattered(u32),
    /// Steepest descent between displaced points: their salt, and their maximum displacement along each axis, in cells.
    Points(u32, f32),
}

/// The planes of a solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Planes {
    /// Inputs.
    pub(crate) inputs: usize,
    /// Layers.
    pub(crate) layers: usize,
    /// Planes in addition to inputs, layers, the routing, counters and the rain.
    pub(crate) scratch: usize,
    /// The plane of the rain, if areas are weighted by it.
    pub(crate) rain: Option<usize>,
}

impl Planes {
    /// Whether rain can be summed over a window.
    pub(crate) fn can_rain(self, padded: &Window) -> bool {
        self.rain.is_none() || padded.len() <= MAX_RAINY
    }

    /// The first plane of the routing.
    fn routing(self) -> usize {
        self.inputs + self.layers
    }

    /// The plane of the counters; the sums of the rain come after it.
    fn counters(self) -> usize {
        self.routing() + PLANES + self.scratch
    }
}

/// The reason why the processor computes weighted drainage areas of large domains.
pub(crate) const RAIN: &str = "the rain over so many cells needs sums of 64 bits, for which WGSL has no atomics";

/// Passes with the words and planes of the routing.
pub(crate) fn passes(
    code: &'static str,
    padded: &Window,
    sea_level: Option<f32>,
    descent: Descent,
    planes: Planes,
) -> Passes {
    let (kind, salt, reach) = match descent {
        Descent::Steepest => (0, 0, 0.0),
        Descent::Scattered(salt) => (SCATTERED, salt, 0.0),
        Descent::Points(salt, reach) => (BETWEEN_POINTS, salt, reach),
    };
    let [routing, counters] = [planes.routing(), planes.counters()];
    // The plane of the rain, and the first plane with its sums.
    let sums = counters + counter_planes(padded);
    let [rain, sums] = planes.rain.map_or([0; 2], |rain| [rain, sums].map(|plane| plane as u32));
    let rain_planes = if planes.rain.is_some() { RAIN_PLANES } else { 0 };
    Passes::new(code, &[])
        .with_planes(Extent::Domain, planes.inputs, &vec![true; planes.layers])
        .with_scratch(PLANES + planes.scratch + counter_planes(padded) + rain_planes)
        .with_constants(CONSTANTS)
        .with_constants([("ROUTING", routing as u32), ("COUNTERS", counters as u32)])
        .with_numbers([("sea_level", sea_level.unwrap_or(f32::MIN)), ("reach", reach)])
        .with_named_words([("descent", kind), ("salt", salt), ("rain_plane", rain), ("rain_sums", sums)])
}

/// The step of a pass: the planes that are read and written, and a number.
pub(crate) fn step(from: u32, to: u32, number: u32) -> u32 {
    from | to << 8 | number << 16
}

/// Number of planes of the counters: more than one in tiny windows.
fn counter_planes(padded: &Window) -> usize {
    COUNTERS.div_ceil(padded.len().max(1))
}

/// Maximum distance from which cells of flats find the rim, in cells.
const FARTHEST: usize = 512;

/// Number of rounds over basins in a step that starts from drained ground, which has few pits. Remaining basins are
/// drained in the next step.
pub(crate) const FEW_ROUNDS: usize = 5;

/// Number of rounds over basins that suffice to drain all of them: each round at least halves their number.
pub(crate) fn all_rounds(padded: &Window) -> usize {
    let inner = padded.width.saturating_sub(2) * padded.height.saturating_sub(2);
    (usize::BITS - inner.leading_zeros()) as usize
}

/// Number of passes that follow paths over all cells, if each pass multiplies the length by `factor`.
pub(crate) fn doublings(padded: &Window, factor: usize) -> usize {
    let (mut passes, mut length) = (1, factor);
    while length < padded.len() {
        passes += 1;
        length = length.saturating_mul(factor);
    }
    passes
}

/// Number of passes that follow receivers over all cells, by [`HOPS`] cells per pass at first.
pub(crate) fn following(padded: &Window) -> usize {
    doublings(padded, HOPS + 1)
}

/// The drainage of flats.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Flats {
    /// Flats are drained by gradients over them, which takes many passes.
    Graded,
    /// Each cell of a flat is a basin.
    Basins,
}

/// Appends the passes that find the receivers of all cells from the heights in a plane. The number of the step is the
/// number of the time step.
pub(crate) fn route(passes: Passes, padded: &Window, rounds: usize, flats: Flats, step: u32) -> Passes {
    let heights = step & 0xff;
    let at = |passes: Passes, function, number: usize| then(passes, function, heights | (number as u32) << 16);
    let mut passes = then(passes, "receive", step);
    if flats == Flats::Graded {
        let farthest = padded.width.max(padded.height).div_ceil(2).min(FARTHEST);
        passes = at(passes, "begin_flats", 0);
        passes = (1..=farthest).fold(passes, |passes, steps| at(passes, "spread_flats", steps));
        passes = at(at(passes, "drain_flats", farthest + 2), "begin_basins", 0);
    }
    passes = follow(passes, padded, "find_pit");
    for round in 1..=rounds {
        for function in ["offer_pass", "choose_pass", "join", "find_root"] {
            passes = at(passes, function, round);
        }
    }
    at(passes, "lead_out", 0)
}

/// Appends the passes that follow the labels of all cells to their end with a function.
pub(crate) fn follow(passes: Passes, padded: &Window, function: &'static str) -> Passes {
    (0..following(padded)).fold(passes, |passes, _| then(passes, function, 0))
}

/// Appends the passes that find the spill levels of basins. Also returns the number with which functions read these
/// levels.
pub(crate) fn spill(passes: Passes, padded: &Window) -> (Passes, u32) {
    let turns = following(padded) as u32;
    let passes = then(passes, "begin_spill", 0);
    ((0..turns).fold(passes, |passes, k| then(passes, "raise_spill", step(0, 0, k % 2))), turns % 2)
}

/// Appends the passes of `numbering.wgsl`, which number marked cells.
pub(crate) fn number(passes: Passes) -> Passes {
    ["count_marks", "sum_marks", "number_marks"].into_iter().fold(passes, |passes, name| then(passes, name, 0))
}

/// Appends the passes that route the heights of plane 0.
pub(crate) fn routed(passes: Passes, padded: &Window, flats: Flats) -> Passes {
    route(then(passes, "outlets", 0), padded, all_rounds(padded), flats, 0)
}

/// Appends the passes that count the cells that drain through each cell.
pub(crate) fn gather(passes: Passes, padded: &Window) -> Passes {
    let passes = then(passes, "begin_areas", 0);
    let steps = 0..doublings(padded, GATHERED_HOPS) as u32;
    steps.fold(passes, |passes, k| then(passes, "gather_areas", k << 16))
}

/// The functions whose calls write words of other calls, or read words that other calls write.
const SHARED: [&str; 14] = [
    "begin_flats",
    "spread_flats",
    "find_pit",
    "offer_pass",
    "choose_pass",
    "find_root",
    "gather_areas",
    "choose_piece",
    "find_lake",
    "count_cells",
    "find_deepest",
    "find_outflow",
    "raise_order",
    "lead_out",
];

/// Appends a pass that runs a function for all cells.
pub(crate) fn then(passes: Passes, function: &'static str, step: u32) -> Passes {
    let passes = passes.then(function, step, [0; 2]);
    if SHARED.contains(&function) { passes.shared() } else { passes }
}
