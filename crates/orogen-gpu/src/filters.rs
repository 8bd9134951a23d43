//! Filters of the engine, by their passes.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Dispatch, GROUP, Job};
use crate::tiles::fitting;
use orogen_engine::lower::Passes;
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;

/// What the passes of all filters have in common.
const PRELUDES: Preludes = Preludes { own: PRELUDE, shared: PRELUDE };

const PRELUDE: &str = include_str!("filters.wgsl");

/// What passes have in common, by whether their calls write to samples of others.
pub(crate) struct Preludes {
    /// The text of passes whose calls write to their own samples alone.
    pub(crate) own: &'static str,
    /// The text of those that share samples.
    pub(crate) shared: &'static str,
}

/// Words before those of the filter, for each pass: see the prelude.
const WORDS: usize = 6;

/// Computes layers of a filter over `window`, as `Filter::apply` does: each given input covers the window grown by `halo`. The result has an element for each
/// of `wanted`, one per declared layer: a grid if it is true. `Ok(None)` if the work was cancelled; `is_cancelled` is asked between parts of it.
///
/// If the planes exceed the [largest buffer](Gpu::buffer_limit), the window is computed in tiles, each with its halo.
///
/// # Errors
/// If the device was lost, has too little memory for a single sample with its halo, or refuses a shader; if an input does not cover the window and its halo.
pub fn apply(
    gpu: &Gpu,
    passes: &Passes,
    inputs: &[Option<&Grid>],
    window: &Window,
    halo: usize,
    wanted: &[bool],
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Option<Grid>>>, Failure> {
    let layers = || wanted.iter().map(|wanted| wanted.then(|| Grid::filled(*window, 0.0f32)));
    let mut out: Vec<Option<Grid>> = layers().collect();
    if window.is_empty() || !wanted.contains(&true) {
        return Ok(Some(out));
    }
    let filter = Planes::new(&PRELUDES, passes, inputs.len(), wanted);
    let limit = gpu.buffer_limit();
    let Some(tiles) = fitting(window, |tile| filter.bytes(tile, halo) <= limit) else {
        let needed = filter.bytes(&Window { width: 1, height: 1, ..*window }, halo) >> 20;
        return Err(Failure::Memory(format!(
            "a sample with its halo of {halo} samples takes {needed} MiB in one buffer, and buffers have at most {} MiB",
            limit >> 20
        )));
    };
    for tile in tiles {
        let Some(made) = filter.tile_of(gpu, inputs, &tile, halo, &is_cancelled)? else { return Ok(None) };
        let mut made = made.into_iter();
        for layer in out.iter_mut().flatten() {
            match made.next() {
                Some(made) if tile == *window => *layer = made,
                Some(made) => layer.paste(&made),
                None => {}
            }
        }
    }
    Ok(Some(out))
}

/// The planes of a filter or solver, with the texts of its passes.
pub(crate) struct Planes<'a> {
    passes: &'a Passes,
    /// The text of each function.
    texts: HashMap<&'static str, String>,
    /// Number of inputs.
    inputs: usize,
    wanted: &'a [bool],
}

