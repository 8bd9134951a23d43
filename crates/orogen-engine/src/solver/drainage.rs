//! Drainage: flow directions, drainage areas, watersheds and stream order.

use crate::large::areas::Layers;
use crate::large::drainage::{self as large, Water};
use crate::large::tiling::Tiling;
use crate::op::{Context, Solution, Solver, Sources};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::accumulation::accumulate_with;
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::hydrology::steepest::Descent;
use orogen_grid::hydrology::{drainage, fill, strahler, watersheds};

choice! {
    /// Flow routing through depressions.
    pub enum Over {
        /// Carving: flow crosses a depression along its valleys to the pit and from there back up to the spill point (Cordonnier, Bovy and
        /// Braun 2019).
        Bed = "bed",
        /// Filling: flow is routed on the filled ground. On level water it follows two integer gradients, away from higher ground and
        /// towards the outlet (Barnes, Lehman and Mulla 2014); ties are broken by a hash.
        Surface = "surface",
    }
}

op! {
    /// Drainage of the source by steepest descent (D8): each cell drains to its steepest lower neighbour (O'Callaghan and Mark 1984).
    ///
    /// Every cell drains to the sea or to the world's border. Ties are broken by a hash of the cell's position. Areas are counted in whole
    /// cells, so they are exact. Time and memory grow with the world, 54 bytes per cell; with less memory available, flow is routed tile by
    /// tile on disk (Barnes 2016).
    pub struct Drainage = "drainage", solver, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Flow routing through depressions: carving (`bed`) or filling (`surface`).
        over: Over = Over::Bed;
        /// Drainage area from which on a cell is a stream, for the layer `strahler`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
    }
    layers {
        /// Drainage area, including the cell itself.
        flow: flow, unit "m^2";
        /// Flow direction, clockwise from east (0) to north-east (7); 8 at outlets.
        receiver: label;
        /// Number of the watershed, from 1: all cells that drain to one outlet. 0 in the sea.
        watershed: label;
        /// Strahler order of the stream; 0 outside streams.
        strahler: label;
        /// The heights with filled depressions.
        filled: height, unit "m";
    }
}

impl Solver for Drainage {
    fn rasters(&self) -> usize {
        6
    }

    fn scratch(&self, padded: &Window) -> u64 {
        // In memory there is one raster less than on disk.
        padded.len() as u64 * 30
    }

    fn scratch_on_disk(&self, padded: &Window) -> u64 {
        large::memory(padded.len() as u64)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        if sources.on_disk() {
            return self.solve_on_disk(sources, context);
        }
        let heights = sources.whole(0, sources.padded())?;
        context.progress.check()?;
        let outlets = Outlets::new(&heights, self.sea.then_some(context.world_params.sea_level as f32));
        let [bed, surface, counting, naming] = context.progress.parts([3.0, 1.0, 1.0, 2.0]);
        let drained = drainage::route_carving_with(&heights, &outlets, Descent::Steepest, &bed)?;
        let filled = fill::filled(&heights, &drained.basins);
        drop(heights);
        context.progress.check()?;
        let receivers = match self.over {
            Over::Bed => drained.receivers,
            Over::Surface => drainage::over_surface_with(&filled, &outlets, Descent::Steepest, &surface)?,
        };
        let filled = sources.keep(filled)?;
        surface.finish();
        let accumulation = accumulate_with(&receivers, &counting)?;
        counting.finish();
        context.progress.check()?;
        let cell_area = receivers.window().cell * receivers.window().cell;
        let threshold = self.threshold(receivers.window());
        let flow = as_samples(&accumulation.area, |cells| (f64::from(cells) * cell_area) as f32);
        let [labelling, ordering] = naming.parts([1.0, 1.0]);
        let watersheds = watersheds::watersheds_with(&receivers, &outlets, &accumulation, &labelling)?;
        labelling.finish();
        let orders = strahler::orders_with(&receivers, &accumulation, threshold, &ordering)?;
        ordering.finish();
        drop(accumulation);
        context.progress.check()?;
        let layers = vec![
            sources.keep(flow)?,
            sources.keep(as_samples(receivers.grid(), f32::from))?,
            sources.keep(as_samples(&watersheds, |n| n as f32))?,
            sources.keep(as_samples(&orders, f32::from))?,
            filled,
        ];
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        35.0
    }
}

impl Drainage {
    /// The minimum number of cells that a stream drains.
    fn threshold(&self, window: &Window) -> u32 {
        (self.stream / (window.cell * window.cell)).ceil().min(f64::from(u32::MAX)) as u32
    }

    /// Tile by tile.
    fn solve_on_disk(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let mut heights = sources.raster()?;
        sources.each_tile(0, sources.padded(), &mut |tile| heights.put(tile))?;
        let (mut codes, mut filled) = (sources.raster()?, sources.raster()?);
        let padded = *sources.padded();
        let tiling = Tiling::new(padded, large::side(padded.len() as u64));
        let sea = self.sea.then_some(context.world_params.sea_level as f32);
        let water = Water { heights: &heights, sea, tiling, progress: context.progress };
        water.route_carving(&mut codes, &mut filled)?;
        let water = Water { heights: &filled, ..water };
        if self.over == Over::Surface {
            water.over_surface(&mut codes)?;
        }
        let threshold = u64::from(self.threshold(sources.padded()));
        let [mut flow, mut watershed, mut strahler] = [sources.raster()?, sources.raster()?, sources.raster()?];
        let layers = Layers { flow: &mut flow, watershed: &mut watershed, strahler: &mut strahler, threshold };
        water.areas(&codes, layers)?;
        Ok(Solution { layers: vec![flow, codes, watershed, strahler, filled], scalars: Vec::new() })
    }
}

fn as_samples<T: Copy>(grid: &Grid<T>, value: impl Fn(T) -> f32) -> Grid {
    let data = grid.data().iter().map(|sample| value(*sample)).collect();
    Grid::from_data(*grid.window(), data).unwrap_or_else(|| Grid::filled(*grid.window(), 0.0))
}
