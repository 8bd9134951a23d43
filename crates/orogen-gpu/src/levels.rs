//! Levels of levelled ops, by their passes.

use crate::failure::Failure;
use crate::filters::{bands, text};
use crate::gpu::Gpu;
use crate::job::{Dispatch, Job};
use crate::layers::Layers;
use crate::source::Source;
use crate::tiles::{fitting, index};
use orogen_engine::device::LevelStep;
use orogen_engine::lower::LevelPasses;
use orogen_grid::grid::{Grid, Window};
use std::borrow::Cow;
use std::collections::HashMap;

/// What the passes of all levels have in common.
pub(crate) const PRELUDE: &str = concat!(include_str!("filters.wgsl"), "\n", include_str!("levels.wgsl"));

/// Computes the planes of the last of some levels, each as `Levelled::refine` does: from those of the level above, and
/// from the op's inputs at the cell of the level. `above` are those above the first. `Ok(None)` if the work was
/// cancelled; `is_cancelled` is asked between parts of it.
///
/// Levels that fit into the [largest buffer](Gpu::buffer_limit) together stay on the card. One that does not fit is
/// computed in tiles, each from its own part of the level above.
///
/// # Errors
/// If the device was lost, has too little memory for a single sample and what it is made from, or refuses a shader; if
/// a level above covers too little.
pub fn refine(
    gpu: &Gpu,
    levels: &[LevelStep],
    above: &[Grid],
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Grid>>, Failure> {
    let limit = gpu.buffer_limit();
    let (mut left, mut made) = (levels, None::<Vec<Grid>>);
    while !left.is_empty() {
        let above = made.as_deref().unwrap_or(above);
        let mut planes_above = above.len();
        let mut chain = Vec::new();
        let mut bytes = 0u64;
        for step in left {
            let level = Level::new(step, planes_above)?;
            bytes = bytes.saturating_add(level.bytes(&step.window));
            if !chain.is_empty() && bytes > limit {
                break;
            }
            planes_above = step.passes.planes;
            chain.push(level);
        }
        let done = match chain.as_slice() {
            [level] if level.bytes(&level.window) > limit => level.in_tiles(gpu, above, &is_cancelled)?,
            levels => together(gpu, levels, above, &is_cancelled)?,
        };
        let Some(planes) = done else { return Ok(None) };
        made = Some(planes);
        left = left.get(chain.len()..).unwrap_or_default();
    }
    Ok(made)
}

/// Levels one from the other, whose planes are all on the card at once. The first one may be a part of its window.
fn together(
    gpu: &Gpu,
    levels: &[Level],
    above: &[Grid],
    is_cancelled: &impl Fn() -> bool,
) -> Result<Option<Vec<Grid>>, Failure> {
    if let Some(level) = levels.iter().find(|level| level.window.is_empty()) {
        return Ok(Some((0..level.passes.planes).map(|_| Grid::filled(level.window, 0.0f32)).collect()));
    }
    let (job, made) = job(levels, above)?;
    let (Some(last), Some(Made { first, grown, window })) = (levels.last(), made) else { return Ok(None) };
    let mut planes = Layers::in_memory(&window, last.passes.planes);
    let firsts: Vec<usize> =
        (0..last.passes.planes).map(|k| first + k * grown.len() + index(&grown, &window)).collect();
    let is_done = planes.run(gpu, job, &window, (&firsts, grown.width), is_cancelled)?;
    Ok(is_done.then(|| planes.into_memory()).flatten())
}

/// The work that makes levels one from the other, and the last of them, if there is one.
///
/// # Errors
/// If a level covers less than what the next one reads.
pub(crate) fn job<'a>(levels: &'a [Level], above: &'a [Grid]) -> Result<(Job<'a>, Option<Made>), Failure> {
    let mut job = Job::default();
    let mut before: Option<Made> = None;
    for level in levels {
        let extents = level.extents(&level.window);
        let [planes, planes_above] = level.planes();
        let first = job.samples;
        let first_above = first + planes * extents.grown.len();
        job.samples = first_above + planes_above * extents.above.len();
        if before.is_none() {
            for (k, grid) in above.iter().enumerate() {
                let at = first_above + k * extents.above.len();
                Source::Memory(grid).add_to(&mut job, &extents.above, at)?;
            }
        }
        let first_input = first + (level.passes.planes + level.passes.scratch) * extents.grown.len();
        for (k, grid) in level.inputs.iter().enumerate() {
            job.uploads.push((first_input + k * extents.grown.len(), padded(grid, &extents.grown)));
        }
        level.dispatch(&mut job, first, &extents, before.as_ref())?;
        before = Some(Made { first, grown: extents.grown, window: level.window });
    }
    Ok((job, before))
}

