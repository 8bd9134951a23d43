//! Streams of a map on disk, by rows of tiles: drainage areas, orders, and longest flow paths.

use super::areas::{Areas, Tile};
use super::tiling::{Border, Tiling, border};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::statistics::Way;
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

/// The streams of a map after the values along its tiles' borders are known.
pub struct Streams<'a> {
    areas: Areas<'a>,
    /// The longest flow path to each exit of each tile.
    ways: Vec<Vec<Way>>,
    threshold: u32,
}

/// Rows of the map with the height of a tile, row-major.
pub struct Strip {
    /// The window of the rows.
    pub window: Window,
    /// The direction code of each cell's receiver.
    pub codes: Vec<u8>,
    /// Number of cells that drain through each cell.
    pub areas: Vec<u32>,
    /// Strahler orders; 0 where there is no stream.
    pub orders: Vec<u8>,
    /// The longest flow path to each cell.
    pub ways: Vec<Way>,
}

/// Memory per sample of a [`Strip`], in bytes.
pub const STRIP_SAMPLE: u64 = 14;

/// Approximate number of passes over each tile before the strips, the unit of progress.
pub const PASSES: f64 = 4.0;

impl<'a> Streams<'a> {
    /// Computes the streams from complete receivers, given as direction codes with
    /// [`NONE`](crate::hydrology::direction::NONE) for outlets. A cell that drains fewer than `threshold` cells is not
    /// a stream. The map must have fewer than 2^32 cells.
    ///
    /// # Errors
    /// If the disk fails, or the work is cancelled.
    pub fn new(codes: &'a Raster, tiling: &'a Tiling, threshold: u32, progress: &'a Progress) -> Result<Streams<'a>> {
        let mut areas = Areas::new(codes, None, tiling, progress)?;
        areas.order_streams(u64::from(threshold))?;
        let (mut ways, mut through) = (Vec::new(), Vec::new());
        for t in 0..tiling.count() {
            let tile = areas.tile(t)?;
            let own = tile.ways(&Border::filled(&tile.window, Way::default()));
            ways.push(areas.exits[t].iter().map(|exit| own[exit.index as usize]).collect::<Vec<Way>>());
            through.push(tile.through());
        }
        let mut streams = Streams { areas, ways, threshold };
        for (t, k) in streams.areas.downstream() {
            let exit = streams.areas.exits[t][k];
            let (_, index) = tiling.locate(exit.to);
            if let Some((to, next)) = streams.areas.next(&exit)
                && let Some(on) = through[to].get(index)
            {
                let way = streams.spills(t, k).then(on);
                streams.ways[to][next] = streams.ways[to][next].longer(way);
            }
        }
        Ok(streams)
    }

    /// The longest flow path out of an exit, up to the receiving cell.
    fn spills(&self, t: usize, k: usize) -> Way {
        let (tiling, exit) = (self.areas.tiling, &self.areas.exits[t][k]);
        let from = tiling.place(tiling.cell_of(&tiling.tile(t), exit.index as usize));
        let to = tiling.place(exit.to);
        // Odd codes are diagonal.
        self.ways[t][k].step(u8::from(from.0 != to.0 && from.1 != to.1))
    }

    /// Visits all rows of tiles from the north.
    ///
    /// # Errors
    /// If the disk fails, the work is cancelled, or `visit` fails.
    pub fn each(&self, mut visit: impl FnMut(&Strip) -> Result<()>) -> Result<()> {
        let tiling = self.areas.tiling;
        for first in (0..tiling.count()).step_by(tiling.columns().max(1)) {
            let rows = tiling.tile(first);
            let window = Window { x: tiling.whole.x, width: tiling.whole.width, ..rows };
            let mut strip = Strip {
                window,
                codes: vec![0; window.len()],
                areas: vec![0; window.len()],
                orders: vec![0; window.len()],
                ways: vec![Way::default(); window.len()],
            };
            for t in first..first + tiling.columns() {
                let tile = self.areas.tile(t)?;
                let inflows = self.areas.inflows(t);
                let areas = tile.areas(&inflows);
                let orders = tile.orders(&areas, &inflows, u64::from(self.threshold));
                let mut incoming = Border::filled(&tile.window, Way::default());
                self.areas.each_inflow(t, |index, from, k| {
                    let longest = incoming.get(index).unwrap_or_default();
                    incoming.set(index, longest.longer(self.spills(from, k)));
                });
                let ways = tile.ways(&incoming);
                let left = (tile.window.x - window.x) as usize;
                for j in 0..window.height {
                    let from = j * tile.window.width..(j + 1) * tile.window.width;
                    let to = j * window.width + left..j * window.width + left + tile.window.width;
                    strip.codes[to.clone()].copy_from_slice(&tile.codes[from.clone()]);
                    strip.orders[to.clone()].copy_from_slice(&orders[from.clone()]);
                    strip.ways[to.clone()].copy_from_slice(&ways[from.clone()]);
                    strip.areas[to].iter_mut().zip(&areas[from]).for_each(|(out, area)| *out = *area as u32);
                }
            }
            visit(&strip)?;
        }
        Ok(())
    }
}

impl Tile {
    /// The longest flow path to each cell; `incoming` are the paths from other tiles.
    fn ways(&self, incoming: &Border<Way>) -> Vec<Way> {
        let mut ways = vec![Way::default(); self.window.len()];
        border(&self.window).for_each(|index| ways[index] = incoming.get(index).unwrap_or_default());
        for cell in self.order.iter().map(|cell| *cell as usize) {
            let receiver = self.receivers[cell] as usize;
            if receiver != cell {
                ways[receiver] = ways[receiver].longer(ways[cell].step(self.codes[cell]));
            }
        }
        ways
    }

