//! Routes of least cost on the lattice (A*). A state is a node and the sector of the direction in which it is reached,
//! so that the cost of turns counts.

use super::Roads;
use super::costs;
use super::heap::Heap;
use super::lattice::Lattice;
use super::lines::RoadKind;
use super::moves::{COUNT, HALF, SECTORS, sector};
use super::ways::Ways;
use crate::error::Result;
use crate::progress::Progress;
use std::collections::BTreeSet;

/// How a state is reached: a move by its number, a jump, or not at all because a route begins there.
const JUMP: u8 = 254;
const START: u8 = 255;
/// The state before a start.
const NONE: u32 = u32::MAX;
/// States between two reports of progress.
const STEP: usize = 1 << 10;

/// Roads that exist already.
#[derive(Default)]
pub(super) struct Existing {
    /// The moves from each node, as bits; empty as long as there are no roads.
    moves: Vec<u128>,
    /// The ends of bridges and tunnels.
    jumps: BTreeSet<[u32; 2]>,
}

impl Existing {
    fn has_move(&self, node: usize, number: usize) -> bool {
        self.moves.get(node).is_some_and(|moves| moves >> number & 1 == 1)
    }

    fn has_jump(&self, ends: [u32; 2]) -> bool {
        self.jumps.contains(&ends)
    }

    /// Whether a link of a route exists.
    pub(super) fn has(&self, lattice: &Lattice, link: &Link) -> bool {
        match link.kind {
            Some(_) => self.has_jump([link.from, link.to]),
            None => number(lattice, link).is_some_and(|number| self.has_move(link.from as usize, number)),
        }
    }

    /// Adds the links of a route, in both directions.
    pub(super) fn add(&mut self, lattice: &Lattice, links: &[Link]) {
        if self.moves.is_empty() {
            self.moves = vec![0; lattice.len()];
        }
        for link in links {
            match (link.kind, number(lattice, link)) {
                (Some(_), _) => {
                    self.jumps.insert([link.from, link.to]);
                    self.jumps.insert([link.to, link.from]);
                }
                (None, Some(number)) => {
                    self.moves[link.from as usize] |= 1 << number;
                    self.moves[link.to as usize] |= 1 << ((number + HALF) % COUNT);
                }
                (None, None) => {}
            }
        }
    }
}

/// A part of a route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    /// The nodes at its ends.
    pub(super) from: u32,
    pub(super) to: u32,
    /// Bridge or tunnel; `None` for a move on the ground.
    pub(super) kind: Option<RoadKind>,
}

/// The number of a link's move.
fn number(lattice: &Lattice, link: &Link) -> Option<usize> {
    let step = between(lattice, link.from as usize, link.to as usize);
    lattice.moves.steps.iter().position(|known| *known == step)
}

/// Columns and rows from a node to another.
fn between(lattice: &Lattice, from: usize, to: usize) -> [i32; 2] {
    let [from, to] = [lattice.place(from), lattice.place(to)];
    [to[0] - from[0], to[1] - from[1]]
}

/// A search, whose arrays are used again by the next one.
pub(super) struct Search<'a> {
    roads: &'a Roads,
    lattice: &'a Lattice,
    ways: &'a Ways,
    costs: Vec<f64>,
    before: Vec<u32>,
    by: Vec<u8>,
}

