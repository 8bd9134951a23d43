//! Heights and water at the lattice points of a level.

use super::lakes::is_lake;
use super::law::slope_of_one_cell;
use super::level::Level;
use super::refinement::Refinement;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::direction::NONE;
use crate::progress::Progress;

/// The terrain at the lattice points of a level.
///
/// Standing water is either sea or a lake. Elsewhere the water level is NaN.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Surface {
    /// Height of the ground in metres; under water, the height of the bottom. The sea is at 0.
    pub height: Grid,
    /// Drainage area in m^2: exact on the finest level of valleys, the value of the nearest node on other levels.
    pub flow: Grid,
    /// Depth of lakes in metres; 0 elsewhere, also in the sea.
    pub lake_depth: Grid,
    /// Height of the surface of standing water in metres; 0 in the sea, NaN on land.
    pub water_level: Grid,
    /// Receiver as in [`Level`]: exact on the finest level of valleys, the value of the nearest node on other levels.
    pub receiver: Grid<u8>,
}

/// Square of the distance in cells within which nodes affect a point.
const RADIUS_SQUARED: f32 = 2.5;

/// Minimum depth of standing water, in metres.
const MIN_DEPTH: f32 = 0.5;

/// Mean change of heights by finer levels, indexed by the number of these levels, as a share of the rise from a node at
/// the source of a river to the next node up. Measured in mountains.
const MEAN_CHANGE: [f32; 7] = [0.0, -0.108, -0.083, -0.073, -0.025, 0.05, 0.05];

/// One point of a surface.
struct Point {
    height: f32,
    area: f32,
    lake_depth: f32,
    water_level: f32,
    receiver: u8,
}

impl Refinement {
    /// Number of samples of the level beyond a window that [`Refinement::surface`] reads.
    pub const SURFACE_REACH: usize = 2;

    /// The terrain at the lattice points of `window`, from a level that covers the window grown by
    /// [`Refinement::SURFACE_REACH`]. On levels other than the finest level of valleys, heights are interpolated
    /// between nodes. They include the mean change by finer levels.
    ///
    /// # Errors
    /// If the level covers too little, the window does not belong to the level, or the work is cancelled.
    pub fn surface(&self, level: &Level, window: &Window, progress: &Progress) -> Result<Surface> {
        self.surface_at(0.0, level, window, progress)
    }

    /// [`Refinement::surface`] at another position within the cells: at `share` of their sides, 0 for the lattice
    /// points, 0.5 for the middles. On the finest level of valleys points are always at its nodes.
    ///
    /// # Errors
    /// The errors of [`Refinement::surface`].
    pub fn surface_at(&self, share: f32, level: &Level, window: &Window, progress: &Progress) -> Result<Surface> {
        self.check(level.depth, window)?;
        let nodes = self.nodes_at(level.depth, window);
        level.check_covers("a surface", &nodes, Refinement::SURFACE_REACH)?;
        let square_metres = (self.cell_of(level.depth) * self.cell_of(level.depth)) as f32;
        let mut surface = Surface {
            height: Grid::filled(*window, 0.0),
            flow: Grid::filled(*window, 0.0),
            lake_depth: Grid::filled(*window, 0.0),
            water_level: Grid::filled(*window, f32::NAN),
            receiver: Grid::filled(*window, NONE),
        };
        progress.expect(window.height as f64);
        for j in 0..window.height {
            progress.step(1.0)?;
            for i in 0..window.width {
                let q = level.row(&nodes, j) + i;
                let point = if self.is_finest(level.depth) { node(level, q) } else { self.between(share, level, q) };
                surface.height[(i, j)] = point.height;
                surface.flow[(i, j)] = point.area * square_metres;
                surface.lake_depth[(i, j)] = point.lake_depth;
                surface.water_level[(i, j)] = point.water_level;
                surface.receiver[(i, j)] = point.receiver;
            }
        }
        Ok(surface)
    }

    /// The position of points at a share of the sides of cells, in cells from the corner of the node's cell.
    pub(super) fn inside(&self, depth: usize, share: f32) -> f32 {
        share + self.half_finest(depth) - self.ahead(depth) as f32
    }

    /// The mean change of heights by finer levels (see [`MEAN_CHANGE`]).
    pub(super) fn mean_change(&self, depth: usize) -> f32 {
        MEAN_CHANGE[self.levels.saturating_sub(depth).min(MEAN_CHANGE.len() - 1)]
    }

