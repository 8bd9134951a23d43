//! Bridges and tunnels: straight moves over water and valleys, and through ridges.

use super::costs::of_grade;
use super::lattice::Lattice;
use super::lines::RoadKind;
use super::{Land, Roads};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;

/// Maximum columns and rows of a direction.
const DIRECTIONS: i32 = 3;
/// Jumps that begin at a node: the ones that save most.
const MOST: usize = 6;
/// Height by which the ground may rise above a bridge or fall below a tunnel between its ends, in metres.
const TOLERANCE: f64 = 1.0;
/// Depth of a valley under a bridge, and of a tunnel under its ridge, at least, in metres.
const DEPTHS: [f64; 2] = [4.0, 10.0];
/// Abutments and portals, as a length of road in widths of the road.
const ENDS: [f64; 2] = [4.0, 12.0];
/// Height of a bridge over ground that doubles its cost, in metres.
const HIGH: f64 = 60.0;

/// A bridge or a tunnel from a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jump {
    /// The node at its end.
    pub(super) to: u32,
    /// The cost.
    pub(super) cost: f32,
    /// Bridge or tunnel.
    pub(super) kind: RoadKind,
}

/// The jumps of all nodes.
#[derive(Default)]
pub(super) struct Jumps {
    /// Index of the first jump of each node, and the number of all.
    firsts: Vec<u32>,
    jumps: Vec<Jump>,
}

impl Jumps {
    pub(super) fn new(roads: &Roads, land: &Land, lattice: &Lattice, progress: &Progress) -> Result<Jumps> {
        let longest = roads.longest_bridge.max(roads.longest_tunnel);
        if longest < 2.0 * lattice.spacing {
            progress.finish();
            return Ok(Jumps::default());
        }
        let directions = directions();
        let [columns, rows] = lattice.size;
        progress.expect(rows as f64);
        let found: Vec<Vec<(u32, Jump)>> = parallel::try_map(0..rows, |row| {
            let mut found = Vec::new();
            let mut own: Vec<(f64, Jump)> = Vec::new();
            for node in row * columns..(row + 1) * columns {
                if lattice.blocked[lattice.sample(node)] {
                    continue;
                }
                own.clear();
                for direction in &directions {
                    March::new(roads, lattice, node, *direction).run(land, &mut own);
                }
                // Stable, so that equal ones stay in the order of directions.
                own.sort_by(|a, b| a.0.total_cmp(&b.0));
                found.extend(own.iter().take(MOST).map(|(_, jump)| (node as u32, *jump)));
            }
            progress.step(1.0)?;
            Ok(found)
        })?;
        let mut firsts = vec![0u32; lattice.len() + 1];
        for (from, jump) in found.iter().flatten() {
            firsts[*from as usize + 1] += 1;
            firsts[jump.to as usize + 1] += 1;
        }
        for node in 0..lattice.len() {
            firsts[node + 1] += firsts[node];
        }
        let nothing = Jump { to: 0, cost: f32::INFINITY, kind: RoadKind::Bridge };
        let mut jumps = vec![nothing; firsts[lattice.len()] as usize];
        let mut next = firsts.clone();
        let mut put = |from: u32, jump: Jump| {
            jumps[next[from as usize] as usize] = jump;
            next[from as usize] += 1;
        };
        for (from, jump) in found.into_iter().flatten() {
            put(from, jump);
            put(jump.to, Jump { to: from, ..jump });
        }
        Ok(Jumps { firsts, jumps })
    }

    /// The jumps from a node.
    pub(super) fn of(&self, node: usize) -> &[Jump] {
        match self.firsts.get(node..node + 2) {
            Some([first, end]) => &self.jumps[*first as usize..*end as usize],
            _ => &[],
        }
    }
}

/// One of each pair of opposite directions.
fn directions() -> Vec<[i32; 2]> {
    let lowest = |a: i32, b: i32| (2..=DIRECTIONS).all(|k| a % k != 0 || b % k != 0);
    let mut directions = Vec::new();
    for row in 0..=DIRECTIONS {
        for column in -DIRECTIONS..=DIRECTIONS {
            if (row > 0 || column == 1) && lowest(column, row) {
                directions.push([column, row]);
            }
        }
    }
    directions
}

/// A search straight ahead for the ends of a bridge and of a tunnel.
struct March<'a> {
    roads: &'a Roads,
    lattice: &'a Lattice,
    start: usize,
    direction: [i32; 2],
    /// Length of a step, in metres, and the height of the start.
    stride: f64,
    height: f64,
    /// Largest and smallest grade from the start to the ground between.
    steepest: f64,
    lowest: f64,
    /// Least and largest height of the ground between, and whether water is.
    range: [f64; 2],
    is_wet: bool,
    /// Cost of the road on the ground.
    ordinary: f64,
}