impl<'a> Search<'a> {
    pub(super) fn new(roads: &'a Roads, lattice: &'a Lattice, ways: &'a Ways) -> Search<'a> {
        Search { roads, lattice, ways, costs: Vec::new(), before: Vec::new(), by: Vec::new() }
    }

    /// The links of the cheapest route between two nodes, and its cost; `None` if there is none.
    pub(super) fn run(
        &mut self,
        [from, to]: [usize; 2],
        existing: &Existing,
        progress: &Progress,
    ) -> Result<Option<(Vec<Link>, f64)>> {
        let lattice = self.lattice;
        let states = lattice.len() * SECTORS;
        progress.expect(states as f64);
        self.costs.clear();
        self.costs.resize(states, f64::INFINITY);
        self.before.clear();
        self.before.resize(states, NONE);
        self.by.clear();
        self.by.resize(states, START);
        let least = self.ways.least.min(1.0) * if existing.moves.is_empty() { 1.0 } else { self.roads.reuse.min(1.0) };
        let goal = lattice.place(to);
        let rest = |node: usize| {
            let [column, row] = lattice.place(node);
            let [x, y] = [f64::from(column - goal[0]), f64::from(row - goal[1])];
            let height = f64::from(lattice.heights[node]) - f64::from(lattice.heights[to]);
            costs::least(self.roads, (x * x + y * y).sqrt() * lattice.spacing, height) * least
        };
        let mut heap = Heap::new(states);
        let start = (from * SECTORS) as u32;
        self.costs[start as usize] = 0.0;
        heap.push(start, rest(from));
        let mut expanded = 0usize;
        while let Some(state) = heap.pop() {
            expanded += 1;
            if expanded.is_multiple_of(STEP) {
                progress.step(STEP as f64)?;
            }
            let node = state as usize / SECTORS;
            if node == to {
                progress.finish();
                return Ok(Some((self.links(state), self.costs[state as usize])));
            }
            self.expand(state, existing, |state, cost| heap.push(state, cost + rest(state as usize / SECTORS)));
        }
        progress.finish();
        Ok(None)
    }

    /// Lowers the costs of the states that a state leads to.
    fn expand(&mut self, state: u32, existing: &Existing, mut push: impl FnMut(u32, f64)) {
        let (lattice, ways) = (self.lattice, self.ways);
        let node = state as usize / SECTORS;
        let (cost, by) = (self.costs[state as usize], self.by[state as usize]);
        let came = match by {
            JUMP => between(lattice, self.before[state as usize] as usize / SECTORS, node),
            START => [0; 2],
            number => lattice.moves.steps[usize::from(number)],
        };
        let [column, row] = lattice.place(node);
        let mut reach = |to: usize, sector: u8, by: u8, total: f64| {
            let next = to * SECTORS + usize::from(sector);
            if total < self.costs[next] {
                self.costs[next] = total;
                self.before[next] = state;
                self.by[next] = by;
                push(next as u32, total);
            }
        };
        for (number, step) in lattice.moves.steps.iter().enumerate() {
            let turn = match by {
                START => 0.0,
                JUMP => lattice.moves.turn(came, *step),
                by => lattice.moves.turn_between(usize::from(by), number),
            };
            if turn.is_infinite() {
                continue;
            }
            let Some(to) = lattice.node([column + step[0], row + step[1]]) else { continue };
            let each = match number < HALF {
                true => ways.costs[node * HALF + number],
                false => ways.costs[to * HALF + number - HALF],
            };
            if each.is_finite() {
                let share = if existing.has_move(node, number) { self.roads.reuse } else { 1.0 };
                reach(to, lattice.moves.sectors[number], number as u8, cost + (f64::from(each) + turn) * share);
            }
        }
        for jump in ways.jumps.of(node) {
            let step = between(lattice, node, jump.to as usize);
            let turn = if by == START { 0.0 } else { lattice.moves.turn(came, step) };
            if turn.is_finite() {
                let share = if existing.has_jump([node as u32, jump.to]) { self.roads.reuse } else { 1.0 };
                reach(jump.to as usize, sector(step), JUMP, cost + (f64::from(jump.cost) + turn) * share);
            }
        }
    }

    /// The links of the route to a state.
    fn links(&self, state: u32) -> Vec<Link> {
        let mut links = Vec::new();
        let mut state = state as usize;
        while self.before[state] != NONE {
            let before = self.before[state];
            let [from, to] = [before as usize / SECTORS, state / SECTORS];
            let kind = (self.by[state] == JUMP).then(|| {
                let jump = self.ways.jumps.of(from).iter().filter(|jump| jump.to as usize == to);
                let cheapest = jump.min_by(|a, b| a.cost.total_cmp(&b.cost));
                cheapest.map_or(RoadKind::Bridge, |jump| jump.kind)
            });
            links.push(Link { from: from as u32, to: to as u32, kind });
            state = before as usize;
        }
        links.reverse();
        links
    }
}
