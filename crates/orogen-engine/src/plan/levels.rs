//! How a window of a levelled op is made: the level that serves it, the pieces that are made in parallel, and the
//! windows of the levels above each piece.
//!
//! Coarse levels are made in *tiles* of a fixed side, which neighboring windows share. If a piece needs more than a few
//! tiles of a level, that level is made over the piece itself: the halos of the tiles would cost more than sharing
//! saves.

use super::around::samples_around;
use super::steps::grid_bytes;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;
use orogen_ops::op::{Levelled, Levels};
use std::ops::Range;

/// Samples along the sides of the tiles of coarse levels.
const TILE: usize = 64;

/// Samples along the sides of the tiles of level 0, whose halo is usually wide.
const COARSEST_TILE: usize = 128;

/// Samples along the sides of the tiles of a level, and samples of tile (0, 0) before the origin. A tile of level 0 has
/// the origin in its middle, because most people look there first.
fn shape(level: usize) -> (usize, i64) {
    if level == 0 { (COARSEST_TILE, COARSEST_TILE as i64 / 2) } else { (TILE, 0) }
}

/// Maximum number of samples along the sides of a window that is read from tiles.
const FEW_TILES: usize = TILE + TILE / 2;

/// Largest and smallest number of rows and columns of a piece, if the window has as many.
const PIECE: [usize; 2] = [1024, 128];

/// Maximum number of samples of a level for one window: 64 GiB for each of its planes.
const MAX_SAMPLES: u64 = 1 << 34;

/// Number of pieces of a window whose memory is estimated.
const MEASURED_PIECES: usize = 1024;

/// The samples of a level from which a window is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Serving {
    /// The level.
    pub level: usize,
    /// Its samples: the window itself if the cells are equal, otherwise the samples around it, which are interpolated.
    pub samples: Window,
}

impl Serving {
    /// The samples that serve a window.
    #[must_use]
    pub fn of(levels: &Levels, window: &Window) -> Serving {
        let level = levels.serving(window.cell);
        Serving { level, samples: samples_around(window, levels.cell(level)) }
    }

