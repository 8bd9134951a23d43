//! Levels of detail around a viewer.

use super::id::ChunkId;
use crate::plan::domain::world_windows;
use crate::world::check_cell;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;

/// Configuration of the chunks around a viewer: square rings, each with cells twice as large as the ring inside.
///
/// **Chunks.** A chunk of level l has sides of `cells * cell * 2^l` metres. The terrain within `range` of the viewer is
/// divided into chunks of the coarsest level. Each chunk that is closer to the viewer than `detail` of its sides is
/// replaced by the four finer ones that cover it, down to level 0. Distances are Chebyshev distances (the greater of
/// the distances east and south), so rings are square. The chunks cover the terrain once, and neighbors differ by at
/// most one level.
///
/// **Borders.** A chunk has `cells + 1` samples per side: its last row and column are its neighbor's first, with the
/// same bits. If the neighbor is one level coarser, its samples are every second one of the finer chunk's, with the
/// same bits unless the recipe has filters (whose results depend on the cell): see [`stitch`](super::seam::stitch).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LodConfig {
    /// Cells along a chunk's side: an even number from 2 to 4096. Default 64.
    pub cells: usize,
    /// Distance between samples at level 0, in metres. Default 1.
    pub cell: f64,
    /// Number of levels, 1 to 24. Default 6.
    pub levels: u8,
    /// Distance to the viewer below which a chunk is replaced by finer ones, in sides of that chunk: 1 + `slack` to 16.
    /// Twice the distance gives about four times as many chunks. Default 1.5.
    pub detail: f64,
    /// Range of sight, in metres. Default 8000.
    pub range: f64,
    /// Hysteresis: the distance beyond `detail` (in sides) and `range` (in sides of the coarsest chunks) at which a
    /// chunk is dropped again, so that a viewer who moves back and forth does not cause the same chunks to be made
    /// repeatedly: 0 to 1. Default 0.25.
    pub slack: f64,
}

impl Default for LodConfig {
    fn default() -> LodConfig {
        LodConfig::new()
    }
}

orogen_noise::builder!(
    LodConfig: with_cells(cells: usize),
    with_cell(cell: f64),
    with_levels(levels: u8),
    with_detail(detail: f64),
    with_range(range: f64),
    with_slack(slack: f64)
);

/// Maximum number of chunks of the coarsest level along the diameter of the range.
const MAX_ACROSS: f64 = 256.0;

impl LodConfig {
    /// The default configuration. Unlike `default`, it can be called in constants.
    #[must_use]
    pub const fn new() -> LodConfig {
        LodConfig { cells: 64, cell: 1.0, levels: 6, detail: 1.5, range: 8000.0, slack: 0.25 }
    }

    /// Checks the configuration.
    ///
    /// # Errors
    /// The message names the invalid number and its range.
    pub fn check(&self) -> Result<()> {
        let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
        if !(2..=4096).contains(&self.cells) || self.cells % 2 == 1 {
            return fault(format!(
                "the number of cells of a chunk must be even and from 2 to 4096, not {}",
                self.cells
            ));
        }
        check_cell(self.cell)?;
        if !(1..=24).contains(&self.levels) {
            return fault(format!("the number of levels of detail must be from 1 to 24, not {}", self.levels));
        }
        if !(0.0..=1.0).contains(&self.slack) {
            return fault(format!("the slack must be from 0 to 1, not {}", self.slack));
        }
        if !(1.0 + self.slack..=16.0).contains(&self.detail) {
            return fault(format!(
                "the detail must be from 1 + slack = {1} to 16, not {0}; otherwise neighbors could differ by more than one level",
                self.detail,
                1.0 + self.slack
            ));
        }
        if !(self.range.is_finite() && self.range > 0.0) {
            return fault(format!("the range must be greater than 0 m, not {}", self.range));
        }
        let across = 2.0 * self.range / self.side(self.levels - 1);
        match across <= MAX_ACROSS {
            true => Ok(()),
            false => fault(format!(
                "a range of {} m spans {across:.0} chunks of the coarsest level, and at most {MAX_ACROSS} are supported; use more levels or a smaller range",
                self.range
            )),
        }
    }

    /// Distance between samples at a level, in metres.
    #[must_use]
    pub fn cell_of(&self, level: u8) -> f64 {
        // A power of two: exact, so that samples shared by two levels have bit-equal positions.
        self.cell * (1u64 << level.min(63)) as f64
    }

