//! `orogen refine`.

use std::path::{Path, PathBuf};

use orogen::Recipe;
use orogen::export::{ExportJob, registry};
use orogen::grid::words::number;
use orogen::io::file::mark;
use orogen::jobs::refine::RefineJob;

use crate::declared::{FormatOptions, OptionsOf};
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, is_stdout};
use crate::source::Source;
use crate::view::View;
use crate::{layer_file, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A file of heights (GeoTIFF, .asc, .hgt, ...)
    place: PathBuf,
    /// Output file; its extension determines the format; - is standard output. With the extension .toml the recipe of
    /// the refined land is written, for the other commands
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Layer to write: height, flow (drainage area), or a layer derived from the heights as in `export`
    #[arg(long, value_name = "L", default_value = orogen::world::HEIGHT)]
    layer: String,
    #[command(flatten)]
    refine: OptionsOf<RefineJob>,
    #[command(flatten)]
    samples: View,
    #[command(flatten)]
    run: RunOptions,
    #[command(flatten)]
    options: FormatOptions,
}

/// Refines the place.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| refine(&Args { samples, out, ..args.clone() }))
}

fn refine(args: &Args) -> Result<(), Failure> {
    let is_recipe = args.out.extension().is_some_and(|extension| extension == "toml");
    let format = match is_stdout(&args.out) {
        true => registry::named("npy"),
        false if is_recipe => None,
        false => Some(registry::of_path(&args.out).map_err(|why| Failure::Usage(why.to_string()))?),
    };
    if Source::find(&args.place)?.dem().is_none() {
        return Err(Failure::Usage(format!(
            "`refine` needs a file of heights, and {} is none; recipes are made at any cell by `orogen export RECIPE --cell`",
            args.place.display()
        )));
    }
    let refining = RefineJob::new(&args.refine.read()?)?;
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.place, &args.samples)?;
    let coarse = recipe.world.cell;
    refining.prepare(&mut recipe, args.samples.cell)?;
    let sink = Sink::new(&args.out, &policy)?;
    let Some(format) = format else { return write_recipe(args, &recipe, &sink) };
    let job = ExportJob::new(format).with_layer(&args.layer).with_options(args.options.read()?);
    job.check()?;
    job.prepare(&mut recipe)?;
    let world = args.run.limits.open(recipe, &budget)?;
    let window = args.samples.window(&world)?;
    let origin = format!(", refined from {} m", number(coarse));
    layer_file::write(job, &world, window, (&args.out, &sink), &origin, args.run.quiet)
}

/// Writes the recipe itself.
fn write_recipe(args: &Args, recipe: &Recipe, sink: &Sink) -> Result<(), Failure> {
    sink.write(|out| out.write_all(mark::marked(&recipe.to_toml()).as_bytes()))?;
    let (name, word) = (name(&args.out), say::word(&args.out));
    sink.tell(args.run.quiet, &format!("wrote {name}; make it: orogen export {word} -o FILE.tif\n"))
}

fn name(path: &Path) -> String {
    path.display().to_string()
}
