//! `orogen map`.

use std::path::PathBuf;

use orogen::io::file;
use orogen::jobs::{MapJob, SheetFormat};

use crate::bar::Bar;
use crate::declared::{LayerOptions, OptionsOf};
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, kind};
use crate::source::title;
use crate::values::name_of;
use crate::view::View;
use crate::{interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// Output file: .png, .svg or .pdf; - is standard output
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Format, if the file extension does not determine it [default: png]
    #[arg(long, value_parser = name_of::sheet())]
    format: Option<SheetFormat>,
    #[command(flatten)]
    options: OptionsOf<MapJob>,
    #[command(flatten)]
    view: View,
    #[command(flatten)]
    layer_options: LayerOptions,
    #[command(flatten)]
    run: RunOptions,
}

/// Draws the sheet.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.view.each_output(&args.out, |view, out| map(&Args { view, out, ..args.clone() }))
}

fn map(args: &Args) -> Result<(), Failure> {
    let kinds = SheetFormat::ALL.map(|format| (format, format.name()));
    let format = kind(&args.out, args.format, &kinds, "a map is a")?;
    let mut job = MapJob::new(format).with_title(title(&args.recipe)).with_options(&args.options.read()?)?;
    job.layer_options = args.layer_options.read()?;
    let Opened { source, mut recipe, budget, policy } = args.run.read(&args.recipe, &args.view)?;
    job.is_place = source.dem().is_some();
    let sink = Sink::new(&args.out, &policy.protecting(args.options.read()?.files()))?;
    job.prepare(&mut recipe)?;
    let world = args.run.limits.open(recipe, &budget)?;
    job.window = Some(args.view.window(&world)?);
    if let Sink::File(output) = &sink {
        file::check_folder(file::folder(output.path()))?;
    }
    let (bar, progress) = Bar::new(args.run.quiet);
    let stopped = |error: orogen::Error| interrupt::explain(error.into(), "nothing was written");
    let drawn = job.draw(&world, &progress).map_err(stopped)?;
    for warning in drawn.warnings() {
        say::error(&format!("warning: {warning}"));
    }
    if !drawn.lacking().is_empty() {
        let letters: String = drawn.lacking().iter().collect();
        say::error(&format!(
            "note: no installed font has the letters {letters}; they are left out (install a font that has them, such as Noto)"
        ));
    }
    match &sink {
        Sink::File(output) => drawn.to_file(output).map_err(stopped)?,
        Sink::Stdout => sink.write(|out| drawn.to_stream(out))?,
    }
    drop(bar);
    sink.tell(args.run.quiet, &format!("{}: {}\n", args.out.display(), drawn.words()))
}
