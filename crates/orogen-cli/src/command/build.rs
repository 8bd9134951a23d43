//! `orogen build`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use orogen::builder::run::{Build, Report, Start};
use orogen::builder::spec::{BuildSpec, Form, Samples};
use orogen::builder::xyz;
use orogen::format::encoding::Encoding;
use orogen::words::{self, bytes, count, number};
use orogen::{Window, World};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::options::Limits;
use crate::replace::Replace;
use crate::seeds::Seeds;
use crate::sink::is_stdout;
use crate::source::Source;
use crate::view::{SizedView, View};
use crate::{disk, finite, interrupt, say};

/// What it takes.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe's file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// What to build: NAME.tif a Cloud-Optimised GeoTIFF, NAME.zarr a Zarr v3 group, NAME a folder of --tiles
    #[arg(short, long, value_name = "OUT")]
    out: PathBuf,
    /// What the tiles of a folder are
    #[arg(long)]
    tiles: Option<Tiles>,
    /// Layers to build, with commas between them
    #[arg(long, value_name = "A,B", value_delimiter = ',', default_value = orogen::world::HEIGHT)]
    layers: Vec<String>,
    #[command(flatten)]
    samples: SizedView,
    /// Samples along a tile's side [default: 512; 513 for tiles that share their edges; 256 for an XYZ tree]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65536), allow_negative_numbers = true)]
    tile: Option<u32>,
    /// Go on with a build that was interrupted, and make again what of it is damaged
    #[arg(long, conflicts_with_all = ["force", "no_clobber"])]
    resume: bool,
    #[command(flatten)]
    replace: Replace,
    #[command(flatten)]
    limits: Limits,
    /// Show neither needs, nor progress, nor the closing words
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// What the tiles of a folder are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Tiles {
    /// 16-bit grey pictures over the range of all tiles, which share their edges
    Png,
    /// Headerless u16, little-endian, over the range of all tiles, which share their edges
    R16,
    /// Headerless f32, little-endian; the tiles share their edges
    R32,
    /// An XYZ tree of Terrarium pictures with TileJSON, for web maps
    Terrarium,
    /// An XYZ tree of Terrain-RGB pictures with TileJSON, for web maps
    TerrainRgb,
}

/// Builds it.
pub fn run(args: &Args) -> Result<(), Failure> {
    Seeds::each(args.samples.view.seed.as_ref(), Some(&args.out), |seed, out| {
        let view = View { seed, ..args.samples.view.clone() };
        let out = out.unwrap_or_default();
        build(&Args { samples: SizedView { view, ..args.samples }, out, ..args.clone() })
    })
}

fn build(args: &Args) -> Result<(), Failure> {
    if is_stdout(&args.out) {
        let message = "a build goes on where it was interrupted, which standard output cannot; name a file, or use `orogen export`";
        return Err(Failure::Usage(message.into()));
    }
    let begun = Instant::now();
    let form = form(args)?;
    let source = Source::find(&args.recipe)?;
    let budget = args.limits.budget();
    let mut recipe = source.read(&budget, &args.samples.view.arguments)?;
    args.samples.view.apply(&mut recipe);
    let output = args.replace.policy(source.inputs(&recipe)).output(&args.out)?;
    let world = args.limits.open(recipe, &budget)?;
    let tile = args.tile.map(|tile| tile as usize);
    let spec = BuildSpec { form, window: window(args, &world, form)?, tile, layers: args.layers.clone() };
    let build = Build::new(&world, &spec, &output)?;
    let start = match (args.resume, args.replace.force) {
        (true, _) => Start::Resume,
        (_, true) => Start::Force,
        _ => Start::Fresh,
    };
    needs(args, &build, start)?;
    let (bar, progress) = Bar::new(args.quiet);
    let report = build.run(start, &progress);
    drop(bar);
    let report =
        report.map_err(|error| interrupt::explain(error.into(), "the same command with --resume goes on from here"))?;
    finite::tell(&args.layers.join("`, `"), report.samples)?;
    if !report.foreign.is_empty() {
        let names: Vec<String> = report.foreign.iter().map(|path| path.display().to_string()).collect();
        let list = words::list(names.iter().map(String::as_str));
        say::error(&format!("note: {} also holds {list}, which no build has made; left as it was", args.out.display()));
    }
    if args.quiet { Ok(()) } else { say::out(&closing(args, &spec, &report, begun.elapsed().as_secs_f64())) }
}

