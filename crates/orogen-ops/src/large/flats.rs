//! Receivers, tile by tile, including flats.
//!
//! On a flat water follows two distances (see [`hydrology::flats`](crate::hydrology::flats)), and a flat may extend
//! over many tiles. Distances are minima over all paths, so they are found by processing tiles repeatedly, each time
//! with the known values along the borders, until no value decreases. Then every tile can be finished separately.

use super::tiling::{Border, Queue, Tiling};
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_grid::hydrology::direction::{NONE, STEPS, hashed, neighbor, one_of, strides};
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::hydrology::receivers::Receivers;
use orogen_grid::hydrology::steepest::{self, Descent};
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A value that is not known yet; known values are smaller.
const UNKNOWN: u64 = u64::MAX;

/// Writes the codes of the receivers to `codes`: steepest descent with resolved flats.
///
/// # Errors
/// If the disk fails, or the work is cancelled.
pub fn resolve(
    heights: &Raster,
    tiling: &Tiling,
    sea: Option<f32>,
    codes: &mut Raster,
    progress: &Progress,
) -> Result<()> {
    let flats = Flats { heights, tiling, sea, progress };
    let known = flats.measure()?;
    for t in 0..tiling.count() {
        codes.put(&flats.finished(t, &known)?)?;
    }
    Ok(())
}

struct Flats<'a> {
    heights: &'a Raster,
    tiling: &'a Tiling,
    sea: Option<f32>,
    progress: &'a Progress,
}

type Borders = Vec<Border<u64>>;

/// The known values of flats along the tiles' borders.
struct Known {
    /// Steps from the higher ground.
    away: Borders,
    /// Steps from the rim.
    rims: Borders,
    /// The first cell of each flat without a rim.
    first: Borders,
    /// Steps from the rim or from that first cell.
    toward: Borders,
}

impl Flats<'_> {
    fn ground(&self, t: usize) -> Result<FlatTile<'_>> {
        self.progress.check()?;
        self.progress.advance(1.0);
        FlatTile::new(self.heights, self.tiling, t, self.sea)
    }

    fn measure(&self) -> Result<Known> {
        let mut crossed = Vec::new();
        for t in 0..self.tiling.count() {
            let ground = self.ground(t)?;
            let tile = self.tiling.tile(t);
            let rim = Border::filled(&tile, ());
            if ground.own.iter().flatten().any(|index| rim.get(*index as usize).is_some()) {
                crossed.push(t);
            }
        }
        let unknown = || (0..self.tiling.count()).map(|t| Border::filled(&self.tiling.tile(t), UNKNOWN)).collect();
        let mut known = Known { away: unknown(), rims: unknown(), first: unknown(), toward: Borders::new() };
        self.settle(&crossed, &mut known.away, 1, |ground| ground.away_seeds())?;
        self.settle(&crossed, &mut known.rims, 1, |ground| ground.rim_seeds())?;
        let rims = &known.rims;
        self.settle(&crossed, &mut known.first, 0, |ground| {
            ground.numbers(&ground.spread(ground.rim_seeds(), rims, 1))
        })?;
        let first = &known.first;
        let mut toward = rims.clone();
        self.settle(&crossed, &mut toward, 1, |ground| ground.toward_seeds(rims, first))?;
        known.toward = toward;
        Ok(known)
    }

    /// Processes tiles until no value along a border decreases.
    fn settle(
        &self,
        tiles: &[usize],
        borders: &mut Borders,
        step: u64,
        seeds: impl Fn(&FlatTile) -> Vec<u64>,
    ) -> Result<()> {
        let mut queue = Queue::new(self.tiling.count());
        tiles.iter().for_each(|t| queue.push(*t));
        while let Some(t) = queue.pop() {
            let ground = self.ground(t)?;
            let values = ground.spread(seeds(&ground), borders, step);
            for ((value, own), number) in values.iter().zip(&ground.own).zip(&ground.numbers) {
                let Some(index) = own.map(|index| index as usize) else { continue };
                if borders[t].get(index).is_none_or(|known| known <= *value) {
                    continue;
                }
                borders[t].set(index, *value);
                for other in STEPS.iter().filter_map(|step| self.tiling.step(*number, *step)) {
                    let (other, _) = self.tiling.locate(other);
                    if other != t {
                        queue.push(other);
                    }
                }
            }
        }
        Ok(())
    }

    /// The codes of a tile, when all values along the borders are known.
    fn finished(&self, t: usize, known: &Known) -> Result<Grid> {
        let ground = self.ground(t)?;
        let tile = self.tiling.tile(t);
        let codes = ground.receivers.grid().data().iter().map(|code| f32::from(*code)).collect();
        let mut codes = Grid::from_data(*ground.heights.window(), codes).unwrap_or_else(|| Grid::filled(tile, 0.0));
        if !ground.flat.is_empty() {
            let away = ground.spread(ground.away_seeds(), &known.away, 1);
            let toward = ground.spread(ground.toward_seeds(&known.rims, &known.first), &known.toward, 1);
            for place in (0..ground.flat.len()).filter(|place| ground.own[*place].is_some()) {
                codes.data_mut()[ground.flat[place] as usize] = f32::from(ground.receiver(place, &away, &toward));
            }
        }
        Ok(codes.crop(&tile).unwrap_or_else(|| Grid::filled(tile, 0.0)))
    }
}

