//! Streams of tiles of a large window.

use super::world::World;
use crate::plan::steps::Plan;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_ops::budget::Budget;
use std::collections::VecDeque;

/// The division of a window into tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tiling {
    /// Side of a tile in samples. The tiles at the window's east and south edges may be smaller.
    pub side: usize,
    /// Number of additional samples at a tile's east and south edges, which are its neighbors' first ones: 0 for tiles
    /// without shared samples, 1 for tiles that share an edge, as game engines require.
    pub overlap: usize,
    /// Memory limit of the stream, in bytes, without the returned tiles; `None` for the world's limit.
    pub memory: Option<u64>,
}

impl Tiling {
    /// Tiles of `side` x `side` samples without overlap.
    #[must_use]
    pub fn of(side: usize) -> Tiling {
        Tiling { side, overlap: 0, memory: None }
    }

    /// Number of tiles of `window`, east and south.
    #[must_use]
    pub fn layout(&self, window: &Window) -> [usize; 2] {
        let side = self.side.max(1);
        [window.width, window.height].map(|samples| samples.saturating_sub(self.overlap).div_ceil(side).max(1))
    }

    /// The window of the tile in column `column` and row `row`.
    #[must_use]
    pub fn tile(&self, window: &Window, column: usize, row: usize) -> Window {
        self.run(window, [column, row], [1, 1])
    }

    /// The window of `count` tiles east and south, starting with the tile at `first`.
    fn run(&self, window: &Window, first: [usize; 2], count: [usize; 2]) -> Window {
        let along = |first: usize, count: usize, samples: usize| {
            let start = (first * self.side).min(samples);
            (start, (count * self.side + self.overlap).min(samples - start))
        };
        let (left, width) = along(first[0], count[0], window.width);
        let (top, height) = along(first[1], count[1], window.height);
        Window { x: window.x + left as i64, y: window.y + top as i64, width, height, cell: window.cell }
    }
}

/// A tile of a stream.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Its column among the tiles, from the west.
    pub column: usize,
    /// Its row among the tiles, from the north.
    pub row: usize,
    /// One grid per layer, in the requested order.
    pub grids: Vec<Grid>,
}

/// Maximum number of samples that are made at once: enough to make halos and plans cheap.
const AT_ONCE: usize = 1 << 24;

/// Number of samples above which more are made at once only if that makes a sample cheaper by a factor of [`CHEAPER`]:
/// the memory of smaller grids is reused by the next ones.
const ENOUGH: usize = 1 << 22;
const CHEAPER: f64 = 1.01;

/// Inverse of the share of a memory limit that one grid made at once may take. The allocator keeps memory that a thread
/// has freed for that thread, outside of the budget, so many small grids take less memory than a few large ones.
const PART_OF_LIMIT: u64 = 16;

/// The tiles of a large window, made on demand: see [`World::tiles`].
pub struct Tiles<'w> {
    world: &'w World,
    layers: Vec<String>,
    window: Window,
    tiling: Tiling,
    progress: Progress,
    /// The work of solving, which precedes the first strip, and the work per sample; known once the first strip is
    /// requested.
    work: Option<[f64; 2]>,
    /// Number of tiles made at once, east and south.
    at_once: [usize; 2],
    /// Strips still to make: the first tile of each and the number of tiles.
    strips: VecDeque<([usize; 2], [usize; 2])>,
    made: VecDeque<Tile>,
    /// The filter for wanted tiles.
    wanted: Box<dyn Fn(usize, usize) -> bool + Send + 'w>,
}

impl World {
    /// Makes layers over a window tile by tile, for windows larger than memory.
    ///
    /// Guarantees:
    ///
    /// - Each tile equals the crop of the whole window, bit for bit, for any tiling, memory limit and number of
    ///   threads.
    /// - Tiles come row by row from the north, each row from west to east, each wanted tile once.
    /// - The work stays within the memory limit of the tiling (or of the world). If even one tile does not fit, nothing
    ///   is started and the error states the needed memory.
    /// - Neighboring tiles are made together if memory allows, so that they share a filter's halo.
    /// - `progress` counts all samples, and cancels the stream with [`ErrorKind::Cancelled`]. The stream ends after an
    ///   error.
    ///
    /// ```
    /// use orogen_engine::tiles::Tiling;
    /// use orogen_engine::{Progress, Window, World};
    ///
    /// let world = World::open(orogen_engine::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
    /// let window = Window::new(300, 200, 30.0);
    /// let whole = world.window("height", &window)?;
    /// for tile in world.tiles(&["height"], &window, Tiling::of(128), &Progress::none())? {
    ///     let grid = &tile?.grids[0];
    ///     assert_eq!(whole.crop(grid.window()).as_ref(), Some(grid));
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`World::plan`]; or a tile has no samples, or one tile needs more memory than allowed.
    pub fn tiles<'w>(
        &'w self,
        layers: &[&str],
        window: &Window,
        tiling: Tiling,
        progress: &Progress,
    ) -> Result<Tiles<'w>> {
        if tiling.side == 0 {
            return Err(Error::new(ErrorKind::Request, "the tile size must be at least 1 sample"));
        }
        if tiling.overlap > tiling.side {
            let message = format!("tiles of {} samples cannot overlap by {}", tiling.side, tiling.overlap);
            return Err(Error::new(ErrorKind::Request, message));
        }
        self.check(window)?;
        let mut tiles = Tiles {
            world: self,
            layers: layers.iter().map(ToString::to_string).collect(),
            window: *window,
            tiling,
            progress: progress.clone(),
            work: None,
            at_once: [1, 1],
            strips: VecDeque::new(),
            made: VecDeque::new(),
            wanted: Box::new(|_, _| true),
        };
        tiles.at_once = tiles.most_at_once()?;
        let count = tiling.layout(window);
        for row in (0..count[1]).step_by(tiles.at_once[1]) {
            for column in (0..count[0]).step_by(tiles.at_once[0]) {
                let [wide, tall] = tiles.at_once;
                tiles.strips.push_back(([column, row], [wide.min(count[0] - column), tall.min(count[1] - row)]));
            }
        }
        Ok(tiles)
    }
}

