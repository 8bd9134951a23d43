//! Places in samples: ground that satisfies conditions.

use super::condition::Condition;
use super::report::Match;
use super::search::Area;
use orogen_engine::world::World;
use orogen_grid::analysis::patches::{Bounds, Rank, blocks, marked, parts};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::format::features::Value;

/// Maximum width of the border in which connected ground is counted, in samples.
const MAX_BORDER: usize = 512;

/// Maximum number of samples along the side of a window at the world's own cell.
const MAX_SIDE: f64 = 512.0;

/// Maximum number of samples of a coarser cell along the side of a block.
const MAX_BLOCK: f64 = 8.0;

/// Memory for finding places, in bytes per sample.
const MEMORY: u64 = 16;

/// Ground that satisfies conditions on layers.
pub(super) struct Ground<'a> {
    pub world: &'a World,
    /// The searched area.
    pub area: Area,
    /// The layers, the heights first.
    layers: Vec<String>,
    /// The units of the layers.
    units: Vec<&'static str>,
    /// Layers with their bounds.
    bounds: Vec<(usize, Bounds)>,
    /// Minimum area of connected ground, in m^2.
    least: f64,
    /// The layer whose largest value is wanted.
    largest: Option<usize>,
}

impl<'a> Ground<'a> {
    pub(super) fn new(
        world: &'a World,
        area: Area,
        conditions: &[Condition],
        least: f64,
        largest: Option<&str>,
    ) -> Result<Ground<'a>> {
        let mut layers = vec![orogen_engine::world::HEIGHT.to_owned()];
        let mut index = |name: &str| match layers.iter().position(|layer| layer == name) {
            Some(k) => k,
            None => {
                layers.push(name.to_owned());
                layers.len() - 1
            }
        };
        let mut bounds = Vec::new();
        for condition in conditions {
            let own = condition.bounds().ok_or_else(|| {
                let message = format!("--where: the values of the layer `{}` are numbers", condition.name);
                Error::new(ErrorKind::Request, message)
            })?;
            bounds.push((index(&condition.name), own));
        }
        let largest = largest.map(index);
        let units = layers.iter().map(|layer| world.unit(layer)).collect::<Result<_>>()?;
        Ok(Ground { world, area, layers, units, bounds, least, largest })
    }

    /// Whether the nearest places are wanted.
    pub(super) fn is_nearest(&self) -> bool {
        self.largest.is_none()
    }

    /// Number of samples along the side of the blocks of a part that are searched at the world's own cell.
    fn block(&self, cell: f64) -> usize {
        (MAX_SIDE * self.world.recipe().world.cell / cell).floor().clamp(1.0, MAX_BLOCK) as usize
    }

    fn grids(&self, window: &Window, progress: &Progress) -> Result<Vec<Grid>> {
        let layers: Vec<&str> = self.layers.iter().map(String::as_str).collect();
        self.world.grids_beside(&layers, window, MEMORY.saturating_mul(window.len() as u64), progress)
    }

    fn marked(&self, grids: &[Grid]) -> Vec<bool> {
        let mut all: Vec<(&Grid, Bounds)> =
            self.bounds.iter().map(|(layer, bounds)| (&grids[*layer], *bounds)).collect();
        if all.is_empty() {
            // Any ground, except where there is none.
            all.push((&grids[0], Bounds { range: [f64::NEG_INFINITY, f64::INFINITY], is_within: true }));
        }
        self.world.install(|| marked(&all))
    }

    fn rank<'g>(&self, grids: &'g [Grid], window: &Window) -> Rank<'g> {
        match self.largest {
            Some(layer) => Rank::Largest(&grids[layer]),
            None => {
                let [x, y] = self.area.near.map(|at| at / window.cell);
                Rank::Nearest([x - window.x as f64, y - window.y as f64])
            }
        }
    }

    /// The windows at the world's own cell in which a coarser part has ground that satisfies the conditions, each with
    /// the rank of its best sample.
    pub(super) fn candidates(&self, part: &Window, progress: &Progress) -> Result<Vec<(f64, Window)>> {
        let own = self.world.recipe().world.cell;
        let grids = self.grids(part, progress)?;
        let (marked, side) = (self.marked(&grids), self.block(part.cell));
        let found = blocks(&marked, part.width, side, self.rank(&grids, part));
        // The sample of a coarser cell stands for the ground around it.
        let times = part.cell / own;
        let span = |first: i64, at: usize| {
            let start = first + (at * side) as i64;
            [start, start + side as i64].map(|at| ((at as f64 - 0.5) * times).round() as i64)
        };
        let windows = found.into_iter().map(|([column, row], rank)| {
            let ([left, right], [top, bottom]) = (span(part.x, column), span(part.y, row));
            let window = Window::new((right - left) as usize, (bottom - top) as usize, own).at(left, top);
            (rank, self.within_world(&window))
        });
        Ok(windows.filter(|(_, window)| !window.is_empty()).collect())
    }

    fn within_world(&self, window: &Window) -> Window {
        match self.world.full_window(window.cell) {
            Ok(whole) if self.world.recipe().world.size.is_some() => window.intersection(&whole),
            _ => *window,
        }
    }

    /// The best places of all connected ground in a window.
    pub(super) fn places(&self, window: &Window, progress: &Progress) -> Result<Vec<Match>> {
        let sample = window.cell * window.cell;
        // Compact ground of this area is within the border.
        let border = (2.0 * libm::sqrt(self.least) / window.cell).ceil().min(MAX_BORDER as f64) as usize;
        let border = if self.least > sample { border } else { 0 };
        let all = self.within_world(&window.grown(border));
        let grids = self.grids(&all, progress)?;
        let (marked, rank) = (self.marked(&grids), self.rank(&grids, &all));
        let (left, top) = ((window.x - all.x) as usize, (window.y - all.y) as usize);
        let frame = [left..left + window.width, top..top + window.height];
        let found = self.world.install(|| parts(marked, all.width, frame, rank));
        let places = found.into_iter().filter(|part| part.samples as f64 * sample >= self.least).map(|part| {
            let (i, j) = (part.best % all.width, part.best / all.width);
            let at = [all.east(i), all.south(j)];
            let values = self.layers.iter().zip(&grids).zip(&self.units);
            let mut values: Vec<_> = values
                .map(|((layer, grid), unit)| (layer.clone(), Value::Real(f64::from(grid.data()[part.best])), *unit))
                .collect();
            if self.least > 0.0 {
                values.push(("area".to_owned(), Value::Real(part.samples as f64 * sample), "m^2"));
            }
            let rank = if self.largest.is_some() { part.rank } else { self.area.distance(at) };
            Match { at, coordinates: at, distance: self.area.distance(at), values, rank }
        });
        Ok(places.filter(|place| place.distance <= self.area.within).collect())
    }
}
