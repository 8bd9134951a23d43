//! `orogen export`.

use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

use orogen::format::levels::Levels;
use orogen::format::{geotiff, npy, png};
use orogen::spool::Spool;
use orogen::{Grid, Window, file};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::format::Format;
use crate::interrupt::Stoppable;
use crate::options::{Limits, View};
use crate::pictures;
use crate::size::{Rectangle, cell, seed};
use crate::source::Source;
use crate::{interrupt, say, view};

/// What it takes.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recipe's file, or the name of a preset
    recipe: PathBuf,
    /// File to write, its extension one of the formats; `-` is standard output
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Format, if the file's extension does not say [default: npy]
    #[arg(long)]
    format: Option<Format>,
    /// Layer to write
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
}

/// Writes the layer.
pub fn run(args: &Args) -> Result<(), Failure> {
    let format = format(args)?;
    let to_stdout = args.out == Path::new("-");
    if to_stdout && io::stdout().is_terminal() {
        return Err(Failure::Usage(
            "standard output is a terminal, which cannot show binary data; name a file with -o, or pipe it on".into(),
        ));
    }
    let mut recipe = Source::find(&args.recipe)?.read()?;
    recipe.world.seed = args.seed.unwrap_or(recipe.world.seed);
    let world = args.limits.open(recipe)?;
    let view = View { seed: None, size: None, cell: args.cell };
    let window = match args.window {
        Some(Rectangle { x, y, width, height }) => {
            let cell = args.cell.unwrap_or(world.recipe().world.cell);
            Window { x, y, width, height, cell }
        }
        None => view::whole(&world, &view)?,
    };
    let plan = world.plan(&[args.layer.as_str()], &window)?;
    if !to_stdout {
        let folder = args.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        file::check_folder(folder)?;
    }
    let (bar, progress) = Bar::new(args.quiet);
    let grids = world.run(&plan, &progress);
    drop(bar);
    let stopped = |failure| interrupt::explain(failure, "nothing was written");
    let Some(grid) = grids.map_err(|error| stopped(error.into()))?.pop() else {
        return Ok(());
    };
    match to_stdout {
        true => {
            let mut out = BufWriter::new(io::stdout().lock());
            let written = write(&mut Stoppable(&mut out), format, &grid, Spool::in_memory()).and_then(|()| out.flush());
            written.map_err(|cause| match interrupt::asked() {
                true => Failure::Interrupted("stopped: what was written is cut short".to_string()),
                false => Failure::stdout(&cause),
            })
        }
        false => {
            file::write_whole(&args.out, |out| write(&mut Stoppable(out), format, &grid, Spool::beside(&args.out)))
                .map_err(|error| stopped(error.into()))?;
            if args.quiet { Ok(()) } else { say::out(&words(args, format, &grid)) }
        }
    }
}

/// The format that is asked for: by name, else by extension, else an array.
fn format(args: &Args) -> Result<Format, Failure> {
    match args.format {
        None if args.out == Path::new("-") => Ok(Format::Npy),
        None => Format::of(&args.out, Format::ALL).map_err(|why| match args.out.extension() {
            None => Failure::Usage(format!("{why}, or say --format")),
            Some(_) => Failure::Usage(why),
        }),
        Some(format) => match Format::of(&args.out, Format::ALL) {
            Ok(other) if other != format => Err(Failure::Usage(format!(
                "--format {} and the extension of {} contradict each other",
                format.name(),
                args.out.display()
            ))),
            _ => Ok(format),
        },
    }
}

/// `spool` is for what cannot be written before all is known.
fn write(out: &mut dyn Write, format: Format, grid: &Grid, spool: Spool) -> io::Result<()> {
    match format {
        Format::Npy => npy::write(out, grid),
        Format::Png => {
            let levels = Levels::of(grid);
            let notes = pictures::notes(grid, &levels);
            let notes: Vec<(&str, &str)> = notes.iter().map(|(keyword, text)| (*keyword, text.as_str())).collect();
            png::write_grey16(out, grid, &levels, &notes)
        }
        Format::Tif => geotiff::writer::write(out, grid, &geotiff::options::Options::default(), spool),
    }
}

fn words(args: &Args, format: Format, grid: &Grid) -> String {
    let (file, layer) = (args.out.display(), &args.layer);
    let size = format!("{} x {} samples of {} m", grid.width(), grid.height(), grid.window().cell);
    let levels = Levels::of(grid);
    match format {
        Format::Npy | Format::Tif => format!("{file}: {layer}, {size}, {} to {}\n", levels.low(), levels.high()),
        Format::Png if levels.is_flat() => {
            format!("{file}: {layer}, {size}, flat at {} and so all black\n", levels.low())
        }
        Format::Png => format!("{file}: {layer}, {size}, 0 is {} and 65535 is {}\n", levels.low(), levels.high()),
    }
}