    /// Side of a chunk of a level, in metres.
    #[must_use]
    pub fn side(&self, level: u8) -> f64 {
        self.cells as f64 * self.cell_of(level)
    }

    /// The samples of a chunk, including its far edges.
    #[must_use]
    pub fn window(&self, id: ChunkId) -> Window {
        let samples = self.cells + 1;
        let first = |index: i64| index.saturating_mul(self.cells as i64);
        Window::new(samples, samples, self.cell_of(id.level)).at(first(id.x), first(id.y))
    }

    /// The samples of a chunk in a world of `size` metres; `None` if the chunk lies outside of the world. A chunk at
    /// the world's far edges is clipped to its samples.
    pub(super) fn window_within(&self, id: ChunkId, size: Option<[f64; 2]>) -> Option<Window> {
        let window = self.window(id);
        let Some(size) = size else { return Some(window) };
        let (world, _) = world_windows(size, window.cell);
        let end = |first: i64, samples: usize, last: i64| -> Option<usize> {
            let samples = (samples as i64).min(last.checked_sub(first)?);
            (first >= 0 && samples >= 2).then_some(samples as usize)
        };
        let width = end(window.x, window.width, world.right())?;
        let height = end(window.y, window.height, world.bottom())?;
        Some(Window { width, height, ..window })
    }

    /// The distance of a viewer from a chunk, in metres; 0 above it.
    #[must_use]
    pub fn distance(&self, id: ChunkId, [x, y]: [f64; 2]) -> f64 {
        let side = self.side(id.level);
        let along = |at: f64, index: i64| {
            let start = index as f64 * side;
            (start - at).max(at - (start + side)).max(0.0)
        };
        along(x, id.x).max(along(y, id.y))
    }

    /// The distance of a viewer from a chunk's center, in metres.
    pub(super) fn distance_to_middle(&self, id: ChunkId, [x, y]: [f64; 2]) -> f64 {
        let side = self.side(id.level);
        let along = |at: f64, index: i64| (at - (index as f64 + 0.5) * side).abs();
        along(x, id.x).max(along(y, id.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_is_said() {
        let good = LodConfig::default();
        assert!(good.check().is_ok());
        for (lod, said) in [
            (LodConfig { cells: 0, ..good }, "from 2 to 4096, not 0"),
            (LodConfig { cells: 33, ..good }, "must be even"),
            (LodConfig { cell: f64::NAN, ..good }, "not NaN"),
            (LodConfig { levels: 0, ..good }, "1 to 24"),
            (LodConfig { levels: 25, ..good }, "1 to 24"),
            (LodConfig { detail: 1.2, ..good }, "1 + slack = 1.25"),
            (LodConfig { slack: -0.1, ..good }, "slack must be from 0 to 1, not -0.1"),
            (LodConfig { range: 0.0, ..good }, "greater than 0 m, not 0"),
            (LodConfig { range: 1e9, ..good }, "more levels"),
        ] {
            let error = lod.check().unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn chunks_share_their_edges_with_neighbors_and_parents() {
        let lod = LodConfig { cell: 1.0 / 3.0, ..LodConfig::default() };
        let id = ChunkId { level: 1, y: -2, x: 3 };
        let (window, east) = (lod.window(id), lod.window(id.beside(1, 0)));
        assert_eq!(window.right() - 1, east.x);
        assert_eq!(window.east(64).to_bits(), east.east(0).to_bits());
        let parent = lod.window(id.parent());
        assert_eq!(
            (parent.x * 2, parent.y * 2),
            (window.x - 64, window.y),
            "an odd column is its parent's eastern half"
        );
        assert_eq!(parent.east(32).to_bits(), window.east(0).to_bits());
    }

    #[test]
    fn a_world_ends_where_its_samples_end() {
        let lod = LodConfig { cells: 10, cell: 1.0, levels: 3, ..LodConfig::default() };
        let within = |level, x, y| lod.window_within(ChunkId { level, y, x }, Some([25.0, 40.0]));
        let size = |window: Option<Window>| window.map(|window| (window.width, window.height));
        assert_eq!(size(within(0, 0, 0)), Some((11, 11)));
        assert_eq!(size(within(0, 2, 3)), Some((6, 11)));
        assert_eq!(size(within(0, 3, 0)), None);
        assert_eq!(size(within(0, 0, 4)), None, "one row of samples is no ground");
        assert_eq!(size(within(0, -1, 0)), None);
        assert_eq!(size(within(1, 1, 1)), Some((3, 11)));
        assert_eq!(size(within(2, 0, 0)), Some((7, 11)));
    }
}
