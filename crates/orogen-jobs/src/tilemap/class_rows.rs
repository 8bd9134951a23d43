//! The classes of a world, row by row from the north.

use orogen_engine::World;
use orogen_engine::bands::Bands;
use orogen_engine::recipe::outputs::CLASS;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::autotile::classes::Classes;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

use super::tileset::Tileset;

/// How far a class may be from a whole number. A value between two classes, such as an interpolated one, is not a
/// class.
const WHOLE: f32 = 1e-3;

/// Maximum number of rows that a band adds.
const BAND: usize = 512;

/// The classes of a window, of which some rows are in memory.
pub(super) struct ClassRows<'w> {
    tileset: &'w Tileset,
    bands: Bands<'w>,
    window: Window,
    /// The rows in memory, starting with row `first` of the window.
    held: Vec<u8>,
    first: usize,
    finite: FiniteCount,
}

impl<'w> ClassRows<'w> {
    /// The classes of a window of a world.
    pub fn new(world: &'w World, tileset: &'w Tileset, window: &Window, progress: &Progress) -> Result<ClassRows<'w>> {
        let bands = world.bands(&[CLASS], window, 0, progress)?;
        Ok(ClassRows { tileset, bands, window: *window, held: Vec::new(), first: 0, finite: FiniteCount::default() })
    }

    /// Memory of the rows of a band, in bytes.
    pub fn memory(window: &Window) -> u64 {
        (window.width * BAND.min(window.height)) as u64
    }

    /// The count of finite samples among the classes so far.
    pub fn finite(&self) -> FiniteCount {
        self.finite
    }

    /// The rows from row `from` of the world up to, but not including, `to`, as far as the window has them. Rows before
    /// `from` are dropped.
    pub fn rows(&mut self, from: i64, to: i64) -> Result<Classes> {
        let (width, height) = (self.window.width, self.window.height as i64);
        let [from, to] = [from, to].map(|row| (row - self.window.y).clamp(0, height) as usize);
        let dropped = from.saturating_sub(self.first).min(self.held.len() / width.max(1));
        self.held.drain(..dropped * width);
        self.first += dropped;
        while self.first + self.held.len() / width.max(1) < to {
            let Some(band) = self.bands.next() else { break };
            for grid in band? {
                self.finite = self.finite.and(FiniteCount::of(grid.data()));
                self.classes(&grid)?;
            }
        }
        let rows = &self.held[(from - self.first) * width..(to - self.first) * width];
        let y = self.window.y + from as i64;
        Ok(Classes::new([self.window.x, y], width, to - from, rows.to_vec()))
    }

    /// Adds the classes of a layer of numbers. Samples without a number get the first class.
    fn classes(&mut self, grid: &Grid) -> Result<()> {
        let terrains = &self.tileset.terrains;
        self.held.reserve(grid.data().len());
        for (at, value) in grid.data().iter().enumerate() {
            if value.is_nan() {
                self.held.push(0);
                continue;
            }
            let class = value.round();
            if (value - class).abs() > WHOLE || !(0.0..terrains.len() as f32).contains(&class) {
                let [x, y] = [at % grid.width(), at / grid.width()];
                let names: Vec<String> =
                    terrains.iter().enumerate().map(|(n, terrain)| format!("{n} {}", terrain.name)).collect();
                return Err(Error::new(
                    ErrorKind::Request,
                    format!(
                        "the output `class` is {value} in column {}, row {}; it must be a class of the tileset `{}`: {}",
                        grid.window().x + x as i64,
                        grid.window().y + y as i64,
                        self.tileset.name,
                        names.join(", ")
                    ),
                ));
            }
            self.held.push(class as u8);
        }
        Ok(())
    }
}
