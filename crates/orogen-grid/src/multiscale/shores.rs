//! Water of a level: seas and lakes inherit their location from the coarser level, and their shores gain detail.

use super::children::{Children, heir};
use super::given::Given;
use super::lakes::{drains, is_lake};
use super::level::Level;
use super::links::{Child, Links};
use super::passages::Passages;
use super::stencil::Extent;
use crate::hydrology::direction::{NONE, STEPS};

/// The constraint of links on a child.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Held {
    /// No link passes.
    Free,
    /// A river passes, on links whose lowest end is at this height. The child is land.
    River(f32),
    /// A river ends here. The child is water.
    Mouth,
    /// A river passes through a lake with this water level.
    Lake(f32),
}

/// Standing water of the children.
pub struct Water {
    /// The water level of each child, in metres; [`LAND`] on land.
    pub levels: Vec<f32>,
    /// Children to which water has spread, each with the neighbor that was water before.
    pub gained: Vec<(usize, usize)>,
}

/// The water level of children on land.
pub const LAND: f32 = f32::INFINITY;

/// Number of further cells by which the sea spreads on a level where the given shore is binding.
pub const SPREAD: usize = 2;

/// Computes the standing water of the children. Updates their distances to the shore.
/// The cells of drawn rivers on land stay land. If the given shore is binding, the sea spreads further, and above
/// detail levels it is also where no other water is near: in small bays, straits and inland seas.
pub fn standing_water(
    parent: &Level,
    links: &Links,
    drawn: &Passages,
    children: &mut Children,
    given: &Given,
) -> Water {
    let binding = given.binding.is_some();
    let is_free = binding && !given.is_of_detail();
    let mut held = held(parent, links);
    let of_parent = |q: usize| q / children.extent.width / 2 * links.width + q % children.extent.width / 2;
    for (q, passage) in drawn.left().filter(|(q, _)| parent.receiver[of_parent(*q)] < NONE) {
        held[q].gain(Held::River(passage.height));
    }
    let (width, parents) = (children.extent.width, links.width);
    let mut levels = vec![LAND; held.len()];
    for (j, row) in levels.chunks_mut(width.max(1)).enumerate() {
        for (i, level) in row.iter_mut().enumerate() {
            let (q, p) = (j * width + i, j / 2 * parents + i / 2);
            let flooded = held[q] == Held::Mouth || (held[q] == Held::Free && children.shore[q] < 0.0);
            match held[q] {
                Held::Lake(own) => *level = own,
                _ if parent.receiver[p] >= NONE && flooded => *level = parent.height[p],
                _ => {}
            }
        }
    }
    dry_between(parent, &held, children.extent.shrunk(1), &mut levels);
    // Water spreads by one cell into low land.
    let (mut gained, mut seas): (Vec<(usize, usize)>, Vec<usize>) = (Vec::new(), Vec::new());
    for pass in 0..=if binding { SPREAD } else { 0 } {
        let first = gained.len();
        let inner = children.extent.shrunk(1);
        for j in inner.rows() {
            for i in inner.columns() {
                let (q, p) = (j * width + i, j / 2 * parents + i / 2);
                let is_low = parent.receiver[p] < NONE && held[q] == Held::Free && children.shore[q] < 0.0;
                if !is_low || levels[q] < LAND {
                    continue;
                }
                let around = [q - 1, q + 1, q - width, q + width];
                let wet = around.into_iter().filter(|&beside| levels[beside] < LAND);
                let Some(beside) = wet.clone().next() else {
                    if is_free && pass == 0 && is_among_land(&levels, width, q) {
                        seas.push(q);
                    }
                    continue;
                };
                if wet.clone().all(|other| levels[other] == levels[beside])
                    && !is_beside_lower(&held, width, q, levels[beside])
                    && (pass == 0 || levels[beside] == 0.0)
                {
                    gained.push((q, beside));
                }
            }
        }
        let spread: Vec<f32> = gained[first..].iter().map(|&(_, beside)| levels[beside]).collect();
        for (&(q, _), level) in gained[first..].iter().zip(spread) {
            levels[q] = level;
        }
        seas.drain(..).for_each(|q| levels[q] = 0.0);
    }
    for ((shore, &level), &held) in children.shore.iter_mut().zip(&levels).zip(&held) {
        *shore = match held {
            _ if level < LAND => shore.min(-0.5 * children.indent),
            Held::River(_) => shore.max(0.8 * children.indent),
            _ => shore.max(0.3 * children.indent),
        };
    }
    Water { levels, gained }
}

