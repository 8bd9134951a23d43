//! Statistics of drainage.

use std::ops::Range;
use std::path::Path;

use super::land::{Land, ROWS};
use super::mean::Mean;
use orogen_engine::budget::Budget;
use orogen_engine::large::drainage as large;
use orogen_engine::large::streams::{PASSES, STRIP_SAMPLE, Streams};
use orogen_engine::large::tiling::Tiling;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::accumulation::accumulate;
use orogen_grid::hydrology::direction::{DISTANCES, neighbor, strides};
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::hydrology::rivers::{self, Reach, STREAM_CELL, network};
use orogen_grid::hydrology::statistics::{self, AreaClasses, AreaCounts, Average};
use orogen_grid::hydrology::steepest::Descent;
use orogen_grid::hydrology::wetness::{wetness, wetness_of_rows};
use orogen_grid::hydrology::{drainage, fill, strahler};
use orogen_grid::progress::Progress;
use orogen_io::pages::{self, Pages, SIDE};
use orogen_io::raster::Raster;
use serde::{Deserialize, Serialize};

/// Thresholds of rivers: minimum drainage area in m^2, and minimum number of cells.
pub const SPRING: f64 = 5e5;
const FEWEST_CELLS: u32 = 32;

/// Statistics of depressions and rivers.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Water {
    /// Share of the cells below the spill level of their depression.
    pub depressions: f64,
    /// Mean depth of those cells, in metres; 0 if there are none.
    pub depression_depth: f64,
    /// Exponent t of P(area > a) ~ a^-t.
    pub area_exponent: Option<f64>,
    /// Exponent of Hack's law.
    pub hack: Option<f64>,
    /// Concavity of the rivers.
    pub concavity: Option<f64>,
    /// Bifurcation ratio: the number of streams of an order divided by that of the next (Horton 1945).
    pub bifurcation: Option<f64>,
    /// Length ratio: the mean length of streams of an order divided by that of the previous one.
    pub length_ratio: Option<f64>,
    /// The highest Strahler order.
    pub order: u8,
    /// Drainage density, in km per km^2.
    pub density: f64,
    /// Mean topographic wetness index.
    pub wetness: f64,
    /// The rivers, from source or confluence to confluence or outlet.
    pub reaches: Vec<Reach>,
}

/// Minimum number of cells that a river drains.
fn spring(window: &Window) -> u32 {
    ((SPRING / (window.cell * window.cell)) as u32).max(FEWEST_CELLS)
}

/// Measures the drainage of heights; samples that are not land are NaN.
///
/// # Errors
/// If the work is cancelled.
pub fn measure(heights: &Grid, progress: &Progress) -> Result<Water> {
    let window = heights.window();
    let outlets = Outlets::new(heights, None);
    let [filling, draining, counting] = progress.parts([3.0, 1.0, 1.0]);
    let filled =
        fill::filled(heights, &drainage::route_carving_with(heights, &outlets, Descent::Steepest, &filling)?.basins);
    let receivers = drainage::over_surface_with(&filled, &outlets, Descent::Steepest, &draining)?;
    // Outlets are not needed again.
    drop(outlets);
    counting.check()?;
    let drained = accumulate(&receivers);
    counting.check()?;
    let spring = spring(window);
    let orders = strahler::strahler_orders(&receivers, &drained, spring);
    let mut ground = WaterCounts::default();
    ground.add(heights, &filled);
    counting.check()?;
    let laws = Laws {
        area_exponent: statistics::area_exponent(&drained),
        hack: statistics::hack_exponent(&receivers, &drained, spring),
        concavity: statistics::concavity(&filled, &receivers, &drained, spring),
    };
    counting.check()?;
    let mut wet = Mean::default();
    wet.add(wetness(heights, &drained).data());
    Ok(Water::of(window, &ground, laws, wet.mean(), network(&receivers, &orders)))
}

/// Memory of [`measure_on_disk`] without rivers, in bytes.
pub fn memory_on_disk(window: &Window) -> u64 {
    let cells = window.len() as u64;
    let side = large::side(cells) as u64;
    let strip = side.saturating_mul(window.width as u64).saturating_mul(STRIP_SAMPLE);
    let rows = (window.width as u64).saturating_mul((ROWS as u64 + 2) * 4 * 6);
    large::memory(cells).saturating_add(strip).saturating_add(rows).saturating_add(3 * pages::memory(window))
}

