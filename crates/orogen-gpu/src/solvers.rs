//! Solvers of the engine, by their passes.

use crate::failure::Failure;
use crate::filters::{Planes, Preludes};
use crate::gpu::Gpu;
use crate::layers::Layers;
use crate::source::Source;
use orogen_engine::lower::Passes;
use orogen_grid::grid::{Grid, Window};

/// What the passes of all solvers have in common.
const PRELUDES: Preludes = Preludes {
    own: concat!(include_str!("solvers.wgsl"), include_str!("own_words.wgsl")),
    shared: concat!(include_str!("solvers.wgsl"), include_str!("shared_words.wgsl")),
};

/// Computes the layers of a solution over `window` from the solver's inputs, which cover it. `Ok(None)` if the work was
/// cancelled; `is_cancelled` is asked between parts of it. The result is the same in each run on a device.
///
/// # Errors
/// If the planes exceed the [largest buffer](Gpu::buffer_limit); if the device was lost, has too little memory, or
/// refuses a shader; if an input does not cover the window.
pub fn solve(
    gpu: &Gpu,
    passes: &Passes,
    inputs: &[Option<&Grid>],
    window: &Window,
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Grid>>, Failure> {
    let wanted = vec![true; passes.layers];
    if window.is_empty() {
        return Ok(Some(wanted.iter().map(|_| Grid::filled(*window, 0.0)).collect()));
    }
    let planes = Planes::new(&PRELUDES, passes, inputs.len(), &wanted);
    let (needed, limit) = (planes.bytes(window, 0), gpu.buffer_limit());
    if needed > limit {
        return Err(Failure::Memory(format!(
            "the planes of the domain take {} MiB in one buffer, and buffers have at most {} MiB",
            needed >> 20,
            limit >> 20
        )));
    }
    let sources: Vec<Option<Source>> = inputs.iter().map(|input| input.map(Source::Memory)).collect();
    let mut layers = Layers::in_memory(window, passes.layers);
    let is_done = planes.make(gpu, &sources, (window, 0), &mut layers, &is_cancelled)?;
    Ok(is_done.then(|| layers.into_memory()).flatten())
}
