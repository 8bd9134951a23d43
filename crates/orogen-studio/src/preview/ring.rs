//! A part of a picture with finer samples.

use std::sync::Arc;

use orogen::budget::Reservation;
use orogen::{Grid, Progress, Result, Window, World};
use serde::{Deserialize, Serialize};

use super::frame::{Frame, Key};
use super::request::Request;
use super::sunlight::{beyond, sunlight};
use super::{cover, failure};
use crate::platform::wire;

/// A part of a picture with finer samples, in the colors and the light of the picture.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ring {
    /// The picture that it belongs to.
    pub frame: Key,
    /// The heights of that picture.
    #[serde(with = "wire::shared")]
    pub land: Arc<Grid>,
    /// The heights of the surface, in metres.
    #[serde(with = "wire::shared")]
    pub heights: Arc<Grid>,
    /// Colors without light, as in a [`Frame`].
    #[serde(with = "wire::bytes")]
    pub albedo: Vec<u8>,
    /// The light, as in a [`Frame`].
    #[serde(with = "wire::bytes")]
    pub light: Vec<u8>,
    /// The memory of the ring, which counts towards the budget of the session that made it.
    #[serde(skip)]
    pub memory: Option<Arc<Reservation>>,
}

impl Ring {
    /// The window.
    #[must_use]
    pub fn window(&self) -> &Window {
        self.heights.window()
    }

    /// The height at a position in metres; `None` outside.
    #[must_use]
    pub fn height(&self, place: [f64; 2]) -> Option<f32> {
        let [i, j] = nearest(self.window(), place);
        let is_inside = |at: i64, count: usize| (0..count as i64).contains(&at);
        (is_inside(i, self.window().width) && is_inside(j, self.window().height))
            .then(|| self.heights.get(i as usize, j as usize))?
    }

    /// Makes a ring of a picture. `known` are heights that may already have been computed.
    ///
    /// # Errors
    /// If the world fails, or the ring does not fit into the memory.
    pub fn make(
        world: &World,
        (request, frame): (&Request, &Frame),
        window: &Window,
        known: &[Arc<Grid>],
        progress: &Progress,
    ) -> Result<Ring> {
        let memory = Some(Arc::new(world.budget().reserve(Frame::memory(window))?));
        let heights = match known.iter().find(|grid| grid.window() == window) {
            Some(heights) => Arc::clone(heights),
            None => Arc::new(grid(world, &request.surface, window, progress)?),
        };
        let mut albedo = albedo(world, request, frame, &heights, progress)?;
        if let Some(rivers) = &frame.rivers {
            rivers.paint(window, &mut albedo);
        }
        progress.check()?;
        let sea_level = frame.sea_level as f32;
        let light = world.install(|| {
            let mut light = sunlight(&heights, sea_level, request.sun);
            beyond(&mut light, &heights, &frame.heights, sea_level, request.sun);
            light
        });
        Ok(Ring { frame: frame.key(), land: Arc::clone(&frame.heights), heights, albedo, light, memory })
    }

    /// Whether its heights differ visibly from those that a coarser grid has between its samples: by more than `share`
    /// of its cell.
    #[must_use]
    pub fn adds_to(&self, coarse: &Grid, share: f64) -> bool {
        let (window, limit) = (self.window(), (share * self.window().cell) as f32);
        let ratio = window.cell / coarse.window().cell;
        let at = |column: usize, row: usize| {
            let along =
                |at: usize, first: i64, coarse_first: i64| (first + at as i64) as f64 * ratio - coarse_first as f64;
            [along(column, window.x, coarse.window().x), along(row, window.y, coarse.window().y)]
        };
        (0..window.height).step_by(3).any(|row| {
            let heights = self.heights.row(row);
            (1..window.width).step_by(2).any(|column| {
                let differs = |coarse: f32| (heights.get(column).copied().unwrap_or(coarse) - coarse).abs() > limit;
                between(coarse, at(column, row)).is_some_and(differs)
            })
        })
    }
}

