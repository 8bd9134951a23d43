//! Levels of levelled ops, by their passes.

use crate::failure::Failure;
use crate::filters::{bands, cropped, inner, text};
use crate::gpu::Gpu;
use crate::job::{Dispatch, Job};
use crate::tiles::fitting;
use orogen_engine::lower::LevelPasses;
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;

/// What the passes of all levels have in common.
const PRELUDE: &str = concat!(include_str!("filters.wgsl"), "\n", include_str!("levels.wgsl"));

/// Words of a level before its own numbers: see the prelude.
const LEVEL_WORDS: usize = 5;

/// Computes the planes of a level over `window`, as `Levelled::refine` does: from those of the level above, and from the op's inputs at the cell of the level.
/// `Ok(None)` if the work was cancelled; `is_cancelled` is asked between parts of it.
///
/// If the planes exceed the [largest buffer](Gpu::buffer_limit), the window is computed in tiles, each from its own part of the level above.
///
/// # Errors
/// If the device was lost, has too little memory for a single sample and what it is made from, or refuses a shader; if the level above covers too little.
pub fn refine(
    gpu: &Gpu,
    passes: &LevelPasses,
    above: &[Grid],
    inputs: &[Option<&Grid>],
    window: &Window,
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Grid>>, Failure> {
    let mut out: Vec<Grid> = (0..passes.planes).map(|_| Grid::filled(*window, 0.0f32)).collect();
    if window.is_empty() {
        return Ok(Some(out));
    }
    let level = Level::new(passes, above, inputs)?;
    let limit = gpu.buffer_limit();
    let Some(tiles) = fitting(window, |tile| level.bytes(tile) <= limit) else {
        let needed = level.bytes(&Window { width: 1, height: 1, ..*window }) >> 20;
        return Err(Failure::Memory(format!(
            "a sample of a level takes {needed} MiB in one buffer, and buffers have at most {} MiB",
            limit >> 20
        )));
    };
    for tile in tiles {
        let Some(made) = level.tile_of(gpu, &tile, &is_cancelled)? else { return Ok(None) };
        for (plane, made) in out.iter_mut().zip(made) {
            if tile == *window {
                *plane = made;
            } else {
                plane.paste(&made);
            }
        }
    }
    Ok(Some(out))
}

/// The part of an input that a tile needs, without values beyond the input's edge; `None` if that is all of it. As `Levelled::refine` does, the last samples at
/// the edge read inputs that none of the window's samples depend on.
fn padded(input: &Grid, grown: &Window) -> Option<Grid> {
    (input.window() != grown).then(|| {
        let mut part = Grid::filled(*grown, f32::NAN);
        part.paste(input);
        part
    })
}

/// A level with its texts.
struct Level<'a> {
    passes: &'a LevelPasses,
    /// The text of each function.
    texts: HashMap<&'static str, String>,
    above: &'a [Grid],
    /// The inputs that are planes.
    inputs: Vec<&'a Grid>,
    /// The cell of the level above.
    cell_above: f64,
}

/// The windows of a tile.
struct Extents {
    /// The samples of the level above.
    above: Window,
    /// All samples of the level in their cells.
    grown: Window,
}

