//! Filling and drainage of a map on disk.

use super::areas::{self, Layers};
use super::tiling::Tiling;
use super::{basins, flats};
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

/// Side of a tile, in cells, for a map with this many cells. Larger tiles take more memory each, but have shorter
/// borders in total.
#[must_use]
pub fn side(cells: u64) -> usize {
    match cells {
        0..0x40_0000 => 256,
        0x40_0000..0x400_0000 => 512,
        0x400_0000..0x3000_0000 => 1024,
        _ => 2048,
    }
}

/// Memory for the work on one tile and for the borders of all tiles of a map with this many cells, in bytes.
#[must_use]
pub fn memory(cells: u64) -> u64 {
    let side = side(cells) as u64;
    let borders = cells.div_ceil(side * side) * 4 * side;
    // Upper bounds per cell of the tile: distances over flats, basins, passes. Per border cell beside a tile: basins,
    // their passes, exits, levels. Per border cell while the passes of all tiles are joined to a tree, without a tile.
    (side * side * 100 + borders * 130).max(borders * 256)
}

/// A map of heights on disk, and its drainage.
pub struct Water<'a> {
    /// The heights.
    pub heights: &'a Raster,
    /// Sea level: cells at or below it are outlets.
    pub sea: Option<f32>,
    /// The tiles.
    pub tiling: Tiling,
    /// Progress and cancellation.
    pub progress: &'a Progress,
}

impl Water<'_> {
    /// Writes the filled heights to `filled`, and the receivers to `codes`: the same as
    /// [`hydrology::drainage::route_carving`](crate::hydrology::drainage::route_carving) and
    /// [`hydrology::fill::filled`](crate::hydrology::fill::filled).
    ///
    /// # Errors
    /// If the disk fails, or the work is cancelled.
    pub fn route_carving(&self, codes: &mut Raster, filled: &mut Raster) -> Result<()> {
        self.progress.expect((FLAT_PASSES + BASIN_PASSES) * self.tiling.count() as f64);
        flats::resolve(self.heights, &self.tiling, self.sea, codes, self.progress)?;
        basins::drain(self.heights, &self.tiling, self.sea, codes, filled, self.progress)
    }

    /// Writes the receivers of heights without depressions to `codes`: the same as
    /// [`hydrology::drainage::over_surface`](crate::hydrology::drainage::over_surface).
    ///
    /// # Errors
    /// If the disk fails, or the work is cancelled.
    pub fn over_surface(&self, codes: &mut Raster) -> Result<()> {
        self.progress.expect(FLAT_PASSES * self.tiling.count() as f64);
        flats::resolve(self.heights, &self.tiling, self.sea, codes, self.progress)
    }

    /// Computes areas, watersheds and orders from complete receivers. If `rain` is given, areas are weighted by its
    /// factors. The result is the same as
    /// [`hydrology::accumulation::accumulate_rain_with`](crate::hydrology::accumulation::accumulate_rain_with).
    ///
    /// # Errors
    /// If the disk fails, or the work is cancelled.
    pub fn areas(&self, codes: &Raster, rain: Option<&Raster>, layers: Layers) -> Result<()> {
        self.progress.expect(AREA_PASSES * self.tiling.count() as f64);
        areas::make(codes, rain, &self.tiling, layers, self.progress)
    }
}