/// [`measure`] for land on disk, with the same bits, tile by tile. Temporary rasters are made in `folder`; the memory
/// of rivers is reserved from `budget`.
///
/// # Errors
/// If the disk fails, the rivers do not fit, or the work is cancelled.
pub fn measure_on_disk(land: &Land, folder: &Path, budget: &Budget, progress: &Progress) -> Result<Water> {
    let window = *land.window();
    let raster = || Pages::scratch(folder, window).map(Raster::on_disk);
    let [filling, draining, passing, counting, naming] = progress.parts([5.0, 3.0, PASSES, 1.5, 1.5]);
    let mut heights = raster()?;
    for rows in bands(0..window.height, SIDE) {
        heights.put(&land.rows(rows)?)?;
    }
    let (mut codes, mut filled) = (raster()?, raster()?);
    let tiling = Tiling::new(window, large::side(window.len() as u64));
    large::Water { heights: &heights, sea: None, tiling, progress: &filling }.route_carving(&mut codes, &mut filled)?;
    filling.finish();
    large::Water { heights: &filled, sea: None, tiling, progress: &draining }.over_surface(&mut codes)?;
    draining.finish();
    let spring = spring(&window);
    passing.expect(PASSES * tiling.count() as f64);
    let streams = Streams::new(&codes, &tiling, spring, &passing)?;
    passing.finish();

    // Counts over all cells, and the number of river cells.
    let (mut ground, mut counts, mut wet) = (WaterCounts::default(), AreaCounts::new(window.len()), Mean::default());
    let (mut largest, mut rivers) = (0, 0);
    streams.each(|strip| {
        counting.check()?;
        counts.add(&strip.areas);
        largest = strip.areas.iter().copied().fold(largest, u32::max);
        rivers += strip.orders.iter().filter(|order| **order > 0).count() as u64;
        let top = (strip.window.y - window.y) as usize;
        for rows in bands(top..top + strip.window.height, ROWS) {
            let here = part(&window, &rows);
            let cells = (rows.start - top) * window.width..(rows.end - top) * window.width;
            let areas = Grid::from_data(here, strip.areas[cells].to_vec()).unwrap_or_else(|| Grid::filled(here, 0));
            let around = heights.get(&part(&window, &near(&rows, window.height)))?;
            wet.add(wetness_of_rows(&around, &areas).data());
            let own = around.crop(&here).unwrap_or_else(|| Grid::filled(here, f32::NAN));
            ground.add(&own, &filled.get(&here)?);
        }
        Ok(())
    })?;
    counting.finish();

    let _rivers = budget.reserve(rivers * STREAM_CELL)?;
    let mut network = rivers::Streams::default();
    let classes = |average| AreaClasses::new(spring, largest, average);
    let (mut hack, mut concavity) = (classes(Average::Median), classes(Average::Mean));
    let strides = strides(window.width);
    streams.each(|strip| {
        naming.check()?;
        let top = (strip.window.y - window.y) as usize;
        for rows in bands(top..top + strip.window.height, ROWS) {
            let around = near(&rows, window.height);
            let filled = filled.get(&part(&window, &around))?;
            for j in rows.clone() {
                for i in 0..window.width {
                    let c = (j - top) * window.width + i;
                    let (area, code) = (strip.areas[c], strip.codes[c]);
                    if area < spring {
                        continue;
                    }
                    let cell = j * window.width + i;
                    let receiver = strides.get(usize::from(code)).map_or(cell, |stride| neighbor(cell, *stride));
                    let height = |cell: usize| filled.data()[cell - around.start * window.width];
                    if let Some(hack) = &mut hack {
                        hack.add(area, strip.ways[c].length());
                    }
                    if let Some(concavity) = &mut concavity
                        && receiver != cell
                    {
                        let drop = statistics::drop_per_metre(height(cell), height(receiver), code, window.cell);
                        concavity.add(area, drop);
                    }
                    if strip.orders[c] > 0 {
                        network.push(cell as u32, receiver as u32, strip.orders[c]);
                    }
                }
            }
        }
        Ok(())
    })?;
    let laws = Laws {
        area_exponent: counts.exponent(),
        hack: hack.and_then(AreaClasses::slope),
        concavity: concavity.and_then(AreaClasses::slope).map(|slope| -slope),
    };
    Ok(Water::of(&window, &ground, laws, wet.mean(), network.network()))
}

/// Splits rows into bands of at most `most`.
fn bands(rows: Range<usize>, most: usize) -> impl Iterator<Item = Range<usize>> {
    let end = rows.end;
    rows.step_by(most).map(move |first| first..(first + most).min(end))
}

/// The rows and their neighbors, where they exist.
fn near(rows: &Range<usize>, height: usize) -> Range<usize> {
    rows.start.saturating_sub(1)..(rows.end + 1).min(height)
}

/// Some rows of a window.
fn part(window: &Window, rows: &Range<usize>) -> Window {
    Window { y: window.y + rows.start as i64, height: rows.len(), ..*window }
}

/// Counts over the ground.
#[derive(Debug, Clone, Copy, Default)]
struct WaterCounts {
    land: f64,
    wet: f64,
    deep: f64,
}

