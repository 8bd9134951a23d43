//! Carves the rivers of a level into the next finer one: heights fall along them from parent to parent.

use super::children::{Children, heir};
use super::distances::Distances;
use super::drainage::{FREE, WATER};
use super::lakes::{drains, is_lake};
use super::level::Level;
use super::links::{Child, Links};
use super::shores::{LAND, Water};
use super::stencil::code;
use crate::hydrology::direction::NONE;

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
}

/// The children with the kept links and the given water. Exact except for seven cells at the edge.
pub fn carve(parent: &Level, links: &Links, children: &Children, water: Water) -> Carved {
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
    };
    carved.lead_lakes(parent, links, children);
    let mut arrivals = Vec::new();
    for q in links.kept(parent).filter(|&q| drains(parent.receiver[q])) {
        arrivals.push(carved.leave(parent, links, children, q));
    }
    for arrival in &arrivals {
        carved.arrive(parent, links, children, arrival);
    }
    for arrival in &arrivals {
        carved.bound_area(parent, links, arrival);
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

    /// Carves a link from its parent to the entry into the receiver's cell.
    fn leave(&mut self, parent: &Level, links: &Links, children: &Children, q: usize) -> Arrival {
        let parents = links.width;
        let (link, target) = (links.list[q], links.target(parent, q));
        let start = Child { parent: q, corner: heir(parent, q) };
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
        self.set(start, top, area);
        if exit != start {
            area += 1.0;
            self.set(exit, top + fall * to_exit, area);
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

    /// Adjusts the areas between the node of the target and its donors, because areas on the coarser level need not be
    /// the sums of their donors' areas.
    fn bound_area(&mut self, parent: &Level, links: &Links, arrival: &Arrival) {
        let (target, entry) = (arrival.target, arrival.entry);
        if !drains(parent.receiver[target]) {
            return;
        }
        let own = |corner| Child { parent: target, corner }.index(links.width);
        let end = own(heir(parent, target));
        if entry != end && own(links.list[target].exit) == entry {
            return;
        }
        if entry != end {
            self.area[entry] = self.area[entry].min(4.0 * parent.area[target]);
        }
        self.area[end] = self.area[end].max(if entry == end { arrival.area } else { self.area[entry] });
    }

    /// Rivers with an area of less than `least` cells choose their receivers again.
    pub fn free(&mut self, least: f32) {
        for (fixed, &area) in self.fixed.iter_mut().zip(&self.area) {
            if area < least && *fixed < f32::from(NONE) {
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
