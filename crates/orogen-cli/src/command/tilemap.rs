//! `orogen tilemap`.

use std::path::PathBuf;

use orogen::Progress;
use orogen::autotile::mask::Layout;
use orogen::recipe::class::document::CLASS;
use orogen::tilemap::art::set::SETS;
use orogen::tilemap::files::SIDE;
use orogen::tilemap::job::TilemapJob;
use orogen::tilemap::tileset_source;
use orogen::world::HEIGHT;

use crate::bar::Bar;
use crate::failure::Failure;
use crate::options::RunOptions;
use crate::sink::is_stdout;
use crate::source::Source;
use crate::values::name_of::NameOf;
use crate::values::size::Size;
use crate::view::SizedView;
use crate::{interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Tileset to draw with: `fields-16` or `fields-32`, or a file: a tileset of Tiled (.tsx) with a wang set, or a description (.toml)
    #[arg(long, value_name = "T", default_value = SETS[0].name)]
    tileset: String,
    /// Wang set to use of a .tsx that has several
    #[arg(long, value_name = "NAME")]
    wang_set: Option<String>,
    /// How the tiles follow their surroundings [default: that of the tileset, `blob`]
    #[arg(long, value_name = "L", value_parser = NameOf::layout())]
    layout: Option<&'static str>,
    /// Make the maps for Tiled infinite: chunks of 16 x 16 tiles at the positions of the world's cells, so that maps of parts join
    #[arg(long)]
    infinite: bool,
    /// Output folder; it is created if needed
    #[arg(short, long, value_name = "DIR", default_value = "tilemap")]
    out: PathBuf,
    #[command(flatten)]
    run: RunOptions,
}

/// Makes the map.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| tilemap(&Args { samples, out, ..args.clone() }))
}

fn tilemap(args: &Args) -> Result<(), Failure> {
    if is_stdout(&args.out) {
        return Err(Failure::Usage("`tilemap` writes several files: name a folder with -o".into()));
    }
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = make(args, &progress);
    drop(bar);
    made.and_then(|text| say::out(&text)).map_err(|failure| interrupt::explain(failure, "nothing was written"))
}

fn make(args: &Args, progress: &Progress) -> Result<String, Failure> {
    let source = Source::find(&args.recipe)?;
    let budget = args.run.limits.budget();
    let mut recipe = args.samples.recipe(&source, &budget)?;
    let layout = args.layout.and_then(Layout::named);
    let tileset = tileset_source::find(&args.tileset, layout, args.wang_set.as_deref())?;
    let inputs = source.inputs(&recipe).into_iter().chain(tileset.files);
    let policy = args.run.replace.policy(inputs);
    let samples = SizedView {
        size: args
            .samples
            .size
            .or((args.samples.view.cell.is_none() && !args.samples.has_part()).then_some(Size::Longer(SIDE))),
        ..args.samples.clone()
    };
    // The classes of a recipe without any depend on the cell of the map.
    let window = samples.window(&args.run.limits.open(recipe.clone(), &budget)?)?;
    let job = TilemapJob::new(tileset.tileset).with_infinite(args.infinite);
    let source_layer = if recipe.outputs().any(|name| name == CLASS) { CLASS } else { HEIGHT };
    job.prepare(&mut recipe, window.cell)?;
    let world = args.run.limits.open(recipe, &budget)?;
    let written = job.to_folder(&world, &window, source_layer, (&args.out, &policy), progress)?;
    if let Some(warning) = &written.warning {
        say::error(&format!("warning: {warning}"));
    }
    Ok(if args.run.quiet { String::new() } else { written.words() })
}
