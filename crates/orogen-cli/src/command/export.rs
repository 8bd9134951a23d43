//! `orogen export`.

use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

use orogen::bands::Bands;
use orogen::format::dem::Georeference;
use orogen::format::levels::{Levels, NO_SAMPLES, extremes};
use orogen::format::png::{Picture, Pixel};
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
    /// A recipe's file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
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
    let (bar, progress) = Bar::new(args.quiet);
    let bands = world.bands(&args.layer, &window, beside(format, &window), &progress)?;
    let what = What { format, window, map: world.recipe().georeference() };
    let stopped = |failure| interrupt::explain(failure, "nothing was written");
    match to_stdout {
        true => {
            let mut out = BufWriter::new(io::stdout().lock());
            // Standard output has no disk of its own to put rows aside on.
            let spool = Spool::beside(&std::env::temp_dir().join("orogen"));
            let written = write(&mut Stoppable(&mut out), &what, bands, spool).and_then(|_| out.flush());
            written.map_err(|cause| match interrupt::asked() {
                true => Failure::Interrupted("stopped: what was written is cut short".to_string()),
                false => Failure::stdout(&cause),
            })
        }
        false => {
            let folder = args.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            file::check_folder(folder)?;
            let mut levels = Levels::new(0.0, 0.0);
            file::write_whole(&args.out, |out| {
                levels = write(&mut Stoppable(out), &what, bands, Spool::beside(&args.out))?;
                Ok(())
            })
            .map_err(|error| stopped(error.into()))?;
            drop(bar);
            if args.quiet { Ok(()) } else { say::out(&words(args, format, &window, &levels)) }
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

/// What a spool keeps in memory before it goes to the disk.
const SPOOL_MEMORY: u64 = 64 << 20;

/// Bytes that writing such a file holds beside the rows at hand.
fn beside(format: Format, window: &Window) -> u64 {
    let row = (window.width as u64).saturating_mul(4);
    let spooled = row.saturating_mul(window.height as u64).min(SPOOL_MEMORY);
    match format {
        Format::Npy => 0,
        Format::Png => spooled,
        // A row of tiles of each level while the next one comes in, and as much again while it is packed.
        Format::Tif => spooled.saturating_add(row.saturating_mul(4 * 512)),
    }
}

/// What is written.
struct What {
    format: Format,
    window: Window,
    /// How metres lie on a map.
    map: Option<Georeference>,
}

/// Writes all rows as they are made; tells their range. `spool` is for what cannot be written before all is known.
fn write(out: &mut dyn Write, what: &What, bands: Bands, mut spool: Spool) -> io::Result<Levels> {
    let What { format, window, map } = what;
    let mut range = NO_SAMPLES;
    let mut rows = bands.map(|band| {
        let band = band?;
        range = extremes(range, band.data());
        Ok::<Grid, io::Error>(band)
    });
    let levels = |[low, high]: [f32; 2]| Levels::new(low, high);
    match *format {
        Format::Npy => {
            npy::write_header(out, window.width, window.height)?;
            rows.try_for_each(|band| npy::write_rows(out, band?.data()))?;
        }
        Format::Tif => {
            let options = geotiff::options::Options { map: map.clone(), ..Default::default() };
            let mut writer = geotiff::writer::Writer::new(window, &options, spool)?;
            rows.try_for_each(|band| writer.rows(band?.data()))?;
            writer.finish(out)?;
        }
        Format::Png => {
            // Which height is white is known at the end: the heights wait for it.
            rows.try_for_each(|band| npy::write_rows(&mut Aside(&mut spool), band?.data()))?;
            let levels = levels(range);
            let notes = pictures::notes(window.cell, &levels);
            let notes: Vec<(&str, &str)> = notes.iter().map(|(keyword, text)| (*keyword, text.as_str())).collect();
            let picture = Picture { width: window.width, height: window.height, pixel: Pixel::Grey16, notes: &notes };
            let mut heights = Vec::new();
            png::write(out, &picture, |rows, pixels| {
                heights.resize(2 * pixels.len(), 0);
                spool.read(4 * (rows.start * window.width) as u64, &mut heights)?;
                for (pixel, height) in pixels.chunks_exact_mut(2).zip(heights.chunks_exact(4)) {
                    let height = f32::from_le_bytes([height[0], height[1], height[2], height[3]]);
                    pixel.copy_from_slice(&levels.to_u16(height).to_be_bytes());
                }
                Ok(())
            })?;
        }
    }
    Ok(levels(range))
}

/// What is written goes into a spool.
struct Aside<'a>(&'a mut Spool);

impl Write for Aside<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.push(bytes).map(|_| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn words(args: &Args, format: Format, window: &Window, levels: &Levels) -> String {
    let (file, layer) = (args.out.display(), &args.layer);
    let size = format!("{} x {} samples of {} m", window.width, window.height, window.cell);
    match format {
        Format::Npy | Format::Tif => format!("{file}: {layer}, {size}, {} to {}\n", levels.low(), levels.high()),
        Format::Png if levels.is_flat() => {
            format!("{file}: {layer}, {size}, flat at {} and so all black\n", levels.low())
        }
        Format::Png => format!("{file}: {layer}, {size}, 0 is {} and 65535 is {}\n", levels.low(), levels.high()),
    }
}
