//! Storage of frames until they are shown, in memory if they are few, otherwise on disk.

use orogen_grid::grid::{Grid, Window};
use orogen_io::samples;
use orogen_io::spool::Spool;
use std::collections::BTreeMap;
use std::io;

/// Heights over one window after several steps.
pub struct FrameSpool {
    spool: Spool,
    window: Window,
    /// The position of the heights after each step.
    starts: BTreeMap<u32, u64>,
}

impl FrameSpool {
    /// An empty spool for grids over `window`.
    #[must_use]
    pub fn new(spool: Spool, window: Window) -> FrameSpool {
        FrameSpool { spool, window, starts: BTreeMap::new() }
    }

    /// Stores the heights after a step, which must have the spool's window.
    ///
    /// # Errors
    /// If the disk is full or fails.
    pub fn put(&mut self, step: u32, heights: &Grid) -> io::Result<()> {
        if heights.window() != &self.window {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        let mut start = None;
        for row in 0..self.window.height {
            let at = self.spool.push(&samples::to_bytes(heights.row(row)))?;
            start.get_or_insert(at);
        }
        self.starts.insert(step, start.unwrap_or_default());
        Ok(())
    }

    /// The heights after a step. After the first call no more can be stored.
    ///
    /// # Errors
    /// If there are none after that step, or the disk fails.
    pub fn get(&mut self, step: u32) -> io::Result<Grid> {
        let start = *self.starts.get(&step).ok_or(io::ErrorKind::NotFound)?;
        let mut grid = Grid::filled(self.window, 0.0);
        let mut bytes = vec![0; 4 * self.window.width];
        for row in 0..self.window.height {
            self.spool.read(start + (row * bytes.len()) as u64, &mut bytes)?;
            samples::read_bytes(grid.row_mut(row), &bytes);
        }
        Ok(grid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_back_in_any_order() {
        let window = Window::new(3, 2, 1.0);
        let frame = |step: u32| Grid::from_data(window, (0..6).map(|k| (k + 10 * step) as f32).collect()).unwrap();
        let mut spool = FrameSpool::new(Spool::in_memory(), window);
        [2, 7, 4].into_iter().for_each(|step| spool.put(step, &frame(step)).unwrap());
        for step in [4, 2, 7, 4] {
            assert_eq!(spool.get(step).unwrap(), frame(step));
        }
        assert_eq!(spool.get(3).unwrap_err().kind(), io::ErrorKind::NotFound);
        assert!(spool.put(9, &Grid::filled(Window::new(2, 2, 1.0), 0.0)).is_err());
    }
}
