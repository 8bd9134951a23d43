//! Mouths of rivers where shores are given. A sample of the shore on a coarse level can be water while only some of its
//! finer samples are, or none. The river is led to finer samples in the sea, or ends in an inland lake.

use super::children::heir;
use super::given::Given;
use super::level::{Level, direction};
use crate::hydrology::direction::{NONE, STEPS, is_diagonal, opposite};

/// Minimum size of an inland lake at a mouth without sea, as the distance from its node to its shore, in cells.
const INLAND: f32 = 1.0;

/// Height of the water of an inland lake, relative to the height of the lowest river that ends there.
const INLAND_HEIGHT: f32 = 0.5;

/// Height of land between a river and the sea, relative to the height of the lowest river that passes.
const PASSED_HEIGHT: f32 = 0.5;

/// Number of links downstream that must be in the sea, too, where rivers drown in the sea beside them: a river does not
/// end in a bay if it leaves it again. So many nodes around a node decide whether it drowns.
pub const DROWNED_LINKS: usize = 2;

/// The children of a node according to the given shore.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Below {
    /// The shore is not given for all children.
    Unknown,
    /// All children are land.
    Land,
    /// At least one child is sea: the one nearest to the heir, and its distance from the shore, negative, in km.
    Sea(u8, f32),
}

/// Leads mouths to the sea of the next level. A node of the sea moves to a child that is sea. If it has none, its
/// rivers continue to a neighboring node that has one; if there is none either, they end in an inland lake. A node of
/// land whose heir is sea becomes sea if its river ends there. If the shore is binding, rivers in the sea beside it
/// become sea before that. Nodes at the edge do not change.
pub fn lead(level: &mut Level, given: &Given) {
    if given.shore.is_none() {
        return;
    }
    let sea = |level: &Level, q: usize| match is_sea(level, q).then(|| below(level, given, q)) {
        Some(Below::Sea(_, shore)) => Some(shore),
        _ => None,
    };
    // Whether a river on land is in the sea of the given shore.
    let is_low = |level: &Level, q: usize| {
        level.receiver[q] < NONE
            && shore_of(level, given, q, heir(level, q)).is_some_and(|shore| shore < 0.0)
            && below(level, given, q) != Below::Unknown
            && lowest_donor(level, q).is_some()
    };
    let is_drowned =
        |level: &Level, q: usize| is_low(level, q) && level.downstream(q).is_some_and(|to| sea(level, to).is_some());
    if given.binding.is_some() {
        let is_beside = |level: &Level, q: usize| {
            let mut around = STEPS.iter().filter_map(|step| level.neighbor(q, *step));
            around.any(|near| sea(level, near).is_some())
        };
        let stays = |level: &Level, q: usize| {
            let mut at = q;
            (0..DROWNED_LINKS).all(|_| match level.downstream(at) {
                Some(to) if level.receiver[to] < NONE => {
                    at = to;
                    shore_of(level, given, to, heir(level, to)).is_some_and(|shore| shore < 0.0)
                }
                _ => true,
            })
        };
        let drowned = |q: &usize| is_low(level, *q) && is_beside(level, *q) && stays(level, *q);
        let drowned: Vec<usize> = level.inner(1).filter(drowned).collect();
        drowned.into_iter().for_each(|q| Change::Drown.apply(level, q));
    }
    let mut changes = Vec::new();
    for q in level.inner(1) {
        if is_sea(level, q) {
            let Some(lowest) = lowest_donor(level, q) else { continue };
            match below(level, given, q) {
                Below::Sea(corner, _) => changes.push((q, Change::Move(corner))),
                Below::Land => {
                    let code = way(level, |near| sea(level, near), q);
                    changes.push((q, code.map_or(Change::Inland(lowest), |code| Change::Lead(code, lowest))));
                }
                Below::Unknown => {}
            }
        } else if is_drowned(level, q) {
            changes.push((q, Change::Drown));
        }
    }
    for (q, change) in changes {
        change.apply(level, q);
    }
}

