//! Shores: lakes as polygons with islands, and the coast of the sea, interpolated between samples at the water level.

use std::collections::BTreeMap;

use super::clip::Rectangle;
use super::given::snapped;
use super::joints::Path;
use super::rings::nested;
use super::water::{Frame, Water};
use crate::contour::chaikin::chaikin;
use crate::contour::line::Line;
use crate::contour::trace::contours;
use crate::error::Result;
use crate::grid::{Grid, Window};

/// Offset in metres that replaces an exact 0, for samples exactly at the water level.
const HARDLY: f32 = 1e-3;

/// The shores of lakes and of the sea, as lines in columns and rows. With north up, in the direction of the line, land
/// is to the right of the shore of a lake and to the left of the coast of the sea.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Shores {
    /// Rings whose last point repeats the first; coasts of the sea may be open.
    pub lines: Vec<Path>,
    /// The water of each line: the number of a lake, or 0 for the sea.
    pub waters: Vec<u32>,
}

impl Shores {
    /// All shores within a frame, with corners cut `rounds` times. Lakes that extend beyond the frame are closed along
    /// its sides.
    ///
    /// # Errors
    /// If there are more shores than can be numbered.
    pub fn of(water: &Water, frame: &Frame, rounds: usize) -> Result<Shores> {
        let mut shores = Shores::default();
        for line in contours(&depths(water, frame), &[0.0])? {
            let Some(lake) = line.points.iter().find_map(|at| wet_beside(*at, &water.labels)) else { continue };
            shores.lines.push(chaikin(&shared(line, water), rounds).path().collect());
            shores.waters.push(lake);
        }
        if let Some(rise) = water.sea_level.and_then(|sea| over_the_sea(water, frame, sea)) {
            for line in contours(&rise, &[0.0])? {
                shores.lines.push(chaikin(&shared(line, water), rounds).path().collect());
                shores.waters.push(0);
            }
        }
        Ok(shores)
    }

    /// The shores of the sea within a rectangle.
    #[must_use]
    pub fn coasts_within(&self, rectangle: &Rectangle) -> Shores {
        let lines: Vec<Path> = self.coasts().flat_map(|line| rectangle.lines(line)).collect();
        Shores { waters: vec![0; lines.len()], lines }
    }

    /// The lakes within a rectangle as polygons, in the order of their numbers, without lakes that are too small.
    #[must_use]
    pub fn areas_within(&self, water: &Water, rectangle: &Rectangle) -> Vec<LakeArea> {
        let mut areas = self.areas();
        areas.retain(|area| !water.is_small(area.lake));
        for area in &mut areas {
            area.parts = area.parts.iter().flat_map(|part| rectangle.polygons(part)).collect();
        }
        areas.retain(|area| !area.parts.is_empty());
        areas
    }

    /// The coast of the sea.
    pub fn coasts(&self) -> impl Iterator<Item = &Path> {
        self.lines.iter().zip(&self.waters).filter(|(_, water)| **water == 0).map(|(line, _)| line)
    }

    /// The lakes as polygons, in the order of their numbers.
    #[must_use]
    pub fn areas(&self) -> Vec<LakeArea> {
        let mut of_lake: BTreeMap<u32, Vec<&Path>> = BTreeMap::new();
        for (line, lake) in self.lines.iter().zip(&self.waters).filter(|(_, water)| **water > 0) {
            if line.len() > 3 && line.first() == line.last() {
                of_lake.entry(*lake).or_default().push(line);
            }
        }
        let area = |(lake, rings): (u32, Vec<&Path>)| LakeArea { lake, parts: nested(rings) };
        of_lake.into_iter().map(area).filter(|area| !area.parts.is_empty()).collect()
    }
}

/// A lake as a multipolygon: parts, each an outer ring and its islands.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LakeArea {
    /// The number of the lake, from 1.
    pub lake: u32,
    /// The parts, the largest first.
    pub parts: Vec<Vec<Path>>,
}

/// A shore. For a given network, its positions have the same bits in every window.
fn shared(mut line: Line, water: &Water) -> Line {
    if water.network.is_some() {
        line.points.iter_mut().for_each(|point| *point = point.map(snapped));
        line.points.dedup();
    }
    line
}

/// Depth of the water in lakes, for the samples of a frame and one sample around it. Negative values are the height of
/// the adjacent land above the water. A high wall around the frame makes shores follow its outermost samples.
fn depths(water: &Water, frame: &Frame) -> Grid {
    const WALL: f32 = -1e30;
    let (columns, rows) = (&frame.columns, &frame.rows);
    let window =
        Window::new(columns.len() + 2, rows.len() + 2, 1.0).at(columns.start as i64 - 1, rows.start as i64 - 1);
    let mut depth = Grid::filled(window, WALL);
    let (width, height) = (water.heights.width(), water.heights.height());
    let level = |label: u32| water.lakes[label as usize - 1].level;
    for j in rows.clone() {
        for i in columns.clone() {
            let here = water.heights[(i, j)];
            let around = || {
                let rows = j.saturating_sub(1)..(j + 2).min(height);
                rows.flat_map(move |y| (i.saturating_sub(1)..(i + 2).min(width)).map(move |x| water.labels[(x, y)]))
            };
            let beside = || around().filter(|other| *other > 0).map(level).reduce(f32::max);
            depth.row_mut(j - rows.start + 1)[i - columns.start + 1] = match water.labels[(i, j)] {
                0 => beside().map_or(-1.0, |level| (level - here).min(-HARDLY)),
                label => (level(label) - here).max(HARDLY),
            };
        }
    }
    depth
}

/// The height above the sea of the samples of a frame. Samples at sea level belong to the sea.
fn over_the_sea(water: &Water, frame: &Frame, sea: f32) -> Option<Grid> {
    let (columns, rows) = (&frame.columns, &frame.rows);
    let window = Window::new(columns.len(), rows.len(), 1.0).at(columns.start as i64, rows.start as i64);
    let rise = |height: f32| if height > sea { (height - sea).max(HARDLY) } else { (height - sea).min(-HARDLY) };
    // A given lake is not the sea, even if its bed is below sea level.
    let lakes = if water.network.is_some() { water.lakes.as_slice() } else { &[] };
    let level = |lake: u32| lakes.get((lake as usize).wrapping_sub(1)).map(|lake| lake.level);
    let of_row = |j: usize| {
        let labels = &water.labels.row(j)[columns.clone()];
        let surface = move |(height, label): (&f32, &u32)| level(*label).map_or(*height, |level| level.max(*height));
        water.heights.row(j)[columns.clone()].iter().zip(labels).map(surface).map(rise)
    };
    Grid::from_data(window, rows.clone().flat_map(of_row).collect())
}

/// The lake at one of the two samples next to a crossing.
fn wet_beside([x, y]: [f64; 2], labels: &Grid<u32>) -> Option<u32> {
    let ends = |v: f64| [v.floor() as usize, v.ceil() as usize];
    let ([west, east], [north, south]) = (ends(x), ends(y));
    let there = |i: usize, j: usize| (i < labels.width() && j < labels.height()).then(|| labels[(i, j)]);
    [there(west, north), there(east, south)].into_iter().flatten().find(|label| *label > 0)
}
