//! `orogen tilemap`.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use orogen::autotile::mask::Layout;
use orogen::file::{self, Output, Staged};
use orogen::recipe::class::document::CLASS;
use orogen::tilemap::art::set::{SETS, Set};
use orogen::tilemap::job::TilemapJob;
use orogen::tilemap::load::any as load;
use orogen::tilemap::load::loaded::Loaded;
use orogen::tilemap::map::Tilemap;
use orogen::tilemap::tileset::Tileset;
use orogen::words::{count, number};
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Progress};
use rayon::prelude::*;

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

/// The files, in the order in which they are put in place: the summary is last, so its presence means that all files are complete.
const FILES: [&str; 10] =
    ["tiles.png", "tiles.tsx", "map.tmx", "map.tmj", LDTK, "tiles.tres", GODOT, "classes.csv", "preview.png", SUMMARY];

const SUMMARY: &str = "tilemap.json";

/// The files that some maps do not have.
const LDTK: &str = "map.ldtk";
const GODOT: &str = "map.tscn";

/// Cells along the longer side of a map without --size and --cell.
const SIDE: usize = 128;

/// Memory for writing the files, in bytes.
const ENCODERS: u64 = 12 << 20;

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
    let tileset = tileset(args)?;
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
    let outputs: Vec<Output> =
        FILES.iter().map(|name| policy.output(args.out.join(name))).collect::<orogen::Result<_>>()?;
    let folder = Folder::ready(&args.out)?;
    let _writing = budget.reserve(ENCODERS)?;
    let [making, writing] = progress.parts([3.0, 1.0]);
    let map = job.stream(&world, &window, &args.out.join(SUMMARY), &making)?;
    finite::tell(source_layer, map.finite)?;
    let missing = world.install(|| write(&map, &outputs, &writing))?;
    folder.keep();
    Ok(if args.run.quiet { String::new() } else { words(&map, &args.out, &missing) })
}

/// A tileset, and the files that it was read from.
struct Drawn {
    tileset: Tileset,
    files: Vec<PathBuf>,
}

/// The tileset of the arguments.
fn tileset(args: &Args) -> Result<Drawn, Failure> {
    let layout = args.layout.and_then(Layout::named);
    if load::is_file(&args.tileset) {
        let path = PathBuf::from(&args.tileset);
        let Loaded { tileset, picture } = load::load(&path, layout, args.wang_set.as_deref())?;
        return Ok(Drawn { tileset, files: vec![path, picture] });
    }
    let Some(set) = Set::named(&args.tileset) else {
        let names: Vec<&str> = SETS.iter().map(|set| set.name).collect();
        return Err(Failure::Usage(format!(
            "there is no tileset `{}`; the tilesets of the program are {}, and files of others end in .tsx or .toml",
            args.tileset,
            names.join(" and ")
        )));
    };
    if args.wang_set.is_some() {
        return Err(Failure::Usage(format!(
            "--wang-set chooses one of a .tsx; `{}` is a tileset of the program",
            set.name
        )));
    }
    Ok(Drawn { tileset: set.draw(layout.unwrap_or(Layout::Blob)), files: Vec::new() })
}

/// Writes all files, or none. Returns the names of those that the map does not have.
fn write(map: &Tilemap, outputs: &[Output], progress: &Progress) -> Result<Vec<&'static str>, Failure> {
    let json = serde_json::to_string_pretty(&map.summary(SOFTWARE))
        .map_err(|e| Error::new(ErrorKind::Internal, e.to_string()))?;
    progress.expect(FILES.len() as f64);
    let is_missing = |name: &str| name == LDTK && !map.fits_ldtk() || name == GODOT && !map.fits_godot();
    let stage = |(name, output): (&&str, &Output)| {
        progress.step(1.0)?;
        match is_missing(name) {
            true => Ok(None),
            false => file::stage(output, |out| write_file(map, name, &json, &mut Stoppable(out))).map(Some),
        }
    };
    let staged: Vec<orogen::Result<Option<Staged>>> = FILES.par_iter().zip(outputs).map(stage).collect();
    let staged: Vec<Option<Staged>> = staged.into_iter().collect::<orogen::Result<_>>()?;
    file::commit(staged.into_iter().flatten().collect())?;
    Ok(FILES.into_iter().filter(|name| is_missing(name)).collect())
}

/// Writes the file of this name.
fn write_file(map: &Tilemap, name: &str, json: &str, out: &mut Stoppable) -> io::Result<()> {
    let notes = [("Software", SOFTWARE)];
    let [image, tsx, tres] = [FILES[0], FILES[1], FILES[5]];
    match name {
        "tiles.png" => map.tileset.write_png(out, &notes),
        "tiles.tsx" => map.tileset.write_tsx(out, image, SOFTWARE),
        "map.tmx" => map.write_tmx(out, tsx, SOFTWARE),
        "map.tmj" => map.write_tmj(out, image, SOFTWARE),
        LDTK => map.write_ldtk(out, image, SOFTWARE),
        "tiles.tres" => map.tileset.write_tileset_tres(out, image, SOFTWARE),
        GODOT => map.write_tscn(out, tres, SOFTWARE),
        "classes.csv" => map.write_csv(out),
        "preview.png" => map.write_png(out, &notes),
        _ => writeln!(out, "{json}"),
    }
}

/// Which places without a tile the summary lists.
fn listed(map: &Tilemap) -> String {
    match map.gaps.len() as u64 == map.gap_count {
        true => "them".into(),
        false => format!("the first {}", map.gaps.len()),
    }
}

/// The final message.
fn words(map: &Tilemap, folder: &Path, missing: &[&str]) -> String {
    let cells = map.classes.len().max(1) as f64;
    let shares = map.tileset.terrains.iter().zip(&map.class_counts).filter(|(_, cells)| **cells > 0);
    let shares: Vec<String> =
        shares.map(|(terrain, of)| format!("{:.0} % {}", 100.0 * *of as f64 / cells, terrain.name)).collect();
    let gaps = match map.gap_count {
        0 => "every place has a tile".to_string(),
        gaps => format!("{} without a tile; tilemap.json lists {}", count(gaps as usize, "place"), listed(map)),
    };
    let written: Vec<&str> = FILES.into_iter().filter(|name| !missing.contains(name)).collect();
    let why = missing.iter().map(|name| match *name {
        LDTK => "\nno map.ldtk: LDtk has no quarter turns, and a project lists each of up to 2^20 tiles",
        _ => "\nno map.tscn: a scene lists each of up to 2^24 tiles, and up to 32767 along a side",
    });
    let objects = match map.objects.len() {
        0 => String::new(),
        objects => format!(", {}", count(objects as usize, "object")),
    };
    format!(
        "{}: {}\n{} x {} tiles of {} ({}), {} m a cell, seed {}\n{}{objects}\n{gaps}{}\n",
        folder.display(),
        written.join("  "),
        map.width,
        map.height,
        map.tileset.name,
        map.tileset.layout.name(),
        number(map.window.cell),
        map.seed,
        shares.join(", "),
        why.collect::<String>(),
    )
}