/// A tile with two cells around it: its receivers by steepest descent, and the flat cells in the tile and next to it.
struct FlatTile<'a> {
    tiling: &'a Tiling,
    heights: Grid,
    receivers: Receivers,
    strides: [isize; 8],
    /// The flat cells.
    flat: Vec<u32>,
    /// The index of each cell among the flat cells.
    places: Vec<u32>,
    /// The index of each flat cell in the tile; `None` if it is outside.
    own: Vec<Option<u32>>,
    /// The number of each flat cell in the map.
    numbers: Vec<u64>,
}

const NO_PLACE: u32 = u32::MAX;

impl<'a> FlatTile<'a> {
    fn new(heights: &Raster, tiling: &'a Tiling, t: usize, sea: Option<f32>) -> Result<FlatTile<'a>> {
        let (tile, beside, window) = (tiling.tile(t), tiling.near(t, 1), tiling.near(t, 2));
        let heights = heights.get(&window)?;
        let outlets = Outlets::new(&heights, sea);
        let receivers = steepest::receivers(&heights, &outlets, Descent::Steepest);
        let (mut flat, mut own, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
        let mut places = Vec::new();
        for y in beside.y..beside.bottom() {
            let row = (y - window.y) as usize * window.width;
            for x in beside.x..beside.right() {
                let cell = row + (x - window.x) as usize;
                if receivers.code(cell) == NONE && !outlets.at(cell) {
                    places.resize(window.len(), NO_PLACE);
                    places[cell] = flat.len() as u32;
                    flat.push(cell as u32);
                    let inside = x >= tile.x && y >= tile.y && x < tile.right() && y < tile.bottom();
                    own.push(inside.then(|| ((y - tile.y) as usize * tile.width + (x - tile.x) as usize) as u32));
                    numbers.push(tiling.cell(x, y));
                }
            }
        }
        let strides = strides(window.width);
        Ok(FlatTile { tiling, heights, receivers, strides, flat, places, own, numbers })
    }

    /// The flat neighbors of a cell with the same height: their indices and directions.
    fn beside(&self, cell: usize) -> impl Iterator<Item = (usize, usize)> {
        let h = self.heights.data();
        let level = move |(k, stride): (usize, &isize)| {
            let n = neighbor(cell, *stride);
            (h[n] == h[cell] && self.places[n] != NO_PLACE).then(|| (k, self.places[n] as usize))
        };
        self.strides.iter().enumerate().filter_map(level)
    }

    /// The directions to neighbors at the height of the cell that have a receiver.
    fn drained_beside(&self, cell: usize) -> u8 {
        let h = self.heights.data();
        let drains = |n: usize| h[n] == h[cell] && self.places[n] == NO_PLACE;
        (0..8).filter(|k| drains(neighbor(cell, self.strides[*k]))).fold(0, |set, k| set | 1 << k)
    }

    /// Seeds of 1 at the flat cells of the tile for which `at` is true. `at` gets the index among the flat cells and
    /// the index in the tile.
    fn seeds(&self, at: impl Fn(usize, usize) -> bool) -> Vec<u64> {
        let cells = self.flat.iter().zip(&self.own).enumerate();
        cells.map(|(place, (c, own))| if own.is_some() && at(place, *c as usize) { 1 } else { UNKNOWN }).collect()
    }

    fn away_seeds(&self) -> Vec<u64> {
        let h = self.heights.data();
        self.seeds(|_, cell| self.strides.iter().any(|stride| h[neighbor(cell, *stride)] > h[cell]))
    }

    fn rim_seeds(&self) -> Vec<u64> {
        self.seeds(|_, cell| self.drained_beside(cell) != 0)
    }

    /// Seeds at the rims, and at the first cell of each flat without a rim.
    fn toward_seeds(&self, rims: &Borders, first: &Borders) -> Vec<u64> {
        let first = self.spread(self.numbers(&self.spread(self.rim_seeds(), rims, 1)), first, 0);
        self.seeds(|place, cell| first[place] == self.numbers[place] || self.drained_beside(cell) != 0)
    }

    /// The number of each cell of the tile from which no rim can be reached.
    fn numbers(&self, toward: &[u64]) -> Vec<u64> {
        let cells = self.own.iter().zip(toward).zip(&self.numbers);
        cells
            .map(|((own, toward), number)| if own.is_some() && *toward == UNKNOWN { *number } else { UNKNOWN })
            .collect()
    }

    /// Spreads values over level ground, increasing by `step` from cell to cell: the minimum that reaches each flat
    /// cell from `seeds` and from the known values around the tile.
    fn spread(&self, seeds: Vec<u64>, borders: &Borders, step: u64) -> Vec<u64> {
        let mut values = seeds;
        for (place, value) in values.iter_mut().enumerate().filter(|(place, _)| self.own[*place].is_none()) {
            let (other, index) = self.tiling.locate(self.numbers[place]);
            *value = (*value).min(borders[other].get(index).unwrap_or(UNKNOWN));
        }
        let known = values.iter().enumerate().filter(|(_, value)| **value != UNKNOWN);
        let mut waiting: BinaryHeap<_> = known.map(|(place, value)| Reverse((*value, place as u32))).collect();
        while let Some(Reverse((value, place))) = waiting.pop() {
            if values[place as usize] < value {
                continue;
            }
            let cell = self.flat[place as usize] as usize;
            for (_, n) in self.beside(cell) {
                if value + step < values[n] {
                    values[n] = value + step;
                    waiting.push(Reverse((value + step, n as u32)));
                }
            }
        }
        values
    }

    fn receiver(&self, place: usize, away: &[u64], toward: &[u64]) -> u8 {
        let (cell, (x, y)) = (self.flat[place] as usize, self.tiling.place(self.numbers[place]));
        let hash = hashed(x, y);
        if toward[place] == 1 {
            return one_of(self.drained_beside(cell), hash);
        }
        // A flat without a known distance has no higher ground around it.
        let away = |place: usize| if away[place] == UNKNOWN { 1 } else { away[place] as i64 };
        let sum = |place: usize| 2 * toward[place] as i64 - away(place);
        let (mut least, mut set) = (sum(place), 0);
        for (k, n) in self.beside(cell) {
            let sum = sum(n);
            if sum < least {
                (least, set) = (sum, 1 << k);
            } else if sum == least && set != 0 {
                set |= 1 << k;
            }
        }
        one_of(set, hash)
    }
}
