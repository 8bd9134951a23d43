//! Layers of levelled ops, by their passes.

use crate::failure::Failure;
use crate::filters::{bands, text};
use crate::gpu::Gpu;
use crate::job::{Dispatch, Job};
use crate::layers::Layers;
use crate::levels::{self, Level, Made, PRELUDE};
use crate::tiles::{fitting, index};
use orogen_engine::device::{LayerStep, LevelStep, PlanGrid};
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;

/// Computes layers of the last of some levels as `Levelled::layers_of` does, and the levels as
/// [`refine`](levels::refine) does. `Ok(None)` if the work was cancelled; `is_cancelled` is asked between parts of it.
/// The layers stay on the card, if they fit into its buffers.
///
/// If the levels do not fit into the [largest buffer](Gpu::buffer_limit) together, the last one is computed from the
/// others in tiles with their layers.
///
/// # Errors
/// Those of [`refine`](levels::refine).
pub fn layers(
    gpu: &Gpu,
    steps: &[LevelStep],
    layers: &LayerStep,
    above: &[Grid],
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<PlanGrid>>, Failure> {
    let count = layers.passes.layers.len();
    let Some((last, others)) = steps.split_last().filter(|_| !layers.window.is_empty()) else {
        return Ok(Some(Layers::in_memory(&layers.window, count).into_grids()));
    };
    let reader = Reader::new(layers);
    let limit = gpu.buffer_limit();
    let mut planes_above = above.len();
    let mut chain = Vec::with_capacity(steps.len());
    for step in others {
        chain.push(Level::new(step, planes_above)?);
        planes_above = step.passes.planes;
    }
    chain.push(Level::new(last, planes_above)?.with_layer_scratch(layers.passes.scratch));
    let bytes = steps.iter().zip(&chain).fold(0u64, |sum, (step, level)| sum.saturating_add(level.bytes(&step.window)));
    let mut out = Layers::new(gpu, &layers.window, count)?;
    if bytes <= limit {
        let is_done = reader.read(gpu, &chain, above, &layers.window, &mut out, &is_cancelled)?;
        return Ok(is_done.then(|| out.into_grids()));
    }
    let made = match others {
        [] => None,
        others => match levels::refine(gpu, others, above, &is_cancelled)? {
            Some(made) => Some(made),
            None => return Ok(None),
        },
    };
    let above = made.as_deref().unwrap_or(above);
    let Some(level) = chain.pop() else { return Ok(None) };
    let Some(tiles) = fitting(&layers.window, |tile| level.bytes(&tile.grown(layers.halo)) <= limit) else {
        return Err(Failure::Memory(format!(
            "a sample of a level with its layers exceeds a buffer, which has at most {} MiB",
            limit >> 20
        )));
    };
    for tile in tiles {
        let level = level.over(tile.grown(layers.halo));
        if !reader.read(gpu, &[level], above, &tile, &mut out, &is_cancelled)? {
            return Ok(None);
        }
    }
    Ok(Some(out.into_grids()))
}

/// Layers with the texts of their passes.
struct Reader<'a> {
    step: &'a LayerStep,
    texts: HashMap<&'static str, String>,
}

impl<'a> Reader<'a> {
    fn new(step: &'a LayerStep) -> Reader<'a> {
        let texts = step.passes.passes.iter().map(|pass| (pass.function, text(PRELUDE, pass.code, pass.function)));
        Reader { step, texts: texts.collect() }
    }

    /// Makes the layers over a tile from levels one from the other. Returns whether that was done, not cancelled.
    fn read(
        &self,
        gpu: &Gpu,
        levels: &[Level],
        above: &[Grid],
        tile: &Window,
        out: &mut Layers,
        is_cancelled: &impl Fn() -> bool,
    ) -> Result<bool, Failure> {
        let (mut job, made) = levels::job(levels, above)?;
        let Some(Made { first, grown, .. }) = made else { return Ok(false) };
        if !grown.contains(&tile.grown(self.step.halo)) {
            return Err(Failure::Input("a level does not cover what its layers read".to_string()));
        }
        self.dispatch(&mut job, first, &grown, tile);
        let plane = |plane: &usize| first + plane * grown.len() + index(&grown, tile);
        let firsts: Vec<usize> = self.step.passes.layers.iter().map(plane).collect();
        out.run(gpu, job, tile, (&firsts, grown.width), is_cancelled)
    }

    /// Adds the runs of all passes over a tile to a job, for a level whose planes are `grown`, from sample `first` on.
    fn dispatch<'b>(&'b self, job: &mut Job<'b>, first: usize, grown: &Window, tile: &Window) {
        let offset = |part: &Window| [part.x - grown.x, part.y - grown.y].map(|offset| offset as usize);
        let own = job.data.len();
        job.data.extend_from_slice(&self.step.passes.words);
        let [left, top] = offset(tile);
        job.data.extend([left, top, tile.width, tile.height].map(|word| word as u32));
        for pass in &self.step.passes.passes {
            let Some(text) = self.texts.get(pass.function) else { continue };
            let over = tile.grown(pass.around);
            let [left, top] = offset(&over);
            for (row, rows) in bands(over.height, over.width * pass.reads) {
                let base = job.data.len() as u32;
                job.data.extend([left, top + row, own].map(|word| word as u32));
                let size = [over.width, rows].map(|side| side as u32);
                let planes = [grown.width, grown.height, first].map(|word| word as u32);
                job.dispatches.push(Dispatch { text, base, size, step: 0, planes });
            }
        }
    }
}
