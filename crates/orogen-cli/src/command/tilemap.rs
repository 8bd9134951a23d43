//! `orogen tilemap`.

use std::path::{Path, PathBuf};

use orogen::autotile::mask::Layout;
use orogen::file::{self, Output};
use orogen::tilemap::art::set::{SETS, Set};
use orogen::tilemap::job::{Tilemap, TilemapJob};
use orogen::tilemap::standard::CLASS;
use orogen::words::{count, number};
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::finite;
use crate::folder::Folder;
use crate::interrupt::{self, Stoppable};
use crate::options::RunOptions;
use crate::say::{self, SOFTWARE};
use crate::sink::is_stdout;
use crate::source::Source;
use crate::values::name_of::NameOf;
use crate::values::size::Size;
use crate::view::SizedView;

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Tileset to draw with
    #[arg(long, value_name = "T", value_parser = NameOf::tileset(), default_value = SETS[0].name)]
    tileset: &'static str,
    /// How the tiles follow their surroundings
    #[arg(long, value_name = "L", value_parser = NameOf::layout(), default_value = Layout::Blob.name())]
    layout: &'static str,
    /// Keep the terrain classes as they are, also where the tileset has no tile
    #[arg(long)]
    no_clean: bool,
    /// Output folder; it is created if needed
    #[arg(short, long, value_name = "DIR", default_value = "tilemap")]
    out: PathBuf,
    #[command(flatten)]
    run: RunOptions,
}

/// The files, in the order in which they are put in place: the summary is last, so its presence means that all files are complete.
const FILES: [&str; 7] = ["tiles.png", "tiles.tsx", "map.tmx", "map.tmj", "classes.csv", "preview.png", "tilemap.json"];

/// Cells along the longer side of a map without --size and --cell.
const SIDE: usize = 128;

/// Memory for writing the files, in bytes.
const ENCODERS: u64 = 4 << 20;

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

fn make(args: &Args, progress: &orogen::Progress) -> Result<String, Failure> {
    let source = Source::find(&args.recipe)?;
    let budget = args.run.limits.budget();
    let mut recipe = args.samples.recipe(&source, &budget)?;
    let policy = args.run.replace.policy(source.inputs(&recipe));
    let samples = SizedView {
        size: args
            .samples
            .size
            .or((args.samples.view.cell.is_none() && !args.samples.has_part()).then_some(Size::Longer(SIDE))),
        ..args.samples.clone()
    };
    // The classes of a recipe without any depend on the cell of the map.
    let window = samples.window(&args.run.limits.open(recipe.clone(), &budget)?)?;
    let (Some(set), Some(layout)) =
        (Set::named(args.tileset), Layout::ALL.into_iter().find(|layout| layout.name() == args.layout))
    else {
        return Err(Failure::Usage(format!(
            "there is no tileset `{}` with the layout `{}`",
            args.tileset, args.layout
        )));
    };
    let job = TilemapJob::new(set.draw(layout)).with_cleans(!args.no_clean);
    let source_layer = if recipe.outputs().any(|name| name == CLASS) { CLASS } else { HEIGHT };
    job.prepare(&mut recipe, window.cell)?;
    let world = args.run.limits.open(recipe, &budget)?;
    let outputs: Vec<Output> =
        FILES.iter().map(|name| policy.output(args.out.join(name))).collect::<orogen::Result<_>>()?;
    let folder = Folder::ready(&args.out)?;
    let _map = budget.reserve(job.memory(&window) + ENCODERS)?;
    let [making, writing] = progress.parts([9.0, 1.0]);
    let map = job.make(&world, &window, &making)?;
    finite::tell(source_layer, map.finite)?;
    write(&map, &outputs)?;
    writing.finish();
    folder.keep();
    Ok(if args.run.quiet { String::new() } else { words(&map, &args.out) })
}

/// Writes all files, or none.
fn write(map: &Tilemap, outputs: &[Output]) -> Result<(), Failure> {
    let notes = [("Software", SOFTWARE)];
    let json = serde_json::to_string_pretty(&map.summary(SOFTWARE))
        .map_err(|e| Error::new(ErrorKind::Internal, e.to_string()))?;
    let staged = [
        file::stage(&outputs[0], |out| map.tileset.write_png(&mut Stoppable(out), &notes))?,
        file::stage(&outputs[1], |out| map.tileset.write_tsx(&mut Stoppable(out), FILES[0], SOFTWARE))?,
        file::stage(&outputs[2], |out| map.write_tmx(&mut Stoppable(out), FILES[1], SOFTWARE))?,
        file::stage(&outputs[3], |out| map.write_tmj(&mut Stoppable(out), FILES[0], SOFTWARE))?,
        file::stage(&outputs[4], |out| map.write_csv(&mut Stoppable(out)))?,
        file::stage(&outputs[5], |out| map.write_png(&mut Stoppable(out), &notes))?,
        file::stage(&outputs[6], |out| writeln!(out, "{json}"))?,
    ];
    Ok(file::commit(staged.into())?)
}

/// The final message.
fn words(map: &Tilemap, folder: &Path) -> String {
    let cells = map.classes.data().len().max(1) as f64;
    let counts = map.classes.counts();
    let shares = map.tileset.terrains.iter().zip(counts).filter(|(_, cells)| *cells > 0);
    let shares: Vec<String> =
        shares.map(|(terrain, of)| format!("{:.0} % {}", 100.0 * of as f64 / cells, terrain.name)).collect();
    let gaps = match (map.gaps_before, map.gaps.as_slice()) {
        (0, []) => "every place has a tile".to_string(),
        (before, []) => {
            format!(
                "every place has a tile; {} had none before {} changed",
                count(before, "place"),
                count(map.changed, "cell")
            )
        }
        (_, [first, ..]) => {
            let layer = map.tileset.terrains.get(usize::from(first.class)).map_or("", |terrain| terrain.name.as_str());
            format!(
                "{} without a tile, the first in column {}, row {}: {layer} with mask {}; tilemap.json lists them",
                count(map.gaps.len(), "place"),
                first.x,
                first.y,
                first.mask
            )
        }
    };
    format!(
        "{}: {}\n{} x {} tiles of {} ({}), {} m a cell, seed {}\n{}\n{gaps}\n",
        folder.display(),
        FILES.join("  "),
        map.width,
        map.height,
        map.tileset.name,
        map.tileset.layout.name(),
        number(map.window.cell),
        map.seed,
        shares.join(", "),
    )
}