impl WaterCounts {
    fn add(&mut self, heights: &Grid, filled: &Grid) {
        for (height, level) in heights.data().iter().zip(filled.data()).filter(|(height, _)| height.is_finite()) {
            self.land += 1.0;
            if level > height {
                self.wet += 1.0;
                self.deep += f64::from(*level) - f64::from(*height);
            }
        }
    }
}

/// Exponents of drainage laws.
struct Laws {
    area_exponent: Option<f64>,
    hack: Option<f64>,
    concavity: Option<f64>,
}

impl Water {
    fn of(window: &Window, ground: &WaterCounts, laws: Laws, wetness: f64, reaches: Vec<Reach>) -> Water {
        let streams = streams(&reaches, window);
        let river: f64 = streams.iter().map(|(_, length)| length).sum();
        let area = ground.land * window.cell * window.cell;
        let order = streams.len() as u8;
        let counted: Vec<f64> = streams.iter().map(|(count, _)| *count).collect();
        let lengths: Vec<f64> = streams.iter().map(|(count, length)| length / count).collect();
        // Rivers of the highest order are cut off at the map's edge.
        let whole = lengths.len().saturating_sub(1);
        Water {
            depressions: ground.wet / f64::max(ground.land, 1.0),
            depression_depth: if ground.wet > 0.0 { ground.deep / ground.wet } else { 0.0 },
            area_exponent: laws.area_exponent,
            hack: laws.hack,
            concavity: laws.concavity,
            bifurcation: ratio(&counted).map(|ratio| 1.0 / ratio),
            length_ratio: if order >= 3 { ratio(&lengths[..whole]) } else { None },
            order,
            density: if area > 0.0 { 1000.0 * river / area } else { 0.0 },
            wetness,
            reaches,
        }
    }
}

/// For each order from 1: the number of streams (consecutive reaches of one order count once) and their total length in
/// metres.
fn streams(reaches: &[Reach], window: &Window) -> Vec<(f64, f64)> {
    let highest = reaches.iter().map(|reach| reach.order).max().unwrap_or(0);
    let mut streams = vec![(0.0, 0.0); usize::from(highest)];
    for reach in reaches {
        let Some((count, length)) = usize::from(reach.order).checked_sub(1).and_then(|k| streams.get_mut(k)) else {
            continue;
        };
        let next = reach.next.and_then(|next| reaches.get(next as usize));
        // A stream is counted at its end, where the next reach has another order.
        if next.is_none_or(|next| next.order != reach.order) {
            *count += 1.0;
        }
        for pair in reach.cells.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|c| (c as usize % window.width, c as usize / window.width));
            let is_diagonal = from.0 != to.0 && from.1 != to.1;
            *length += DISTANCES[usize::from(is_diagonal)] * window.cell;
        }
    }
    streams
}

/// The mean ratio between consecutive numbers: the slope of a line through their logarithms. `None` for fewer than two.
fn ratio(numbers: &[f64]) -> Option<f64> {
    let count = numbers.len() as f64;
    if numbers.len() < 2 || numbers.iter().any(|number| *number <= 0.0) {
        return None;
    }
    let middle = (count - 1.0) / 2.0;
    let (mut above, mut below) = (0.0, 0.0);
    for (k, number) in numbers.iter().enumerate() {
        let x = k as f64 - middle;
        above += x * libm::log(*number);
        below += x * x;
    }
    Some(libm::exp(above / below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_those_of_horton() {
        assert!((ratio(&[64.0, 16.0, 4.0]).unwrap() - 0.25).abs() < 1e-12);
        assert_eq!((ratio(&[3.0]), ratio(&[3.0, 0.0])), (None, None));
    }

    #[test]
    fn a_valley_has_one_river_and_a_pit_is_a_depression() {
        // A V running south over 80 x 160 cells of 100 m, with a pit of one cell on its flank.
        let mut grid = Grid::filled(Window::new(80, 160, 100.0), 0.0f32);
        for j in 0..160 {
            for i in 0..80 {
                grid.row_mut(j)[i] = 20.0 * (i as f32 - 39.0).abs() + 500.0 - 2.0 * j as f32;
            }
        }
        grid.row_mut(60)[20] -= 300.0;
        let water = measure(&grid, &Progress::none()).unwrap();
        assert!((water.depressions - 1.0 / 12_800.0).abs() < 1e-9, "{}", water.depressions);
        assert!(water.depression_depth > 200.0 && water.order >= 1);
        // About 155 cells of river: 15 km on 128 km^2; no flank is long enough for a second river.
        assert!((0.05..0.15).contains(&water.density), "{}", water.density);
        let river = water.reaches.iter().find(|reach| reach.cells.contains(&(100 * 80 + 39))).unwrap();
        assert_eq!(river.order, water.order);
    }
}
