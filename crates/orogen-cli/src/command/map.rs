//! `orogen map`.

use std::path::PathBuf;

use clap::ValueEnum;
use orogen::io::file;
use orogen::jobs::{MapJob, SheetFormat};

use crate::bar::Bar;
use crate::declared::{LayerOptions, OptionsOf};
use crate::failure::Failure;
use crate::options::Limits;
use crate::replace::Replace;
use crate::sink::{Sink, kind};
use crate::source::{Source, title};
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
    #[arg(long)]
    format: Option<Kind>,
    #[command(flatten)]
    options: OptionsOf<MapJob>,
    #[command(flatten)]
    view: View,
    #[command(flatten)]
    replace: Replace,
    #[command(flatten)]
    layer_options: LayerOptions,
    #[command(flatten)]
    limits: Limits,
    /// Print no progress and no summary
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// The kinds of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Picture
    Png,
    /// Vector drawing
    Svg,
    /// PDF page
    Pdf,
}

impl From<Kind> for SheetFormat {
    fn from(kind: Kind) -> SheetFormat {
        match kind {
            Kind::Png => SheetFormat::Png,
            Kind::Svg => SheetFormat::Svg,
            Kind::Pdf => SheetFormat::Pdf,
        }
    }
}

const KINDS: [(Kind, &[&str]); 3] = [(Kind::Png, &["png"]), (Kind::Svg, &["svg"]), (Kind::Pdf, &["pdf"])];

/// Draws the sheet.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.view.each_output(&args.out, |view, out| map(&Args { view, out, ..args.clone() }))
}

fn map(args: &Args) -> Result<(), Failure> {
    let format = kind(&args.out, args.format, &KINDS, "a map")?;
    let mut job = MapJob::new(format.into()).with_title(title(&args.recipe)).with_options(&args.options.read()?)?;
    job.layer_options = args.layer_options.read()?;
    let source = Source::find(&args.recipe)?;
    job.is_place = matches!(source, Source::Dem(_));
    let budget = args.limits.budget();
    let mut recipe = args.view.recipe(&source, &budget)?;
    let policy = args.replace.policy(source.inputs(&recipe)).protecting(args.options.read()?.files());
    let sink = Sink::new(&args.out, &policy)?;
    job.prepare(&mut recipe)?;
    let world = args.limits.open(recipe, &budget)?;
    job.window = Some(args.view.window(&world)?);
    if let Sink::File(output) = &sink {
        file::check_folder(file::folder(output.path()))?;
    }
    let (bar, progress) = Bar::new(args.quiet);
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
    sink.tell(args.quiet, &format!("{}: {}\n", args.out.display(), drawn.words()))
}
