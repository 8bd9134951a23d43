//! Borders of tiles: whether rivers continue on the other side.

use super::layers::{Tiles, cells_to_edge, neighbours};
use super::mosaic::{Mosaic, TILES, paste};
use super::network::Network;
use orogen::hydrology::direction::hashed;
use orogen::{Result, Window};

/// Drainage area from which on a cell belongs to a river here, in m².
const RIVER: f64 = 1e6;

/// Cells near the edge of a window that are not checked: the receivers there may be outside.
const MARGIN: usize = 2;

/// Rivers at the borders of tiles.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Borders {
    /// Borders between two tiles.
    pub borders: usize,
    /// Rivers that cross them.
    pub crossings: usize,
    /// Cells at the borders where a river is cut: without a receiver, or with one across the border that has a smaller area.
    pub cut: usize,
    /// Cells at the borders that are not cut, but half of whose area goes nowhere or comes from nowhere.
    pub unbalanced: usize,
}

impl std::ops::AddAssign for Borders {
    fn add_assign(&mut self, other: Borders) {
        self.borders += other.borders;
        self.crossings += other.crossings;
        self.cut += other.cut;
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
    /// Whether a cell lies behind the border, east or south of it.
    fn is_behind(self, window: &Window, cell: usize) -> bool {
        match self {
            Border::Column(column) => cell % window.width >= column,
            Border::Row(row) => cell / window.width >= row,
        }
    }

    /// The cells on both sides.
    fn cells(self, window: &Window) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (window.width, window.height);
        let count = if let Border::Column(_) = self { height } else { width };
        (0..count).flat_map(move |k| match self {
            Border::Column(column) => [k * width + column - 1, k * width + column],
            Border::Row(row) => [(row - 1) * width + k, row * width + k],
        })
    }
}

/// The inner borders of a mosaic.
pub fn measure(network: &Network, mosaic: &Mosaic) -> Borders {
    measure_lines(network, (1..TILES).map(|k| k * mosaic.side))
}

/// The middle lines of the tiles of a mosaic, as if they were borders, for comparison: what is found there is not due to tiles.
pub fn measure_middles(network: &Network, mosaic: &Mosaic) -> Borders {
    measure_lines(network, (0..TILES).map(|k| k * mosaic.side + mosaic.side / 2))
}

/// Borders before these columns and rows.
fn measure_lines(network: &Network, lines: impl Iterator<Item = usize>) -> Borders {
    let mut found = Borders::default();
    for border in lines.flat_map(|k| [Border::Column(k), Border::Row(k)]) {
        found += measure_border(network, border);
        // One for each tile along it.
        found.borders += TILES;
    }
    found
}

/// Pairs of adjacent windows of `side` x `side` cells, each made apart. The pairs lie inside `extent`; `seed` chooses where.
pub fn measure_pairs(tiles: Tiles, extent: &Window, side: usize, pairs: usize, seed: i64) -> Result<Borders> {
    let mut found = Borders::default();
    for pair in 0..pairs as i64 {
        let along = usize::from(hashed(pair, seed).is_multiple_of(2));
        let shape = Window::new(side * (1 + along), side * (2 - along), extent.cell);
        let within = |from: i64, cells: usize, taken: usize, salt: i64| {
            from + (u64::from(hashed(pair, seed ^ salt)) % (cells.saturating_sub(taken) as u64 + 1)) as i64
        };
        let x = within(extent.x, extent.width, shape.width, 1 << 40);
        let y = within(extent.y, extent.height, shape.height, 1 << 41);
        let window = shape.at(x, y);
        let water = paste(window, window.tiles(side), tiles)?;
        let border = if along == 1 { Border::Column(side) } else { Border::Row(side) };
        found += measure_border(&Network::new(&water), border);
        found.borders += 1;
    }
    Ok(found)
}

/// Rivers at one border of a window, except near the ends of the border.
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
        if neighbours(window, cell).any(|(_, to)| water.is_standing(to)) {
            continue;
        }
        let shrinks = crosses && receiver.is_some_and(|to| water.area(to) < water.area(cell));
        if shrinks || receiver.is_none() {
            found.cut += 1;
        } else {
            found.unbalanced += usize::from(network.ends(cell) || network.begins(cell));
        }
    }
    found
}
