//! Division of a map into tiles, and values along their borders.

use orogen_grid::grid::Window;
use std::collections::VecDeque;

/// A map divided into square tiles.
#[derive(Debug, Clone, Copy)]
pub struct Tiling {
    /// The map.
    pub whole: Window,
    side: usize,
    columns: usize,
    rows: usize,
}

impl Tiling {
    /// Tiles of `side` x `side` cells, smaller at the far edges.
    #[must_use]
    pub fn new(whole: Window, side: usize) -> Tiling {
        let side = side.max(1);
        Tiling { whole, side, columns: whole.width.div_ceil(side), rows: whole.height.div_ceil(side) }
    }

    /// Number of tiles.
    #[must_use]
    pub fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// Number of columns of tiles.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The window of a tile.
    #[must_use]
    pub fn tile(&self, index: usize) -> Window {
        let (left, top) = (index % self.columns * self.side, index / self.columns * self.side);
        Window {
            x: self.whole.x + left as i64,
            y: self.whole.y + top as i64,
            width: self.side.min(self.whole.width - left),
            height: self.side.min(self.whole.height - top),
            cell: self.whole.cell,
        }
    }

    /// The window of a tile extended by `halo` cells on each side, where the map has them.
    #[must_use]
    pub fn near(&self, index: usize, halo: usize) -> Window {
        let grown = self.tile(index).grown(halo);
        let (x, y) = (grown.x.max(self.whole.x), grown.y.max(self.whole.y));
        let (right, bottom) = (grown.right().min(self.whole.right()), grown.bottom().min(self.whole.bottom()));
        Window { x, y, width: (right - x) as usize, height: (bottom - y) as usize, cell: grown.cell }
    }

    /// The number of a cell of the map, in row-major order.
    #[must_use]
    pub fn cell(&self, x: i64, y: i64) -> u64 {
        (y - self.whole.y) as u64 * self.whole.width as u64 + (x - self.whole.x) as u64
    }

    /// The number in the map of the cell with this index in a window.
    #[must_use]
    pub fn cell_of(&self, window: &Window, index: usize) -> u64 {
        self.cell(window.x + (index % window.width) as i64, window.y + (index / window.width) as i64)
    }

    /// The position of a cell.
    #[must_use]
    pub fn place(&self, cell: u64) -> (i64, i64) {
        let width = self.whole.width as u64;
        (self.whole.x + (cell % width) as i64, self.whole.y + (cell / width) as i64)
    }

    /// The tile that contains a cell, and the cell's index in it.
    #[must_use]
    pub fn locate(&self, cell: u64) -> (usize, usize) {
        let width = self.whole.width as u64;
        let (i, j) = ((cell % width) as usize, (cell / width) as usize);
        let tile = j / self.side * self.columns + i / self.side;
        (tile, j % self.side * self.tile(tile).width + i % self.side)
    }

    /// The cell in a direction, if it is on the map.
    #[must_use]
    pub fn step(&self, cell: u64, (east, south): (isize, isize)) -> Option<u64> {
        let (x, y) = self.place(cell);
        let (x, y) = (x + east as i64, y + south as i64);
        let inside = x >= self.whole.x && y >= self.whole.y && x < self.whole.right() && y < self.whole.bottom();
        inside.then(|| self.cell(x, y))
    }
}

/// A value for each cell along a tile's border.
#[derive(Debug, Clone)]
pub struct Border<T> {
    width: usize,
    height: usize,
    values: Vec<T>,
}

impl<T: Copy> Border<T> {
    /// The same value for all border cells of a tile.
    pub fn filled(tile: &Window, value: T) -> Border<T> {
        Border { width: tile.width, height: tile.height, values: vec![value; 2 * (tile.width + tile.height)] }
    }

    /// The value of the cell with this index in the tile; `None` if it is not on the border.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<T> {
        self.slot(index).map(|slot| self.values[slot])
    }

    /// Sets the value of the cell with this index in the tile; does nothing if it is not on the border.
    pub fn set(&mut self, index: usize, value: T) {
        if let Some(slot) = self.slot(index) {
            self.values[slot] = value;
        }
    }

    fn slot(&self, index: usize) -> Option<usize> {
        let (i, j) = (index % self.width, index / self.width);
        match (i, j) {
            (i, 0) => Some(i),
            (i, j) if j + 1 == self.height => Some(self.width + i),
            (0, j) => Some(2 * self.width + j),
            (i, j) if i + 1 == self.width => Some(2 * self.width + self.height + j),
            _ => None,
        }
    }
}

/// The indices of the cells along a tile's border, each once.
pub fn border(tile: &Window) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (tile.width, tile.height);
    (0..height).flat_map(move |j| {
        let whole_row = j == 0 || j + 1 == height || width == 1;
        (0..width).step_by(if whole_row { 1 } else { width - 1 }).map(move |i| j * width + i)
    })
}

/// A queue of tiles, each contained at most once.
#[derive(Debug)]
pub struct Queue {
    tiles: VecDeque<usize>,
    waiting: Vec<bool>,
}

impl Queue {
    /// An empty queue for `count` tiles.
    #[must_use]
    pub fn new(count: usize) -> Queue {
        Queue { tiles: VecDeque::new(), waiting: vec![false; count] }
    }

    /// Appends a tile unless it is in the queue.
    pub fn push(&mut self, tile: usize) {
        if !std::mem::replace(&mut self.waiting[tile], true) {
            self.tiles.push_back(tile);
        }
    }

    /// Removes the first tile.
    pub fn pop(&mut self) -> Option<usize> {
        let tile = self.tiles.pop_front()?;
        self.waiting[tile] = false;
        Some(tile)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_hold_every_cell_once_and_borders_are_their_rims() {
        let whole = Window::new(23, 17, 2.0).at(-5, 9);
        for side in [1, 2, 5, 16, 40] {
            let tiling = Tiling::new(whole, side);
            let mut seen = vec![0; whole.len()];
            for t in 0..tiling.count() {
                let tile = tiling.tile(t);
                for index in 0..tile.len() {
                    let cell = tiling.cell_of(&tile, index);
                    assert_eq!(tiling.locate(cell), (t, index));
                    seen[cell as usize] += 1;
                }
                let mut values = Border::filled(&tile, 0usize);
                let rim: Vec<usize> = border(&tile).collect();
                rim.iter().for_each(|index| values.set(*index, index + 1));
                for index in 0..tile.len() {
                    let (i, j) = (index % tile.width, index / tile.width);
                    let outer = i == 0 || j == 0 || i + 1 == tile.width || j + 1 == tile.height;
                    assert_eq!(rim.iter().filter(|other| **other == index).count(), usize::from(outer));
                    assert_eq!(values.get(index), outer.then_some(index + 1));
                }
            }
            assert!(seen.iter().all(|times| *times == 1));
        }
    }
}