/// A change to a node at which rivers end, or near which they end.
enum Change {
    /// The node moves to a child.
    Move(u8),
    /// The node becomes land with this receiver, lower than its lowest donor.
    Lead(u8, f32),
    /// The node becomes an inland lake, lower than its lowest donor.
    Inland(f32),
    /// The node becomes sea.
    Drown,
}

impl Change {
    fn apply(&self, level: &mut Level, q: usize) {
        match *self {
            Change::Move(corner) => {
                level.east[q] = inside(level.east[q], corner & 1 == 1);
                level.south[q] = inside(level.south[q], corner & 2 == 2);
            }
            Change::Lead(code, lowest) => (level.receiver[q], level.height[q]) = (code, PASSED_HEIGHT * lowest),
            Change::Inland(lowest) => {
                let cell = (level.window.cell * 1e-3) as f32;
                (level.height[q], level.shore[q]) = (INLAND_HEIGHT * lowest, level.shore[q].min(-INLAND * cell));
            }
            Change::Drown => (level.receiver[q], level.height[q]) = (NONE, 0.0),
        }
    }
}

/// A position in a cell, mirrored if necessary so that it is in the first or the second half.
fn inside(share: f32, second: bool) -> f32 {
    if (share >= 0.5) == second { share } else { 1.0 - share }
}

/// Whether a node is in the sea.
fn is_sea(level: &Level, q: usize) -> bool {
    level.receiver[q] == NONE && level.height[q] == 0.0
}

/// The given distance of a child from the shore, in km.
fn shore_of(level: &Level, given: &Given, q: usize, corner: u8) -> Option<f32> {
    let (i, j) = ((q % level.window.width) as i64, (q / level.window.width) as i64);
    let (x, y) = (2 * (level.window.x + i), 2 * (level.window.y + j));
    given.shore_of_cell(x + i64::from(corner & 1), y + i64::from(corner >> 1))
}

/// The children of a node according to the given shore.
fn below(level: &Level, given: &Given, q: usize) -> Below {
    let own = heir(level, q);
    let mut found = Below::Land;
    // The heir, its two neighbors, and the opposite child.
    for flip in [0, 1, 2, 3] {
        let corner = own ^ flip;
        let Some(shore) = shore_of(level, given, q, corner) else { return Below::Unknown };
        let is_better = match found {
            Below::Sea(best, other) => flip == 2 && best != own && shore < other,
            _ => true,
        };
        if shore < 0.0 && is_better {
            found = Below::Sea(corner, shore);
        }
    }
    found
}

/// The height of the lowest river that ends at a node, which must not be at the edge.
fn lowest_donor(level: &Level, q: usize) -> Option<f32> {
    let donors = STEPS.iter().zip(0u8..).filter_map(|(step, code)| {
        let donor = level.neighbor(q, *step)?;
        (direction(level.receiver[donor]) == opposite(code)).then(|| level.height[donor])
    });
    donors.reduce(f32::min)
}

/// The direction from a node to the neighboring sea that is furthest from its shore. Directions across a side are
/// preferred, and no direction crosses a river.
fn way(level: &Level, sea: impl Fn(usize) -> Option<f32>, q: usize) -> Option<u8> {
    let mut best: Option<(bool, f32, u8)> = None;
    for (code, &step) in (0u8..).zip(&STEPS) {
        let Some(shore) = level.neighbor(q, step).and_then(&sea) else { continue };
        let found = (is_diagonal(code), shore, code);
        if best.is_none_or(|best| (found.0, found.1) < (best.0, best.1)) && !(found.0 && is_crossed(level, q, step)) {
            best = Some(found);
        }
    }
    best.map(|(_, _, code)| code)
}