impl<'w> Tiles<'w> {
    /// Restricts the stream to tiles for which `wanted(column, row)` returns true, for example if the other tiles exist
    /// already.
    pub fn only(mut self, wanted: impl Fn(usize, usize) -> bool + Send + 'w) -> Tiles<'w> {
        self.wanted = Box::new(wanted);
        self
    }

    /// Number of tiles of the window, east and south.
    #[must_use]
    pub fn layout(&self) -> [usize; 2] {
        self.tiling.layout(&self.window)
    }

    /// Number of tiles made at once, east and south: more tiles share halos, fewer take less memory.
    #[must_use]
    pub fn at_once(&self) -> [usize; 2] {
        self.at_once
    }

    /// The next tiles that are made together, in the order of the stream, for callers that process them in parallel.
    /// `None` at the end.
    pub fn next_strip(&mut self) -> Option<Result<Vec<Tile>>> {
        if !self.made.is_empty() {
            return Some(Ok(self.made.drain(..).collect()));
        }
        if let Err(error) = self.weigh() {
            self.strips.clear();
            return Some(Err(error));
        }
        while let Some((first, count)) = self.strips.pop_front() {
            match self.make(first, count) {
                Ok(tiles) if tiles.is_empty() => {}
                Ok(tiles) => return Some(Ok(tiles)),
                Err(error) => {
                    self.strips.clear();
                    return Some(Err(error));
                }
            }
        }
        None
    }

    /// Declares the total work, before the first strip.
    fn weigh(&mut self) -> Result<()> {
        if self.work.is_some() {
            return Ok(());
        }
        let layers: Vec<&str> = self.layers.iter().map(String::as_str).collect();
        let window = self.tiling.run(&self.window, [0, 0], self.at_once);
        let [solving, making] = self.world.work_of(&self.plan(&layers, &window)?)?;
        let each = making / window.len().max(1) as f64;
        let samples = self.strips.iter().filter_map(|(first, count)| Some(self.wanted(*first, *count)?.1.len() as f64));
        self.progress.expect(solving + each * samples.sum::<f64>());
        self.work = Some([solving, each]);
        Ok(())
    }

    /// The wanted tiles among `count` starting with `first`, and their common window; `None` if there are none.
    fn wanted(&self, first: [usize; 2], count: [usize; 2]) -> Option<(Vec<[usize; 2]>, Window)> {
        let all = (0..count[1]).flat_map(|row| (0..count[0]).map(move |column| [first[0] + column, first[1] + row]));
        let wanted: Vec<[usize; 2]> = all.filter(|[column, row]| (self.wanted)(*column, *row)).collect();
        let windows = wanted.iter().map(|[column, row]| self.tiling.tile(&self.window, *column, *row));
        let window = windows.reduce(|all, tile| all.union(&tile))?;
        Some((wanted, window))
    }

    /// Makes the wanted tiles among `count` starting with `first`.
    fn make(&mut self, first: [usize; 2], count: [usize; 2]) -> Result<Vec<Tile>> {
        let Some((wanted, window)) = self.wanted(first, count) else { return Ok(Vec::new()) };
        let grids = self.grids(&window)?;
        let mut tiles: Vec<Tile> =
            wanted.into_iter().map(|[column, row]| Tile { column, row, grids: Vec::new() }).collect();
        // Each grid is freed before the next one is cut.
        for grid in grids {
            for tile in &mut tiles {
                tile.grids.extend(grid.crop(&self.tiling.tile(&self.window, tile.column, tile.row)));
            }
        }
        Ok(tiles)
    }

    /// Makes the layers over a window of wanted tiles.
    fn grids(&mut self, window: &Window) -> Result<Vec<Grid>> {
        let [solving, each] = self.work.unwrap_or_default();
        // Solving is complete at the end of the first strip.
        self.work = Some([0.0, each]);
        let part = self.progress.part(solving + each * window.len() as f64);
        let layers: Vec<&str> = self.layers.iter().map(String::as_str).collect();
        self.world.run(&self.plan(&layers, window)?, &part)
    }

    /// The layers over all tiles that are made together next, not cut into tiles; for streams of all tiles.
    pub(crate) fn next_grids(&mut self) -> Option<Result<Vec<Grid>>> {
        if let Err(error) = self.weigh() {
            self.strips.clear();
            return Some(Err(error));
        }
        let (first, count) = self.strips.pop_front()?;
        let window = self.tiling.run(&self.window, first, count);
        let made = self.grids(&window);
        if made.is_err() {
            self.strips.clear();
        }
        Some(made)
    }

    /// The largest number of tiles to make at once: rows of them across the whole window, otherwise a part of a row,
    /// otherwise one tile.
    fn most_at_once(&self) -> Result<[usize; 2]> {
        let [columns, rows] = self.layout();
        let samples = |[wide, tall]: [usize; 2]| {
            let window = self.tiling.run(&self.window, [0, 0], [wide, tall]);
            window.width.saturating_mul(window.height)
        };
        let allowed = self.allowed();
        let most = allowed.map_or(AT_ONCE, |allowed| AT_ONCE.min((allowed / PART_OF_LIMIT / 4) as usize));
        let fewer = |at_once: [usize; 2]| match at_once {
            [wide, 1] => [wide.div_ceil(2), 1],
            [wide, tall] => [wide, tall.div_ceil(2)],
        };
        let mut at_once = [columns, rows];
        loop {
            if at_once == [1, 1] || samples(at_once) <= most {
                let needed = self.needed(at_once)?;
                match allowed {
                    Some(allowed) if needed > allowed => {
                        if at_once == [1, 1] {
                            let side = self.tiling.side;
                            let what = format!("a tile of {side} x {side} samples");
                            let own = self.tiling.memory.map(Budget::of);
                            let budget = own.as_ref().unwrap_or(self.world.budget());
                            return Err(budget.refusal(&what, needed, "use smaller tiles, or raise the memory limit"));
                        }
                    }
                    _ => break,
                }
            }
            at_once = fewer(at_once);
        }
        // Rows of tiles are not divided.
        let cheapest = CHEAPER * self.work_per_sample(at_once)?;
        while at_once[1] > 1 && samples(at_once) > ENOUGH && self.work_per_sample(fewer(at_once))? <= cheapest {
            at_once = fewer(at_once);
        }
        Ok(at_once)
    }

    /// Approximate time for a sample if this many tiles are made at once.
    fn work_per_sample(&self, at_once: [usize; 2]) -> Result<f64> {
        let layers: Vec<&str> = self.layers.iter().map(String::as_str).collect();
        let window = self.tiling.run(&self.window, [0, 0], at_once);
        let [_, making] = self.world.work_of(&self.plan(&layers, &window)?)?;
        Ok(making / window.len().max(1) as f64)
    }

    /// Memory for making this many tiles at once, in bytes: of the plan, and of the tiles cut from its result.
    fn needed(&self, at_once: [usize; 2]) -> Result<u64> {
        let layers: Vec<&str> = self.layers.iter().map(String::as_str).collect();
        let window = self.tiling.run(&self.window, [0, 0], at_once);
        let plan = self.plan(&layers, &window)?;
        Ok(self.world.memory_of(&plan)?.saturating_add(self.cut(&window)))
    }

    /// Memory of the tiles cut from the result over a window, in bytes.
    fn cut(&self, window: &Window) -> u64 {
        (window.len() as u64).saturating_mul(4).saturating_mul(self.layers.len() as u64)
    }

    /// Memory limit of the stream, in bytes; `None` for no limit.
    fn allowed(&self) -> Option<u64> {
        self.tiling.memory.or(self.world.memory_limit())
    }

    /// The plan for layers over a window that is made at once.
    fn plan(&self, layers: &[&str], window: &Window) -> Result<Plan> {
        let allowed = self.allowed().map(|allowed| allowed.saturating_sub(self.cut(window)));
        self.world.plan_within(layers, window, allowed)
    }
}

impl Iterator for Tiles<'_> {
    type Item = Result<Tile>;

    fn next(&mut self) -> Option<Result<Tile>> {
        if let Some(tile) = self.made.pop_front() {
            return Some(Ok(tile));
        }
        match self.next_strip()? {
            Ok(tiles) => self.made.extend(tiles),
            Err(error) => return Some(Err(error)),
        }
        self.made.pop_front().map(Ok)
    }
}
