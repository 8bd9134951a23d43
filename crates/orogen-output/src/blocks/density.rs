//! The shape of the ground in space: what the output `density` of a recipe adds to the heights.
//!
//! The density minus the depth below the ground, density - (height - altitude), is sampled at every fourth column, row
//! and level of the world and interpolated linearly between them. So the ground keeps the detail of its heights, and a
//! chunk needs few samples in space.

use super::levels::Levels;
use orogen_engine::World;
use orogen_engine::budget::Reservation;
use orogen_engine::world::HEIGHT;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;

/// The output with the density of the ground in space, in metres: solid where it is above 0.
pub const DENSITY: &str = "density";

/// Distance between samples, in blocks.
pub const STEP: i64 = 4;

/// Maximum number of samples that are computed at once.
const AT_ONCE: usize = 1 << 20;

/// Density offsets over a part of the world.
#[derive(Debug)]
pub(super) struct Offsets {
    /// The horizontal samples; their column and row in the world are multiples of [`STEP`].
    nodes: Window,
    /// The index of the lowest sample of a column; its level is the index times [`STEP`].
    lowest: i64,
    /// Samples per column.
    count: usize,
    /// The offsets, column by column, each from the bottom.
    offsets: Vec<f32>,
    _memory: Reservation,
}

impl Offsets {
    /// The offsets over a window of columns and a range of levels, for a density in land with exaggerated altitudes.
    ///
    /// Fails if the layers cannot be made, or `progress` is cancelled.
    pub(super) fn of(
        world: &World,
        columns: &Window,
        levels: Levels,
        exaggeration: f64,
        progress: &Progress,
    ) -> Result<Offsets> {
        let cell = columns.cell;
        let range = |from: i64, to: i64| (from.div_euclid(STEP), (to - 1).div_euclid(STEP) + 2);
        let ((west, east), (north, south)) = (range(columns.x, columns.right()), range(columns.y, columns.bottom()));
        let (lowest, highest) =
            range(i64::from(levels.bottom), i64::from(levels.top()).max(i64::from(levels.bottom) + 1));
        let (width, height) = ((east - west) as usize, (south - north) as usize);
        let nodes = world.surroundings(&Window { x: west, y: north, width, height, cell: cell * STEP as f64 }, 0);
        let count = (highest - lowest) as usize;
        let memory = world.budget().reserve((nodes.len() as u64).saturating_mul(4 * count as u64))?;
        let altitudes: Vec<f64> =
            (lowest..highest).map(|node| Levels::middle((node * STEP) as i32, cell) / exaggeration).collect();
        let mut offsets = vec![0.0; nodes.len() * count];
        progress.expect(nodes.height as f64);
        let rows = (AT_ONCE / (nodes.width * count).max(1)).max(1);
        for top in (0..nodes.height).step_by(rows) {
            let band = Window { y: nodes.y + top as i64, height: rows.min(nodes.height - top), ..nodes };
            let heights = world.grids(&[HEIGHT], &band, &Progress::none())?;
            let densities = world.volume(DENSITY, &band, &altitudes)?;
            for (k, altitude) in altitudes.iter().enumerate() {
                let samples = densities.slice(k).iter().zip(heights.iter().flat_map(|grid| grid.data()));
                for (at, (density, height)) in samples.enumerate() {
                    let offset = exaggeration * (f64::from(*density) - (f64::from(*height) - altitude));
                    // Where the density is missing, the offset is 0.
                    offsets[(top * nodes.width + at) * count + k] =
                        if offset.is_finite() { offset as f32 } else { 0.0 };
                }
            }
            progress.step(band.height as f64)?;
        }
        Ok(Offsets { nodes, lowest, count, offsets, _memory: memory })
    }

    /// The offsets of a column at the levels of the samples, from the lowest, into `out`.
    pub(super) fn column(&self, [x, y]: [i64; 2], out: &mut Vec<f32>) {
        let along = |at: i64, start: i64, length: usize| {
            let node = at.div_euclid(STEP);
            let [here, next] = [node, node + 1].map(|node| (node - start).clamp(0, length as i64 - 1) as usize);
            (here, next, at.rem_euclid(STEP) as f32 / STEP as f32)
        };
        let (west, east, u) = along(x, self.nodes.x, self.nodes.width);
        let (north, south, v) = along(y, self.nodes.y, self.nodes.height);
        let at = |column: usize, row: usize| {
            let start = (row * self.nodes.width + column) * self.count;
            &self.offsets[start..start + self.count]
        };
        let (nw, ne, sw, se) = (at(west, north), at(east, north), at(west, south), at(east, south));
        out.clear();
        out.extend((0..self.count).map(|k| {
            let (upper, lower) = (nw[k] + (ne[k] - nw[k]) * u, sw[k] + (se[k] - sw[k]) * u);
            upper + (lower - upper) * v
        }));
    }

    /// The offset of a column's [samples](Offsets::column) at a level.
    #[inline]
    pub(super) fn at(&self, column: &[f32], level: i32) -> f32 {
        let place = i64::from(level) - self.lowest * STEP;
        let [here, next] = [0, 1].map(|step| (place.div_euclid(STEP) + step).clamp(0, self.count as i64 - 1) as usize);
        column[here] + (column[next] - column[here]) * (place.rem_euclid(STEP) as f32 / STEP as f32)
    }
}
