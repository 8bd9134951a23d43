//! The passes by which a graphics card computes the levels of drained land.

use super::drained::Drained;
use crate::declare::Spec;
use crate::lower::{Extent, Lowering, Over, Pass, Passes};
use orogen_grid::grid::Window;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::lowered::{FLAGS, Words};
use orogen_grid::multiscale::refinement::Refinement;
use orogen_grid::multiscale::schedule::{LevelPass, Schedule};

/// The text of a shader file, preceded by the files that it needs.
macro_rules! code {
    ($($file:literal),+) => {
        concat!(
            include_str!("../lower/power.wgsl"),
            include_str!("../lower/product.wgsl"),
            include_str!("../lower/hash.wgsl"),
            include_str!("passes/common.wgsl"),
            $(include_str!(concat!("passes/", $file))),+
        )
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
const LAW: &str = code!("distances.wgsl", "law.wgsl");
const GROWTH: &str = code!("distances.wgsl", "growth.wgsl");
const DRAINAGE: &str = code!("drainage.wgsl");
const CREEP: &str = code!("creep.wgsl");
const DETAIL: &str = code!("detail.wgsl");

/// The planes after the planes of a level, by their names in shaders. The names in one line are uses of one plane, in
/// this order.
const SCRATCH: [&[&str]; 14] = [
    // The second planes of heights and areas, which passes read and write in turn.
    &["OTHER_HEIGHT"],
    &["OTHER_AREA"],
    // Fixed receivers, FREE or WATER.
    &["FIXED"],
    // What links determine for each child, a height, and its water level; then the law of slopes and widths of floors.
    &["HELD", "RIVER"],
    &["HELD_HEIGHT", "STABLE"],
    &["LEVEL", "WIDTH"],
    // The direction to the water that has spread to a child plus 1, 0 elsewhere; then floors.
    &["GAINED", "FIRST_FLOOR"],
    // The direction in which a link leads, NONE elsewhere; then floors.
    &["LED", "SECOND_FLOOR"],
    // Water levels while water spreads; then distances to the nodes in the east, south-east, south and south-west. On
    // the finest level, where rivers are straightened: shortcuts and the paths of rivers.
    &["FIRST_LEVEL", "DISTANCE", "FOUND"],
    &["DRIED_LEVEL", "TAKEN"],
    &["WAY"],
    &["OTHER_WAY"],
    // The smallest heights around lakes, read and written in turn, if there are lakes.
    &["RIM"],
    &["LEAST"],
];
const LAKE_SCRATCH: usize = 2;

/// The planes after the planes of the level above.
const SCRATCH_ABOVE: [&[&str]; 5] = [
    // Nodes that become mouths; slopes, their weights and their means; data for the choice of links; then links, with
    // the shares of their length up to the exit and the entry.
    &["NEW_EAST", "SLOPE", "DIRECT"],
    &["NEW_SOUTH", "WEIGHT", "USED"],
    &["NEW_HEIGHT", "MEAN", "LINK"],
    &["NEW_RECEIVER", "TO_EXIT"],
    &["NEW_SHORE", "TO_ENTRY"],
];

/// Number of passes in which skipped cells lose their rivers.
const DRY_PASSES: usize = 6;

/// Approximate number of samples that a call reads, from few planes.
pub(super) const FEW: usize = 10;
/// Approximate number of samples that a call reads from the neighbors.
pub(super) const AROUND: usize = 40;
/// Approximate number of samples that a call reads from the links around a cell.
const LINKS_AROUND: usize = 200;

/// The inputs that levels read. The word with the plane of an input is called `given_` and its name; it is 0 if the
/// input is not given.
const GIVEN: [&str; 6] = ["shore", "uplift", "stability_factor", "creep_factor", "floor_factor", "rain"];

/// The passes by which a graphics card computes a level of an op. `given` says for each input whether it is given.
#[must_use]
pub fn lower(land: &Drained, level: usize, spec: &Spec, given: &[bool]) -> Lowering<Passes> {
    if level == 0 {
        return Lowering::Processor("the coarsest level is made of the inputs alone");
    }
    let refinement = &land.refinement;
    let schedule = refinement.schedule(level);
    if schedule.lakes > 0 {
        return Lowering::Processor("lakes are searched along rivers, one after the other");
    }
    if refinement.is_shore_binding() && spec.given_input("shore", given).is_some() {
        return Lowering::Processor("the sea follows a binding shore across many cells");
    }
    // Detail levels take over the data of the finest level of valleys and read no inputs.
    let given = if level > refinement.levels { &[] } else { given };
    let ahead = [level - 1, level].map(|level| {
        let sample = Window::new(1, 1, refinement.cell_of(level));
        land.nodes_at(level, &sample).x
    });
    let unused = if schedule.rims.is_some() { 0 } else { LAKE_SCRATCH };
    let mut passes = passes(refinement, level, &SCRATCH)
        .with_scratch(Level::PLANES + SCRATCH.len() - unused)
        .with_constants(numbered(&SCRATCH_ABOVE));
    for name in GIVEN {
        let input = spec.given_input(name, given);
        // Number 0 is the first plane of the level, never an input.
        let plane = input.map_or(0, |_| passes.planes);
        passes = passes.with_named_words([(format!("given_{name}").as_str(), plane as u32)]);
        if let Some(input) = input {
            passes.inputs.resize(passes.inputs.len().max(input + 1), None);
            passes.inputs[input] = Some(plane);
            passes.planes += 1;
        }
    }
    passes.extent = Extent::Above { scratch: SCRATCH_ABOVE.len(), ahead, reach: refinement.reach(level) };
    passes.layers = (0..Level::PLANES).collect();
    passes.passes = List::of(&schedule, spec.given_input("shore", given).is_some()).passes;
    Lowering::Shader(passes)
}

/// Empty passes with the numbers of a level, and with names for the planes after the planes of the level.
pub(super) fn passes(refinement: &Refinement, level: usize, scratch: &[&[&'static str]]) -> Passes {
    let Words { flags, hashes, numbers } = refinement.words(level);
    Passes::new("", &[])
        .with_constants(Level::PLANE_NAMES.into_iter().zip(0..).chain(numbered(scratch)).chain(FLAGS))
        .with_named_words([("flags", flags)])
        .with_pairs(hashes)
        .with_numbers(numbers)
}

/// The names of the planes after the planes of a level, each with its number.
pub(super) fn numbered(scratch: &[&[&'static str]]) -> impl Iterator<Item = (&'static str, u32)> {
    let planes = (Level::PLANES as u32..).zip(scratch);
    planes.flat_map(|(plane, names)| names.iter().map(move |name| (*name, plane)))
}

/// The number of a plane.
fn plane(name: &str) -> u32 {
    let mut planes = Level::PLANE_NAMES.into_iter().zip(0..).chain(numbered(&SCRATCH));
    planes.find(|(known, _)| *known == name).map_or(0, |(_, plane)| plane)
}

/// The passes so far.
struct List {
    passes: Vec<Pass>,
    /// Cells at the edge of the children that passes leave out.
    inset: usize,
    heights: Turns,
    areas: Turns,
    /// Number of passes of growth.
    grown: u32,
}

/// Two planes that are read and written in turn.
struct Turns {
    planes: [u32; 2],
    /// Number of remaining passes.
    left: usize,
}

impl Turns {
    /// The plane that is read; the last pass writes the first one.
    fn now(&self) -> u32 {
        self.planes[self.left % 2]
    }

    /// The plane that is read and the plane that is written, as the lower bits of a step.
    fn next(&mut self) -> u32 {
        let read = self.now();
        self.left = self.left.saturating_sub(1);
        read | self.now() << 8
    }
}

impl List {
    fn of(schedule: &Schedule, has_shore: bool) -> List {
        let count = |writes: fn(LevelPass) -> bool| schedule.passes.iter().filter(|pass| writes(**pass)).count();
        let turns = |planes: [&str; 2], left| Turns { planes: planes.map(plane), left };
        let mut list = List {
            passes: Vec::new(),
            inset: 0,
            heights: turns(["HEIGHT", "OTHER_HEIGHT"], count(LevelPass::writes_heights)),
            // One more for the pass that bounds areas.
            areas: turns(["AREA", "OTHER_AREA"], count(LevelPass::writes_areas) + 1),
            grown: 0,
        };
        if has_shore {
            list.pass_above(MOUTHS, "decide_mouths", 1, LINKS_AROUND);
            list.pass_above(MOUTHS, "move_mouths", 1, FEW);
        }
        list.carve(schedule);
        list.inset = schedule.edge();
        schedule.passes.iter().for_each(|pass| list.settle(*pass));
        list.pass(DRAINAGE, "finish", 0, FEW);
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

    /// A pass over neighbors, one cell further from the edge.
    fn settle(&mut self, pass: LevelPass) {
        self.inset += 1;
        let (code, function) = match pass {
            LevelPass::FirstAreas | LevelPass::AddAreas => (DRAINAGE, "add_areas"),
            LevelPass::Grow => (GROWTH, "grow"),
            LevelPass::Creep => (CREEP, "creep"),
            LevelPass::RaiseBanks => (CREEP, "raise_banks"),
            LevelPass::Descend => (CREEP, "descend"),
            LevelPass::RaiseAreas => (DRAINAGE, "raise_areas"),
            LevelPass::LimitAreas => (DRAINAGE, "limit_areas"),
        };
        let step = if pass.writes_areas() {
            self.areas.next() | u32::from(pass == LevelPass::FirstAreas) << 16
        } else if pass.writes_heights() {
            self.heights.next() | self.areas.now() << 16
        } else {
            self.heights.now()
        };
        let floors = if pass == LevelPass::Grow { self.grown & 1 } else { 0 };
        self.grown += u32::from(pass == LevelPass::Grow);
        self.pass(code, function, step | floors << 24, AROUND);
    }

    /// The planes of heights and areas that are read now, as the lower bits of a step.
    fn planes(&self) -> u32 {
        self.heights.now() | self.areas.now() << 8
    }

    /// Adds the passes that make the children, and carve the rivers and the water of the level above into them.
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
            let rims = ["RIM", "LEAST"].map(plane);
            self.pass(LAKE_SHORES, "begin_rims", self.heights.now() | rims[0] << 8, FEW);
            for k in 0..rim {
                let step = rims[k % 2] | rims[(k + 1) % 2] << 8 | (k as u32) << 16;
                self.pass(LAKE_SHORES, "widen_rims", step, AROUND);
            }
        }
        self.pass(LAW, "set_law", self.planes(), FEW);
    }

    fn straighten(&mut self, schedule: &Schedule) {
        let (edge, ways) = (std::mem::replace(&mut self.inset, schedule.carved), ["WAY", "OTHER_WAY"].map(plane));
        self.pass(STRAIGHTEN, "find_shortcuts", 0, FEW);
        self.pass(STRAIGHTEN, "take_shortcuts", 0, AROUND);
        self.pass(STRAIGHTEN, "bypass", self.areas.now() | ways[0] << 8, LINKS_AROUND);
        for k in 0..DRY_PASSES {
            self.pass(STRAIGHTEN, "dry", ways[k % 2] | ways[(k + 1) % 2] << 8, FEW);
        }
        self.pass(STRAIGHTEN, "straighten", self.planes() | ways[DRY_PASSES % 2] << 16, FEW);
        self.inset = edge;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_have_numbers_by_their_names() {
        let names = ["HEIGHT", "AREA", "OTHER_HEIGHT", "OTHER_AREA", "WAY", "OTHER_WAY", "RIM", "LEAST"];
        assert_eq!(names.map(plane), [2, 3, 8, 9, 18, 19, 20, 21]);
    }
}