/// The sample closest to a position, from the first one of a window.
fn nearest(window: &Window, [east, south]: [f64; 2]) -> [i64; 2] {
    let sample = |metres: f64| (metres / window.cell).round() as i64;
    [sample(east) - window.x, sample(south) - window.y]
}

/// The height between the samples of a grid, at a column and row.
fn between(grid: &Grid, [column, row]: [f64; 2]) -> Option<f32> {
    let [i, j] = [column, row].map(|at| at.floor().max(0.0) as usize);
    let [u, v] = [(column - i as f64) as f32, (row - j as f64) as f32];
    let mix = |a: f32, b: f32, share: f32| if share > 0.0 { a + (b - a) * share } else { a };
    let along = |row: usize| {
        let next = if u > 0.0 { grid.get(i + 1, row)? } else { 0.0 };
        Some(mix(grid.get(i, row)?, next, u))
    };
    let below = if v > 0.0 { along(j + 1)? } else { 0.0 };
    Some(mix(along(j)?, below, v))
}

/// A layer over a window.
fn grid(world: &World, layer: &str, window: &Window, progress: &Progress) -> Result<Grid> {
    world.grids(&[layer], window, progress)?.pop().ok_or_else(failure::nothing)
}

/// Colors without light: in the colors of the picture, whose range of values differs from that of the ring.
fn albedo(world: &World, request: &Request, frame: &Frame, heights: &Grid, progress: &Progress) -> Result<Vec<u8>> {
    let window = heights.window();
    let Some(colors) = &frame.colors else {
        return Ok(cover::paint(world, &request.coloring, heights, &frame.heights, progress)?.0);
    };
    if request.layer == request.surface {
        return Ok(colors.paint(heights));
    }
    // Layers that are derived from the heights depend on the cell, or on all of the land. Their colors are those of the
    // picture.
    if world.plan(&[&request.layer], window).is_err() {
        return Ok(enlarged(frame, window));
    }
    Ok(colors.paint(&grid(world, &request.layer, window, progress)?))
}

/// The colors of a picture over a window with finer samples.
fn enlarged(frame: &Frame, window: &Window) -> Vec<u8> {
    let land = frame.window();
    let ratio = window.cell / land.cell;
    let along = |at: usize, first: i64, of_land: i64, count: usize| {
        let at = ((first + at as i64) as f64 * ratio - of_land as f64).clamp(0.0, (count - 1) as f64);
        let first = (at.floor() as usize).min(count.saturating_sub(2));
        (first, (first + 1).min(count - 1), at - first as f64)
    };
    let mut bytes = Vec::with_capacity(4 * window.width * window.height);
    for j in 0..window.height {
        let (above, below, v) = along(j, window.y, land.y, land.height);
        for i in 0..window.width {
            let (left, right, u) = along(i, window.x, land.x, land.width);
            bytes.extend((0..4).map(|part| {
                let byte = |i: usize, j: usize| f64::from(frame.albedo[4 * (j * land.width + i) + part]);
                let mix = |a: f64, b: f64, share: f64| a + (b - a) * share;
                let rows = [above, below].map(|row| mix(byte(left, row), byte(right, row), u));
                (mix(rows[0], rows[1], v) + 0.5) as u8
            }));
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_between_samples() {
        let grid = Grid::from_data(Window::new(3, 2, 10.0), vec![0.0, 10.0, 20.0, 100.0, 110.0, 120.0]).unwrap();
        for (at, expect) in [([0.0, 0.0], 0.0), ([0.5, 0.0], 5.0), ([2.0, 1.0], 120.0), ([1.5, 0.5], 65.0)] {
            assert_eq!(between(&grid, at), Some(expect));
        }
        assert_eq!(between(&grid, [2.5, 0.0]), None);
    }
}