impl<'a> March<'a> {
    fn new(roads: &'a Roads, lattice: &'a Lattice, start: usize, direction: [i32; 2]) -> March<'a> {
        let [column, row] = direction.map(f64::from);
        March {
            roads,
            lattice,
            start,
            direction,
            stride: (column * column + row * row).sqrt() * lattice.spacing,
            height: f64::from(lattice.heights[start]),
            steepest: f64::NEG_INFINITY,
            lowest: f64::INFINITY,
            range: [f64::INFINITY, f64::NEG_INFINITY],
            is_wet: false,
            ordinary: 0.0,
        }
    }

    /// Adds the first bridge and the first tunnel in the direction, each with its cost over that of the ground.
    fn run(mut self, land: &Land, found: &mut Vec<(f64, Jump)>) {
        let [column, row] = self.lattice.place(self.start);
        let mut wanted = [self.roads.longest_bridge, self.roads.longest_tunnel];
        let (mut node, mut before) = (self.start, self.height);
        for k in 1i32.. {
            let length = f64::from(k) * self.stride;
            wanted.iter_mut().for_each(|longest| *longest = if length > *longest { 0.0 } else { *longest });
            if wanted == [0.0; 2] {
                return;
            }
            let next = [column + k * self.direction[0], row + k * self.direction[1]];
            let Some(next) = self.lattice.node(next) else { return };
            for (sample, share) in self.lattice.between(node, self.direction) {
                if !self.passes(land, sample, length - (1.0 - share) * self.stride) {
                    return;
                }
            }
            let height = f64::from(self.lattice.heights[next]);
            let sample = self.lattice.sample(next);
            let grade = (height - before) / self.stride;
            // On open ground a bridge begins where it falls, and a tunnel where it rises, too steeply for a road.
            if k == 1 && !self.is_wet && !self.lattice.blocked[sample] {
                let limits = [grade < -self.roads.grade, grade > self.roads.grade];
                wanted.iter_mut().zip(limits).for_each(|(longest, is)| *longest = if is { *longest } else { 0.0 });
            }
            self.ordinary += self.stride * of_grade(self.roads, grade);
            if !self.lattice.blocked[sample] && height.is_finite() {
                for (kind, longest) in [RoadKind::Bridge, RoadKind::Tunnel].into_iter().zip(&mut wanted) {
                    if *longest > 0.0
                        && k > 1
                        && let Some(cost) = self.ends(kind, length, height)
                    {
                        *longest = 0.0;
                        let over = if self.is_wet { 0.0 } else { cost / self.ordinary };
                        if over < 1.0 {
                            found.push((over, Jump { to: next as u32, cost: cost as f32, kind }));
                        }
                    }
                }
            }
            if !self.passes(land, sample, length) {
                return;
            }
            (node, before) = (next, height);
        }
    }

    /// Notes a sample on the way; false where there is no height.
    fn passes(&mut self, land: &Land, sample: usize, distance: f64) -> bool {
        let height = f64::from(land.ground.data()[sample]);
        if self.lattice.wet[sample] {
            self.is_wet = true;
            return height.is_finite();
        }
        self.steepest = self.steepest.max((height - TOLERANCE - self.height) / distance);
        self.lowest = self.lowest.min((height + TOLERANCE - self.height) / distance);
        self.range = [self.range[0].min(height), self.range[1].max(height)];
        true
    }

    /// The cost of a bridge or tunnel that ends here; `None` if it cannot.
    fn ends(&self, kind: RoadKind, length: f64, height: f64) -> Option<f64> {
        let grade = (height - self.height) / length;
        let [bridge, tunnel] = DEPTHS;
        let fits = match kind {
            RoadKind::Bridge => {
                self.steepest <= grade && (self.is_wet || self.range[0] + bridge < self.height.min(height))
            }
            _ => self.lowest >= grade && !self.is_wet && self.range[1] - tunnel > self.height.max(height),
        };
        if grade.abs() > self.roads.grade || !fits {
            return None;
        }
        let share = grade / self.roads.grade;
        let (each, ends) = match kind {
            RoadKind::Bridge => {
                let high = (self.height.min(height) - self.range[0]).max(0.0);
                (self.roads.bridge_cost * (1.0 + if high.is_finite() { high / HIGH } else { 0.0 }), ENDS[0])
            }
            _ => (self.roads.tunnel_cost, ENDS[1]),
        };
        Some((length * each + ends * self.roads.width) * (1.0 + 0.5 * share * share))
    }
}
