//! `orogen export`.

use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::builder::PossibleValue;
use orogen::Window;
use orogen::export::derived::list;
use orogen::export::format::Format;
use orogen::export::subject::Subject;
use orogen::export::{registry, run as exporting};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::format_options::FormatOptions;
use crate::options::{Limits, View};
use crate::size::{Rectangle, cell, seed};
use crate::source::Source;
use crate::{interrupt, say, view};

/// What it takes.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recipe's file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// File to write, its extension one of the formats; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Format, if the file's extension does not say [default: npy]
    #[arg(long, value_parser = Named)]
    format: Option<&'static str>,
    /// Layer to write: an output, `node.layer`, or what follows from the heights: slope, aspect, curvature, normal, occlusion, splat
    #[arg(long, value_name = "L", default_value = orogen::world::HEIGHT)]
    layer: String,
    /// Samples to write, at the cell asked for [default: the whole world]
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true)]
    window: Option<Rectangle>,
    /// Metres from one sample to the next [default: the world's cell]
    #[arg(long, value_name = "M", value_parser = cell, allow_negative_numbers = true)]
    cell: Option<f64>,
    /// Seed of the world, instead of the recipe's
    #[arg(long, value_name = "N", value_parser = seed, allow_negative_numbers = true)]
    seed: Option<u64>,
    #[command(flatten)]
    limits: Limits,
    /// Show neither progress nor the closing words
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    options: FormatOptions,
}

/// The names of formats.
#[derive(Clone)]
struct Named;

impl clap::builder::TypedValueParser for Named {
    type Value = &'static str;

    fn parse_ref(
        &self,
        command: &clap::Command,
        arg: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<&'static str, clap::Error> {
        let known = clap::builder::PossibleValuesParser::new(possible());
        let name = known.parse_ref(command, arg, value)?;
        // A name that is possible has a format.
        Ok(registry::named(&name).map_or("npy", |format| format.name))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(possible().into_iter()))
    }
}

fn possible() -> Vec<PossibleValue> {
    let formats = registry::all().iter();
    formats.map(|format| PossibleValue::new(format.name).help(format.about).aliases(format.aliases)).collect()
}

/// Writes the layer.
pub fn run(args: &Args) -> Result<(), Failure> {
    let format = format(args)?;
    let options = args.options.read()?;
    registry::check(format, &options)?;
    let to_stdout = args.out == Path::new("-");
    if to_stdout && io::stdout().is_terminal() {
        return Err(Failure::Usage(
            "standard output is a terminal, which cannot show binary data; name a file with -o, or pipe it on".into(),
        ));
    }
    let mut recipe = Source::find(&args.recipe)?.read()?;
    recipe.world.seed = args.seed.unwrap_or(recipe.world.seed);
    list::prepare(&mut recipe, &args.layer);
    let world = args.limits.open(recipe)?;
    let view = View { seed: None, size: None, cell: args.cell };
    let window = match args.window {
        Some(Rectangle { x, y, width, height }) => {
            let cell = args.cell.unwrap_or(world.recipe().world.cell);
            Window { x, y, width, height, cell }
        }
        None => view::whole(&world, &view)?,
    };
    let (bar, progress) = Bar::new(args.quiet);
    let subject = Subject::new(&world, &args.layer, window, &progress)?;
    match to_stdout {
        true => {
            let mut out = BufWriter::new(io::stdout().lock());
            let written = exporting::to_stream(format, subject, &options, &mut out).and_then(|_| out.flush());
            // What is left in the buffer after a failure must not be tried again on the way out.
            drop(out.into_parts());
            written.map_err(|cause| match interrupt::asked() {
                true => Failure::Interrupted("stopped: what was written is cut short".to_string()),
                false => Failure::stdout(&cause),
            })
        }
        false => {
            let words = exporting::to_file(format, subject, &options, &args.out)
                .map_err(|error| interrupt::explain(error.into(), "nothing was written"))?;
            drop(bar);
            let size = format!("{} x {} samples of {} m", window.width, window.height, window.cell);
            match args.quiet {
                true => Ok(()),
                false => say::out(&format!("{}: {}, {size}, {words}\n", args.out.display(), args.layer)),
            }
        }
    }
}

/// The format that is asked for: by name, else by extension, else an array.
fn format(args: &Args) -> Result<&'static Format, Failure> {
    let named = args.format.and_then(registry::named);
    if args.out == Path::new("-") {
        return named.or(registry::named("npy")).ok_or_else(|| Failure::Usage("say --format".into()));
    }
    match (named, registry::of_path(&args.out)) {
        (Some(format), Ok(other)) if other.name != format.name => Err(Failure::Usage(format!(
            "--format {} and the extension of {} contradict each other",
            format.name,
            args.out.display()
        ))),
        (Some(format), _) => Ok(format),
        (None, Ok(format)) => Ok(format),
        (None, Err(why)) if args.out.extension().is_none() => Err(Failure::Usage(format!("{why}, or say --format"))),
        (None, Err(why)) => Err(Failure::Usage(why.to_string())),
    }
}
