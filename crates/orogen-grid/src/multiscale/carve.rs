//! Carves the rivers of a level into the next finer one: heights fall along them from parent to parent.

use super::children::{Children, heir};
use super::distances::Distances;
use super::drainage::{FREE, WATER};
use super::lakes::{drains, is_lake};
use super::level::Level;
use super::links::{Child, Links};
use super::passages::{Drawn, Passage};
use super::refinement::Refinement;
use super::shores::{LAND, Water};
use super::stencil::code;
use crate::hydrology::direction::{NONE, STEPS};

/// Height of the end of a tributary above the bed of a drawn river, in metres.
const DRAWN_STEP: f32 = 0.012;

/// Height of nodes that have no height yet.
pub const UNKNOWN: f32 = 1e30;

/// Nodes with the rivers of the next coarser level.
pub struct Carved {
    pub height: Vec<f32>,
    pub area: Vec<f32>,
    /// Code of the receiver's direction.
    pub receiver: Vec<f32>,
    /// The receiver's code where it must not change; otherwise [`FREE`] or [`WATER`].
    pub fixed: Vec<f32>,
    /// `None` on the finest level, where nodes are on the lattice.
    pub distances: Option<Distances>,
    /// Areas of drawn rivers by the drawing, in cells; 0 elsewhere. Empty without drawn rivers.
    pub drawn: Vec<f32>,
}

/// Maximum number of cells along a drawn river to which the area of a tributary is added.
pub const JOINED: usize = 8;

/// The children with the kept links, the given water and the drawn rivers. Exact except for seven cells at the edge,
/// and [`JOINED`] more with drawn rivers.
pub fn carve(
    land: &Refinement,
    parent: &Level,
    links: &Links,
    children: &Children,
    water: Water,
    drawn: &Drawn,
) -> Carved {
    let Water { levels, gained } = water;
    let extent = children.extent;
    let fixed = levels.iter().map(|&level| if level < LAND { WATER } else { FREE }).collect();
    let mut height = levels;
    for height in height.iter_mut().filter(|height| **height >= LAND) {
        *height = UNKNOWN;
    }
    let mut carved = Carved {
        height,
        area: vec![0.0; extent.len()],
        receiver: vec![f32::from(NONE); extent.len()],
        fixed,
        distances: children.is_irregular().then(|| Distances::new(extent, &children.east, &children.south)),
        drawn: vec![0.0; if drawn.below.is_empty() { 0 } else { extent.len() }],
    };
    carved.lead_lakes(parent, links, children);
    let kilometres = land.kilometres(children.depth);
    let scale = Scale { rise: land.least_rise(children.depth), cells: 1.0 / (kilometres * kilometres) };
    carved.draw(parent, children, drawn, scale);
    let mut arrivals = Vec::new();
    for q in links.kept(parent).filter(|&q| drains(parent.receiver[q])) {
        arrivals.push(carved.leave(parent, links, children, drawn, q));
    }
    for arrival in &arrivals {
        carved.arrive(parent, links, children, arrival);
    }
    for arrival in &arrivals {
        carved.bound_area(parent, links, arrival);
    }
    for (area, drawn) in carved.area.iter_mut().zip(&carved.drawn) {
        *area = area.max(*drawn);
    }
    for area in carved.area.iter_mut().filter(|area| **area < 1.0) {
        *area = 1.0;
    }
    for (q, beside) in gained {
        if carved.receiver[beside] < WATER {
            carved.receiver[q] = f32::from(code_between(children, q, beside));
        }
    }
    carved
}

/// Minimum fall from a cell of a drawn river to water, in metres, and the number of cells of a square kilometre.
#[derive(Clone, Copy)]
struct Scale {
    rise: f32,
    cells: f64,
}

/// The last part of a link, after it has left its parent's cell.
struct Arrival {
    target: usize,
    entry: usize,
    /// Height at the entry.
    height: f32,
    area: f32,
}

impl Carved {
    /// Directs the water of lakes with an outlet to the heir of the lake's node where no link passes.
    fn lead_lakes(&mut self, parent: &Level, links: &Links, children: &Children) {
        for q in parent.inner(1).filter(|&q| is_lake(parent.receiver[q])) {
            let own = |corner| Child { parent: q, corner }.index(links.width);
            let end = heir(parent, q);
            for corner in (0..4).filter(|corner| *corner != end && self.fixed[own(*corner)] == WATER) {
                self.receiver[own(corner)] = f32::from(code_between(children, own(corner), own(end)));
            }
        }
    }

    /// Whether a drawn river leaves this cell on land.
    fn is_drawn(&self, q: usize) -> bool {
        self.drawn.get(q).is_some_and(|area| *area > 0.0)
    }

    /// A drawn river takes a shortcut past this cell.
    pub fn undraw(&mut self, q: usize) {
        if let Some(area) = self.drawn.get_mut(q) {
            *area = 0.0;
        }
    }

