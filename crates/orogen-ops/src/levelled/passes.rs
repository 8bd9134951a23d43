//! The levels of drained land as passes of a graphics card.

use crate::lower::{Extent, Lowering, Over, Pass, Passes};
use orogen_grid::grid::Window;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::lowered::{FLAGS, Schedule, Words};
use orogen_grid::multiscale::refinement::Refinement;

/// What the passes of one file of shaders need before it.
macro_rules! code {
    ($($file:literal),+) => {
        concat!(include_str!("../lower/power.wgsl"), include_str!("../lower/product.wgsl"), include_str!("passes/common.wgsl"), $(include_str!(concat!("passes/", $file))),+)
    };
}
pub(super) use code;

const MOUTHS: &str = code!("link.wgsl", "mouths.wgsl");
const CHILDREN: &str = code!("children.wgsl");
const LINKS: &str = code!("link.wgsl", "links.wgsl");
const SHORES: &str = code!("link.wgsl", "shores.wgsl");
const CARVE: &str = code!("link.wgsl", "carve.wgsl");
const STRAIGHTEN: &str = code!("link.wgsl", "straighten.wgsl");
const LAKE_SHORES: &str = code!("lake_shores.wgsl");
const LAW: &str = code!("law.wgsl");
const GROWTH: &str = code!("growth.wgsl");
const DRAINAGE: &str = code!("drainage.wgsl");
const CREEP: &str = code!("creep.wgsl");
const DETAIL: &str = code!("detail.wgsl");

/// The planes of the level between which heights and areas alternate; the first of each is one of the level's own.
const HEIGHTS: [u32; 2] = [2, 8];
const AREAS: [u32; 2] = [3, 9];

/// The planes of the ways of rivers while they are straightened, and the passes in which skipped cells dry up.
const WAYS: [u32; 2] = [18, 19];
const DRY_PASSES: usize = 6;

/// The planes between which the smallest heights around lakes alternate.
const RIMS: [u32; 2] = [20, 21];

/// Number of planes beside those of a level, without and with lakes, and of those of the level above.
const SCRATCH: usize = 12;
const LAKE_SCRATCH: usize = 14;
const SCRATCH_ABOVE: usize = 5;

/// Samples that a call reads, about: of few planes, of the neighbors, and of the links around a cell.
pub(super) const FEW: usize = 10;
pub(super) const AROUND: usize = 40;
const LINKS_AROUND: usize = 200;

/// The words of the planes of the inputs that levels read, 0 where nothing is given.
const GIVEN: [&str; 6] = ["given_shore", "given_uplift", "given_stability", "given_creep", "given_floor", "given_rain"];

/// The inputs of an op that levels read: their indices among its inputs, of those that are given.
#[derive(Debug, Clone, Copy, Default)]
pub struct GivenInputs {
    /// The distance to the shore.
    pub shore: Option<usize>,
    /// Uplift over erodibility.
    pub uplift: Option<usize>,
    /// Factor of the stable slope.
    pub stability_factor: Option<usize>,
    /// Factor of creep.
    pub creep_factor: Option<usize>,
    /// Factor of the width of floors.
    pub floor_factor: Option<usize>,
    /// Factor of the rain.
    pub rain: Option<usize>,
}

/// How a graphics card computes a level of an op whose lattices are `ahead` of the samples of windows by this number of
/// samples.
#[must_use]
pub fn lower(refinement: &Refinement, level: usize, given: &GivenInputs, ahead: fn(usize) -> i64) -> Lowering<Passes> {
    if level == 0 {
        return Lowering::Processor("the coarsest level is made of the inputs alone");
    }
    if refinement.begins_lakes(level) {
        return Lowering::Processor("lakes are searched along rivers, one after the other");
    }
    let schedule = refinement.schedule(level);
    let scratch = if schedule.rims.is_some() { LAKE_SCRATCH } else { SCRATCH };
    // Detail levels take over what the finest level of valleys has.
    let given = if level > refinement.levels { &GivenInputs::default() } else { given };
    let GivenInputs { shore, uplift, stability_factor, creep_factor, floor_factor, rain } = *given;
    let given = [shore, uplift, stability_factor, creep_factor, floor_factor, rain];
    let ahead = [level - 1, level].map(|level| {
        let sample = Window::new(1, 1, refinement.cell_of(level));
        ahead(level) + refinement.nodes_at(level, &sample).x
    });
    let mut passes = passes(refinement, level).with_scratch(Level::PLANES + scratch);
    for (name, input) in GIVEN.into_iter().zip(given) {
        // Number 0 is the first plane of the level, never an input.
        let plane = input.map_or(0, |_| passes.planes);
        passes = passes.with_named_words([(name, plane as u32)]);
        if let Some(input) = input {
            passes.inputs.resize(passes.inputs.len().max(input + 1), None);
            passes.inputs[input] = Some(plane);
            passes.planes += 1;
        }
    }
    passes.extent = Extent::Above { scratch: SCRATCH_ABOVE, ahead, reach: refinement.reach(level) };
    passes.layers = (0..Level::PLANES).collect();
    passes.passes = List::of(&schedule, shore.is_some()).passes;
    Lowering::Shader(passes)
}