/// Whether a river passes between the two cells next to a step across a corner.
fn is_crossed(level: &Level, q: usize, (east, south): (isize, isize)) -> bool {
    let leads = |from: (isize, isize), by: (isize, isize)| {
        let code = level.neighbor(q, from).map_or(NONE, |near| direction(level.receiver[near]));
        STEPS.get(usize::from(code)) == Some(&by)
    };
    leads((east, 0), (-east, south)) || leads((0, south), (east, -south))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Grid, Window};

    /// The middle of five rows of five nodes. Nodes from column `coast` on are sea, and land drains to the east.
    const MIDDLE: usize = 12;

    fn level(coast: usize) -> Level {
        let window = Window::new(5, 5, 1000.0).at(-2, -2);
        let plane = |value: &dyn Fn(usize) -> f32| (0..25).map(|q| value(q % 5)).collect::<Vec<f32>>();
        Level {
            depth: 0,
            window,
            east: plane(&|_| 0.3),
            south: plane(&|_| 0.3),
            height: plane(&|i| if i < coast { 100.0 - 10.0 * i as f32 } else { 0.0 }),
            area: plane(&|_| 1.0),
            receiver: (0..25).map(|q| if q % 5 < coast { 0 } else { NONE }).collect(),
            variation: plane(&|_| 0.0),
            uplift: plane(&|_| 0.0),
            shore: plane(&|i| if i < coast { 0.5 } else { -0.2 }),
        }
    }

    /// The level after [`lead`], where the given shore has sea at the children for which `is_sea` is true.
    fn led(mut level: Level, is_sea: impl Fn(usize, usize) -> bool) -> Level {
        let window = Window { x: -4, y: -4, width: 10, height: 10, cell: 500.0 };
        let metres = (0..100).map(|q| if is_sea(q % 10, q / 10) { -300.0 } else { 300.0 }).collect();
        let shore = Grid::from_data(window, metres).unwrap();
        lead(&mut level, &Given { shore: Some(&shore), ..Given::default() });
        level
    }

    #[test]
    fn a_mouth_moves_to_the_child_that_is_sea() {
        let found = led(level(2), |i, _| i >= 5);
        assert_eq!((found.east[MIDDLE], found.south[MIDDLE]), (0.7, 0.3));
        assert_eq!((found.receiver[MIDDLE], heir(&found, MIDDLE)), (NONE, 1));
        // The opposite child is taken if there is no other, and no node moves away from the sea.
        let found = led(level(2), |i, j| i == 5 && j == 5 || i > 5);
        assert_eq!(heir(&found, MIDDLE), 3);
        assert_eq!(led(level(2), |i, _| i >= 4), level(2));
    }

    #[test]
    fn a_river_goes_on_to_the_sea_beside_or_ends_in_a_lake() {
        let found = led(level(2), |i, _| i >= 6);
        assert_eq!((found.receiver[MIDDLE], found.height[MIDDLE]), (0, 45.0));
        // Sea only across a corner, with no river between.
        let found = led(level(2), |i, j| i >= 6 && j >= 6);
        assert_eq!(found.receiver[MIDDLE], 1);
        let found = led(level(2), |_, _| false);
        assert!(found.is_inland(MIDDLE) && found.receiver[MIDDLE] == NONE);
        assert_eq!((found.height[MIDDLE], found.shore[MIDDLE]), (45.0, -1.0));
        // Sea without rivers and nodes at the edge do not change.
        assert_eq!((found.height[MIDDLE + 1], found.height[22]), (0.0, 0.0));
    }

    #[test]
    fn land_before_the_sea_drowns_where_the_shore_is_behind_it() {
        let found = led(level(3), |i, _| i >= 4);
        assert_eq!((found.receiver[MIDDLE], found.height[MIDDLE]), (NONE, 0.0));
        // No change where the heir is land, nor at a node that is two nodes away from the sea.
        assert_eq!(led(level(3), |i, _| i >= 5), level(3));
        assert_eq!(led(level(4), |i, _| i >= 4).receiver[MIDDLE], 0);
    }

    #[test]
    fn without_a_shore_nothing_changes() {
        let mut found = level(2);
        lead(&mut found, &Given::default());
        assert_eq!(found, level(2));
        // No change where the shore has no values.
        let shore = Grid::filled(Window { x: -4, y: -4, width: 10, height: 10, cell: 500.0 }, f32::NAN);
        lead(&mut found, &Given { shore: Some(&shore), ..Given::default() });
        assert_eq!(found, level(2));
    }
}
