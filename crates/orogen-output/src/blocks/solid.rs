//! Which blocks of a column are solid.

use super::density::Offsets;
use super::land::{Column, Land};
use super::levels::Levels;

/// Which levels of a column are solid. Reused for one column after another.
#[derive(Default)]
pub(super) struct Solid<'a> {
    height: f64,
    cell: f64,
    offsets: Option<&'a Offsets>,
    /// The offsets of the column.
    column: Vec<f32>,
}

impl<'a> Solid<'a> {
    /// Starts a column.
    pub(super) fn begin(&mut self, land: &'a Land, column: &Column, at: [i64; 2]) {
        (self.height, self.cell) = (f64::from(column.height), land.window.cell);
        self.offsets = land.offsets.as_ref();
        if let Some(offsets) = self.offsets {
            offsets.column(at, &mut self.column);
        }
    }

    /// The density in the middle of a level, in metres.
    #[inline]
    pub(super) fn density(&self, level: i32) -> f32 {
        let above = (self.height - Levels::middle(level, self.cell)) as f32;
        above + self.offsets.map_or(0.0, |offsets| offsets.at(&self.column, level))
    }

    /// Whether a level is solid.
    #[inline]
    pub(super) fn at(&self, level: i32) -> bool {
        self.density(level) > 0.0
    }
}

impl Land {
    /// Calls a function with the density in the middle of each block of a column, from the bottom: positive where it is
    /// solid, in metres. Outside the land, the nearest column is used.
    pub(super) fn densities(&self, x: i64, y: i64, mut visit: impl FnMut(usize, f32)) {
        let x = x.clamp(self.around.x, self.around.right() - 1);
        let y = y.clamp(self.around.y, self.around.bottom() - 1);
        let Some(column) = self.column(x, y).filter(|column| column.height.is_finite()) else { return };
        let mut solid = Solid::default();
        solid.begin(self, column, [x, y]);
        (0..self.levels.count).for_each(|k| visit(k, solid.density(self.levels.bottom + k as i32)));
    }
}