/// Passes that read the numbers of a level.
pub(super) fn passes(refinement: &Refinement, level: usize) -> Passes {
    let Words { flags, hashes, numbers } = refinement.words(level);
    let planes = Level::PLANE_NAMES.into_iter().zip(0..);
    Passes::new("", &[])
        .with_constants(planes.chain([("LEAST", RIMS[1])]).chain(FLAGS))
        .with_named_words([("flags", flags)])
        .with_pairs(hashes)
        .with_numbers(numbers)
}

/// The passes so far.
struct List {
    passes: Vec<Pass>,
    /// Cells at the edge of the children that passes leave out.
    inset: usize,
    heights: Turns,
    areas: Turns,
}

/// Two planes that are read and written in turn.
struct Turns {
    planes: [u32; 2],
    /// Number of passes that are left.
    left: usize,
}

impl Turns {
    /// The plane that is read; the last pass writes the first one.
    fn now(&self) -> u32 {
        self.planes[self.left % 2]
    }

    /// The plane that is read and the one that is written, as the lower bits of a step.
    fn next(&mut self) -> u32 {
        let read = self.now();
        self.left = self.left.saturating_sub(1);
        read | self.now() << 8
    }
}

impl List {
    fn of(schedule: &Schedule, has_shore: bool) -> List {
        let growth = schedule.first_passes + schedule.rounds;
        let heights = growth + schedule.creep_passes + schedule.bank_rounds * schedule.bank_passes;
        let areas = schedule.rounds * schedule.area_passes
            + schedule.last_area_passes
            + schedule.raise_passes
            + schedule.limit_passes;
        let mut list = List {
            passes: Vec::new(),
            inset: 0,
            heights: Turns { planes: HEIGHTS, left: heights },
            // And the pass that bounds them.
            areas: Turns { planes: AREAS, left: areas + 1 },
        };
        if has_shore {
            list.pass_above(MOUTHS, "decide_mouths", 1, LINKS_AROUND);
            list.pass_above(MOUTHS, "move_mouths", 1, FEW);
        }
        list.carve(schedule);
        list.inset = schedule.carved + schedule.straightened;
        if let Some(rim) = schedule.rims {
            list.inset += rim + 1;
        }
        list.grow(schedule);
        list.creep(schedule);
        list.settle_areas(schedule);
        list
    }

    /// A pass over the children.
    fn pass(&mut self, code: &'static str, function: &'static str, step: u32, reads: usize) {
        let over = Over::Planes([self.inset; 2]);
        self.passes.push(Pass { code, function, step, over, reads, is_shared: false });
    }

    /// A pass over the level above.
    fn pass_above(&mut self, code: &'static str, function: &'static str, inset: usize, reads: usize) {
        let over = Over::Above([inset; 2]);
        self.passes.push(Pass { code, function, step: 0, over, reads, is_shared: false });
    }

    /// One pass further from the edge, over neighbors.
    fn further(&mut self, code: &'static str, function: &'static str, step: u32) {
        self.inset += 1;
        self.pass(code, function, step, AROUND);
    }

    /// The planes of heights and areas that are read now, as the lower bits of a step.
    fn planes(&self) -> u32 {
        self.heights.now() | self.areas.now() << 8
    }