    /// Leads drawn rivers through the cells that they cross, at their own heights, to the water that they end in.
    fn draw(&mut self, parent: &Level, children: &Children, drawn: &Drawn, scale: Scale) {
        let width = children.extent.width;
        let inner = |q: usize| {
            let (i, j) = (q % width, q / width);
            (1..width - 1).contains(&i) && (1..children.extent.height - 1).contains(&j)
        };
        for (q, passage) in drawn.below.left().filter(|(q, _)| inner(*q)) {
            if self.fixed[q] != WATER {
                self.pass(children, q, passage, passage.code, scale);
            }
        }
        // A river that ends on land, next to water. If it also ended there on the coarser level, its node is kept.
        for (q, passage) in drawn.below.ended().filter(|(q, _)| inner(*q)) {
            let p = q / width / 2 * (width / 2) + q % width / 2;
            let is_kept = parent.receiver[p] < NONE && drawn.above.at(p).is_some_and(|above| above.code == NONE);
            if self.fixed[q] == WATER || is_kept {
                continue;
            }
            let ways = [0u8, 2, 4, 6, 1, 3, 5, 7].into_iter();
            if let Some(code) = ways.into_iter().find(|code| self.fixed[beside(q, *code, width)] == WATER) {
                self.pass(children, q, passage, code, scale);
            }
        }
    }

    /// Leads a drawn river from a cell to the next one.
    fn pass(&mut self, children: &Children, q: usize, passage: &Passage, code: u8, scale: Scale) {
        let to = beside(q, code, children.extent.width);
        let least = if self.fixed[to] == WATER { self.height[to] + scale.rise } else { f32::NEG_INFINITY };
        self.height[q] = passage.height.max(least);
        self.connect(children, q, to);
        self.drawn[q] = ((passage.area * scale.cells) as f32).max(1.0);
    }

    /// The cell after one of a drawn river.
    fn next(&self, q: usize, width: usize) -> usize {
        beside(q, self.receiver[q] as u8, width)
    }

    /// Carves a link from its parent to the entry into the receiver's cell. A drawn river has its own course.
    fn leave(&mut self, parent: &Level, links: &Links, children: &Children, drawn: &Drawn, q: usize) -> Arrival {
        let parents = links.width;
        let (link, target) = (links.list[q], links.target(parent, q));
        let start = Child { parent: q, corner: heir(parent, q) };
        if self.is_drawn(start.index(parents)) {
            let own = start.index(parents);
            let entry = self.next(own, children.extent.width);
            let area = if drawn.above.is_led(parent, q) { 4.0 * parent.area[q] } else { 0.0 };
            self.area[own] += area;
            return Arrival { target: Child::at(entry, parents).parent, entry, height: self.height[own], area };
        }
        let exit = Child { parent: q, corner: link.exit };
        let entry = Child { parent: target, corner: link.entry };
        let end = Child { parent: target, corner: heir(parent, target) };
        let length = |from, to| if from == to { 0.0 } else { children.distance(from, to, parents) };
        // The water of lakes with an outlet is level. A link from a lake falls only beyond the last child in the lake,
        // a link to a lake only up to the entry.
        let (from_lake, to_lake) = (is_lake(parent.receiver[q]), is_lake(parent.receiver[target]));
        let is_water = |child: Child| self.fixed[child.index(parents)] == WATER;
        let first = if from_lake && is_water(exit) { 0.0 } else { length(start, exit) };
        let via = links.via(parent, q);
        let second = match via {
            Some(via) if from_lake && is_water(via) => length(via, entry),
            Some(via) => length(exit, via) + length(via, entry),
            None => length(exit, entry),
        };
        let is_reached = to_lake && is_water(entry);
        let third = if is_reached { 0.0 } else { length(entry, end) };
        let whole = (first + second + third).max(0.01);
        let (to_exit, to_entry) = (first / whole, (first + second) / whole);
        let (top, fall) = (parent.height[q], parent.height[target] - parent.height[q]);
        // The area grows by one cell at each step, so that it is never less than the inflow.
        let mut area = 4.0 * parent.area[q];
        let [start, exit, entry] = [start, exit, entry].map(|child| child.index(parents));
        // A tributary ends above the bed of the drawn river that it meets.
        let least = if self.is_drawn(entry) { self.height[entry] + DRAWN_STEP } else { f32::NEG_INFINITY };
        self.set(start, top.max(least + DRAWN_STEP), area);
        if exit != start {
            area += 1.0;
            self.set(exit, (top + fall * to_exit).max(least), area);
            self.connect(children, start, exit);
        }
        match via {
            Some(via) => {
                let via = via.index(parents);
                area += 1.0;
                self.set(via, top + fall * (0.5 * (to_exit + to_entry)), area);
                self.connect(children, exit, via);
                self.connect(children, via, entry);
            }
            None => self.connect(children, exit, entry),
        }
        Arrival { target, entry, height: top + fall * to_entry, area }
    }