/// The part of an input that a tile needs, without values beyond the input's edge. As `Levelled::refine` does, the last
/// samples at the edge read inputs that none of the window's samples depend on.
fn padded<'a>(input: &'a Grid, grown: &Window) -> Cow<'a, [f32]> {
    if input.window() == grown {
        return input.data().into();
    }
    let mut part = Grid::filled(*grown, f32::NAN);
    part.paste(input);
    part.into_data().into()
}

/// A level that a job makes.
pub(crate) struct Made {
    /// The index of its first sample.
    pub first: usize,
    /// All samples of its planes, and those that are right.
    pub grown: Window,
    window: Window,
}

/// A level with its texts.
pub(crate) struct Level<'a> {
    passes: &'a LevelPasses,
    /// The text of each function.
    texts: HashMap<&'static str, String>,
    /// The inputs that are planes.
    inputs: Vec<&'a Grid>,
    /// Number of planes of the level above.
    planes_above: usize,
    /// Number of planes beside those of the level that its layers need.
    layer_scratch: usize,
    window: Window,
}

/// The windows of a tile.
struct Extents {
    /// The samples of the level above.
    above: Window,
    /// All samples of the level in their cells.
    grown: Window,
}

/// The function that takes planes of the level above.
const TAKE_OVER: &str = "take_over";

impl<'a> Level<'a> {
    pub(crate) fn new(step: &'a LevelStep, planes_above: usize) -> Result<Level<'a>, Failure> {
        let missing = || Failure::Input("an input of a level or the level above is missing".to_string());
        let passes = &step.passes;
        let inputs = passes.inputs.iter().map(|&input| step.inputs.get(input)?.as_ref());
        let inputs = inputs.collect::<Option<Vec<_>>>().filter(|_| planes_above > 0).ok_or_else(missing)?;
        let mut texts = HashMap::from([(TAKE_OVER, text(PRELUDE, "", TAKE_OVER))]);
        for pass in &passes.passes {
            let function = pass.pass.function;
            texts.entry(function).or_insert_with(|| text(PRELUDE, pass.code, function));
        }
        Ok(Level { passes, texts, inputs, planes_above, layer_scratch: 0, window: step.window })
    }

    /// The same level, whose layers need this number of planes.
    pub(crate) fn with_layer_scratch(self, layer_scratch: usize) -> Level<'a> {
        Level { layer_scratch, ..self }
    }

