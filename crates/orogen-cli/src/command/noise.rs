//! `orogen noise`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use orogen::Progress;
use orogen::grid::words;
use orogen::io::format::png::{Animation, Picture};
use orogen::io::format::{npy, png};
use orogen::jobs::noise::NoiseJob;
use orogen::noise::Basis;
use orogen::output::noise_pictures::look::{Drawing, Look};
use orogen::output::noise_pictures::slice::Slice;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::moving::{AnimationTarget, Moving};
use crate::options::DrawOptions;
use crate::sink::{Sink, is_stdout, kind};
use crate::values::name_of;
use crate::{disk, interrupt, say};

/// Duration of a frame, in milliseconds.
const DELAY: u16 = 40;

/// Bytes of samples that are computed at a time.
const BAND: usize = 1 << 22;

/// Maximum size of the header of an array file, in bytes.
const HEADER: u64 = 256;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Sample (i, j) is the noise at (i, j), exactly as the library orogen-noise computes it for the \
                        Fractal of these parameters (also with one octave); with --tileable the whole of it is a period, as \
                        its method tiled gives it. -1 is black and 1 is white."
)]
pub struct Args {
    /// Noise basis
    #[arg(value_parser = name_of::basis())]
    basis: Basis,
    /// Output file, .png or .npy [default: noise.png, or noise.npy for a volume]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    options: OptionsOf<NoiseJob>,
    #[command(flatten)]
    draw: DrawOptions,
    /// Print no progress and no summary
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// The kinds of files of one drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Png,
    Npy,
}

/// A checked drawing task.
struct Task<'a> {
    draw: &'a DrawOptions,
    out: &'a Path,
    format: Format,
    job: NoiseJob,
    progress: Progress,
}

/// Draws the noise.
pub fn run(args: &Args) -> Result<(), Failure> {
    let job = NoiseJob::new(args.basis, &args.options.read()?)?;
    let (default, kinds) = match job.volume {
        Some(_) => ("noise.npy", [(Format::Npy, "npy"), (Format::Png, "png")]),
        None => ("noise.png", [(Format::Png, "png"), (Format::Npy, "npy")]),
    };
    let out = args.out.as_deref().unwrap_or(Path::new(default));
    // Noise has no position on Earth, so map formats do not apply. Frames may also be written in formats for
    // animations.
    let frames = job.frames.filter(|_| out.extension().is_none_or(|extension| extension != "npy"));
    let target = frames.map(|_| AnimationTarget::of(out)).transpose().map_err(Failure::Usage)?;
    let format = if target.is_some() { Format::Png } else { kind(out, None, &kinds, "a noise is a")? };
    let task = Task { draw: &args.draw, out, format, job, progress: Progress::none() };
    task.check()?;
    let policy = args.draw.replace.anywhere();
    let outputs = match (&target, frames) {
        (Some(target), Some(frames)) => target.outputs(out, frames, &policy)?,
        _ => vec![Sink::new(out, &policy)?],
    };
    task.afford()?;
    if let (false, Some(note)) = (args.quiet, task.note()) {
        say::error(&note);
    }
    let (bar, progress) = Bar::new(args.quiet);
    let task = Task { progress, ..task };
    let written = match (&target, frames) {
        (Some(target), Some(frames)) => task.write_frames(target, &outputs, frames),
        _ => outputs[0].write(|out| match format {
            Format::Npy => task.write_array(out),
            Format::Png => task.write_picture(out),
        }),
    };
    drop(bar);
    written.map_err(|failure| interrupt::explain(failure, "nothing was written"))?;
    outputs[0].tell(args.quiet, &task.words())
}

