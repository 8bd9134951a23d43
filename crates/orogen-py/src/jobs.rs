//! Files of a world: exports, maps, renders, blocks, tilemaps and builds.

use std::path::{Path, PathBuf};

use orogen::builder::run::Start;
use orogen::builder::{Build, BuildSpec, Form};
use orogen::export::targets::job::EngineJob;
use orogen::export::{ExportJob, registry};
use orogen::io::file::{self, Existing, OutputPolicy};
use orogen::jobs::blocks_folder::BlocksFolder;
use orogen::jobs::{BlockFormat, BlocksJob, MapJob, RenderJob, SheetFormat};
use orogen::options::Options;
use orogen::tilemap::TilemapJob;
use orogen::view::View;
use orogen::world::HEIGHT;
use orogen::{Progress, Result, Window};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::internal;
use crate::options::split;
use crate::output::{by_extension, policy};
use crate::run::run;
use crate::world::{Choice, World};

/// What is written.
struct Work<'a> {
    world: &'a World,
    path: &'a Path,
    layer: &'a str,
    title: &'a str,
    view: View,
    policy: OutputPolicy,
    options: Options,
    layer_options: Options,
    engine_options: Options,
}

/// Does the work that `name` names and writes its files; returns warnings.
#[pyfunction]
#[pyo3(signature = (world, name, path, layer, title, choice, overwrite, options, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
pub fn write(
    py: Python<'_>,
    world: &Bound<'_, World>,
    name: &str,
    path: PathBuf,
    layer: &str,
    title: &str,
    choice: Choice<'_>,
    overwrite: Option<bool>,
    options: &Bound<'_, PyDict>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<String>> {
    let [options, layer_options, engine_options] = split(name, options)?;
    let write = match name {
        "export" => export,
        "map" => map,
        "render" => render,
        "blocks" => blocks,
        "minecraft" => minecraft,
        "tilemap" => tilemap,
        "build" => build,
        _ => return Err(internal(py, "unknown work")),
    };
    let world = world.get();
    let policy = policy(overwrite).protecting(&world.inputs).protecting(options.files());
    let view = choice.view(py)?;
    let work = Work { world, path: &path, layer, title, view, policy, options, layer_options, engine_options };
    run(py, progress, |progress| write(&work, progress))
}

impl Work<'_> {
    /// The window of a choice of samples.
    fn window(&self, view: &View) -> Result<Window> {
        view.window(&self.world.world, |_| ())
    }
}

/// A layer in the format of the file's extension, or in that of a game engine.
fn export(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    let job = ExportJob::new(registry::of_path(work.path)?)
        .with_layer(work.layer)
        .with_options(work.options.clone())
        .with_layer_options(work.layer_options.clone());
    job.check()?;
    let world = work.world.prepared(|recipe| job.prepare(recipe))?;
    let output = work.policy.output(work.path)?;
    let count = match EngineJob::chosen(&job, &work.engine_options, &work.view, world.recipe())? {
        Some(engine) => engine.run(&world, &output, progress)?.count,
        None => job.with_window(work.window(&work.view)?).to_file(&world, &output, progress)?.count,
    };
    Ok(count.check(&format!("the layer `{}`", work.layer))?.into_iter().collect())
}

/// A map sheet.
fn map(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    let format = by_extension(work.path, &SheetFormat::ALL.map(|format| (format, format.name())), "a map")?;
    let mut job = MapJob::new(format).with_title(work.title).with_options(&work.options)?;
    job.layer_options = work.layer_options.clone();
    job.is_place = work.world.is_place;
    job.window = Some(work.window(&work.view)?);
    let world = work.world.prepared(|recipe| job.prepare(recipe))?;
    let drawn = job.to_file(&world, &work.policy.output(work.path)?, progress)?;
    let mut warnings = drawn.warnings().to_vec();
    if !drawn.lacking().is_empty() {
        let letters: String = drawn.lacking().iter().collect();
        warnings.push(format!("no installed font has the letters {letters}; they are left out"));
    }
    Ok(warnings)
}

/// A picture in perspective.
fn render(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    by_extension(work.path, &[((), "png")], "a render")?;
    let job = RenderJob::default().with_options(&work.options)?.with_window(work.window(&work.view)?);
    let world = work.world.prepared(|recipe| job.prepare(recipe))?;
    job.to_file(&world, &work.policy.output(work.path)?, progress)?;
    Ok(Vec::new())
}

/// Blocks in the format of the file's extension, or a Luanti world if it has none.
fn blocks(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    let files = BlockFormat::FILES.map(|format| (format, format.name()));
    let format = match work.path.extension() {
        None => BlockFormat::Luanti,
        Some(_) => by_extension(work.path, &files, "blocks are a folder for a Luanti world, or a file, which")?,
    };
    blocks_as(format, work, progress)
}

/// A save of Minecraft.
fn minecraft(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    blocks_as(BlockFormat::Minecraft, work, progress)
}

fn blocks_as(format: BlockFormat, work: &Work, progress: &Progress) -> Result<Vec<String>> {
    let job = BlocksJob::new(format).with_options(&work.options)?;
    let window = work.window(&BlocksJob::view(&work.view, &work.world.world.recipe().world))?;
    let world = work.world.prepared(|recipe| job.prepare(recipe, window.cell))?;
    let warning = if format.is_folder() {
        let folder = BlocksFolder::new(format, work.path, &window, &work.policy)?;
        let made = job.make(&world, &window, progress)?;
        let warning = made.finite.check(&format!("the layer `{HEIGHT}`"))?;
        made.to_folder(folder)?;
        warning
    } else {
        let output = work.policy.output(work.path)?;
        let made = job.make(&world, &window, progress)?;
        let warning = made.finite.check(&format!("the layer `{HEIGHT}`"))?;
        file::write_whole(&output, |out| made.to_stream(out))?;
        warning
    };
    Ok(warning.into_iter().collect())
}

/// A map of tiles in a folder.
fn tilemap(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    let job = TilemapJob::with_options(&work.options)?;
    let window = work.window(&TilemapJob::view(&work.view))?;
    let policy = work.policy.clone().protecting(&job.files);
    let has_classes = work.world.world.recipe().outputs().any(|name| name == "class");
    let world = work.world.prepared(|recipe| job.prepare(recipe, window.cell))?;
    let source = if has_classes { "class" } else { HEIGHT };
    let written = job.to_folder(&world, &window, source, (work.path, &policy), progress)?;
    Ok(written.warning.into_iter().collect())
}

/// A world of any size in tiles, or as one large file, continued where an earlier build stopped.
fn build(work: &Work, progress: &Progress) -> Result<Vec<String>> {
    let form = Form::chosen(work.path, &work.options)?;
    let world = work.world.with_whole_files()?;
    let window = form.window(&world, &work.view, &work.options)?;
    let spec = BuildSpec::new(form, window).with_options(&work.options);
    let build = Build::new(&world, &spec, &work.policy.output(work.path)?)?;
    let start = if work.policy.existing() == Existing::Replace { Start::Force } else { Start::Resume };
    let report = build.run(start, progress)?;
    Ok(report.samples.check(&format!("the layer `{}`", spec.layers.join("`, `")))?.into_iter().collect())
}