/// What OUT and --tiles say together.
fn form(args: &Args) -> Result<Form, Failure> {
    let tiles = args.tiles.map(|tiles| match tiles {
        Tiles::Png => Form::Tiles(Samples::Png),
        Tiles::R16 => Form::Tiles(Samples::R16),
        Tiles::R32 => Form::Tiles(Samples::R32),
        Tiles::Terrarium => Form::Xyz(Encoding::Terrarium),
        Tiles::TerrainRgb => Form::Xyz(Encoding::TerrainRgb),
    });
    let out = args.out.display();
    match (Form::of(&args.out), tiles) {
        (Some(form), None) => Ok(form),
        (None, Some(tiles)) => Ok(tiles),
        (Some(_), Some(_)) => Err(Failure::Usage(format!(
            "--tiles makes a folder, and {out} has the extension of a file: leave out one of them"
        ))),
        (None, None) => Err(Failure::Usage(format!(
            "{out} does not tell what to build: name a .tif or a .zarr, or say --tiles png, r16, r32, terrarium or terrain-rgb"
        ))),
    }
}

/// The samples that are asked for.
fn window(args: &Args, world: &World, form: Form) -> Result<Window, Failure> {
    let SizedView { view, size } = &args.samples;
    let cell = view.cell.unwrap_or(match form {
        Form::Xyz(_) => {
            let tile = args.tile.map(|tile| tile as usize).or(form.usual_tile()).unwrap_or(1);
            xyz::cell_near(world.recipe().world.cell, tile)
        }
        _ => world.recipe().world.cell,
    });
    if let (Form::Xyz(_), Some(_)) = (form, size) {
        return Err(Failure::Usage("an XYZ tree has cells of its own; leave out --size, or say --cell".into()));
    }
    if let Some(part) = view.part(world, *size, cell)? {
        return Ok(part);
    }
    let whole = match size {
        Some(_) => args.samples.window(world)?,
        None => world.full_window(cell)?,
    };
    Ok(match form {
        // Up to the far edge, which tiles share with the neighbours they do not have.
        Form::Tiles(_) => Window { width: whole.width + 1, height: whole.height + 1, ..whole },
        _ => whole,
    })
}

/// Says what it takes, and refuses what there is no room for.
fn needs(args: &Args, build: &Build, start: Start) -> Result<(), Failure> {
    let (disk, there) = build.disk();
    let free = disk::free_at(&args.out);
    let there = if start == Start::Resume { there } else { 0 };
    if !args.quiet {
        let (tiles, samples) = build.tiles();
        let way = match disk.scratch {
            0 => String::new(),
            scratch => format!(", and until it is finished {} in {}", bytes(scratch), build.beside().display()),
        };
        let free = free.map_or(String::new(), |free| format!("; {} are free", bytes(free)));
        say::error(&format!(
            "{} of {:.1} million samples; up to {} of memory; up to {} of disk{way}{free}",
            count(tiles, "tile"),
            samples as f64 / 1e6,
            bytes(build.memory()),
            bytes(disk.result)
        ));
    }
    disk::afford(&args.out, (disk.result + disk.scratch).saturating_sub(there), free)?;
    Ok(())
}

/// The closing words.
fn closing(args: &Args, spec: &BuildSpec, report: &Report, seconds: f64) -> String {
    let Window { width, height, cell, .. } = spec.window;
    let made = match report {
        Report { made: 0, .. } => "everything was there and sound".to_string(),
        Report { made, kept: 0, .. } => format!("{} made", count(*made, "tile")),
        Report { made, kept, again: 0, .. } => format!("{} made, {kept} kept", count(*made, "tile")),
        Report { made, kept, again, .. } => {
            format!("{} made, {kept} kept, {again} of them computed again to make it of", count(*made, "tile"))
        }
    };
    format!(
        "{}: {}, {width} x {height} samples of {} m, {}\n{made} in {seconds:.1} s\n",
        Path::new(&args.out).display(),
        spec.layers.join(", "),
        number(cell),
        bytes(report.bytes),
    )
}
