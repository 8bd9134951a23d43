//! Scattered objects over a window: trees, rocks, houses.

use std::ops::Range;

use super::world::World;
use crate::recipe::outputs::{HEIGHT, LAKES};
use crate::recipe::scatter::document::{ExpandedScatter, InWater, Scatter, Turn};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::placement::{NearPoints, Placement, PlacementWater, height, mean};
use orogen_grid::poisson_discs::{POINTS, PoissonDiscs};
use orogen_grid::progress::Progress;
use orogen_grid::random::Random;
use orogen_ops::budget::Reservation;

/// An object on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// The index of its entry in [`Recipe::scatter`](crate::Recipe::scatter).
    pub entry: usize,
    /// Metres east and south of the world's origin.
    pub position: [f64; 2],
    /// Height of the ground in metres, on the full mesh of the window's samples.
    pub height: f64,
    /// Scale factor.
    pub size: f64,
    /// Rotation about the vertical axis in degrees, clockwise seen from above, 0 to less than 360.
    pub turn: f64,
}

impl World {
    /// The recipe's [scatter](crate::recipe::scatter::document::Scatter) over a window: the objects from its first
    /// sample up to, but not including, one cell beyond its last one. Adjacent windows therefore never share an object.
    /// The objects are ordered by entry, then row by row of a lattice.
    ///
    /// The objects and their positions do not depend on the window and its cell: conditions are computed at the entry's
    /// cell, by default the world's. Heights are computed from the window's samples.
    ///
    /// # Errors
    /// If the recipe has no scatter or no layer `height`, the window is not valid for this world, memory does not
    /// suffice, or the work was cancelled.
    pub fn objects(&self, window: &Window, progress: &Progress) -> Result<Vec<Object>> {
        self.check(window)?;
        self.unit(HEIGHT)?;
        let recipe = self.recipe();
        let entries: Vec<(&Scatter, &ExpandedScatter)> =
            recipe.scatter().iter().zip(recipe.expanded_scatter()).collect();
        if entries.is_empty() {
            let message = "the recipe has no objects; add a table `[[scatter]]` with `name` and `spacing`";
            return Err(Error::new(ErrorKind::Request, message));
        }
        let side = |first: i64, samples: usize, most: Option<f64>| {
            let ends = [first, first + samples as i64].map(|sample| sample as f64 * window.cell);
            let most = most.unwrap_or(f64::INFINITY);
            let least = if most.is_finite() { 0.0 } else { f64::NEG_INFINITY };
            ends[0].max(least)..ends[1].min(most)
        };
        let size = recipe.world.size;
        let bounds = [
            side(window.x, window.width, size.map(|size| size[0])),
            side(window.y, window.height, size.map(|size| size[1])),
        ];
        if bounds.iter().any(|side| side.is_empty()) {
            return Ok(Vec::new());
        }
        progress.expect(2.0 * entries.len() as f64 + 1.0);
        let beyond = beyond(&entries);
        let mut placed: Vec<Placed> = Vec::new();
        for ((entry, expanded), beyond) in entries.iter().zip(beyond) {
            let points = self.placed(entry, expanded, &grown(&bounds, beyond), &placed, progress)?;
            placed.push(points);
        }
        let ground = samples(&bounds, window.cell);
        let heights = self.grids_beside(&[HEIGHT], &ground, 0, &progress.part(1.0))?;
        let Some(heights) = heights.first() else { return Ok(Vec::new()) };
        // Without spare capacity, which would not be in the memory of the points.
        let mut objects = Vec::with_capacity(placed.iter().map(|placed| placed.points.len()).sum());
        for (entry, (placed, (scatter, _))) in placed.iter().zip(&entries).enumerate() {
            for (position, bits) in placed.points.iter().copied() {
                let height = height(heights, position);
                if bounds.iter().zip(position).all(|(side, at)| side.contains(&at)) && height.is_finite() {
                    let mut random = Random::of_state(bits);
                    let [low, high] = scatter.size;
                    let size = (low + random.share() * (high - low)).clamp(low, high);
                    let turn = match scatter.turn {
                        Turn::Random => random.share() * 360.0,
                        Turn::Fixed(degrees) => degrees,
                    };
                    objects.push(Object { entry, position, height, size, turn });
                }
            }
        }
        Ok(objects)
    }

