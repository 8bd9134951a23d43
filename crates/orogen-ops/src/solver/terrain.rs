//! Input of the solvers of water: the heights of their domain, and the cells at which water leaves it.

use crate::budget::memory;
use crate::large::drainage::{self as large, Water};
use crate::large::tiling::Tiling;
use crate::op::{Context, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::drainage::{self, Drainage};
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::hydrology::steepest::Descent;
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

/// The input `source` of a solver over its domain, in memory.
pub(crate) fn heights(sources: &dyn Sources, context: &Context) -> Result<Grid> {
    let heights = sources.whole("source", sources.padded())?;
    context.progress.check()?;
    Ok(heights)
}

/// The sea level as a height, if the sea is an outlet.
pub(crate) fn sea_level(sea: bool, context: &Context) -> Option<f32> {
    sea_level_of(sea, context.world_params)
}

/// The sea level of a world as a height, if the sea is an outlet.
pub(crate) fn sea_level_of(sea: bool, world_params: &WorldParams) -> Option<f32> {
    sea.then_some(world_params.sea_level as f32)
}

/// An area in m^2 as a number of cells, at least `fewest`.
pub(crate) fn cells_of(area: f64, window: &Window, fewest: u32) -> u32 {
    (area / (window.cell * window.cell)).ceil().clamp(f64::from(fewest), f64::from(u32::MAX)) as u32
}

/// A layer with a value for each sample of a grid.
pub(crate) fn layer_of<T: Copy>(grid: &Grid<T>, value: impl Fn(T) -> f32) -> Grid {
    let mut layer = Grid::filled(*grid.window(), 0.0f32);
    layer.data_mut().iter_mut().zip(grid.data()).for_each(|(sample, of)| *sample = value(*of));
    layer
}

/// A layer with a value for each cell of a window.
pub(crate) fn layer(window: Window, value: impl Fn(usize) -> f32) -> Grid {
    let mut layer = Grid::filled(window, 0.0f32);
    layer.data_mut().iter_mut().enumerate().for_each(|(cell, sample)| *sample = value(cell));
    layer
}

/// The domain in memory.
pub(crate) struct Terrain {
    /// The heights.
    pub(crate) heights: Grid,
    /// The cells at which water leaves: the border of the domain, and the sea.
    pub(crate) outlets: Outlets,
}

impl Terrain {
    /// Reads the input `source`.
    pub(crate) fn read(sources: &dyn Sources, sea: bool, context: &Context) -> Result<Terrain> {
        let heights = heights(sources, context)?;
        let outlets = Outlets::new(&heights, sea_level(sea, context));
        Ok(Terrain { heights, outlets })
    }

    /// Routes flow by steepest descent, carving through depressions.
    pub(crate) fn route(&self, progress: &Progress) -> Result<Drainage> {
        drainage::route_carving_with(&self.heights, &self.outlets, Descent::Steepest, progress)
    }
}

/// The domain on disk, for solving tile by tile.
pub(crate) struct TiledTerrain {
    /// The heights.
    pub(crate) heights: Raster,
    /// The tiles.
    pub(crate) tiling: Tiling,
    sea: Option<f32>,
}

impl TiledTerrain {
    /// Memory of solving tile by tile, in bytes.
    pub(crate) fn memory(padded: &Window) -> u64 {
        large::memory(memory(padded, 1))
    }

    /// Reads the input `source`.
    pub(crate) fn read(sources: &dyn Sources, sea: bool, context: &Context) -> Result<TiledTerrain> {
        let mut heights = sources.raster()?;
        let padded = sources.padded();
        sources.each_tile("source", padded, &mut |tile| heights.put(tile))?;
        let tiling = Tiling::new(*padded, large::side(memory(padded, 1)));
        Ok(TiledTerrain { heights, tiling, sea: sea_level(sea, context) })
    }

    /// The hydrology of heights over the domain, such as its own heights.
    pub(crate) fn water<'a>(&self, heights: &'a Raster, progress: &'a Progress) -> Water<'a> {
        Water { heights, sea: self.sea, tiling: self.tiling, progress }
    }
}
