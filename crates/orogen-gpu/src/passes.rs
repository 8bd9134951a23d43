//! Passes of the engine: filters, solvers, levels, and the layers of levels.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Dispatch, GROUP, Job};
use crate::layers::Layers;
use crate::source::Source;
use crate::tiles::{fitting, index, offset};
use orogen_engine::device::{PassRun, PassStep, PlanGrid};
use orogen_engine::lower::{Extent, Over, Pass, Passes};
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;
use std::fmt::Write;

/// The common functions of all passes; of passes whose calls write only their own words; and of passes whose calls
/// share words.
const PLANES: &str = include_str!("planes.wgsl");
const OWN_WORDS: &str = include_str!("own_words.wgsl");
const SHARED_WORDS: &str = include_str!("shared_words.wgsl");

/// The pass that copies a plane of the level above from the planes in which that level was made.
const TAKE_OVER: Pass =
    Pass { code: "", function: "take_over", step: 0, over: Over::Above([0; 2]), reads: 1, is_shared: false };

/// Runs passes one after the other, each from the layers of the previous one, and returns the wanted layers of the
/// last. With [`stays`](PassRun::stays) they are on the card if they fit into its buffers, otherwise in memory. Returns
/// `Ok(None)` if the work was cancelled; `is_cancelled` is called between parts of it. The result is the same in each
/// run on a device.
///
/// Passes whose planes together fit into the [largest buffer](Gpu::buffer_limit) stay on the card. Other passes are
/// computed in tiles, each from the parts of its inputs that it needs.
///
/// # Errors
/// If the device was lost, has too little memory for a single sample and its inputs, or rejects a shader; if an input
/// or a level covers too little.
pub fn run(gpu: &Gpu, run: &PassRun, is_cancelled: impl Fn() -> bool) -> Result<Option<Vec<PlanGrid>>, Failure> {
    let Some(last) = run.steps.last() else { return Ok(Some(Vec::new())) };
    if last.window.is_empty() {
        return Ok(Some(Layers::in_memory(&last.window, last.passes.layers.len()).into_grids()));
    }
    let stages = Stage::all(gpu, run)?;
    let (mut left, mut made) = (stages.as_slice(), None::<Vec<Grid>>);
    loop {
        let above = made.as_deref().unwrap_or(run.above);
        let mut sums = left.iter().scan(0u64, |sum, stage| {
            *sum = sum.saturating_add(stage.bytes(&stage.window));
            Some(*sum)
        });
        let fit = sums.by_ref().take_while(|sum| *sum <= gpu.buffer_limit()).count().max(1);
        let (now, rest) = left.split_at(fit);
        let Some(stage) = now.last() else { return Ok(Some(Vec::new())) };
        let tiles = stage.tiles(gpu, now.len() == 1)?;
        let mut layers = match run.stays && rest.is_empty() {
            true => Layers::new(gpu, &stage.window, stage.layers.len())?,
            false => Layers::in_memory(&stage.window, stage.layers.len()),
        };
        for tile in tiles {
            let (job, made) = job(now, &tile, above)?;
            let first = |plane: &usize| made.first + plane * made.planes.len() + index(&made.planes, &tile);
            let firsts: Vec<usize> = stage.layers.iter().map(first).collect();
            if !layers.run(gpu, job, &tile, (&firsts, made.planes.width), &is_cancelled)? {
                return Ok(None);
            }
        }
        if rest.is_empty() {
            return Ok(Some(layers.into_grids()));
        }
        (left, made) = (rest, layers.into_memory());
    }
}

/// The job that makes stages one from the other, the last of them over a tile, and the position of that tile's planes.
fn job<'a>(stages: &'a [Stage], tile: &Window, above: &'a [Grid]) -> Result<(Job<'a>, Made), Failure> {
    let mut job = Job::default();
    let mut before = Made::NONE;
    for (k, stage) in stages.iter().enumerate() {
        let window = if k + 1 == stages.len() { tile } else { &stage.window };
        let above = if k == 0 { above } else { &[] };
        before = stage.add_to(&mut job, window, above, (k > 0).then_some(&before))?;
    }
    Ok((job, before))
}

