//! Cuts and embankments: the ground under roads and beside them.

use super::lines::{RoadKind, RoadLine};
use super::{Land, RoadLayers, Roads};
use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::progress::Progress;

/// Slope of the walls at the end of cuts and embankments that are too wide.
const WALL: f64 = 3.0;
/// Greatest height of a wall, in metres.
const HIGHEST: f64 = 60.0;
/// Half the width of a road in the ground, at least, in samples: along any direction it has a sample in each step.
const NARROWEST: f64 = 0.75;

/// The land beside all roads, at a sample.
#[derive(Clone, Copy)]
struct Section {
    /// The height below which embankments fill the ground, and the distance of their road.
    least: [f32; 2],
    /// The height down to which cuts are made, and the distance of their road.
    most: [f32; 2],
    /// Height and distance of the nearest road on the ground.
    road: [f32; 2],
    /// Distance and kind of the nearest road of any kind.
    nearest: (f32, u8),
}

/// A part of a line between two points.
struct Piece {
    ends: [[f64; 3]; 2],
    kind: RoadKind,
}

/// The ground with roads, and their layers. The lines are relative to the first sample, and relative to the world's
/// origin afterwards.
pub(super) fn build(roads: &Roads, land: &Land, mut lines: Vec<RoadLine>, progress: &Progress) -> Result<RoadLayers> {
    let window = *land.ground.window();
    let nowhere = f32::INFINITY;
    let empty = Section {
        least: [f32::NEG_INFINITY, nowhere],
        most: [nowhere; 2],
        road: [0.0, nowhere],
        nearest: (nowhere, 0),
    };
    let mut sections = vec![empty; window.len()];
    let half = (0.5 * roads.width).max(NARROWEST * window.cell);
    for line in &lines {
        progress.check()?;
        for (k, ends) in line.points.windows(2).enumerate() {
            add(roads, &window, half, &Piece { ends: [ends[0], ends[1]], kind: line.kinds[k] }, &mut sections);
        }
    }
    progress.step(1.0)?;
    let mut height = land.ground.data().to_vec();
    let (mut road, mut kind) = (vec![0.0f32; window.len()], vec![0.0f32; window.len()]);
    let mut change = vec![0.0f32; window.len()];
    let side = (0.25 * roads.width).max(window.cell);
    for (cell, section) in sections.iter().enumerate() {
        let before = land.ground.data()[cell];
        if before.is_finite() && section.road[1].is_finite() {
            height[cell] = section.height(before, half as f32);
            change[cell] = height[cell] - before;
        }
        let beyond = (f64::from(section.road[1]) - 0.5 * roads.width) / side;
        let share = (1.0 - beyond).clamp(0.0, 1.0);
        road[cell] = (share * share * (3.0 - 2.0 * share)) as f32;
        if section.nearest.0 <= half as f32 {
            kind[cell] = f32::from(section.nearest.1);
        }
    }
    let origin = [window.east(0), window.south(0)];
    for point in lines.iter_mut().flat_map(|line| &mut line.points) {
        (point[0], point[1]) = (point[0] + origin[0], point[1] + origin[1]);
    }
    let grid = |data: Vec<f32>| {
        Grid::from_data(window, data).ok_or_else(|| Error::new(ErrorKind::Internal, "a plane of another length"))
    };
    Ok(RoadLayers { height: grid(height)?, road: grid(road)?, kind: grid(kind)?, change: grid(change)?, lines })
}

impl Section {
    /// The height of ground beside roads.
    fn height(&self, ground: f32, half: f32) -> f32 {
        if self.road[1] <= half {
            return self.road[0];
        }
        let ([least, one], [most, other]) = (self.least, self.most);
        if least <= most {
            return ground.max(least).min(most);
        }
        // Between two roads that are too close for their slopes: a wall, at the height of each road beside it.
        let (one, other) = ((one - half).max(0.0), (other - half).max(0.0));
        let share = if one + other > 0.0 { one / (one + other) } else { 0.5 };
        least + (most - least) * share
    }
}

/// Height of a cut or an embankment at a distance from the road.
fn rise(roads: &Roads, slope: f64, distance: f64) -> f64 {
    let beyond = (distance - roads.slope_width).max(0.0);
    slope * (distance - beyond) + WALL.max(slope) * beyond
}

/// Adds a piece to the sections around it.
fn add(roads: &Roads, window: &Window, half: f64, piece: &Piece, sections: &mut [Section]) {
    let is_ground = piece.kind == RoadKind::Road;
    let reach = half + if is_ground { roads.slope_width + HIGHEST / WALL } else { window.cell };
    let span = |axis: usize, count: usize| {
        let [a, b] = piece.ends.map(|end| end[axis]);
        let start = ((a.min(b) - reach) / window.cell).floor() as i64;
        let end = ((a.max(b) + reach) / window.cell).ceil() as i64 + 1;
        let limit = |at: i64| at.clamp(0, count as i64) as usize;
        limit(start)..limit(end)
    };
    let (columns, rows) = (span(0, window.width), span(1, window.height));
    let [from, to] = piece.ends;
    let along = [to[0] - from[0], to[1] - from[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    for j in rows {
        for i in columns.clone() {
            let away = [i as f64 * window.cell - from[0], j as f64 * window.cell - from[1]];
            let share = match square > 0.0 {
                true => ((away[0] * along[0] + away[1] * along[1]) / square).clamp(0.0, 1.0),
                false => 0.0,
            };
            let [x, y] = [away[0] - share * along[0], away[1] - share * along[1]];
            let distance = (x * x + y * y).sqrt();
            if distance > reach {
                continue;
            }
            let section = &mut sections[j * window.width + i];
            let near = distance as f32;
            if near < section.nearest.0 {
                section.nearest = (near, piece.kind as u8);
            }
            if !is_ground {
                continue;
            }
            let level = from[2] + share * (to[2] - from[2]);
            if near < section.road[1] {
                section.road = [level as f32, near];
            }
            let beside = (distance - half).max(0.0);
            let least = (level - rise(roads, roads.embankment_slope, beside)) as f32;
            if least > section.least[0] {
                section.least = [least, near];
            }
            let most = (level + rise(roads, roads.cut_slope, beside)) as f32;
            if most < section.most[0] {
                section.most = [most, near];
            }
        }
    }
}