impl<'a> Level<'a> {
    fn new(passes: &'a LevelPasses, above: &'a [Grid], inputs: &[Option<&'a Grid>]) -> Result<Level<'a>, Failure> {
        let missing = || Failure::Input("an input of a level or the level above is missing".to_string());
        let inputs = passes.inputs.iter().map(|&input| inputs.get(input).copied().flatten());
        let inputs = inputs.collect::<Option<Vec<_>>>().ok_or_else(missing)?;
        let cell_above = above.first().ok_or_else(missing)?.window().cell;
        let mut texts = HashMap::new();
        for pass in &passes.passes {
            let function = pass.pass.function;
            texts.entry(function).or_insert_with(|| text(PRELUDE, pass.code, function));
        }
        Ok(Level { passes, texts, above, inputs, cell_above })
    }

    /// Number of planes of the level, and of the level above.
    fn planes(&self) -> [usize; 2] {
        let passes = self.passes;
        [passes.planes + passes.scratch + self.inputs.len(), self.above.len() + passes.scratch_above]
    }

    /// What a tile is made from.
    fn extents(&self, tile: &Window) -> Extents {
        let [ahead_above, ahead] = self.passes.ahead;
        // Half the first node, rounded down, to half the last, rounded up.
        let halved = |first: i64, end: i64| (first.div_euclid(2), end.div_euclid(2) + 1);
        let ((left, right), (top, bottom)) =
            (halved(tile.x + ahead, tile.right() + ahead), halved(tile.y + ahead, tile.bottom() + ahead));
        let (width, height) = ((right - left) as usize, (bottom - top) as usize);
        let nodes = Window { x: left, y: top, width, height, cell: self.cell_above }.grown(self.passes.reach);
        let grown = Window {
            x: 2 * nodes.x - ahead,
            y: 2 * nodes.y - ahead,
            width: 2 * nodes.width,
            height: 2 * nodes.height,
            cell: tile.cell,
        };
        Extents { above: nodes.at(nodes.x - ahead_above, nodes.y - ahead_above), grown }
    }

    /// Memory of the planes for a tile, in bytes.
    fn bytes(&self, tile: &Window) -> u64 {
        let Extents { above, grown } = self.extents(tile);
        let [planes, planes_above] = self.planes().map(|planes| planes as u64);
        4 * (planes.saturating_mul(grown.len() as u64)).saturating_add(planes_above.saturating_mul(above.len() as u64))
    }

    /// The planes over a tile.
    fn tile_of(
        &self,
        gpu: &Gpu,
        tile: &Window,
        is_cancelled: &impl Fn() -> bool,
    ) -> Result<Option<Vec<Grid>>, Failure> {
        let Extents { above, grown } = self.extents(tile);
        let [planes, planes_above] = self.planes();
        let parents = self.above.iter().map(|grid| cropped(Some(grid), &above)).collect::<Result<Vec<_>, _>>()?;
        let inputs: Vec<Option<Grid>> = self.inputs.iter().map(|grid| padded(grid, &grown)).collect();
        let first_above = planes * grown.len();
        let first_input = self.passes.planes + self.passes.scratch;
        let parents = self.above.iter().zip(&parents).enumerate();
        let parents = parents.map(|(k, (whole, part))| (first_above + k * above.len(), part.as_ref().unwrap_or(whole)));
        let inputs = self.inputs.iter().zip(&inputs).enumerate();
        let inputs = inputs.map(|(k, (whole, part))| ((first_input + k) * grown.len(), part.as_ref().unwrap_or(whole)));
        let nodes = [grown.x, grown.y].map(|x| x + self.passes.ahead[1]);
        let position = nodes.into_iter().flat_map(|x| [x as u32, (x >> 32) as u32]);
        let mut job = Job {
            data: std::iter::once(planes as u32).chain(position).chain(self.passes.words.iter().copied()).collect(),
            samples: first_above + planes_above * above.len(),
            uploads: parents.chain(inputs).map(|(first, grid)| (first, grid.data())).collect(),
            ..Job::default()
        };
        self.dispatch(&mut job, &grown, &above);
        // Whole rows are copied back: those of the tile.
        let (left, top) = ((tile.x - grown.x) as usize, (tile.y - grown.y) as usize);
        let rows = tile.height * grown.width;
        job.downloads = (0..self.passes.planes).map(|k| (k * grown.len() + top * grown.width, rows)).collect();
        let Some(back) = job.run(gpu, is_cancelled)? else { return Ok(None) };
        Ok(Some(back.into_iter().map(|rows| inner(&rows, tile, grown.width, left)).collect()))
    }

    /// Adds the runs of all passes to a job.
    fn dispatch<'b>(&'b self, job: &mut Job<'b>, grown: &Window, above: &Window) {
        // Passes of the same part share their words.
        let mut bases = HashMap::new();
        for pass in &self.passes.passes {
            let Some(text) = self.texts.get(pass.pass.function) else { continue };
            let over = if pass.is_above { above } else { grown };
            let [left, top] = pass.pass.inset;
            let (width, height) = (over.width.saturating_sub(2 * left), over.height.saturating_sub(2 * top));
            for (first, rows) in bands(height, width * pass.pass.reads) {
                let start = [left, top + first];
                let base = *bases.entry(start).or_insert(job.data.len());
                if base == job.data.len() {
                    let words = [grown.width, grown.height, start[0], start[1], LEVEL_WORDS];
                    job.data.extend(words.map(|word| word as u32));
                }
                let size = [width, rows].map(|side| side as u32);
                job.dispatches.push(Dispatch { text, base: base as u32, size, step: pass.pass.step });
            }
        }
    }
}
