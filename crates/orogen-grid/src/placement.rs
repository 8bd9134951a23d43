//! Placement of scattered points by density, by water, and by distance to other points.

use crate::error::Result;
use crate::grid::Grid;
use crate::poisson_discs::{DiscPoint, PoissonDiscs, square};
use crate::progress::Progress;
use crate::triangles;
use std::ops::Range;

/// Where points may be placed.
#[derive(Debug)]
pub struct Placement<'a> {
    /// All points are within these eastings and southings, in metres.
    pub bounds: [Range<f64>; 2],
    /// Number of points as a share of the greatest possible one, 0 to 1. There are no points where it is NaN.
    pub density: &'a Grid,
    /// The water that points need or avoid; `None` if it does not matter.
    pub water: Option<PlacementWater<'a>>,
    /// Points that were placed before and their minimum distance to the new ones.
    pub near: Vec<NearPoints>,
}

/// The water of a terrain, as a condition for points.
#[derive(Debug)]
pub struct PlacementWater<'a> {
    /// Heights in metres.
    pub heights: &'a Grid,
    /// Depths of lakes, in metres.
    pub lakes: Option<&'a Grid>,
    /// The height of the sea, in metres.
    pub sea_level: f64,
    /// Whether points are placed only in water; otherwise only on land.
    pub is_wanted: bool,
}

impl Placement<'_> {
    /// The points within the bounds.
    ///
    /// # Errors
    /// Those of [`PoissonDiscs::within`].
    pub fn points(
        &self,
        discs: &PoissonDiscs,
        within: &[Range<f64>; 2],
        progress: &Progress,
    ) -> Result<Vec<DiscPoint>> {
        discs.within(within, |position| self.at(position), progress)
    }

    fn at(&self, position: [f64; 2]) -> f64 {
        let is_within = self.bounds.iter().zip(position).all(|(side, at)| (side.start..=side.end).contains(&at));
        // NaN is treated like a density of 0.
        let density = if is_within { interpolated(self.density, position) } else { 0.0 };
        let is_right = |water: &PlacementWater| water.is_wet(position) == water.is_wanted;
        let is_free = density > 0.0
            && self.water.as_ref().is_none_or(is_right)
            && !self.near.iter().any(|near| near.is_within(position));
        if is_free { density } else { 0.0 }
    }
}

impl PlacementWater<'_> {
    fn is_wet(&self, position: [f64; 2]) -> bool {
        wet(self.heights, self.lakes, self.sea_level, position)
    }
}

/// The corners of the cell around a position, and the position in the cell: 0 to 1 along each side.
fn cell(grid: &Grid, position: [f64; 2]) -> Option<([f32; 4], [f64; 2])> {
    let window = grid.window();
    // Independent of the window, so that all windows give the same bits.
    let [east, south] = position.map(|at| at / window.cell);
    let [column, row] = [east.floor(), south.floor()];
    let i = usize::try_from(column as i64 - window.x).ok()?;
    let j = usize::try_from(row as i64 - window.y).ok()?;
    let corner = |i, j| grid.get(i, j);
    let corners = [corner(i, j)?, corner(i + 1, j)?, corner(i, j + 1)?, corner(i + 1, j + 1)?];
    Some((corners, [east - column, south - row]))
}

/// Bilinear interpolation; NaN outside the grid.
fn interpolated(grid: &Grid, position: [f64; 2]) -> f64 {
    let Some((corners, [u, v])) = cell(grid, position) else { return f64::NAN };
    let [nw, ne, sw, se] = corners.map(f64::from);
    let [north, south] = [nw + u * (ne - nw), sw + u * (se - sw)];
    north + v * (south - north)
}

/// The height of the triangle mesh of the samples at a position in metres; NaN outside the grid. See
/// [`triangles::height`].
#[must_use]
pub fn height(heights: &Grid, position: [f64; 2]) -> f64 {
    cell(heights, position).map_or(f64::NAN, |(corners, at)| triangles::height(corners, at))
}