    /// The length of the path from each border cell to the exit of its water.
    fn through(&self) -> Border<Way> {
        let mut ways = vec![Way::default(); self.window.len()];
        for cell in self.order.iter().rev().map(|cell| *cell as usize) {
            let receiver = self.receivers[cell] as usize;
            if receiver != cell {
                ways[cell] = ways[receiver].step(self.codes[cell]);
            }
        }
        let mut along = Border::filled(&self.window, Way::default());
        border(&self.window).for_each(|index| along.set(index, ways[index]));
        along
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Grid;
    use orogen_grid::hydrology::accumulation::accumulate;
    use orogen_grid::hydrology::outlets::Outlets;
    use orogen_grid::hydrology::statistics::longest_ways;
    use orogen_grid::hydrology::steepest::Descent;
    use orogen_grid::hydrology::{drainage, samples, strahler};

    #[test]
    fn strips_are_what_is_made_in_memory() {
        for heights in samples::grids().into_iter().filter(|heights| !heights.data().is_empty()) {
            let window = *heights.window();
            let receivers =
                drainage::route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
            let drained = accumulate(&receivers);
            let (orders, ways) =
                (strahler::strahler_orders(&receivers, &drained, 5), longest_ways(&receivers, &drained));
            let codes = receivers.codes().iter().map(|code| f32::from(*code)).collect();
            let raster = Raster::in_memory(Grid::from_data(window, codes).unwrap());
            for side in [1, 3, 8, 17, 64] {
                let (tiling, progress) = (Tiling::new(window, side), Progress::none());
                let streams = Streams::new(&raster, &tiling, 5, &progress).unwrap();
                let mut at = 0;
                let each = |strip: &Strip| {
                    let here = at..at + strip.window.len();
                    assert_eq!(strip.codes, receivers.codes()[here.clone()]);
                    assert_eq!(strip.areas, drained.area.data()[here.clone()]);
                    assert_eq!(strip.orders, orders.data()[here.clone()]);
                    assert_eq!(strip.ways, ways[here.clone()], "tiles of {side}");
                    at = here.end;
                    Ok(())
                };
                streams.each(each).unwrap();
                assert_eq!(at, window.len());
            }
        }
    }
}