    /// Checks that the number of samples is reasonable: a window whose cell is far larger than the coarsest level's
    /// needs many samples of that level for each of its own.
    ///
    /// # Errors
    /// If there are too many; the message has the largest possible cell for a window of this size.
    pub fn check(&self, levels: &Levels, window: &Window, node: &str) -> Result<()> {
        let Window { x, y, width, height, cell } = self.samples;
        // Beyond 2^53 whole numbers are not exact, so samples coincide.
        if [x, y].iter().any(|first| first.unsigned_abs() > 1 << 53) {
            let message = format!(
                "the window is too far from the origin for node `{node}`; use a window within {} m of it",
                number(cell * (1u64 << 53) as f64)
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        if (width as u64).saturating_mul(height as u64) <= MAX_SAMPLES {
            return Ok(());
        }
        let coarsest = levels.cell(0);
        // Twice the cell needs four times as many samples.
        let share = MAX_SAMPLES as f64 / (window.width as f64 * window.height as f64);
        let largest = (coarsest * share.sqrt()).floor();
        let message = if self.level == 0 && window.cell > coarsest && largest >= coarsest {
            format!(
                "a window of {} x {} samples at a cell of {} m needs {:.0} x {:.0} samples of the coarsest level of node `{node}`, which has a cell of {} m; use \
                 a cell of at most {} m",
                window.width,
                window.height,
                number(window.cell),
                width,
                height,
                number(cell),
                number(largest)
            )
        } else {
            format!(
                "a window of {} x {} samples at a cell of {} m needs {width} x {height} samples of node `{node}`, more than {MAX_SAMPLES}; use fewer samples at once",
                window.width,
                window.height,
                number(window.cell)
            )
        };
        Err(Error::new(ErrorKind::Request, message))
    }

    /// Parts of the samples that are made in parallel: at least one per thread, unless they would be too narrow.
    pub fn pieces(&self, threads: usize) -> impl Iterator<Item = Window> + use<> {
        let [most, least] = PIECE;
        let samples = self.samples;
        let Window { width, height, .. } = samples;
        let columns = width.div_ceil(most).max(1);
        let rows = height.div_ceil(most).max(threads.div_ceil(columns).min(height / least)).max(1);
        let rows = height.div_ceil(rows).max(1);
        let columns = width.div_ceil(columns).max(1);
        let bands = (0..height.div_ceil(rows)).map(move |band| Window {
            y: samples.y + (band * rows) as i64,
            height: rows.min(height - band * rows),
            ..samples
        });
        let across = move |band: Window| {
            (0..width.div_ceil(columns)).map(move |piece| Window {
                x: band.x + (piece * columns) as i64,
                width: columns.min(width - piece * columns),
                ..band
            })
        };
        bands.flat_map(across)
    }
}

/// The level from whose tiles the pieces of a window are made. It does not depend on the number of threads; only the
/// pieces do. `wanted` says for each layer of the op whether it is requested, here and in the functions below.
#[must_use]
pub fn tiled(op: &dyn Levelled, wanted: &[bool], serving: &Serving) -> usize {
    let Serving { mut level, samples } = *serving;
    let [most, _] = PIECE;
    let largest = Window { width: samples.width.min(most), height: samples.height.min(most), ..samples };
    let mut window = largest.grown(op.surface_halo(level, wanted));
    while level > 0 && window.width.max(window.height) > FEW_TILES {
        window = op.parent(level, &window);
        level -= 1;
    }
    level
}

/// The windows of the levels from `tiled` to `level` from which a piece of `level` is made.
#[must_use]
pub fn windows(op: &dyn Levelled, wanted: &[bool], tiled: usize, level: usize, piece: &Window) -> Vec<Window> {
    let mut windows = vec![piece.grown(op.surface_halo(level, wanted))];
    for level in (tiled + 1..=level).rev() {
        let window = windows.last().map(|window| op.parent(level, window));
        windows.extend(window);
    }
    windows.reverse();
    windows
}

/// For each level from the coarsest, a window that contains all samples from which a window is made; for the tiled
/// levels it consists of whole tiles.
#[must_use]
pub fn covering(op: &dyn Levelled, wanted: &[bool], window: &Window) -> Vec<Window> {
    let serving = Serving::of(&op.levels(), window);
    let tiled = tiled(op, wanted, &serving);
    let mut windows: Vec<Window> =
        windows(op, wanted, tiled, serving.level, &serving.samples).into_iter().rev().collect();
    if let Some(first) = windows.last_mut() {
        *first = of_tiles(tiled, first);
    }
    for level in (1..=tiled).rev() {
        let above = windows.last().map(|window| of_tiles(level - 1, &op.parent(level, window)));
        windows.extend(above);
    }
    windows.reverse();
    windows
}

/// The window of all tiles that cover a window.
fn of_tiles(level: usize, window: &Window) -> Window {
    let (columns, rows) = tile_ranges(level, window);
    if columns.is_empty() || rows.is_empty() {
        return *window;
    }
    let tile = |column, row| tile(level, (column, row), window.cell);
    tile(columns.start, rows.start).union(&tile(columns.end - 1, rows.end - 1))
}

/// The tiles that cover a window, by their column and row.
pub fn tiles(level: usize, window: &Window) -> impl Iterator<Item = (i64, i64)> + use<> {
    let (columns, rows) = tile_ranges(level, window);
    rows.flat_map(move |row| columns.clone().map(move |column| (column, row)))
}

/// The columns and rows of the tiles that cover a window.
fn tile_ranges(level: usize, window: &Window) -> (Range<i64>, Range<i64>) {
    let (side, start) = shape(level);
    let index = |sample: i64| (sample + start).div_euclid(side as i64);
    (index(window.x)..index(window.right() - 1) + 1, index(window.y)..index(window.bottom() - 1) + 1)
}

/// The window of a tile.
#[must_use]
pub fn tile(level: usize, (column, row): (i64, i64), cell: f64) -> Window {
    let (side, start) = shape(level);
    let first = |index: i64| index * side as i64 - start;
    Window::new(side, side, cell).at(first(column), first(row))
}

/// Memory for making a window in addition to its layers, in bytes.
#[must_use]
pub fn memory(op: &dyn Levelled, wanted: &[bool], window: &Window, threads: usize) -> u64 {
    let serving = Serving::of(&op.levels(), window);
    let (Serving { level, samples }, tiled) = (serving, tiled(op, wanted, &serving));
    let planes = op.planes() as u64;
    let layers = wanted.iter().filter(|wanted| **wanted).count() as u64;
    let held = |window: &Window| grid_bytes(window).saturating_mul(planes);
    // Whole tiles cover up to a tile more on each side. The level above has a quarter as many samples, plus its halo.
    let of_tiles = |window: &Window| held(&window.grown(COARSEST_TILE)).saturating_mul(2);
    let piece = |piece: &Window| {
        let windows = windows(op, wanted, tiled, level, piece);
        let levels = tiled..=level;
        let pair = windows.windows(2).map(|pair| held(&pair[0]).saturating_add(held(&pair[1]))).max();
        let scratch = levels.zip(&windows).skip(1).map(|(level, window)| op.scratch(level, window)).max();
        let made = grid_bytes(piece).saturating_mul(layers);
        pair.unwrap_or_else(|| windows.iter().map(held).sum()).saturating_add(scratch.unwrap_or(0)).saturating_add(made)
    };
    // Pieces of the same size at other positions need at most one more row and column.
    let largest = serving.pieces(threads).take(MEASURED_PIECES).map(|window| piece(&window)).max().unwrap_or(0);
    let pieces = serving.pieces(threads).take(threads).count() as u64;
    let all = windows(op, wanted, tiled, level, &samples).first().map_or(0, of_tiles);
    let one = |level: usize| {
        let window = tile(level, (0, 0), op.levels().cell(level));
        held(&window).saturating_add(op.scratch(level, &window)).saturating_add(match level {
            0 => 0,
            level => held(&op.parent(level, &window)),
        })
    };
    let tile = (0..=tiled).map(one).max().unwrap_or(0);
    let threads = threads as u64;
    let apart = if samples.cell == window.cell { 0 } else { grid_bytes(&samples).saturating_mul(layers) };
    let working = largest.saturating_mul(pieces).max(tile.saturating_mul(threads));
    all.saturating_add(working).saturating_add(apart)
}

/// Approximate time for making a window on one core, in nanoseconds, if no tiles are kept yet.
#[must_use]
pub fn cost(op: &dyn Levelled, wanted: &[bool], window: &Window) -> f64 {
    let serving = Serving::of(&op.levels(), window);
    let (Serving { level, samples }, tiled) = (serving, tiled(op, wanted, &serving));
    let sum = |level: usize, window: &Window| op.cost(level) * window.width as f64 * window.height as f64;
    let windows = windows(op, wanted, tiled, level, &samples);
    let direct: f64 = (tiled..=level).zip(&windows).skip(1).map(|(level, window)| sum(level, window)).sum();
    let first = windows.first().map_or(0.0, |window| sum(tiled, &window.grown(TILE / 2)));
    let above: f64 = (0..tiled).map(|level| 4.0 * op.cost(level) * (TILE * TILE) as f64).sum();
    direct + first + above
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coarsest_level_that_is_fine_enough_serves_a_window() {
        let levels = Levels { finest: 60.0, count: 4 };
        assert_eq!([0, 1, 2, 3].map(|level| levels.cell(level)), [480.0, 240.0, 120.0, 60.0]);
        let window = |cell: f64| Window::new(10, 7, cell).at(-33, 5);
        for (cell, level) in [(1e9, 0), (480.0, 0), (479.0, 1), (240.0, 1), (61.0, 3), (60.0, 3), (7.0, 3)] {
            let serving = Serving::of(&levels, &window(cell));
            assert_eq!(serving.level, level, "{cell}");
            if cell == levels.cell(level) {
                assert_eq!(serving.samples, window(cell));
            } else {
                let (samples, window) = (serving.samples, window(cell));
                assert!(samples.east(1) < window.east(0) && samples.east(samples.width - 2) > window.east(9), "{cell}");
                assert!(samples.south(1) < window.south(0) && samples.south(samples.height - 2) > window.south(6));
            }
        }
        assert!(Serving::of(&levels, &Window::new(0, 5, 7.0)).samples.is_empty());
    }

    #[test]
    fn pieces_cover_a_window_once_and_are_no_slivers() {
        for (width, height, threads) in
            [(1, 1, 8), (1024, 1024, 2), (3000, 10, 4), (5000, 2500, 3), (300, 300, 64), (0, 3, 2)]
        {
            let samples = Window::new(width, height, 60.0).at(-7, 1000);
            let pieces: Vec<Window> = Serving { level: 0, samples }.pieces(threads).collect();
            assert_eq!(pieces.iter().map(Window::len).sum::<usize>(), samples.len(), "{width} x {height}");
            for (k, piece) in pieces.iter().enumerate() {
                assert!(samples.contains(piece) && piece.width <= 1024 && piece.height <= 1024, "{piece:?}");
                assert!(pieces.iter().skip(k + 1).all(|other| piece.intersection(other).is_empty()));
            }
            assert!(width < 1024 || height < 1024 || pieces.len() >= threads.min(2));
        }
    }

    #[test]
    fn tiles_cover_a_window() {
        let window = Window::new(130, 3, 8.0).at(-65, 63);
        let covering: Vec<_> = tiles(5, &window).collect();
        assert_eq!(covering, [(-2, 0), (-1, 0), (0, 0), (1, 0), (-2, 1), (-1, 1), (0, 1), (1, 1)]);
        assert_eq!(tile(5, (-2, 1), 8.0), Window::new(64, 64, 8.0).at(-128, 64));
        let covering: Vec<_> = tiles(0, &window).collect();
        assert_eq!(covering, [(-1, 0), (0, 0), (1, 0), (-1, 1), (0, 1), (1, 1)]);
        assert_eq!(tile(0, (0, 1), 8.0), Window::new(128, 128, 8.0).at(-64, 64));
        assert_eq!(tiles(5, &Window::new(0, 0, 8.0)).count(), 0);
    }

    #[test]
    fn a_window_of_far_larger_cells_than_the_coarsest_level_is_refused() {
        let levels = Levels { finest: 60.0, count: 4 };
        let check = |window: &Window| Serving::of(&levels, window).check(&levels, window, "land");
        assert!(check(&Window::new(32, 32, 1.9e6)).is_ok() && check(&Window::new(32, 32, 60.0)).is_ok());
        let error = check(&Window::new(32, 32, 3e10)).unwrap_err().to_string();
        assert!(
            error.contains("needs 1937500006 x 1937500006 samples of the coarsest level of node `land`"),
            "{error}"
        );
        assert!(error.contains("use a cell of at most 1966080 m"), "{error}");
        assert!(check(&Window::new(32, 32, 1966080.0)).is_ok());
        let far = Window::new(32, 32, 1e12).at(1 << 53, -(1 << 53));
        assert!(
            check(&far)
                .unwrap_err()
                .to_string()
                .contains("too far from the origin for node `land`; use a window within 4.3")
        );
        assert!(
            check(&Window::new(1 << 30, 1 << 30, 60.0)).unwrap_err().to_string().contains("use fewer samples at once")
        );
    }

    #[test]
    fn estimates_of_a_huge_window_take_no_time_and_no_memory() {
        let samples = Window::new(1 << 40, 1 << 40, 60.0).at(-(1 << 39), 1 << 45);
        let pieces: Vec<Window> = Serving { level: 0, samples }.pieces(4).take(3).collect();
        assert_eq!(pieces[2], Window::new(1024, 1024, 60.0).at(samples.x + 2048, samples.y));
        let covering = of_tiles(3, &samples);
        assert!(covering.contains(&samples) && covering.width == 1 << 40, "{covering:?}");
    }
}