    /// The children, and the rivers and the water of the level above in them.
    fn carve(&mut self, schedule: &Schedule) {
        if schedule.begins_details {
            self.pass_above(DETAIL, "weigh", 1, FEW);
            self.pass_above(DETAIL, "average", 2, AROUND);
            self.pass_above(DETAIL, "prepare", 0, AROUND);
        }
        self.pass(CHILDREN, "place", 0, FEW);
        self.pass(CHILDREN, "inherit", 0, FEW);
        self.pass_above(LINKS, "connect", 1, AROUND);
        self.pass_above(LINKS, "occupy", 1, AROUND);
        self.pass_above(LINKS, "go_around", 1, AROUND);
        self.pass(SHORES, "hold", 0, LINKS_AROUND);
        self.pass(SHORES, "dry_between", 0, AROUND);
        self.pass(SHORES, "spread", 0, AROUND);
        self.pass_above(CARVE, "measure", 1, AROUND);
        self.pass(CARVE, "carve", self.planes(), LINKS_AROUND);
        let step = self.areas.next();
        self.pass(CARVE, "bound_areas", step, LINKS_AROUND);
        if schedule.is_finest {
            self.straighten(schedule);
        } else {
            self.pass(CARVE, "measure_cells", 0, AROUND);
        }
        if let Some(rim) = schedule.rims {
            self.pass(LAKE_SHORES, "begin_rims", self.heights.now() | RIMS[0] << 8, FEW);
            for k in 0..rim {
                let step = RIMS[k % 2] | RIMS[(k + 1) % 2] << 8 | (k as u32) << 16;
                self.pass(LAKE_SHORES, "widen_rims", step, AROUND);
            }
        }
        self.pass(LAW, "set_law", self.planes(), FEW);
    }

    fn straighten(&mut self, schedule: &Schedule) {
        let edge = std::mem::replace(&mut self.inset, schedule.carved);
        self.pass(STRAIGHTEN, "find_shortcuts", 0, FEW);
        self.pass(STRAIGHTEN, "take_shortcuts", 0, AROUND);
        self.pass(STRAIGHTEN, "bypass", self.areas.now() | WAYS[0] << 8, LINKS_AROUND);
        for k in 0..DRY_PASSES {
            self.pass(STRAIGHTEN, "dry", WAYS[k % 2] | WAYS[(k + 1) % 2] << 8, FEW);
        }
        self.pass(STRAIGHTEN, "straighten", self.planes() | WAYS[DRY_PASSES % 2] << 16, FEW);
        self.inset = edge;
    }

    fn grow(&mut self, schedule: &Schedule) {
        for k in 0..schedule.first_passes + schedule.rounds {
            let round = k.checked_sub(schedule.first_passes);
            for pass in 0..round.map_or(0, |_| schedule.area_passes) {
                // What is not a river yet has drained nothing before the first of these passes.
                let is_first = u32::from(round == Some(0) && pass == 0);
                let step = self.areas.next() | is_first << 16;
                self.further(DRAINAGE, "add_areas", step);
            }
            let step = self.heights.next() | self.areas.now() << 16 | (k as u32 & 1) << 24;
            self.further(GROWTH, "grow", step);
        }
    }

    fn creep(&mut self, schedule: &Schedule) {
        for _ in 0..schedule.creep_passes {
            let step = self.heights.next() | self.areas.now() << 16;
            self.further(CREEP, "creep", step);
        }
        for _ in 0..schedule.bank_rounds {
            for _ in 0..schedule.bank_passes {
                let step = self.heights.next() | self.areas.now() << 16;
                self.further(CREEP, "raise_banks", step);
            }
            self.further(CREEP, "descend", self.heights.now());
        }
    }

    /// The last passes of areas, and receivers as a level has them.
    fn settle_areas(&mut self, schedule: &Schedule) {
        let passes = [
            ("add_areas", schedule.last_area_passes),
            ("raise_areas", schedule.raise_passes),
            ("limit_areas", schedule.limit_passes),
        ];
        for (function, count) in passes {
            for _ in 0..count {
                let step = self.areas.next();
                self.further(DRAINAGE, function, step);
            }
        }
        self.pass(DRAINAGE, "finish", 0, FEW);
    }
}
