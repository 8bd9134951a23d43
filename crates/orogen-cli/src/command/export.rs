//! `orogen export`.

use std::path::PathBuf;

use orogen::World;
use orogen::export::derived::list;
use orogen::export::targets::job::EngineJob;
use orogen::export::{ExportJob, Format, registry};
use orogen::grid::words::{count, number};
use orogen::io::file::OutputPolicy;

use crate::bar::Bar;
use crate::declared::{FormatOptions, LayerOptions, OptionsOf};
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, is_stdout};
use crate::values::name_of;
use crate::view::SizedView;
use crate::{finite, interrupt, layer_file, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
#[command(after_long_help = layers(), after_help = "`orogen export --help` lists the layers derived from the heights.")]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// Output file; its extension determines the format; - is standard output
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Format, if the file extension does not determine it [default: npy]
    #[arg(long, value_parser = name_of::format())]
    format: Option<&'static Format>,
    /// Layer to write: an output, `node.layer`, or a layer derived from the heights, listed below
    #[arg(long, value_name = "L", default_value = orogen::world::HEIGHT)]
    layer: String,
    #[command(flatten)]
    samples: SizedView,
    #[command(flatten)]
    engine: OptionsOf<EngineJob>,
    #[command(flatten)]
    run: RunOptions,
    #[command(flatten)]
    options: FormatOptions,
    #[command(flatten)]
    layer_options: LayerOptions,
}

/// The derived layers, for the help text.
fn layers() -> String {
    let widest = list::all().iter().map(|layer| layer.name.len()).max().unwrap_or_default();
    let lines = list::all().iter().map(|layer| {
        let about = wrapped(layer.about, HELP_WIDTH - widest - 4).join(&format!("\n{:1$}", "", widest + 4));
        format!("  {:widest$}  {about}", layer.name)
    });
    format!("Layers derived from the heights:\n{}", lines.collect::<Vec<_>>().join("\n"))
}

/// Width of the help text of lists, in columns: that of narrow terminals.
const HELP_WIDTH: usize = 80;

/// The lines of a text, broken between words.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

/// Writes the layer.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| export(&Args { samples, out, ..args.clone() }))
}

fn export(args: &Args) -> Result<(), Failure> {
    let job = ExportJob::new(format(args)?)
        .with_layer(&args.layer)
        .with_options(args.options.read()?)
        .with_layer_options(args.layer_options.read()?);
    job.check()?;
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    let policy = policy.protecting(job.files());
    job.prepare(&mut recipe)?;
    let world = args.run.limits.open(recipe, &budget)?;
    let view = args.samples.view.samples(args.samples.size)?;
    if let Some(engine) = EngineJob::chosen(&job, &args.engine.read()?, &view, world.recipe())? {
        return for_engine(args, &engine, &world, &policy);
    }
    let window = args.samples.window(&world)?;
    let sink = Sink::new(&args.out, &policy)?;
    layer_file::write(job, &world, window, (&args.out, &sink), "", args.run.quiet)
}

/// Writes the layer for an engine.
fn for_engine(args: &Args, job: &EngineJob, world: &World, policy: &OutputPolicy) -> Result<(), Failure> {
    if is_stdout(&args.out) {
        return Err(Failure::Usage("--target cannot write to standard output; name a file with -o".into()));
    }
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = job
        .run(world, &policy.output(&args.out)?, &progress)
        .map_err(|error| interrupt::explain(error.into(), "nothing was written"))?;
    drop(bar);
    finite::tell(&args.layer, made.count)?;
    if args.run.quiet {
        return Ok(());
    }
    let ([width, height], cell) = (made.samples, made.frame.window.cell);
    let files = match made.files.as_slice() {
        [one] => one.display().to_string(),
        [first, .., last] => format!("{} to {}, {}", first.display(), last.display(), count(made.files.len(), "tile")),
        [] => String::new(),
    };
    let mut text =
        format!("{files}: {}, {width} x {height} samples of {} m, {}\n", args.layer, number(cell), made.words);
    let notes = made.frame.note.iter().map(|note| format!("note: {note}"));
    for line in notes.chain(made.import.into_iter().map(|line| format!("  {line}"))) {
        text.push_str(&line);
        text.push('\n');
    }
    say::out(&text)
}

/// The requested format: by name, otherwise by extension, otherwise an array.
fn format(args: &Args) -> Result<&'static Format, Failure> {
    let named = args.format;
    if is_stdout(&args.out) {
        return named.or(registry::named("npy")).ok_or_else(|| Failure::Usage("say --format".into()));
    }
    match (named, registry::of_path(&args.out)) {
        (Some(format), Ok(other)) if other.name != format.name => Err(Failure::Usage(format!(
            "--format {} does not match the extension of {}",
            format.name,
            args.out.display()
        ))),
        (Some(format), _) => Ok(format),
        (None, Ok(format)) => Ok(format),
        (None, Err(why)) if args.out.extension().is_none() => Err(Failure::Usage(format!("{why}, or use --format"))),
        (None, Err(why)) => Err(Failure::Usage(why.to_string())),
    }
}