    /// Carves the end of a link, from the entry to the receiver's heir.
    fn arrive(&mut self, parent: &Level, links: &Links, children: &Children, arrival: &Arrival) {
        let (target, entry) = (arrival.target, arrival.entry);
        let own = |corner| Child { parent: target, corner }.index(links.width);
        let end = own(heir(parent, target));
        let drains = drains(parent.receiver[target]);
        if self.is_drawn(entry) {
            self.join(parent, links, entry, arrival.area);
            return;
        }
        if entry == end || (self.fixed[entry] == WATER && !drains) {
            return;
        }
        if drains && own(links.list[target].exit) == entry {
            // The link joins the river below its node.
            self.area[end] -= arrival.area;
            return;
        }
        let height = if arrival.height < self.height[entry] { arrival.height } else { self.height[entry] };
        let own = if self.area[entry] > 0.0 { 0.0 } else { 1.0 };
        self.set(entry, height, arrival.area + own);
        self.connect(children, entry, end);
    }

    /// Adds the area of a tributary to the cells of a drawn river down to the next node of the coarser level, which
    /// contains it.
    fn join(&mut self, parent: &Level, links: &Links, entry: usize, area: f32) {
        let (mut way, mut at) = ([0; JOINED], entry);
        let mut most = f32::INFINITY;
        let mut cells = 0;
        for passed in &mut way {
            let Child { parent: above, corner } = Child::at(at, links.width);
            if !self.is_drawn(at) {
                break;
            }
            if links.list[above].kept && heir(parent, above) == corner {
                most = 4.0 * parent.area[above];
                break;
            }
            (*passed, cells) = (at, cells + 1);
            at = self.next(at, 2 * links.width);
        }
        for &q in &way[..cells] {
            let own = if self.area[q] > 0.0 { 0.0 } else { 1.0 };
            self.area[q] = (self.area[q] + area + own).min(most.max(self.area[q]));
        }
    }

    /// Adjusts the areas between the node of the target and its donors, because areas on the coarser level need not be
    /// the sums of their donors' areas.
    fn bound_area(&mut self, parent: &Level, links: &Links, arrival: &Arrival) {
        let (target, entry) = (arrival.target, arrival.entry);
        let own = |corner| Child { parent: target, corner }.index(links.width);
        let end = own(heir(parent, target));
        if !drains(parent.receiver[target]) || self.is_drawn(entry) {
            return;
        }
        if entry != end && own(links.list[target].exit) == entry {
            return;
        }
        if entry != end {
            self.area[entry] = self.area[entry].min(4.0 * parent.area[target]);
        }
        self.area[end] = self.area[end].max(if entry == end { arrival.area } else { self.area[entry] });
    }

    /// The cells of drawn rivers, and their areas by the drawing, in cells.
    pub fn drawn_areas(&self) -> Vec<(usize, f32)> {
        self.drawn.iter().copied().enumerate().filter(|(_, area)| *area > 0.0).collect()
    }

    /// Minimum heights with which drawn rivers keep theirs. `least` is empty if there are no others, and otherwise
    /// `anything` where there is none.
    pub fn hold_drawn(&self, least: &mut Vec<f32>, anything: f32) {
        for (q, _) in self.drawn_areas() {
            least.resize(self.height.len(), anything);
            least[q] = self.height[q];
        }
    }

    /// Rivers with an area of less than `least` cells choose their receivers again, but not drawn ones.
    pub fn free(&mut self, least: f32) {
        for (q, (fixed, &area)) in self.fixed.iter_mut().zip(&self.area).enumerate() {
            let is_drawn = self.drawn.get(q).is_some_and(|area| *area > 0.0);
            if area < least && *fixed < f32::from(NONE) && !is_drawn {
                *fixed = FREE;
            }
        }
    }

    /// Sets the height and adds to the area; standing water keeps its level.
    fn set(&mut self, q: usize, height: f32, area: f32) {
        if self.fixed[q] != WATER {
            self.height[q] = height;
        }
        self.area[q] += area;
    }

    /// Makes the adjacent cell `to` the receiver of `from`.
    fn connect(&mut self, children: &Children, from: usize, to: usize) {
        let (width, code) = (children.extent.width, code_between(children, from, to));
        self.receiver[from] = f32::from(code);
        if self.fixed[from] != WATER {
            self.fixed[from] = f32::from(code);
        }
        if let Some(distances) = &mut self.distances {
            distances.open(from, code, width, &children.east, &children.south);
        }
    }
}

/// The direction from a cell to an adjacent one.
fn code_between(children: &Children, from: usize, to: usize) -> u8 {
    let width = children.extent.width;
    code((to % width) as isize - (from % width) as isize, (to / width) as isize - (from / width) as isize)
}

/// The cell next to `q` in the direction of a code.
fn beside(q: usize, code: u8, width: usize) -> usize {
    let (east, south) = STEPS[usize::from(code & 7)];
    q.wrapping_add_signed(south * width as isize + east)
}
