//! Borders of tiles: checks whether rivers continue on the other side.

use super::layers::{Tiles, Water, cells_to_edge, neighbors};
use super::mosaic::{Mosaic, TILES};
use super::network::Network;
use orogen::grid::hydrology::direction::hashed;
use orogen::{Error, ErrorKind, Result, Window};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Drainage area in m² from which a cell belongs to a river.
const RIVER: f64 = 1e6;

/// Width of the edge of a window that is not checked, in cells: receivers there may be outside.
const MARGIN: usize = 2;

/// Statistics of rivers at the borders of tiles.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Borders {
    /// Number of borders between two tiles.
    pub borders: usize,
    /// Number of rivers that cross the borders.
    pub crossings: usize,
    /// Cells at the borders where a river is cut: without a receiver, or with a receiver across the border that has
    /// less than half of the area.
    pub cut: usize,
    /// Cells at the borders that are not cut, but whose receiver across the border has a smaller area.
    pub falling: usize,
    /// Cells at the borders that are not cut, but where half of the area has no source or no destination.
    pub unbalanced: usize,
}

impl std::ops::AddAssign for Borders {
    fn add_assign(&mut self, other: Borders) {
        self.borders += other.borders;
        self.crossings += other.crossings;
        self.cut += other.cut;
        self.falling += other.falling;
        self.unbalanced += other.unbalanced;
    }
}

/// A border between two columns or two rows of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Border {
    /// Before this column of the window.
    Column(usize),
    /// Before this row of the window.
    Row(usize),
}

impl Border {
    /// Whether a cell lies east or south of the border.
    fn is_behind(self, window: &Window, cell: usize) -> bool {
        match self {
            Border::Column(column) => cell % window.width >= column,
            Border::Row(row) => cell / window.width >= row,
        }
    }

    /// The cells on both sides of the border.
    fn cells(self, window: &Window) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (window.width, window.height);
        let count = if let Border::Column(_) = self { height } else { width };
        (0..count).flat_map(move |k| match self {
            Border::Column(column) => [k * width + column - 1, k * width + column],
            Border::Row(row) => [(row - 1) * width + k, row * width + k],
        })
    }
}

/// Measures the inner borders of a mosaic.
pub fn measure(network: &Network, mosaic: &Mosaic) -> Borders {
    measure_lines(network, (1..TILES).map(|k| k * mosaic.side))
}

/// Measures the middle lines of the tiles of a mosaic as if they were borders, for comparison: faults found there are
/// not caused by tiles.
pub fn measure_middles(network: &Network, mosaic: &Mosaic) -> Borders {
    measure_lines(network, (0..TILES).map(|k| k * mosaic.side + mosaic.side / 2))
}

/// Measures borders before these columns and rows.
fn measure_lines(network: &Network, lines: impl Iterator<Item = usize>) -> Borders {
    let mut found = Borders::default();
    for border in lines.flat_map(|k| [Border::Column(k), Border::Row(k)]) {
        found += measure_border(network, border);
        // One border for each tile along the line.
        found.borders += TILES;
    }
    found
}

/// Measures pairs of adjacent windows of `side` x `side` cells. The first window of each pair is made by one of
/// `tiles`, the second by the other. Pairs are made in parallel on `threads` threads. They lie inside `extent`; `seed`
/// determines the positions.
pub fn measure_pairs(tiles: [Tiles; 2], places: &Places, threads: usize) -> Result<Pairs> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut found = Pairs::default();
        loop {
            let pair = next.fetch_add(1, Ordering::Relaxed);
            if pair >= places.pairs {
                return Ok(found);
            }
            found += measure_pair(tiles, places, pair as i64)
                .inspect_err(|_| next.store(places.pairs, Ordering::Relaxed))?;
        }
    };
    let parts: Vec<Result<Pairs>> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(work)).collect();
        let panicked = |_| Err(Error::new(ErrorKind::Internal, "a thread panicked"));
        workers.into_iter().map(|worker| worker.join().unwrap_or_else(panicked)).collect()
    });
    let mut found = Pairs::default();
    for part in parts {
        found += part?;
    }
    Ok(found)
}

/// Statistics of pairs of windows.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pairs {
    /// Between the two windows.
    pub borders: Borders,
    /// Along the middle of the first windows, for comparison.
    pub middles: Borders,
}

impl std::ops::AddAssign for Pairs {
    fn add_assign(&mut self, other: Pairs) {
        self.borders += other.borders;
        self.middles += other.middles;
    }
}