/// Approximate number of passes over each tile, the unit of progress.
const FLAT_PASSES: f64 = 3.0;
const BASIN_PASSES: f64 = 2.0;
const AREA_PASSES: f64 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::{Grid, Window};
    use orogen_grid::hydrology::accumulation::{UNIT_WEIGHT, accumulate_rain_with};
    use orogen_grid::hydrology::direction::hashed;
    use orogen_grid::hydrology::outlets::Outlets;
    use orogen_grid::hydrology::steepest::Descent;
    use orogen_grid::hydrology::{drainage, fill, samples, strahler, watersheds};

    fn raster(window: &Window) -> Raster {
        Raster::in_memory(Grid::filled(*window, 0.0))
    }

    fn grid(raster: &Raster) -> Grid {
        raster.get(raster.window()).unwrap()
    }

    fn same(got: &Raster, expect: impl Fn(usize) -> f32, what: &str) {
        for (c, got) in grid(got).data().iter().enumerate() {
            let expect = expect(c);
            assert!(
                got.to_bits() == expect.to_bits() || got.is_nan() && expect.is_nan(),
                "{what}, {c}: {got} {expect}"
            );
        }
    }

    /// Rain factors, some of them too large or too small.
    fn rain(window: &Window) -> Grid {
        let factors = (0..window.len()).map(|cell| hashed(cell as i64, 5) % 1000).map(|k| k as f32 / 400.0 - 0.2);
        Grid::from_data(*window, factors.map(|factor| if factor > 2.2 { 1e3 } else { factor }).collect()).unwrap()
    }

    fn check(heights: &Grid, side: usize, sea: Option<f32>, surface: bool) {
        let window = *heights.window();
        let outlets = Outlets::new(heights, sea);
        let bed = drainage::route_carving(heights, &outlets, Descent::Steepest);
        let full = fill::filled(heights, &bed.basins);
        let progress = Progress::default();
        let source = Raster::in_memory(heights.clone());
        let water = Water { heights: &source, sea, tiling: Tiling::new(window, side), progress: &progress };
        let (mut codes, mut filled) = (raster(&window), raster(&window));
        water.route_carving(&mut codes, &mut filled).unwrap();
        same(&filled, |c| full.data()[c], "filled");
        let mut receivers = bed.receivers;
        if surface {
            receivers = drainage::over_surface(&full, &outlets, Descent::Steepest);
            Water { heights: &filled, ..water }.over_surface(&mut codes).unwrap();
        }
        same(&codes, |c| f32::from(receivers.code(c)), "receivers");
        let rain = surface.then(|| rain(&window));
        let drained = accumulate_rain_with(&receivers, rain.as_ref(), &progress).unwrap();
        let (labels, orders) =
            (watersheds(&receivers, &outlets, &drained), strahler::strahler_orders(&receivers, &drained, 5));
        let [mut flow, mut watershed, mut strahler] = [0; 3].map(|_| raster(&window));
        let layers = Layers { flow: &mut flow, watershed: &mut watershed, strahler: &mut strahler, threshold: 5 };
        let water = Water { heights: &source, sea, tiling: Tiling::new(window, side), progress: &progress };
        let rain = rain.map(Raster::in_memory);
        water.areas(&codes, rain.as_ref(), layers).unwrap();
        let cell_area = window.cell * window.cell;
        same(
            &flow,
            |c| match &drained.discharge {
                Some(discharge) => (discharge.data()[c] as f64 * (cell_area / f64::from(UNIT_WEIGHT))) as f32,
                None => (f64::from(drained.area.data()[c]) * cell_area) as f32,
            },
            "flow",
        );
        same(&watershed, |c| labels.data()[c] as f32, "watershed");
        same(&strahler, |c| f32::from(orders.data()[c]), "strahler");
    }

    /// Wide flats, nested depressions, ties: few different heights, with plateaus and bowls.
    fn terraced(width: usize, height: usize, seed: i64) -> Grid {
        let mut grid = samples::hills(width, height, seed);
        let levels = [120.0, 250.0, 400.0][seed as usize % 3];
        grid.data_mut().iter_mut().for_each(|h| *h = (*h / levels).floor() * levels - 200.0);
        grid
    }

    /// Level ground with scattered pits and walls.
    fn strewn(width: usize, height: usize, seed: i64) -> Grid {
        let mut grid = Grid::filled(Window::new(width, height, 3.0).at(-7, 12), 0.0);
        for (k, h) in grid.data_mut().iter_mut().enumerate() {
            *h = match hashed(k as i64, seed) % 23 {
                0 => -1.0,
                1 | 2 => 1.0,
                3 => 2.0,
                4 => -0.0,
                _ => 0.0,
            };
        }
        grid
    }

    #[test]
    fn tile_by_tile_is_the_same_as_in_memory() {
        for (k, heights) in samples::grids().into_iter().filter(|grid| !grid.data().is_empty()).enumerate() {
            for side in [1, 3, 8, 17, 64] {
                check(&heights, side, [None, Some(250.0)][k % 2], side % 2 == 1);
            }
        }
    }

    #[test]
    fn wide_flats_and_nested_depressions_over_many_tiles_are_the_same() {
        check_seeds(0..12);
    }

    #[test]
    #[ignore = "long: two hundred grounds of each kind"]
    fn many_wide_flats_and_nested_depressions_are_the_same() {
        check_seeds(12..200);
    }

    fn check_seeds(seeds: std::ops::Range<i64>) {
        for seed in seeds {
            let side = [2, 5, 9, 14][seed as usize % 4];
            for surface in [false, true] {
                check(&terraced(61, 47, seed), side, Some(-200.0).filter(|_| seed % 3 == 0), surface);
                check(&strewn(53, 39, seed), side, None, surface);
            }
        }
    }
}
