//! Scattered objects for an engine: over the terrain that its heights have for the same request.

use super::frame::Frame;
use super::job::{EngineJob, Exported};
use crate::export::files::Files;
use crate::export::layer_source::LayerSource;
use crate::export::quantizer::RANGE;
use crate::export::run;
use crate::export::vectors::scatter;
use crate::options::Options;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::progress::Progress;
use orogen_io::file::{self, Output};

/// Exports the objects of a world over a frame, all tiles or none.
///
/// # Errors
/// If the engine has no form for the layer or another one, or the errors of [`run::to_file`].
pub(super) fn export(
    job: &EngineJob,
    frame: Frame,
    world: &World,
    output: &Output,
    progress: &Progress,
) -> Result<Exported> {
    let EngineJob { target, format, .. } = *job;
    let path = output.path();
    let known = target.formats_of(scatter::LAYER.name);
    if job.layer != scatter::LAYER.name || known.is_empty() {
        return refuse(format!("{} has no form of its own for `{}`; leave out --target", target.name, job.layer));
    }
    if !known.contains(&format.name) {
        let list: Vec<String> = known.iter().map(|name| format!(".{name}")).collect();
        return refuse(format!(
            "{} reads `{}` as {}, not as .{}",
            target.name,
            job.layer,
            list.join(" or "),
            format.name
        ));
    }
    let outputs = frame.outputs(target, output)?;
    let mut options = Options::default();
    let [ranging, writing] = progress.parts([if format.knows(RANGE.name) { 1.0 } else { 0.0 }, 1.0]);
    if format.knows(RANGE.name) {
        // The range of the whole frame, as for the heights: all tiles have it.
        let mut all = LayerSource::new(world, HEIGHT, frame.window, &ranging)?;
        all.rows(|_| Ok(())).map_err(|cause| file::explain("make", path, &cause))?;
        all.count().check(&format!("the layer `{HEIGHT}`"))?;
        let mut own = Options::default();
        (target.heights)(&all.levels(), &mut own)?;
        if let Some([low, high]) = own.pair(RANGE.name) {
            options.give(&RANGE, &format!("{low},{high}"))?;
        }
    }
    writing.expect(outputs.len() as f64);
    let mut written = Vec::new();
    let mut words = String::new();
    for row in 0..frame.tiles[1] {
        for column in 0..frame.tiles[0] {
            let part = writing.part(1.0);
            let source = LayerSource::of_features(world, vec![&scatter::LAYER], frame.tile(column, row), &part)?;
            let (made, told) = run::staged(format, source, &options, &outputs[row * frame.tiles[0] + column])?;
            words = told.words;
            written.push(made);
        }
    }
    if outputs.len() > 1 {
        words = "the objects of each tile, relative to it".into();
    }
    written.into_iter().try_for_each(Files::commit).map_err(|cause| file::explain("write", path, &cause))?;
    Ok(Exported {
        samples: [frame.window.width, frame.window.height],
        frame,
        files: outputs.iter().map(|output| output.path().to_path_buf()).collect(),
        words,
        count: FiniteCount::default(),
        import: target.objects.iter().flat_map(|objects| objects.import).map(|line| (*line).to_string()).collect(),
    })
}

fn refuse<T>(message: String) -> Result<T> {
    Err(Error::new(ErrorKind::Request, message))
}
