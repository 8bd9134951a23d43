//! What a road costs, in metres of level road on level ground.

use super::lattice::Lattice;
use super::moves::HALF;
use super::{Land, Roads};
use crate::error::Result;
use crate::parallel;
use crate::progress::Progress;

/// Share of the maximum grade for which routes are planned: smooth curves are shorter than routes.
const PLANNED: f64 = 0.88;
/// Additional cost at that grade, and of grades beyond it, linear and quadratic in the excess.
const AT_GRADE: f64 = 1.0;
const BEYOND: [f64; 2] = [8.0, 16.0];
/// Additional cost where the ground falls across the road as steeply as its cuts, and of steeper ground.
const ACROSS: f64 = 1.5;
const WALL: f64 = 4.0;
/// Additional cost per metre of height, and per square metre, by which a straight move is above or below the ground at
/// most.
const EARTHWORKS: [f64; 2] = [0.15, 0.04];
/// Limits of the factor that recipes give.
const FACTORS: std::ops::RangeInclusive<f64> = 0.05..=1e6;

/// A factor of a recipe.
pub(super) fn factor(given: f32) -> f64 {
    // A sample without a factor is barred, see `Lattice`.
    if given.is_nan() { *FACTORS.end() } else { f64::from(given).clamp(*FACTORS.start(), *FACTORS.end()) }
}

/// The factor of a grade.
pub(super) fn of_grade(roads: &Roads, grade: f64) -> f64 {
    let share = grade.abs() / (PLANNED * roads.grade);
    let beyond = (share - 1.0).max(0.0);
    1.0 + AT_GRADE * share.min(1.0) * share.min(1.0) + beyond * (BEYOND[0] + BEYOND[1] * beyond)
}

/// Bridges and tunnels with this cost per metre, or more, are more expensive than [`least`] at any grade up to the
/// maximum.
const STEEPER: f64 = 2.5;

/// The least cost of any road over a distance and a height. The factor of grades is convex, so an even grade is the
/// cheapest; a road that would be too steep is longer than the distance.
pub(super) fn least(roads: &Roads, distance: f64, height: f64) -> f64 {
    let run = height.abs() / (PLANNED * roads.grade);
    if !run.is_finite() || roads.bridge_cost.min(roads.tunnel_cost) < STEEPER {
        return distance;
    }
    if run >= distance { (1.0 + AT_GRADE) * run } else { distance + AT_GRADE * run * run / distance }
}

/// The part of a road's cost for earthworks of a height.
fn of_earthworks(height: f64) -> f64 {
    height * (EARTHWORKS[0] + EARTHWORKS[1] * height)
}

/// The costs of the first half of the moves from each node; infinite where a road cannot be.
pub(super) fn of_moves(roads: &Roads, land: &Land, lattice: &Lattice, progress: &Progress) -> Result<Vec<f32>> {
    let mut costs = vec![f32::INFINITY; lattice.len() * HALF];
    let [columns, rows] = lattice.size;
    progress.expect(rows as f64);
    parallel::try_for_each(costs.chunks_mut(columns * HALF).enumerate(), |(row, costs)| {
        for (column, costs) in costs.chunks_mut(HALF).enumerate() {
            let node = row * columns + column;
            if lattice.blocked[lattice.sample(node)] {
                continue;
            }
            for (cost, step) in costs.iter_mut().zip(&lattice.moves.steps) {
                if let Some(found) = of_move(roads, land, lattice, node, *step) {
                    *cost = found as f32;
                }
            }
        }
        progress.step(1.0)
    })?;
    Ok(costs)
}

/// The ground's slope at a node, east and south.
fn slope(lattice: &Lattice, node: usize) -> [f64; 2] {
    let [column, row] = lattice.place(node);
    let height = |at: [i32; 2]| lattice.node(at).map(|node| f64::from(lattice.heights[node])).filter(|h| h.is_finite());
    let along = |before: [i32; 2], after: [i32; 2]| {
        let own = f64::from(lattice.heights[node]);
        match (height(before), height(after)) {
            (Some(before), Some(after)) => (after - before) / (2.0 * lattice.spacing),
            (Some(before), None) => (own - before) / lattice.spacing,
            (None, Some(after)) => (after - own) / lattice.spacing,
            (None, None) => 0.0,
        }
    };
    [along([column - 1, row], [column + 1, row]), along([column, row - 1], [column, row + 1])]
}

fn of_move(roads: &Roads, land: &Land, lattice: &Lattice, from: usize, step: [i32; 2]) -> Option<f64> {
    let [column, row] = lattice.place(from);
    let to = lattice.node([column + step[0], row + step[1]])?;
    if lattice.blocked[lattice.sample(to)] {
        return None;
    }
    let direction = step.map(f64::from);
    let nodes = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt();
    let length = nodes * lattice.spacing;
    let [low, high] = [from, to].map(|node| f64::from(lattice.heights[node]));
    let factors = land.cost.map(|cost| cost.data());
    let at = |sample: usize| factors.map_or(1.0, |factors| factor(factors[sample]));
    let mut factor = 0.5 * (at(lattice.sample(from)) + at(lattice.sample(to)));
    let (mut deepest, mut samples) = (0.0f64, 1.0);
    for (sample, share) in lattice.between(from, step) {
        if lattice.blocked[sample] {
            return None;
        }
        let height = f64::from(land.ground.data()[sample]);
        deepest = deepest.max((height - (low + share * (high - low))).abs());
        factor += at(sample);
        samples += 1.0;
    }
    let across = [from, to].map(|node| {
        let [east, south] = slope(lattice, node);
        let across = (east * direction[1] - south * direction[0]).abs() / nodes / roads.cut_slope;
        ACROSS * across * across + WALL * (across - 1.0).max(0.0)
    });
    let each = of_grade(roads, (high - low) / length) + 0.5 * (across[0] + across[1]) + of_earthworks(deepest);
    Some(length * each * factor / samples)
}
