//! River sediment on valley floors.

use super::growth::FLOOR_AREA;
use super::growth_row::FLOOR_WIDTH;
use super::law::MAX_FLOOR_FACTOR;
use super::level::Level;
use super::refinement::Refinement;
use super::surface::Surface;
use crate::erosion::power::power;
use crate::error::Result;
use crate::grid::Grid;
use crate::hydrology::direction::{DISTANCES, STEPS};
use crate::progress::Progress;
use std::collections::BinaryHeap;
use std::f32::consts::E;

/// Slope of the rock below a floor: the continuation of the sides of the valley.
const ROCK_SLOPE: f32 = 0.25;

/// Maximum slope of a floor, and minimum slope of a hillside.
const FLOOR_SLOPE: f32 = 0.03;
const STEEP: f32 = 0.1;

/// Distance in metres to the hillside at which the slope is halfway between these two.
const FOOT: f32 = 60.0;

/// Units of distance to the hillside per cell, and per diagonal of a cell. Sums of integers do not depend on the path.
const UNITS: [u32; 2] = [64, 91];

/// Ground of this slope counts twice, steeper ground more: the factor is 1 + (slope / `FRICTION_SLOPE`)^2.
const FRICTION_SLOPE: f32 = 0.04;

/// Upper limit of the thickness of the sediment, which the widest floors approach, in metres.
const THICKEST: f32 = 100.0;

/// Half the width of the widest floor, in metres and in cells.
const WIDEST: f64 = 4000.0;
const MAX_CELLS: usize = 128;

impl Refinement {
    /// Samples of a level beyond a window that [`Refinement::sediment`] reads.
    #[must_use]
    pub fn sediment_reach(&self, depth: usize) -> usize {
        Refinement::SURFACE_REACH + self.floor_cells(depth) + 3
    }

    fn floor_cells(&self, depth: usize) -> usize {
        self.cells_in(depth, WIDEST, MAX_CELLS)
    }

    /// Thickness in metres of the river sediment at the points of a surface of this level; 0 on hillsides and in
    /// standing water. `share` is the position within cells at which the surface was made (see
    /// [`Refinement::surface_at`]).
    ///
    /// # Errors
    /// If the level does not cover the surface's window grown by [`Refinement::sediment_reach`], or the work is
    /// cancelled.
    pub fn sediment(&self, share: f32, level: &Level, surface: &Surface, progress: &Progress) -> Result<Grid> {
        let window = surface.height.window();
        let nodes = self.nodes_at(level.depth, window);
        level.check_covers("sediment", &nodes, self.sediment_reach(level.depth))?;
        let cell = self.cell_of(level.depth) as f32;
        let fill = spread(level, cell, self.fills(level), progress)?;
        let hillside = hillside_distances(level, cell, self.floor_cells(level.depth) as u32);
        progress.check()?;
        let mut thickness = Grid::filled(*window, 0.0f32);
        for j in 0..window.height {
            progress.check()?;
            for i in 0..window.width {
                if surface.water_level[(i, j)].is_nan() {
                    let q = self.nearest_node(share, level, level.row(&nodes, j) + i);
                    // The foot of a hillside is halfway between a node of the floor and a node of the hillside.
                    let metres = (hillside[q] as f32 / UNITS[0] as f32 - 0.5).max(0.0) * cell;
                    let depth = fill[q].min(ROCK_SLOPE * metres);
                    thickness[(i, j)] = THICKEST * depth / (THICKEST + depth);
                }
            }
        }
        Ok(thickness)
    }

    /// The depth of the rock below rivers, in metres; 0 elsewhere.
    fn fills(&self, level: &Level) -> Vec<f32> {
        let cell = self.cell_of(level.depth);
        let share_of_a_cell = (cell * cell * 1e-6 / FLOOR_AREA) as f32;
        let widest = (self.floor_cells(level.depth) as f64 * cell) as f32;
        let fill = |q: usize| {
            let share = level.area[q] * share_of_a_cell;
            if share <= 1.0 || level.is_water(q) {
                return 0.0;
            }
            // On detail levels `variation` contains the whole logarithm.
            let logarithm = level.variation[q] + if self.is_detail(level.depth) { 0.0 } else { level.uplift[q] };
            let factor = power(E, -logarithm).min(MAX_FLOOR_FACTOR) * (share - 1.0).min(1.0);
            let half = (FLOOR_WIDTH * share.sqrt() * factor).min(widest);
            ROCK_SLOPE * half * flatness(level, cell as f32, q)
        };
        (0..level.window.len()).map(fill).collect()
    }
}