    /// The same over another window.
    pub(crate) fn over(&self, window: Window) -> Level<'a> {
        Level { window, texts: self.texts.clone(), inputs: self.inputs.clone(), ..*self }
    }

    /// Number of planes of the level, and of the level above.
    fn planes(&self) -> [usize; 2] {
        let passes = self.passes;
        let beside = (passes.scratch + self.inputs.len()).max(self.layer_scratch);
        [passes.planes + beside, self.planes_above + passes.scratch_above]
    }

    /// What a tile is made from.
    fn extents(&self, tile: &Window) -> Extents {
        let [ahead_above, ahead] = self.passes.ahead;
        // Half the first node, rounded down, to half the last, rounded up.
        let halved = |first: i64, end: i64| (first.div_euclid(2), end.div_euclid(2) + 1);
        let ((left, right), (top, bottom)) =
            (halved(tile.x + ahead, tile.right() + ahead), halved(tile.y + ahead, tile.bottom() + ahead));
        let (width, height) = ((right - left) as usize, (bottom - top) as usize);
        let nodes = Window { x: left, y: top, width, height, cell: 2.0 * tile.cell }.grown(self.passes.reach);
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
    pub(crate) fn bytes(&self, tile: &Window) -> u64 {
        let Extents { above, grown } = self.extents(tile);
        let [planes, planes_above] = self.planes().map(|planes| planes as u64);
        let words = planes.saturating_mul(grown.len() as u64);
        words.saturating_add(planes_above.saturating_mul(above.len() as u64)).saturating_mul(4)
    }

    /// The planes over the window, tile by tile.
    fn in_tiles(
        &self,
        gpu: &Gpu,
        above: &[Grid],
        is_cancelled: &impl Fn() -> bool,
    ) -> Result<Option<Vec<Grid>>, Failure> {
        let limit = gpu.buffer_limit();
        let Some(tiles) = fitting(&self.window, |tile| self.bytes(tile) <= limit) else {
            let needed = self.bytes(&Window { width: 1, height: 1, ..self.window }) >> 20;
            return Err(Failure::Memory(format!(
                "a sample of a level takes {needed} MiB in one buffer, and buffers have at most {} MiB",
                limit >> 20
            )));
        };
        let mut out: Vec<Grid> = (0..self.passes.planes).map(|_| Grid::filled(self.window, 0.0f32)).collect();
        for window in tiles {
            let Some(made) = together(gpu, &[self.over(window)], above, is_cancelled)? else { return Ok(None) };
            out.iter_mut().zip(&made).for_each(|(plane, made)| plane.paste(made));
        }
        Ok(Some(out))
    }

    /// Adds the runs of all passes to a job, with planes from `first` on. The level above is uploaded, or was made
    /// `before`.
    fn dispatch<'b>(
        &'b self,
        job: &mut Job<'b>,
        first: usize,
        extents: &Extents,
        before: Option<&Made>,
    ) -> Result<(), Failure> {
        let Extents { above, grown } = extents;
        let source = match before {
            None => [0; 5],
            Some(made) if made.window.contains(above) => {
                let (left, top) = (above.x - made.grown.x, above.y - made.grown.y);
                [made.first, made.grown.width, made.grown.height, left as usize, top as usize]
            }
            Some(_) => return Err(Failure::Input("a level does not cover what the next one reads".to_string())),
        };
        let [planes, _] = self.planes();
        let nodes = [grown.x, grown.y].map(|x| x + self.passes.ahead[1]);
        job.data.push(planes as u32);
        job.data.extend(nodes.into_iter().flat_map(|x| [x as u32, (x >> 32) as u32]));
        job.data.extend(source.map(|word| word as u32));
        let own = job.data.len();
        job.data.extend_from_slice(&self.passes.words);
        // Passes of the same part share their words.
        let mut bases = HashMap::new();
        let mut add = |function: &str, step: u32, over: &Window, [left, top]: [usize; 2], reads: usize| {
            let Some(text) = self.texts.get(function) else { return };
            let (width, height) = (over.width.saturating_sub(2 * left), over.height.saturating_sub(2 * top));
            for (row, rows) in bands(height, width * reads) {
                let start = [left, top + row];
                let base = *bases.entry(start).or_insert(job.data.len());
                if base == job.data.len() {
                    job.data.extend([start[0], start[1], own].map(|word| word as u32));
                }
                let size = [width, rows].map(|side| side as u32);
                let planes = [grown.width, grown.height, first].map(|word| word as u32);
                job.dispatches.push(Dispatch { text, base: base as u32, size, step, planes });
            }
        };
        if before.is_some() {
            (0..self.planes_above).for_each(|plane| add(TAKE_OVER, plane as u32, above, [0; 2], 1));
        }
        for pass in &self.passes.passes {
            let over = if pass.is_above { above } else { grown };
            add(pass.pass.function, pass.pass.step, over, pass.pass.inset, pass.pass.reads);
        }
        Ok(())
    }
}