/// Whether a position is in the sea or in a lake. Near the shore of a lake, the interpolated depth decides.
fn wet(heights: &Grid, lakes: Option<&Grid>, sea_level: f64, position: [f64; 2]) -> bool {
    let is_above = height(heights, position) > sea_level;
    !is_above || lakes.is_some_and(|lakes| interpolated(lakes, position) > 0.0)
}

/// The mean of all samples, where samples that are not positive count as 0.
#[must_use]
pub fn mean(grid: &Grid) -> f64 {
    let sum: f64 = grid.data().iter().filter(|value| **value > 0.0).map(|value| f64::from(*value)).sum();
    sum / grid.data().len().max(1) as f64
}

/// Points in square buckets, to find those near a position.
#[derive(Debug)]
pub struct NearPoints {
    distance: f64,
    bucket: f64,
    first: [i64; 2],
    columns: i64,
    rows: i64,
    /// The index of the first point of each bucket, then the number of points.
    starts: Vec<usize>,
    points: Vec<[f64; 2]>,
}

/// Maximum number of buckets along a side.
const MAX_BUCKETS: f64 = 1024.0;

impl NearPoints {
    /// Memory in bytes for `points` points.
    #[must_use]
    pub fn memory(points: usize) -> u64 {
        let buckets = (MAX_BUCKETS + 2.0) * (MAX_BUCKETS + 2.0);
        (points * size_of::<[f64; 2]>()) as u64 + buckets as u64 * size_of::<usize>() as u64
    }

    /// Buckets of `points` (positions with their random bits), to which others keep at least `distance` metres.
    #[must_use]
    pub fn new(points: &[([f64; 2], u64)], distance: f64) -> NearPoints {
        let ends = |axis: usize| {
            let start = points.iter().map(|(at, _)| at[axis]).fold(f64::INFINITY, f64::min);
            let end = points.iter().map(|(at, _)| at[axis]).fold(f64::NEG_INFINITY, f64::max);
            start..end.max(start)
        };
        if points.is_empty() {
            let starts = vec![0];
            return NearPoints {
                distance,
                bucket: distance,
                first: [0; 2],
                columns: 0,
                rows: 0,
                starts,
                points: Vec::new(),
            };
        }
        let [across, down] = [ends(0), ends(1)];
        let bucket = distance.max((across.end - across.start).max(down.end - down.start) / MAX_BUCKETS);
        let number = |at: f64| (at / bucket).floor() as i64;
        let first = [number(across.start), number(down.start)];
        let (columns, rows) = (number(across.end) - first[0] + 1, number(down.end) - first[1] + 1);
        let of = |[x, y]: [f64; 2]| ((number(y) - first[1]) * columns + number(x) - first[0]) as usize;
        let mut points: Vec<[f64; 2]> = points.iter().map(|(at, _)| *at).collect();
        points.sort_by_key(|at| of(*at));
        let mut starts = vec![0; (columns * rows) as usize + 1];
        points.iter().for_each(|at| starts[of(*at) + 1] += 1);
        (1..starts.len()).for_each(|k| starts[k] += starts[k - 1]);
        NearPoints { distance, bucket, first, columns, rows, starts, points }
    }

    /// Whether a point is nearer to `position` than the distance.
    fn is_within(&self, position: [f64; 2]) -> bool {
        let [column, row] = [0, 1].map(|axis| (position[axis] / self.bucket).floor() as i64 - self.first[axis]);
        let rows = (row - 1).max(0)..(row + 2).min(self.rows);
        let (from, to) = ((column - 1).max(0), (column + 2).min(self.columns));
        from < to
            && rows.into_iter().any(|row| {
                let [start, end] = [from, to].map(|column| self.starts[(row * self.columns + column) as usize]);
                self.points[start..end].iter().any(|at| square(*at, position) < self.distance * self.distance)
            })
    }
}