    /// The points of an entry within bounds, at their clearance from the points `placed` before.
    fn placed(
        &self,
        entry: &Scatter,
        expanded: &ExpandedScatter,
        bounds: &[Range<f64>; 2],
        before: &[Placed],
        progress: &Progress,
    ) -> Result<Placed> {
        let recipe = self.recipe();
        let discs = PoissonDiscs::new(entry.spacing, recipe.world.world_params().seed_of(entry.seed));
        let mut around = grown(bounds, discs.reach());
        if let Some(size) = recipe.world.size {
            let clipped = |side: &Range<f64>, most: f64| side.start.max(0.0)..side.end.min(most);
            around = [clipped(&around[0], size[0]), clipped(&around[1], size[1])];
        }
        let mut layers = vec![expanded.density.as_str()];
        if entry.water != InWater::Any {
            layers.push(HEIGHT);
            layers.extend(recipe.outputs().any(|output| output == LAKES).then_some(LAKES));
        }
        let window = samples(&around, entry.cell.unwrap_or(recipe.world.cell));
        if recipe.world.size.is_none() {
            self.check(&window)?;
        }
        let grids = self.grids_beside(&layers, &window, 0, &progress.part(1.0))?;
        let _grids = self.budget().reserve((window.len().saturating_mul(layers.len() * size_of::<f32>())) as u64)?;
        let Some((density, water)) = grids.split_first() else { return Err(missing()) };
        // All points within and around the bounds.
        let area = window.len() as f64 * window.cell * window.cell;
        let count = area / (entry.spacing * entry.spacing) * POINTS * mean(density).min(1.0) * 1.02 + 1000.0;
        let held = self.budget().reserve((count * POINT_MEMORY) as u64)?;
        let before = if entry.clearance > 0.0 { before } else { &[] };
        let searched: u64 = before.iter().map(|placed| NearPoints::memory(placed.points.len())).sum();
        let _search = self.budget().reserve(searched.saturating_add(PoissonDiscs::memory(self.threads())))?;
        let near: Vec<NearPoints> =
            before.iter().map(|placed| NearPoints::new(&placed.points, entry.clearance)).collect();
        let sea_level = recipe.world.sea_level;
        let water = match (entry.water, water) {
            (InWater::Any, _) | (_, []) => None,
            (wanted, [heights, lakes @ ..]) => {
                Some(PlacementWater { heights, lakes: lakes.first(), sea_level, is_wanted: wanted == InWater::Only })
            }
        };
        let placement = Placement { bounds: around, density, water, near };
        // There are no points outside the world, however far the bounds extend.
        let bounds = match recipe.world.size {
            Some(size) => {
                [0, 1].map(|k| bounds[k].start.max(-entry.spacing)..bounds[k].end.min(size[k] + entry.spacing))
            }
            None => bounds.clone(),
        };
        let points = self.install(|| placement.points(&discs, &bounds, &progress.part(1.0)))?;
        let points = points.into_iter().map(|point| (point.position, point.bits)).collect();
        Ok(Placed { points, _held: held })
    }
}

/// Memory per point, in bytes: in the list of its entry, in the search, and in the list of all entries.
const POINT_MEMORY: f64 = 144.0;

/// The points of an entry, with their random bits.
struct Placed {
    points: Vec<([f64; 2], u64)>,
    _held: Reservation,
}

/// Distance beyond the window to which the points of each entry are needed, in metres, because points of later entries
/// depend on them.
fn beyond(entries: &[(&Scatter, &ExpandedScatter)]) -> Vec<f64> {
    let mut beyond = vec![0.0; entries.len()];
    let mut furthest: f64 = 0.0;
    for (k, (entry, _)) in entries.iter().enumerate().rev() {
        beyond[k] = furthest;
        if entry.clearance > 0.0 {
            let reach = PoissonDiscs::new(entry.spacing, 0).reach();
            furthest = furthest.max(beyond[k] + reach + entry.clearance);
        }
    }
    beyond
}

fn grown(bounds: &[Range<f64>; 2], by: f64) -> [Range<f64>; 2] {
    bounds.clone().map(|side| side.start - by..side.end + by)
}

/// The samples around all positions within bounds.
fn samples(bounds: &[Range<f64>; 2], cell: f64) -> Window {
    let [columns, rows] = bounds.clone().map(|side| {
        let [first, last] = [side.start, side.end].map(|at| (at / cell).floor() as i64);
        (first, last.saturating_sub(first).saturating_add(2).max(1) as usize)
    });
    Window { x: columns.0, y: rows.0, width: columns.1, height: rows.1, cell }
}

fn missing() -> Error {
    Error::new(ErrorKind::Internal, "the density of an entry of `scatter` was not computed")
}