impl Task<'_> {
    /// Checks that the file format can hold the drawing.
    fn check(&self) -> Result<(), Failure> {
        let NoiseJob { look, frames, volume, range, is_deep, .. } = &self.job;
        let wrong = match self.format {
            Format::Png if range.is_some() => {
                "--range sets the values of an array; use the extension .npy (in a picture -1 is black and 1 is white)"
            }
            Format::Png if volume.is_some() => "--volume writes an array; use the extension .npy",
            Format::Npy if frames.is_some() => "--frames writes pictures; use the extension .png or .gif",
            Format::Npy if matches!(look, Look::Texture(_)) => "--texture writes a picture; use the extension .png",
            Format::Npy if *is_deep => "--bits applies to pictures; arrays are f32",
            _ => return Ok(()),
        };
        Err(Failure::Usage(wrong.into()))
    }

    /// Checks that memory suffices.
    fn afford(&self) -> Result<(), Failure> {
        let wide = |width: usize, bytes: usize| width as u64 * bytes as u64;
        // A band of samples with its derivatives, columns and pixels, and the rows that the encoder keeps.
        let [width, height] = self.job.size;
        let band = wide(self.rows_a_band() * width, 32).saturating_add(wide(width, 48));
        let frame = match self.job.frames {
            // The raw, the filtered and the compressed frame, and its samples.
            Some(_) => wide(width, 4 * self.drawing().pixel().bytes() + 32).saturating_mul(height as u64),
            None => 0,
        };
        self.draw.budget().afford(band.saturating_add(frame))?;
        // The size of a picture is known only after compression.
        if self.format == Format::Npy && !is_stdout(self.out) {
            let samples = (width as u64).saturating_mul(height as u64).saturating_mul(self.grids());
            disk::afford_file(self.out, samples.saturating_mul(4).saturating_add(HEADER))?;
        }
        Ok(())
    }

    /// Number of grids in an array.
    fn grids(&self) -> u64 {
        if self.job.look == Look::Normal { 2 } else { self.job.volume.unwrap_or(1) }
    }

    fn drawing(&self) -> Drawing {
        Drawing::new(self.job.slice(None), self.job.look, self.job.is_deep)
    }

    fn rows_a_band(&self) -> usize {
        (BAND / 4 / self.job.size[0]).clamp(1, self.job.size[1])
    }

    fn write_picture(&self, out: &mut dyn Write) -> io::Result<()> {
        let drawing = self.drawing();
        let description = self.description();
        let notes = [("Software", say::SOFTWARE), ("Description", description.as_str())];
        let [width, height] = self.job.size;
        let picture = Picture::new(width, height, drawing.pixel()).with_notes(&notes);
        self.progress.expect(height as f64);
        png::write(out, &picture, |rows, bytes| {
            self.progress.check()?;
            let work = rows.len() as f64;
            drawing.paint(self.job.depth, rows, bytes);
            self.progress.advance(work);
            Ok(())
        })
    }

    fn write_frames(&self, target: &AnimationTarget, outputs: &[Sink], frames: u32) -> Result<(), Failure> {
        let drawing = self.drawing();
        if *target == AnimationTarget::Gif && self.job.is_deep {
            return Err(Failure::Usage("a GIF has 8 bits; leave out --bits 16, or write a .png".into()));
        }
        let description = self.description();
        let notes = [("Software", say::SOFTWARE), ("Description", description.as_str())];
        let [width, height] = self.job.size;
        let picture = Picture::new(width, height, drawing.pixel()).with_notes(&notes);
        let frame = |k: u32, bytes: &mut [u8]| drawing.paint(Some(self.job.depth_of(k, frames)), 0..height, bytes);
        let bytes = width * height * drawing.pixel().bytes();
        let sample = || {
            let mut sample = vec![0; 2 * bytes];
            let (one, other) = sample.split_at_mut(bytes);
            frame(0, one);
            frame(frames / 3, other);
            Ok(sample)
        };
        let animation = Animation::new(frames, DELAY);
        let moving = Moving { outputs, target, picture, animation, sample: &sample };
        self.progress.expect(f64::from(frames));
        moving.write(|k, bytes| {
            self.progress.check()?;
            frame(k, bytes);
            self.progress.advance(1.0);
            Ok(())
        })
    }

    fn write_array(&self, out: &mut dyn Write) -> io::Result<()> {
        let NoiseJob { size: [width, height], look, depth, volume, .. } = self.job;
        let slice = self.job.slice(depth);
        self.progress.expect(self.grids() as f64 * height as f64);
        if let Some(slices) = volume {
            npy::write_shape(out, &[slices as usize, height, width])?;
            let first = depth.unwrap_or(0.0);
            return (0..slices).try_for_each(|n| {
                let slice = Slice { depth: Some(first + n as f64), ..slice };
                self.bands(out, |rows, value| self.fill(&slice, rows, value))
            });
        }
        if look == Look::Normal {
            npy::write_shape(out, &[2, height, width])?;
            let mut other = vec![0.0; self.rows_a_band() * width];
            self.bands(out, |rows, dx| {
                let dy = &mut other[..dx.len()];
                slice.fill_slopes(rows, dx, dy);
            })?;
            return self.bands(out, |rows, dy| {
                let dx = &mut other[..dy.len()];
                slice.fill_slopes(rows, dx, dy);
            });
        }
        npy::write_header(out, width, height)?;
        self.bands(out, |rows, value| self.fill(&slice, rows, value))
    }

    /// The values of some rows, mapped to the range.
    fn fill(&self, slice: &Slice, rows: std::ops::Range<usize>, value: &mut [f32]) {
        slice.fill(rows, value);
        if let Some([low, high]) = self.job.range {
            for value in value {
                let share = (f64::from(*value) + 1.0) / 2.0;
                *value = (low * (1.0 - share) + high * share) as f32;
            }
        }
    }

    /// Writes all rows in bands that `fill` computes.
    fn bands(&self, out: &mut dyn Write, mut fill: impl FnMut(std::ops::Range<usize>, &mut [f32])) -> io::Result<()> {
        let [width, height] = self.job.size;
        let mut band = vec![0.0; self.rows_a_band() * width];
        for first in (0..height).step_by(self.rows_a_band()) {
            let last = (first + self.rows_a_band()).min(height);
            let value = &mut band[..(last - first) * width];
            self.progress.check()?;
            fill(first..last, value);
            npy::write_rows(out, value)?;
            self.progress.advance((last - first) as f64);
        }
        Ok(())
    }

    /// A one-line description of the drawing.
    fn description(&self) -> String {
        let NoiseJob { noise, fractal, look, depth, range, is_tileable, .. } = &self.job;
        let octaves = noise.octaves;
        let plural = if octaves == 1 { "" } else { "s" };
        let made_of = |sum: &str| format!("{sum} of {octaves} octave{plural} of ");
        let sum = match look {
            Look::Texture(texture) => made_of(texture.name()),
            // One octave of fBm is the noise itself.
            _ if *fractal == "fbm" && octaves == 1 => String::new(),
            _ => made_of(fractal),
        };
        let depth = depth.map(|z| format!(", depth {z}")).unwrap_or_default();
        let repeating = if *is_tileable { ", repeating" } else { "" };
        let (basis, seed, wavelength) = (noise.basis.name(), noise.seed, self.wavelength());
        let range = range.map(|[low, high]| format!(", {low} to {high}")).unwrap_or_default();
        words::readable(format!("{sum}{basis} noise, wavelength {wavelength}{depth}, seed {seed}{repeating}{range}"))
    }

    /// The actual wavelength: per axis, if they differ.
    fn wavelength(&self) -> String {
        let asked = self.job.noise.wavelength;
        if !self.job.is_tileable {
            return asked.to_string();
        }
        let slice = self.job.look.made_of(&self.job.slice(None));
        let [x, y] = slice.fit().wavelengths(asked);
        // A texture may be stretched.
        let [x, y] = [x, y / slice.stretch].map(|wavelength| (wavelength * 100.0).round() / 100.0);
        if x == y { x.to_string() } else { format!("{x} x {y}") }
    }

    /// A note about rounding.
    fn note(&self) -> Option<String> {
        let (asked, drawn) = (self.job.noise.wavelength, self.wavelength());
        let fit = self.job.look.made_of(&self.job.slice(None)).fit();
        let [x, y, deep] = fit.cells;
        let [across, down, through] = fit.steps.map(|step| (step - 1.0).abs() > 1e-9);
        let plane = format!("it is {drawn}, so that {x} x {y} fit");
        let depth = format!("through the slices it is {}, so that {deep} fit", asked / fit.steps[2]);
        let rounded = match (across || down, through) {
            _ if !self.job.is_tileable => return None,
            (false, false) => return None,
            (true, false) => plane,
            (false, true) => depth,
            (true, true) => format!("{plane}; {depth}"),
        };
        Some(format!("note: the size is not a multiple of the wavelength {asked}; {rounded}"))
    }

    fn words(&self) -> String {
        let [width, height] = self.job.size;
        let size = match (self.job.frames, self.job.volume) {
            (Some(frames), _) => format!("{frames} frames of {width} x {height}"),
            (_, Some(slices)) => format!("{slices} slices of {width} x {height}"),
            _ => format!("{width} x {height}"),
        };
        format!("{}: {}; {size} samples\n", self.out.display(), self.description())
    }
}