/// Keeps lakes with an outlet apart from other water and from lower rivers: where they meet, children without a link
/// become land.
fn dry_between(parent: &Level, held: &[Held], extent: Extent, levels: &mut [f32]) {
    if !parent.receiver.iter().any(|code| is_lake(*code)) {
        return;
    }
    let (width, parents) = (extent.width, extent.width / 2);
    let in_lake = |q: usize| {
        let p = q / width / 2 * parents + q % width / 2;
        matches!(held[q], Held::Lake(_)) || is_lake(parent.receiver[p])
    };
    let mut dry = Vec::new();
    for j in extent.rows() {
        for q in extent.columns().map(|i| j * width + i).filter(|q| levels[*q] < LAND && held[*q] == Held::Free) {
            let around = STEPS.map(|(east, south)| q.wrapping_add_signed(south * width as isize + east));
            let meets = |o: usize| levels[o] < LAND && levels[o] != levels[q] && (in_lake(q) || in_lake(o));
            if around.into_iter().any(meets) || (in_lake(q) && is_beside_lower(held, width, q, levels[q])) {
                dry.push(q);
            }
        }
    }
    dry.into_iter().for_each(|q| levels[q] = LAND);
}

/// Whether no water is beside a child.
fn is_among_land(levels: &[f32], width: usize, q: usize) -> bool {
    let mut around = STEPS.into_iter().map(|(east, south)| q.wrapping_add_signed(south * width as isize + east));
    around.all(|near| levels[near] >= LAND)
}

/// Whether a river that is, or will be further down, lower than a water level passes next to a child.
fn is_beside_lower(held: &[Held], width: usize, q: usize, level: f32) -> bool {
    STEPS.into_iter().any(|(east, south)| {
        let near = q.wrapping_add_signed(south * width as isize + east);
        matches!(held[near], Held::River(lowest) if lowest < level)
    })
}

/// The constraint of the kept links on each child.
fn held(parent: &Level, links: &Links) -> Vec<Held> {
    let parents = links.width;
    // Nodes of lakes that receive water from the same lake.
    let mut fed = vec![false; links.list.len()];
    for q in links.kept(parent).filter(|q| is_lake(parent.receiver[*q])) {
        fed[links.target(parent, q)] = true;
    }
    let mut held = vec![Held::Free; 4 * links.list.len()];
    for q in links.kept(parent) {
        let link = links.list[q];
        let own = |corner| Child { parent: q, corner }.index(parents);
        let start = own(heir(parent, q));
        let code = parent.receiver[q];
        if !drains(code) {
            if link.fed && held[start] == Held::Free {
                held[start] = Held::Mouth;
            }
            continue;
        }
        let target = links.target(parent, q);
        let entry = Child { parent: target, corner: link.entry }.index(parents);
        let (lake, river) = (Held::Lake(parent.height[q]), Held::River(parent.height[target]));
        let is_outlet = is_lake(code) && !is_lake(parent.receiver[target]);
        held[start].gain(if is_lake(code) { lake } else { river });
        // A lake ends at the start of its outlet's link, so that the river falls along the whole link. If the lake has
        // no other part, it ends behind the link.
        let passed = if is_lake(code) && !(is_outlet && fed[q]) { lake } else { river };
        held[own(link.exit)].gain(passed);
        if let Some(via) = links.via(parent, q) {
            held[via.index(parents)].gain(passed);
        }
        if is_lake(code) && !is_outlet {
            held[entry].gain(Held::Lake(parent.height[target]));
        } else if parent.receiver[target] < NONE {
            held[entry].gain(river);
        }
    }
    held
}

impl Held {
    /// Combines two constraints: lakes take precedence over rivers, and the lowest river counts.
    fn gain(&mut self, other: Held) {
        *self = match (*self, other) {
            (Held::Lake(level), Held::River(_)) => Held::Lake(level),
            (Held::River(one), Held::River(other)) => Held::River(one.min(other)),
            (_, other) => other,
        };
    }
}