impl<'a> Planes<'a> {
    /// Planes of passes that have these texts in common.
    pub(crate) fn new(preludes: &Preludes, passes: &'a Passes, inputs: usize, wanted: &'a [bool]) -> Planes<'a> {
        let mut texts = HashMap::new();
        for pass in &passes.passes {
            let prelude = if pass.is_shared { preludes.shared } else { preludes.own };
            texts.entry(pass.function).or_insert_with(|| text(prelude, passes.code, pass.function));
        }
        Planes { passes, texts, inputs, wanted }
    }

    /// Number of planes.
    fn count(&self) -> usize {
        self.inputs + self.wanted.len() + self.passes.scratch
    }

    /// Memory of the planes for a tile, in bytes.
    pub(crate) fn bytes(&self, tile: &Window, halo: usize) -> u64 {
        let side = |samples: usize| samples as u64 + 2 * halo as u64;
        (4 * self.count() as u64).saturating_mul(side(tile.width)).saturating_mul(side(tile.height))
    }

    /// The wanted layers over a tile.
    pub(crate) fn tile_of(
        &self,
        gpu: &Gpu,
        inputs: &[Option<&Grid>],
        tile: &Window,
        halo: usize,
        is_cancelled: &impl Fn() -> bool,
    ) -> Result<Option<Vec<Grid>>, Failure> {
        let grown = tile.grown(halo);
        let cropped = inputs.iter().map(|input| cropped(*input, &grown)).collect::<Result<Vec<_>, _>>()?;
        let uploads = inputs.iter().zip(&cropped).enumerate().filter_map(|(k, (input, cropped))| {
            let grid = cropped.as_ref().or(*input)?;
            Some((k * grown.len(), grid.data()))
        });
        let mut job = Job {
            data: self.passes.words.clone(),
            samples: self.count() * grown.len(),
            uploads: uploads.collect(),
            ..Job::default()
        };
        // Passes of the same part share their words.
        let mut bases = HashMap::new();
        for pass in &self.passes.passes {
            let Some(text) = self.texts.get(pass.function) else { continue };
            let [left, top] = pass.inset.map(|inset| inset.min(halo));
            let (width, height) = (grown.width - 2 * left, grown.height - 2 * top);
            for (first, rows) in bands(height, width * pass.reads) {
                let start = [left, top + first];
                let base = *bases.entry(start).or_insert(job.data.len());
                if base == job.data.len() {
                    let words: [usize; WORDS] = [grown.width, grown.height, start[0], start[1], 0, 0];
                    job.data.extend(words.map(|word| word as u32));
                }
                let size = [width, rows].map(|side| side as u32);
                job.dispatches.push(Dispatch { text, base: base as u32, size, step: pass.step });
            }
        }
        // Whole rows are copied back: those of the tile.
        let rows = tile.height * grown.width;
        let layers = self.wanted.iter().enumerate().filter(|(_, wanted)| **wanted);
        job.downloads = layers.map(|(k, _)| ((self.inputs + k) * grown.len() + halo * grown.width, rows)).collect();
        let Some(back) = job.run(gpu, is_cancelled)? else { return Ok(None) };
        Ok(Some(back.into_iter().map(|rows| inner(&rows, tile, grown.width, halo)).collect()))
    }
}

/// Number of samples that one dispatch reads at most: a fraction of a second on slow cards.
const READS: usize = 1 << 30;

/// Bands of rows, of each the first row and the number of rows, of which none reads too much if a row reads `reads` samples. At least one workgroup is high.
pub(crate) fn bands(height: usize, reads: usize) -> impl Iterator<Item = (usize, usize)> {
    let group = GROUP as usize;
    let rows = (READS / reads.max(1) / group).max(1) * group;
    (0..height).step_by(rows).map(move |first| (first, rows.min(height - first)))
}

/// The part of an input that a tile needs; `None` if that is all of it, or if it is not given.
pub(crate) fn cropped(input: Option<&Grid>, grown: &Window) -> Result<Option<Grid>, Failure> {
    match input {
        None => Ok(None),
        Some(grid) if grid.window() == grown => Ok(None),
        Some(grid) => match grid.crop(grown) {
            Some(grid) => Ok(Some(grid)),
            None => Err(Failure::Input("an input does not cover the window and its halo".to_string())),
        },
    }
}

/// A tile from whole rows of its planes, of which each has `left` samples before it.
pub(crate) fn inner(rows: &[f32], tile: &Window, width: usize, left: usize) -> Grid {
    let mut grid = Grid::filled(*tile, 0.0f32);
    for (out, row) in grid.data_mut().chunks_mut(tile.width).zip(rows.chunks(width)) {
        out.copy_from_slice(&row[left..left + tile.width]);
    }
    grid
}

/// The text of a pass. It depends on the op and the function alone.
pub(crate) fn text(prelude: &str, code: &str, function: &str) -> String {
    format!(
        "{prelude}\n{code}\n\
        @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
        \x20   if (id.x >= frame.width || id.y >= frame.height) {{ return; }}\n\
        \x20   let at = id.xy + vec2<u32>(data[frame.base + 2u], data[frame.base + 3u]);\n\
        \x20   {function}(data[frame.base + 4u], vec2<i32>(at));\n\
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