/// Positions of pairs of windows.
#[derive(Debug, Clone, Copy)]
pub struct Places {
    /// The window that contains all pairs.
    pub extent: Window,
    /// Cells along the sides of a window.
    pub side: usize,
    /// Number of pairs.
    pub pairs: usize,
    /// Number of pairs in the same region, which are made from the same coarse tiles. The regions are at random
    /// positions, too.
    pub near: usize,
    /// Seed of the positions.
    pub seed: i64,
}

/// Cells along the sides of the square that contains the pairs of one region.
const REGION: usize = 1024;

impl Places {
    /// The window of a pair, and whether its windows are side by side instead of one below the other.
    fn pair(&self, pair: i64) -> (Window, bool) {
        let Places { extent, side, seed, .. } = *self;
        let beside = hashed(pair, seed).is_multiple_of(2);
        let along = usize::from(beside);
        let region = match self.near {
            0 | 1 => extent,
            near => {
                let square = [extent.width, extent.height].map(|cells| cells.min(REGION.max(2 * side)));
                placed(square, &extent, pair / near as i64, seed ^ (1 << 42))
            }
        };
        (placed([side * (1 + along), side * (2 - along)], &region, pair, seed), beside)
    }
}

/// A window of this size inside another one, at a position from hashes of `index`.
fn placed([width, height]: [usize; 2], within: &Window, index: i64, seed: i64) -> Window {
    let at = |from: i64, cells: usize, taken: usize, salt: i64| {
        from + (u64::from(hashed(index, seed ^ salt)) % (cells.saturating_sub(taken) as u64 + 1)) as i64
    };
    let x = at(within.x, within.width, width, 1 << 40);
    let y = at(within.y, within.height, height, 1 << 41);
    Window::new(width, height, within.cell).at(x, y)
}

fn measure_pair(tiles: [Tiles; 2], places: &Places, pair: i64) -> Result<Pairs> {
    let (window, beside) = places.pair(pair);
    let water = paste_pair(tiles, places, &window)?;
    let network = Network::new(&water);
    let line = |at: usize| {
        let border = if beside { Border::Column(at) } else { Border::Row(at) };
        Borders { borders: 1, ..measure_border(&network, border) }
    };
    Ok(Pairs { borders: line(places.side), middles: line(places.side / 2) })
}

/// The window of a pair, composed of its two windows.
fn paste_pair(tiles: [Tiles; 2], places: &Places, window: &Window) -> Result<Water> {
    let mut water: Option<Water> = None;
    for (part, tiles) in window.tiles(places.side).zip(tiles) {
        let tile = tiles(&part)?;
        water.get_or_insert_with(|| Water::like(&tile, *window)).paste(&tile);
    }
    water.ok_or_else(|| Error::new(ErrorKind::Internal, "a pair has no windows"))
}

/// The number of pairs, among the first `count`, that differ from the same window made at once.
pub fn count_different(tiles: [Tiles; 2], places: &Places, count: usize) -> Result<usize> {
    let mut different = 0;
    for pair in 0..count.min(places.pairs) as i64 {
        let (window, _) = places.pair(pair);
        different += usize::from(paste_pair(tiles, places, &window)? != tiles[0](&window)?);
    }
    Ok(different)
}

/// Measures rivers at one border of a window, except near the ends of the border.
fn measure_border(network: &Network, border: Border) -> Borders {
    let water = network.water;
    let window = water.window();
    let mut found = Borders::default();
    let inner = border.cells(window).filter(|cell| cells_to_edge(window, *cell) >= MARGIN);
    for cell in inner.filter(|cell| water.area(*cell) > RIVER && !water.is_standing(*cell)) {
        let behind = border.is_behind(window, cell);
        let receiver = network.receiver(cell);
        let crosses = receiver.is_some_and(|to| border.is_behind(window, to) != behind);
        found.crossings += usize::from(crosses);
        // The area of lakes and the sea is not defined: rivers end and begin there.
        if neighbors(window, cell).any(|(_, to)| water.is_standing(to)) {
            continue;
        }
        let holds = |share: f64| !crosses || receiver.is_some_and(|to| water.area(to) >= share * water.area(cell));
        if receiver.is_none() || !holds(0.5) {
            found.cut += 1;
        } else {
            found.falling += usize::from(!holds(1.0));
            found.unbalanced += usize::from(network.ends(cell) || network.begins(cell));
        }
    }
    found
}