/// Passes with their own planes, and the passes that continue with these planes.
struct Stage<'a> {
    steps: Vec<(&'a Passes, Texts)>,
    extent: Extent,
    /// The inputs that have planes.
    inputs: Vec<(usize, Source<'a>)>,
    /// Number of planes, of planes of the level above, and of scratch planes at its cell.
    planes: usize,
    layers_above: usize,
    scratch_above: usize,
    /// The planes and the window of the result.
    layers: &'a [usize],
    window: Window,
}

/// The planes of a stage that a job makes.
struct Made {
    /// The index of the first sample.
    first: usize,
    /// The windows of the planes, of the planes of the level above, and of the samples of the planes that are valid at
    /// the end.
    planes: Window,
    above: Window,
    window: Window,
}

impl Made {
    /// No planes.
    const NONE: Made = Made { first: 0, planes: NOWHERE, above: NOWHERE, window: NOWHERE };
}

/// A window without samples.
const NOWHERE: Window = Window { x: 0, y: 0, width: 0, height: 0, cell: 1.0 };

impl<'a> Stage<'a> {
    /// The stages of a run.
    fn all(gpu: &Gpu, run: &'a PassRun) -> Result<Vec<Stage<'a>>, Failure> {
        let mut stages: Vec<Stage> = Vec::new();
        for step in run.steps {
            match (step.passes.extent, stages.last_mut()) {
                (Extent::Before(_), Some(stage)) => {
                    stage.planes = stage.planes.max(step.passes.planes);
                    stage.steps.push((&step.passes, texts(&step.passes)));
                    (stage.layers, stage.window) = (&step.passes.layers, step.window);
                }
                (_, before) => {
                    let layers_above = before.map_or(run.above.len(), |stage| stage.layers.len());
                    stages.push(Stage::new(gpu, step, layers_above)?);
                }
            }
        }
        Ok(stages)
    }

    fn new(gpu: &Gpu, step: &'a PassStep, layers_above: usize) -> Result<Stage<'a>, Failure> {
        let missing = || Failure::Input("an input of a level or the level above is missing".to_string());
        let PassStep { passes, window, .. } = step;
        let (layers_above, scratch_above) = match passes.extent {
            Extent::Above { scratch, .. } if layers_above > 0 => (layers_above, scratch),
            Extent::Above { .. } | Extent::Before(_) => return Err(missing()),
            Extent::Halo(_) | Extent::Domain => (0, 0),
        };
        let mut inputs = Vec::new();
        for (k, plane) in passes.inputs.iter().enumerate() {
            match (plane, step.inputs.get(k).and_then(Option::as_ref)) {
                (Some(plane), Some(grid)) => inputs.push((*plane, Source::of(gpu, grid)?)),
                (Some(_), None) if layers_above > 0 => return Err(missing()),
                _ => {}
            }
        }
        Ok(Stage {
            steps: vec![(passes, texts(passes))],
            extent: passes.extent,
            inputs,
            planes: passes.planes,
            layers_above,
            scratch_above,
            layers: &passes.layers,
            window: *window,
        })
    }

    /// The windows of the planes for a tile of the result.
    fn made(&self, tile: &Window) -> Made {
        let halo = |passes: &Passes| if let Extent::Before(halo) = passes.extent { halo } else { 0 };
        let window = tile.grown(self.steps.iter().map(|(passes, _)| halo(passes)).sum());
        let Extent::Above { ahead: [ahead_above, ahead], reach, .. } = self.extent else {
            let halo = if let Extent::Halo(halo) = self.extent { halo } else { 0 };
            return Made { planes: window.grown(halo), window, ..Made::NONE };
        };
        // From half the first node, rounded down, to half the last node, rounded up.
        let halved = |first: i64, end: i64| (first.div_euclid(2), end.div_euclid(2) + 1);
        let ((left, right), (top, bottom)) =
            (halved(window.x + ahead, window.right() + ahead), halved(window.y + ahead, window.bottom() + ahead));
        let (width, height) = ((right - left) as usize, (bottom - top) as usize);
        let nodes = Window { x: left, y: top, width, height, cell: 2.0 * window.cell }.grown(reach);
        let planes = Window {
            x: 2 * nodes.x - ahead,
            y: 2 * nodes.y - ahead,
            width: 2 * nodes.width,
            height: 2 * nodes.height,
            cell: window.cell,
        };
        Made { first: 0, planes, above: nodes.at(nodes.x - ahead_above, nodes.y - ahead_above), window }
    }

    /// Memory of the planes for a tile, in bytes.
    fn bytes(&self, tile: &Window) -> u64 {
        let Made { planes, above, .. } = self.made(tile);
        let words = |count: usize, window: &Window| {
            (4 * count as u64).saturating_mul(window.width as u64).saturating_mul(window.height as u64)
        };
        words(self.planes, &planes).saturating_add(words(self.layers_above + self.scratch_above, &above))
    }

    /// The tiles in which the result is made: one tile unless `is_alone`.
    fn tiles(&self, gpu: &Gpu, is_alone: bool) -> Result<Vec<Window>, Failure> {
        let limit = gpu.buffer_limit();
        let fits = |tile: &Window| !is_alone || self.bytes(tile) <= limit;
        let (what, least) = match self.extent {
            Extent::Domain => ("the domain takes", self.window),
            _ => ("a sample and what it is made from take", Window { width: 1, height: 1, ..self.window }),
        };
        let tiles = if fits(&least) { fitting(&self.window, fits) } else { None };
        tiles.ok_or_else(|| {
            let (needed, limit) = (self.bytes(&least) >> 20, limit >> 20);
            Failure::Memory(format!("{what} {needed} MiB in one buffer, and buffers have at most {limit} MiB"))
        })
    }

    /// Adds the passes of a tile to a job, from the level `above`, or from the planes made `before` in the same job.
    fn add_to<'b>(
        &'b self,
        job: &mut Job<'b>,
        tile: &Window,
        above: &'b [Grid],
        before: Option<&Made>,
    ) -> Result<Made, Failure> {
        let made = Made { first: job.samples, ..self.made(tile) };
        let (planes, cells) = (&made.planes, made.planes.len());
        let first_above = made.first + self.planes * cells;
        job.samples = first_above + (self.layers_above + self.scratch_above) * made.above.len();
        let is_level = self.layers_above > 0;
        if is_level {
            for (k, grid) in above.iter().enumerate() {
                Source::Memory(grid).add_to(job, &made.above, first_above + k * made.above.len())?;
            }
            if before.is_some_and(|before| !before.window.contains(&made.above)) {
                return Err(Failure::Input("a level does not cover what the next one reads".to_string()));
            }
        }
        for (plane, source) in &self.inputs {
            let at = made.first + plane * cells;
            match *source {
                // The outermost samples of a level read inputs on which no sample of the window depends.
                Source::Memory(grid) if is_level && grid.window() != planes => {
                    let mut part = Grid::filled(*planes, f32::NAN);
                    part.paste(grid);
                    job.uploads.push((at, part.into_data().into()));
                }
                source => source.add_to(job, planes, at)?,
            }
        }
        for (k, (passes, texts)) in self.steps.iter().enumerate() {
            let header = header(self.planes, self.ahead(), &made, tile, before);
            job.data.extend(header.map(|(_, word)| word));
            let own = job.data.len();
            job.data.extend_from_slice(&passes.words);
            let take_over = |plane: usize| Pass { step: plane as u32, ..TAKE_OVER };
            let taken = if k == 0 && before.is_some() { self.layers_above } else { 0 };
            let passes = (0..taken).map(take_over).chain(passes.passes.iter().copied());
            dispatch(job, passes, texts, (&made, tile, own));
        }
        Ok(made)
    }

    /// Number of samples by which the lattice of the planes is ahead of the lattice of windows.
    fn ahead(&self) -> i64 {
        if let Extent::Above { ahead: [_, ahead], .. } = self.extent { ahead } else { 0 }
    }
}

/// Adds the runs of passes over a tile to a job, whose words begin at `own`.
fn dispatch<'a>(
    job: &mut Job<'a>,
    passes: impl Iterator<Item = Pass>,
    texts: &'a Texts,
    (made, tile, own): (&Made, &Window, usize),
) {
    let planes = &made.planes;
    // Passes of the same part share their words.
    let mut bases = HashMap::new();
    for pass in passes {
        let Some(text) = texts.get(pass.function) else { continue };
        let (left, top, width, height) = match pass.over {
            Over::Planes(inset) => part(planes, inset),
            Over::Above(inset) => part(&made.above, inset),
            Over::Window(around) => {
                let (over, around) = (tile.grown(around), offset(planes, &tile.grown(around)));
                (around.0, around.1, over.width, over.height)
            }
        };
        for (row, rows) in bands(height, width * pass.reads) {
            let start = [left, top + row];
            let base = *bases.entry(start).or_insert(job.data.len());
            if base == job.data.len() {
                job.data.extend([start[0], start[1], own].map(|word| word as u32));
            }
            let planes = [planes.width, planes.height, made.first].map(|word| word as u32);
            let size = [width, rows].map(|side| side as u32);
            job.dispatches.push(Dispatch { text, base: base as u32, size, step: pass.step, planes });
        }
    }
}

/// The words before the words of passes, with the names by which shaders read them: the number of planes; the position
/// of the first sample on the lattice, which is `ahead` samples ahead of the lattice of windows; the planes of the
/// level above, if they were made in the same job; and the window.
fn header(
    planes: usize,
    ahead: i64,
    made: &Made,
    tile: &Window,
    before: Option<&Made>,
) -> [(&'static str, u32); HEADER] {
    let [x, y] = [made.planes.x, made.planes.y].map(|start| start + ahead);
    let source = before.map_or([0; 5], |before| {
        let (left, top) = offset(&before.planes, &made.above);
        [before.first, before.planes.width, before.planes.height, left, top]
    });
    let (left, top) = offset(&made.planes, tile);
    [
        ("plane_count", planes as u32),
        ("column_low", x as u32),
        ("column_high", (x >> 32) as u32),
        ("row_low", y as u32),
        ("row_high", (y >> 32) as u32),
        ("made_first", source[0] as u32),
        ("made_columns", source[1] as u32),
        ("made_rows", source[2] as u32),
        ("made_left", source[3] as u32),
        ("made_top", source[4] as u32),
        ("window_left", left as u32),
        ("window_top", top as u32),
        ("window_columns", tile.width as u32),
        ("window_rows", tile.height as u32),
    ]
}

/// Number of words before the words of passes.
const HEADER: usize = 14;

/// The part of a window without some columns and rows at each side: its first column and row, and its numbers of
/// columns and rows.
fn part(window: &Window, [left, top]: [usize; 2]) -> (usize, usize, usize, usize) {
    (left, top, window.width.saturating_sub(2 * left), window.height.saturating_sub(2 * top))
}

/// Maximum number of samples that one dispatch reads, which takes a fraction of a second on slow cards.
const READS: usize = 1 << 30;

/// Bands of rows, each with its first row and number of rows, that read at most [`READS`] samples each if a row reads
/// `reads` samples. A band has at least the rows of one workgroup.
fn bands(height: usize, reads: usize) -> impl Iterator<Item = (usize, usize)> {
    let group = GROUP as usize;
    let rows = (READS / reads.max(1) / group).max(1) * group;
    (0..height).step_by(rows).map(move |first| (first, rows.min(height - first)))
}

/// The shader of each function.
type Texts = HashMap<&'static str, String>;

/// The shaders of passes. They depend only on the op and the functions.
fn texts(passes: &Passes) -> Texts {
    let mut texts = HashMap::new();
    let taken = matches!(passes.extent, Extent::Above { .. }).then_some(&TAKE_OVER);
    for pass in taken.into_iter().chain(&passes.passes) {
        texts.entry(pass.function).or_insert_with(|| text(&passes.head, pass));
    }
    texts
}

fn text(head: &str, pass: &Pass) -> String {
    let mut text = [PLANES, if pass.is_shared { SHARED_WORDS } else { OWN_WORDS }, head, pass.code].concat();
    for (k, (name, _)) in header(0, 0, &Made::NONE, &NOWHERE, None).into_iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "fn {name}() -> u32 {{ return data[data[frame.base + 2u] - {}u]; }}", HEADER - k);
    }
    let function = pass.function;
    text + &format!(
        "@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
        \x20   if (id.x >= frame.width || id.y >= frame.height) {{ return; }}\n\
        \x20   let at = id.xy + vec2<u32>(data[frame.base], data[frame.base + 1u]);\n\
        \x20   {function}(data[frame.base + 2u], vec2<i32>(at));\n\
        }}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_cover_everything_once() {
        for (height, reads) in [(1, 1), (100, READS), (100, READS / 30), (64, READS / 64), (5, usize::MAX)] {
            let bands: Vec<_> = bands(height, reads).collect();
            assert_eq!(bands.iter().map(|(_, rows)| rows).sum::<usize>(), height);
            assert!(bands.windows(2).all(|pair| pair[0].0 + pair[0].1 == pair[1].0), "{bands:?}");
            assert!(bands.iter().all(|(_, rows)| *rows <= 8 || rows * reads <= READS), "{bands:?}");
        }
    }
}
