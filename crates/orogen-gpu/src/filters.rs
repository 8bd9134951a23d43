//! Filters of the engine, by their passes.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Dispatch, GROUP, Job};
use crate::layers::Layers;
use crate::source::Source;
use crate::tiles::{fitting, index};
use orogen_engine::device::{FilterExtent, PlanGrid};
use orogen_engine::lower::Passes;
use orogen_grid::grid::Window;
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

/// Computes layers of a filter over `window`, as `Filter::apply` does: each given input covers at least the window
/// grown by `halo`. The result has an element for each of `wanted`, one per declared layer: a grid if it is true.
/// `Ok(None)` if the work was cancelled; `is_cancelled` is asked between parts of it.
///
/// If the planes exceed the [largest buffer](Gpu::buffer_limit), the window is computed in tiles, each with its halo.
/// The layers stay on the device, if they fit into its buffers.
///
/// # Errors
/// If the device was lost, has too little memory for a single sample with its halo, or refuses a shader; if an input
/// does not cover the window and its halo.
pub fn apply(
    gpu: &Gpu,
    passes: &Passes,
    inputs: &[Option<&PlanGrid>],
    extent: &FilterExtent,
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Option<PlanGrid>>>, Failure> {
    let FilterExtent { window, halo, ref wanted } = *extent;
    let count = wanted.iter().filter(|wanted| **wanted).count();
    let layers = match window.is_empty() || count == 0 {
        true => Layers::in_memory(&window, count),
        false => {
            let sources = inputs.iter().map(|input| input.map(|grid| Source::of(gpu, grid)).transpose());
            let sources = sources.collect::<Result<Vec<_>, _>>()?;
            let filter = Planes::new(&PRELUDES, passes, inputs.len(), wanted);
            let limit = gpu.buffer_limit();
            let Some(tiles) = fitting(&window, |tile| filter.bytes(tile, halo) <= limit) else {
                let needed = filter.bytes(&Window { width: 1, height: 1, ..window }, halo) >> 20;
                return Err(Failure::Memory(format!(
                    "a sample with its halo of {halo} samples takes {needed} MiB in one buffer, and buffers have at most {} MiB",
                    limit >> 20
                )));
            };
            let mut layers = Layers::new(gpu, &window, count)?;
            for tile in tiles {
                if !filter.make(gpu, &sources, (&tile, halo), &mut layers, &is_cancelled)? {
                    return Ok(None);
                }
            }
            layers
        }
    };
    let mut made = layers.into_grids().into_iter();
    Ok(Some(wanted.iter().map(|wanted| if *wanted { made.next() } else { None }).collect()))
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

    /// Makes the wanted layers over a tile from inputs that cover it, grown by the halo. Returns whether that was done,
    /// not cancelled.
    pub(crate) fn make(
        &self,
        gpu: &Gpu,
        inputs: &[Option<Source>],
        (tile, halo): (&Window, usize),
        layers: &mut Layers,
        is_cancelled: &impl Fn() -> bool,
    ) -> Result<bool, Failure> {
        let grown = tile.grown(halo);
        let mut job = Job { data: self.passes.words.clone(), samples: self.count() * grown.len(), ..Job::default() };
        for (k, input) in inputs.iter().enumerate() {
            input.map_or(Ok(()), |source| source.add_to(&mut job, &grown, k * grown.len()))?;
        }
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
                    job.data.extend([start[0], start[1], 0].map(|word| word as u32));
                }
                let size = [width, rows].map(|side| side as u32);
                let planes = [grown.width as u32, grown.height as u32, 0];
                job.dispatches.push(Dispatch { text, base: base as u32, size, step: pass.step, planes });
            }
        }
        let planes = self.wanted.iter().enumerate().filter(|(_, wanted)| **wanted);
        let first = |k: usize| (self.inputs + k) * grown.len() + index(&grown, tile);
        let firsts: Vec<usize> = planes.map(|(k, _)| first(k)).collect();
        layers.run(gpu, job, tile, (&firsts, grown.width), is_cancelled)
    }
}

/// Number of samples that one dispatch reads at most: a fraction of a second on slow cards.
const READS: usize = 1 << 30;

/// Bands of rows, of each the first row and the number of rows, of which none reads too much if a row reads `reads`
/// samples. At least one workgroup is high.
pub(crate) fn bands(height: usize, reads: usize) -> impl Iterator<Item = (usize, usize)> {
    let group = GROUP as usize;
    let rows = (READS / reads.max(1) / group).max(1) * group;
    (0..height).step_by(rows).map(move |first| (first, rows.min(height - first)))
}

/// The text of a pass. It depends on the op and the function alone.
pub(crate) fn text(prelude: &str, code: &str, function: &str) -> String {
    format!(
        "{prelude}\n{code}\n\
        @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
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
