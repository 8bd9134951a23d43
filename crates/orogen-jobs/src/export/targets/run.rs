//! The steps of an export for an engine.

use super::frame::Frame;
use super::job::{EngineJob, Exported};
use super::objects;
use crate::export::channels::{NORMAL, WEIGHTS};
use crate::export::derived::layer::Nature;
use crate::export::files::Files;
use crate::export::layer_source::LayerSource;
use crate::export::quantizer::{self, BITS, RANGE};
use crate::export::{features, run};
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::file::{self, Output};

impl EngineJob {
    /// Exports all tiles, or none. Heights use the engine's format and scale, weights and normals its conventions;
    /// other layers are 8-bit grayscale pictures.
    ///
    /// # Errors
    /// The errors of [`Frame::new`]; if the engine does not support the format; or those of
    /// [`ExportJob::to_file`](crate::export::job::ExportJob::to_file).
    pub fn run(&self, world: &World, output: &Output, progress: &Progress) -> Result<Exported> {
        self.check()?;
        let frame = Frame::new(self.target, world, &self.samples)?;
        match features::list::listed(&self.layer) {
            Some(_) if world.unit(&self.layer).is_err() => objects::export(self, frame, world, output, progress),
            _ => export(self, frame, world, output, progress),
        }
    }
}

/// Exports the layer of a job over a frame, all tiles or none.
///
/// # Errors
/// If the target does not support the format, or the errors of [`run::to_file`].
fn export(job: &EngineJob, frame: Frame, world: &World, output: &Output, progress: &Progress) -> Result<Exported> {
    let EngineJob { target, format, ref layer, .. } = *job;
    let path = output.path();
    let mut options = job.options.clone();
    // Plain numbers are computed twice: for their range, and tile by tile.
    let nature = LayerSource::new(world, layer, frame.window, progress)?.nature();
    let [ranging, writing] = progress.parts([if nature == Nature::Numbers { 1.0 } else { 0.0 }, 1.0]);
    writing.expect((frame.tiles[0] * frame.tiles[1]) as f64);
    let source = |window: Window, progress: &Progress| LayerSource::new(world, layer, window, progress);
    let mut all = source(frame.window, &ranging)?;
    let known = if layer == HEIGHT { target.formats } else { &["png"] };
    if !known.contains(&format.name) {
        let list: Vec<String> = known.iter().map(|name| format!(".{name}")).collect();
        let message = format!("{} imports `{layer}` as {}, not as .{}", target.name, list.join(" or "), format.name);
        return Err(Error::new(ErrorKind::Request, message));
    }
    let outputs = frame.outputs(target, output)?;
    let mut import = Vec::new();
    let mut less = 0;
    match nature {
        // One scale for all tiles: the whole range is needed before the first one is written.
        Nature::Numbers => {
            // Tiles that cannot be written are rejected before the range is computed.
            all.prepare((format.memory)(&frame.tile(0, 0), &options))?;
            all.rows(|_| Ok(())).map_err(|cause| file::explain("make", path, &cause))?;
            if layer == HEIGHT {
                let levels = all.levels();
                (target.heights)(&levels, &mut options)?;
                import = (target.import)(frame.side, frame.window.cell, &levels);
            } else {
                options.give(&BITS, "8")?;
                let levels = quantizer::natural(&all, quantizer::most(&options))
                    .map_err(|cause| file::explain("write", path, &cause))?;
                if !levels.is_flat() {
                    options.give(&RANGE, &format!("{},{}", levels.low(), levels.high()))?;
                }
            }
        }
        Nature::Normal => options.give(&NORMAL, target.normal)?,
        Nature::Color => {}
        Nature::Weights => {
            options.give(&WEIGHTS, target.weights)?;
            less = target.weights_less;
        }
    }
    let (mut written, mut words, mut count) = (Vec::new(), String::new(), FiniteCount::default());
    for row in 0..frame.tiles[1] {
        for column in 0..frame.tiles[0] {
            let tile = frame.tile(column, row);
            let window = Window { width: tile.width - less, height: tile.height - less, ..tile };
            let output = &outputs[row * frame.tiles[0] + column];
            let (made, told) = run::staged(format, source(window, &writing.part(1.0))?, &options, output)?;
            (words, count) = (told.words, count.and(told.count));
            written.push(made);
        }
    }
    written.into_iter().try_for_each(Files::commit).map_err(|cause| file::explain("write", path, &cause))?;
    let files = outputs.iter().map(|output| output.path().to_path_buf()).collect();
    let samples = [frame.window.width - less, frame.window.height - less];
    Ok(Exported { frame, files, samples, words, count, import })
}