    /// The point at a share of the sides of cell `q`, offset by half a finest cell, from the nodes of 4 x 4 cells.
    /// These contain all nodes within the radius of a corner; for a middle, 3 x 3 cells do.
    fn between(&self, share: f32, level: &Level, q: usize) -> Point {
        let width = level.window.width;
        let inside = self.inside(level.depth, share);
        let (mut land, mut water) = (Plane::default(), Plane::default());
        let (mut shore, mut nearest, mut nearest_water) = (Plane::default(), (f32::INFINITY, q), (f32::INFINITY, q));
        for (row, south) in (0..4).map(|row| (q + row * width - 2 * width - 2, row as f32 - 2.0)) {
            for (o, east) in (0..4).map(|column| (row + column, column as f32 - 2.0)) {
                let (x, y) = (level.east[o] + east - inside, level.south[o] + south - inside);
                let square = x * x + y * y;
                let is_water = level.receiver[o] >= NONE;
                if square < nearest.0 {
                    nearest = (square, o);
                }
                if is_water && square < nearest_water.0 {
                    nearest_water = (square, o);
                }
                let weight = 1.0 - square / RADIUS_SQUARED;
                if weight > 0.0 {
                    let weight = weight * weight;
                    shore.add(weight, x, y, level.shore[o]);
                    land.add(weight, x, y, level.height[o]);
                    if is_water {
                        water.add(weight, x, y, bottom(level, o));
                    }
                }
            }
        }
        let (area, receiver) = (level.area[nearest.1], level.receiver[nearest.1]);
        if nearest_water.0 < f32::INFINITY && shore.mean() < 0.0 {
            let surface = level.height[nearest_water.1];
            let bed = if water.weight > 0.0 { water.mean() } else { bottom(level, nearest_water.1) };
            let bed = bed.min(surface - MIN_DEPTH);
            let bed = if is_lake(level.receiver[nearest_water.1]) { above_the_sea(bed, surface) } else { bed };
            let lake_depth = if surface > 0.0 { surface - bed } else { 0.0 };
            let receiver = level.receiver[nearest_water.1];
            return Point { height: bed, area, lake_depth, water_level: surface, receiver };
        }
        let change = self.mean_change(level.depth)
            * slope_of_one_cell(self, level.depth, level.variation[nearest.1] + level.uplift[nearest.1]);
        let height = land.at_origin() + change;
        // Land at a shore is at least as high as the water.
        let height = if nearest_water.0 < f32::INFINITY { height.max(level.height[nearest_water.1]) } else { height };
        Point { height, area, lake_depth: 0.0, water_level: f32::NAN, receiver: receiver.min(NONE) }
    }
}

/// A node of the finest level of valleys, which is at a lattice point.
fn node(level: &Level, q: usize) -> Point {
    let (height, area, receiver) = (level.height[q], level.area[q], level.receiver[q]);
    if receiver < NONE {
        return Point { height, area, lake_depth: 0.0, water_level: f32::NAN, receiver };
    }
    let bed = bottom(level, q);
    let lake_depth = if height > 0.0 { height - bed } else { 0.0 };
    Point { height: bed, area, lake_depth, water_level: height, receiver }
}

/// Slope of the bottom of lakes with an outlet, in metres per km from the shore, and their maximum depth in metres.
const VALLEY_LAKE: (f32, f32) = (80.0, 300.0);

/// Slope and maximum depth of lakes without an outlet.
const BASIN_LAKE: (f32, f32) = (8.0, 120.0);

/// Height of the bottom of standing water. The bottom of lakes falls from the shore to their maximum depth. The sea has
/// a shelf of 80 km, a continental slope and a deep plain.
fn bottom(level: &Level, q: usize) -> f32 {
    let (height, distance) = (level.height[q], (-level.shore[q]).max(0.0));
    if height > 0.0 {
        if is_lake(level.receiver[q]) {
            return above_the_sea(height - (VALLEY_LAKE.0 * distance).min(VALLEY_LAKE.1), height);
        }
        return height - (BASIN_LAKE.0 * distance).min(BASIN_LAKE.1);
    }
    sea_bottom(distance)
}

/// Height of the sea floor at a distance from the shore, in km.
pub(super) fn sea_bottom(distance: f32) -> f32 {
    let t = ((distance - 80.0) / 200.0).clamp(0.0, 1.0);
    let shelf = 1.8 * distance.min(80.0);
    let rise = ((distance - 280.0).max(0.0) * 1.5).min(1400.0);
    -(shelf + 3400.0 * t * t * (3.0 - 2.0 * t) + rise)
}

/// The bed of a lake with this surface, limited so that it is not below the sea, because a recipe's sea is where the
/// ground is at or below sea level.
fn above_the_sea(bed: f32, surface: f32) -> f32 {
    bed.max(0.5 * surface.min(1.0))
}

/// Weighted sums for the least-squares plane through values.
#[derive(Default)]
struct Plane {
    weight: f32,
    /// Sums of x, y and the values.
    first: [f32; 3],
    /// Sums of x x, x y, y y, x value and y value.
    second: [f32; 5],
}

impl Plane {
    #[inline(always)]
    fn add(&mut self, weight: f32, x: f32, y: f32, value: f32) {
        self.weight += weight;
        let (x_weight, y_weight) = (weight * x, weight * y);
        for (sum, term) in self.first.iter_mut().zip([x_weight, y_weight, weight * value]) {
            *sum += term;
        }
        let terms = [x_weight * x, x_weight * y, y_weight * y, x_weight * value, y_weight * value];
        for (sum, term) in self.second.iter_mut().zip(terms) {
            *sum += term;
        }
    }

    /// The mean value.
    fn mean(&self) -> f32 {
        self.first[2] / self.weight.max(1e-6)
    }

    /// The value of the plane at (0, 0). If all nodes lie on one side, it is limited to their values.
    fn at_origin(&self) -> f32 {
        let inverse = 1.0 / self.weight.max(1e-6);
        let [x, y, value] = self.first.map(|sum| sum * inverse);
        let [xx, xy, yy, x_value, y_value] = self.second.map(|sum| sum * inverse);
        // The small term prevents the plane from tilting if the nodes are on one line.
        let (a, b, d) = (xx - x * x + 0.02, xy - x * y, yy - y * y + 0.02);
        let (e, f) = (x_value - x * value, y_value - y * value);
        let determinant = a * d - b * b;
        value - (e * d - f * b) / determinant * x - (f * a - e * b) / determinant * y
    }
}