/// 1 where the ground on both sides of a river is a floor, 0 where it is steep.
fn flatness(level: &Level, cell: f32, q: usize) -> f32 {
    let side = |turn: u8| {
        let Some(beside) = level.neighbor(q, STEPS[usize::from((level.receiver[q] + turn) & 7)]) else { return 0.0 };
        let distance = DISTANCES[usize::from((level.receiver[q] + turn) & 7)] as f32 * cell;
        let slope = (level.height[beside] - level.height[q]).abs() / distance;
        ((STEEP - slope) / (STEEP - FLOOR_SLOPE)).clamp(0.0, 1.0)
    };
    0.5 * (side(2) + side(6))
}

/// Distance from each node to the nearest hillside in units of [`UNITS`], at most `most` cells, by steps to the eight
/// neighbors.
fn hillside_distances(level: &Level, cell: f32, most: u32) -> Vec<u32> {
    let width = level.window.width;
    let most = most * UNITS[0];
    let mut distance = vec![most; level.window.len()];
    for q in level.inner(1) {
        let at = |q: usize| level.height[q];
        let across = |a: usize, b: usize, by: usize| {
            at(b - by) + 2.0 * at(b) + at(b + by) - at(a - by) - 2.0 * at(a) - at(a + by)
        };
        let (east, south) = (across(q - 1, q + 1, width), across(q - width, q + width, 1));
        let slope = (east * east + south * south).sqrt() / (8.0 * cell);
        let foot = FOOT * (STEEP - slope).max(0.0) / (slope - FLOOR_SLOPE).max(1e-6);
        distance[q] = most.min((foot / cell * UNITS[0] as f32) as u32);
    }
    let mut lower = |q: usize, from: usize, by: u32| distance[q] = distance[q].min(distance[from] + by);
    for q in level.inner(1) {
        for (from, by) in [(q - width - 1, 1), (q - width, 0), (q - width + 1, 1), (q - 1, 0)] {
            lower(q, from, UNITS[by]);
        }
    }
    for q in level.inner(1).rev() {
        for (from, by) in [(q + width + 1, 1), (q + width, 0), (q + width - 1, 1), (q + 1, 0)] {
            lower(q, from, UNITS[by]);
        }
    }
    distance
}

/// Spreads the fill from rivers over the floors. A node gets the largest value that is left along any path from a
/// river. Each link of a path reduces the value by the slope of the rock times the length, and by more where the ground
/// is steeper than a floor.
fn spread(level: &Level, cell: f32, mut fill: Vec<f32>, progress: &Progress) -> Result<Vec<f32>> {
    // The bits of positive numbers sort like the numbers.
    let rivers = fill.iter().enumerate().filter(|(_, fill)| **fill > 0.0);
    let mut waiting: BinaryHeap<(u32, usize)> = rivers.map(|(q, fill)| (fill.to_bits(), q)).collect();
    let mut taken = 0usize;
    while let Some((bits, q)) = waiting.pop() {
        taken += 1;
        if taken & 0xFFFF == 0 {
            progress.check()?;
        }
        if bits < fill[q].to_bits() {
            continue;
        }
        for (step, distance) in STEPS.iter().zip(DISTANCES) {
            let Some(to) = level.neighbor(q, *step).filter(|to| !level.is_water(*to)) else { continue };
            let metres = distance as f32 * cell;
            let slope = (level.height[to] - level.height[q]) / (FRICTION_SLOPE * metres);
            let left = f32::from_bits(bits) - ROCK_SLOPE * metres * (1.0 + slope * slope);
            if left > fill[to] {
                fill[to] = left;
                waiting.push((left.to_bits(), to));
            }
        }
    }
    Ok(fill)
}
