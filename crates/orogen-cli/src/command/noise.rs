//! `orogen noise`.

use std::f64::consts::TAU;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use orogen::Progress;
use orogen::grid::words;
use orogen::io::format::png::{Animation, Picture};
use orogen::io::format::{npy, png};
use orogen::output::noise_pictures::look::{Drawing, Look};
use orogen::output::noise_pictures::slice::Slice;
use orogen::output::noise_pictures::texture::Texture;
use orogen_noise::{Basis, Fractal, MAX_OCTAVES, TileError};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::format::Format;
use crate::fractal_options::{self, Sum};
use crate::moving::{AnimationTarget, Moving};
use crate::options::DrawOptions;
use crate::sink::{Sink, is_stdout};
use crate::values::number::{MOST, finite, frequency, positive, range, seed, wavelength};
use crate::values::size::Size;
use crate::{disk, interrupt, say};

/// Duration of a frame, in milliseconds.
const DELAY: u16 = 40;

/// Mean number of frames of an animation per wavelength.
const FRAMES_A_WAVELENGTH: f64 = 24.0;

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
    #[arg(value_parser = basis())]
    basis: Basis,
    /// Output file, .png or .npy [default: noise.png, or noise.npy for a volume]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Samples of the picture, along both sides or WxH
    #[arg(long, value_name = "N|WxH", default_value = "512", allow_negative_numbers = true)]
    size: Size,
    /// Seed of the noise
    #[arg(long, value_name = "N", value_parser = seed, default_value = "0", allow_negative_numbers = true)]
    seed: u64,
    /// Wavelength in samples: the approximate distance between hills, or the side of the squares of white noise
    /// [default: 64, of white noise 1; textures have their own]
    #[arg(long, visible_alias = "scale", value_name = "N", value_parser = wavelength, allow_negative_numbers = true)]
    wavelength: Option<f64>,
    /// Frequency of the noise in waves per sample: 1 / wavelength
    #[arg(long, value_name = "F", value_parser = frequency, conflicts_with = "wavelength", allow_negative_numbers = true)]
    frequency: Option<f64>,
    /// Number of octaves, each finer and weaker than the one before [default: 1, with --fractal 6; textures have their
    /// own]
    #[arg(long, value_name = "N", value_parser = octaves(), allow_negative_numbers = true)]
    octaves: Option<u32>,
    /// Amplitude ratio between successive octaves
    #[arg(long, visible_alias = "persistence", value_name = "G", value_parser = finite, default_value = "0.5",
          allow_negative_numbers = true)]
    gain: f64,
    /// Frequency ratio between successive octaves
    #[arg(long, value_name = "L", value_parser = positive, default_value = "2", allow_negative_numbers = true)]
    lacunarity: f64,
    #[command(flatten)]
    sum: fractal_options::Options,
    /// Make the noise tileable horizontally and vertically, and through the frames or the slices of a volume.
    /// Wavelengths are adjusted slightly so that a whole number of them fits
    #[arg(long)]
    tileable: bool,
    /// Draw a slice of 3D noise at this depth (in samples) instead of 2D noise
    #[arg(long, value_name = "Z", value_parser = finite, allow_negative_numbers = true)]
    z: Option<f64>,
    /// Draw the slope as a normal map of ground a quarter of a wavelength high: red is east, green is north (up), blue
    /// is up. As .npy: the slopes along x and y per sample, of shape (2, H, W)
    #[arg(long, conflicts_with_all = ["texture", "volume"])]
    gradient: bool,
    /// Values of an array in place of -1 and 1: the noise is mapped linearly, so that -1 becomes A and 1 becomes B
    #[arg(long, value_name = "A,B", value_parser = range, allow_hyphen_values = true, conflicts_with_all = ["gradient", "texture"])]
    range: Option<[f64; 2]>,
    /// Draw a textbook texture made from the noise
    #[arg(long, value_parser = texture(), conflicts_with = "volume")]
    texture: Option<Texture>,
    /// Bits per grey value, or per component of a normal
    #[arg(long, value_name = "8|16", value_parser = ["8", "16"], default_value = "8")]
    bits: String,
    /// Write an animation of N frames (animated .png, .gif, or files such as noise-%03d.png). Each frame is a slice of
    /// 3D noise: from --z forward and back, slowing down at the turns, so that it loops smoothly; with --tileable it
    /// moves forward all the time
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), allow_negative_numbers = true,
          conflicts_with = "volume")]
    frames: Option<u32>,
    /// Write a volume of N slices, one sample apart, starting at --z, as .npy of shape (N, H, W)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST), allow_negative_numbers = true)]
    volume: Option<u64>,
    #[command(flatten)]
    options: DrawOptions,
    /// Print no progress and no summary
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// Parser of the noise bases of the library.
fn basis() -> impl TypedValueParser<Value = Basis> {
    let names = PossibleValuesParser::new(Basis::all().iter().map(|basis| basis.name()));
    names.try_map(|name| Basis::from_name(&name).ok_or("it is not known"))
}

/// Parser of the textures of the library.
fn texture() -> impl TypedValueParser<Value = Texture> {
    let names = Texture::ALL.map(|texture| PossibleValue::new(texture.name()).help(texture.about()));
    PossibleValuesParser::new(names)
        .try_map(|name| Texture::ALL.into_iter().find(|texture| texture.name() == name).ok_or("it is not known"))
}

fn octaves() -> impl TypedValueParser<Value = u32> {
    clap::value_parser!(u32).range(1..=i64::from(MAX_OCTAVES))
}

/// The checked drawing task.
struct Task<'a> {
    args: &'a Args,
    out: &'a Path,
    format: Format,
    noise: Fractal,
    look: Look,
    width: usize,
    height: usize,
    progress: Progress,
}

/// Draws the noise.
pub fn run(args: &Args) -> Result<(), Failure> {
    let default = if args.volume.is_some() { "noise.npy" } else { "noise.png" };
    let out = args.out.as_deref().unwrap_or(Path::new(default));
    // Noise has no position on the earth, so map formats do not apply.
    // Frames may also be written in formats for animations.
    let target = match args.frames.filter(|_| out.extension().is_none_or(|extension| extension != "npy")) {
        Some(_) => Some(AnimationTarget::of(out).map_err(Failure::Usage)?),
        None => None,
    };
    let format = match target {
        Some(_) => Format::Png,
        None if is_stdout(out) && args.volume.is_some() => Format::Npy,
        None if is_stdout(out) => Format::Png,
        None => Format::of(out, &[Format::Npy, Format::Png]).map_err(Failure::Usage)?,
    };
    let (width, height) = match args.size {
        Size::Longer(n) => (n, n),
        Size::Both(width, height) => (width, height),
    };
    let look = match (args.gradient, args.texture) {
        (_, Some(texture)) => Look::Texture(texture),
        (true, None) => Look::Normal,
        (false, None) => Look::Grey,
    };
    let task = Task { args, out, format, noise: noise(args)?, look, width, height, progress: Progress::none() };
    task.check()?;
    let outputs = match (&target, args.frames) {
        (Some(target), Some(frames)) => target.outputs(out, frames, &args.options.replace.anywhere())?,
        _ => vec![Sink::new(out, &args.options.replace.anywhere())?],
    };
    task.afford()?;
    if let (false, Some(note)) = (args.quiet, task.note()) {
        say::error(&note);
    }
    let (bar, progress) = Bar::new(args.quiet);
    let task = Task { progress, ..task };
    let written = match (&target, args.frames) {
        (Some(target), Some(frames)) => task.write_frames(target, &outputs, frames),
        _ => outputs[0].write(|out| match format {
            Format::Npy => task.write_array(out),
            _ => task.write_picture(out),
        }),
    };
    drop(bar);
    written.map_err(|failure| interrupt::explain(failure, "nothing was written"))?;
    outputs[0].tell(args.quiet, &task.words())
}

fn noise(args: &Args) -> Result<Fractal, Failure> {
    // Textbooks show white noise with one value per sample.
    let usual = if args.basis == Basis::White { 1.0 } else { 64.0 };
    let wavelength = args.wavelength.or(args.frequency.map(|frequency| 1.0 / frequency));
    Ok(Fractal::new(args.seed, wavelength.or(args.texture.map(Texture::wavelength)).unwrap_or(usual))
        .with_basis(args.basis)
        .with_kind(args.sum.kind().map_err(Failure::Usage)?)
        .with_octaves(args.octaves.or(args.texture.map(Texture::octaves)).unwrap_or(args.sum.octaves()))
        .with_lacunarity(args.lacunarity)
        .with_gain(args.gain))
}

impl Task<'_> {
    /// Checks for contradicting options.
    fn check(&self) -> Result<(), Failure> {
        let Args { texture, frames, volume, gradient, basis, .. } = self.args;
        let (png, deep) = (self.format == Format::Png, self.deep());
        let wrong = match () {
            () if *gradient && *basis == Basis::White => {
                "white noise has no slope; leave out --gradient, or choose another noise".into()
            }
            () if *gradient && !basis.has_gradient() => {
                format!(
                    "the slope of {} is not implemented; use perlin, value or simplex, or leave out --gradient",
                    basis.name()
                )
            }
            () if self.args.range.is_some() && png => {
                "--range sets the values of an array; use the extension .npy (in a picture -1 is black and 1 is white)"
                    .into()
            }
            () if volume.is_some() && png => "--volume writes an array; use the extension .npy".into(),
            () if frames.is_some() && !png => "--frames writes pictures; use the extension .png or .gif".into(),
            () if texture.is_some() && !png => "--texture writes a picture; use the extension .png".into(),
            () if texture.is_some() && deep => {
                "--bits 16 applies to grey pictures and normal maps, not to textures".into()
            }
            () if !png && deep => "--bits applies to pictures; arrays are f32".into(),
            () => match self.look.made_of(&self.slice(None)).tiled() {
                Ok(_) => return Ok(()),
                Err(TileError::Slanted) => format!(
                    "{} cannot be tileable: its triangular lattice repeats only along slanted axes; use perlin, value \
                     or worley",
                    basis.name()
                ),
                Err(reason) if self.noise.lacunarity.fract() != 0.0 => {
                    format!("--tileable needs a whole number for --lacunarity, such as 2: {reason}")
                }
                Err(reason) => format!("--tileable: {reason}"),
            },
        };
        Err(Failure::Usage(wrong))
    }

    /// Checks that memory suffices.
    fn afford(&self) -> Result<(), Failure> {
        let wide = |width: usize, bytes: usize| width as u64 * bytes as u64;
        // A band of samples with its derivatives, columns and pixels, and the rows that the encoder keeps.
        let band = wide(self.rows_a_band() * self.width, 32).saturating_add(wide(self.width, 48));
        let frame = match self.args.frames {
            // The raw, the filtered and the compressed frame, and its samples.
            Some(_) => wide(self.width, 4 * self.drawing().pixel().bytes() + 32).saturating_mul(self.height as u64),
            None => 0,
        };
        let needed = band.saturating_add(frame);
        self.args.options.budget().afford(needed)?;
        // The size of a picture is known only after compression.
        let array = |grids: u64| {
            let samples = (self.width as u64).saturating_mul(self.height as u64).saturating_mul(grids);
            samples.saturating_mul(4).saturating_add(HEADER)
        };
        match (self.format, self.args.volume) {
            _ if is_stdout(self.out) => {}
            (Format::Npy, Some(slices)) => disk::afford_file(self.out, array(slices))?,
            (Format::Npy, None) => disk::afford_file(self.out, array(if self.args.gradient { 2 } else { 1 }))?,
            _ => {}
        }
        Ok(())
    }

    fn deep(&self) -> bool {
        self.args.bits == "16"
    }

    fn drawing(&self) -> Drawing {
        Drawing::new(self.slice(None), self.look, self.deep())
    }

    /// The samples at a depth, or of 2D noise.
    fn slice(&self, depth: Option<f64>) -> Slice {
        let through = match (self.args.frames, self.args.volume) {
            (Some(frames), _) => self.waves(frames) * self.noise.wavelength,
            (_, Some(slices)) => slices as f64,
            _ => 0.0,
        };
        let repeat = if self.args.tileable { [self.width as f64, self.height as f64, through] } else { [0.0; 3] };
        Slice { noise: self.noise, width: self.width, depth, stretch: 1.0, repeat }
    }

    /// Number of whole wavelengths that an animation passes.
    fn waves(&self, frames: u32) -> f64 {
        (f64::from(frames) / FRAMES_A_WAVELENGTH).round().max(1.0)
    }

    fn rows_a_band(&self) -> usize {
        (BAND / 4 / self.width).clamp(1, self.height)
    }

    fn write_picture(&self, out: &mut dyn Write) -> io::Result<()> {
        let drawing = self.drawing();
        let description = self.description();
        let notes = [("Software", say::SOFTWARE), ("Description", description.as_str())];
        let picture = Picture::new(self.width, self.height, drawing.pixel()).with_notes(&notes);
        self.progress.expect(self.height as f64);
        png::write(out, &picture, |rows, bytes| {
            self.progress.check()?;
            let work = rows.len() as f64;
            drawing.paint(self.args.z, rows, bytes);
            self.progress.advance(work);
            Ok(())
        })
    }

    fn write_frames(&self, target: &AnimationTarget, outputs: &[Sink], frames: u32) -> Result<(), Failure> {
        let drawing = self.drawing();
        if *target == AnimationTarget::Gif && self.deep() {
            return Err(Failure::Usage("a GIF has 8 bits; leave out --bits 16, or write a .png".into()));
        }
        let description = self.description();
        let notes = [("Software", say::SOFTWARE), ("Description", description.as_str())];
        let picture = Picture::new(self.width, self.height, drawing.pixel()).with_notes(&notes);
        let frame = |k: u32, bytes: &mut [u8]| drawing.paint(Some(self.depth(k, frames)), 0..self.height, bytes);
        let bytes = self.width * self.height * drawing.pixel().bytes();
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

    /// The depth of a frame. Tileable noise is passed once; in other noise a circular path would need a fourth
    /// dimension, so the path goes forward and back along a cosine.
    fn depth(&self, frame: u32, frames: u32) -> f64 {
        let turn = f64::from(frame) / f64::from(frames);
        let way = match self.args.tileable {
            true => self.waves(frames) * self.noise.wavelength * turn,
            false => {
                let farthest = f64::from(frames) / 2.0 * self.noise.wavelength / FRAMES_A_WAVELENGTH;
                farthest * (1.0 - libm::cos(TAU * turn)) / 2.0
            }
        };
        self.args.z.unwrap_or(0.0) + way
    }

    fn write_array(&self, out: &mut dyn Write) -> io::Result<()> {
        let slice = self.slice(self.args.z);
        let (width, height) = (self.width, self.height);
        let grids = if self.args.gradient { 2 } else { self.args.volume.unwrap_or(1) };
        self.progress.expect(grids as f64 * height as f64);
        if let Some(slices) = self.args.volume {
            npy::write_shape(out, &[slices as usize, height, width])?;
            let first = self.args.z.unwrap_or(0.0);
            return (0..slices).try_for_each(|n| {
                let slice = Slice { depth: Some(first + n as f64), ..slice };
                self.bands(out, |rows, value| self.fill(&slice, rows, value))
            });
        }
        if self.args.gradient {
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
        if let Some([low, high]) = self.args.range {
            for value in value {
                let share = (f64::from(*value) + 1.0) / 2.0;
                *value = (low * (1.0 - share) + high * share) as f32;
            }
        }
    }

    /// Writes all rows in bands that `fill` computes.
    fn bands(&self, out: &mut dyn Write, mut fill: impl FnMut(std::ops::Range<usize>, &mut [f32])) -> io::Result<()> {
        let mut band = vec![0.0; self.rows_a_band() * self.width];
        for first in (0..self.height).step_by(self.rows_a_band()) {
            let last = (first + self.rows_a_band()).min(self.height);
            let value = &mut band[..(last - first) * self.width];
            self.progress.check()?;
            fill(first..last, value);
            npy::write_rows(out, value)?;
            self.progress.advance((last - first) as f64);
        }
        Ok(())
    }

    /// A one-line description of the drawing.
    fn description(&self) -> String {
        let Fractal { basis, seed, octaves, .. } = self.noise;
        let plural = if octaves == 1 { "" } else { "s" };
        let made_of = |sum: &str| format!("{sum} of {octaves} octave{plural} of ");
        let sum = match self.look {
            Look::Texture(texture) => made_of(texture.name()),
            // One octave of fBm is the noise itself.
            _ if self.args.sum.sum() == Sum::Fbm && octaves == 1 => String::new(),
            _ => made_of(&self.args.sum.sum().name()),
        };
        let depth = self.args.z.map(|z| format!(", depth {z}")).unwrap_or_default();
        let repeating = if self.args.tileable { ", repeating" } else { "" };
        let (basis, wavelength) = (basis.name(), self.wavelength());
        let range = self.args.range.map(|[low, high]| format!(", {low} to {high}")).unwrap_or_default();
        words::readable(format!("{sum}{basis} noise, wavelength {wavelength}{depth}, seed {seed}{repeating}{range}"))
    }

    /// The actual wavelength: per axis, if they differ.
    fn wavelength(&self) -> String {
        let asked = self.noise.wavelength;
        if !self.args.tileable {
            return asked.to_string();
        }
        let slice = self.look.made_of(&self.slice(None));
        let [x, y] = slice.fit().wavelengths(asked);
        // A texture may be stretched.
        let [x, y] = [x, y / slice.stretch].map(|wavelength| (wavelength * 100.0).round() / 100.0);
        if x == y { x.to_string() } else { format!("{x} x {y}") }
    }

    /// A note about rounding.
    fn note(&self) -> Option<String> {
        let (asked, drawn) = (self.noise.wavelength, self.wavelength());
        let fit = self.look.made_of(&self.slice(None)).fit();
        let [x, y, deep] = fit.cells;
        let [across, down, through] = fit.steps.map(|step| (step - 1.0).abs() > 1e-9);
        let plane = format!("it is {drawn}, so that {x} x {y} fit");
        let depth = format!("through the slices it is {}, so that {deep} fit", asked / fit.steps[2]);
        let rounded = match (across || down, through) {
            _ if !self.args.tileable => return None,
            (false, false) => return None,
            (true, false) => plane,
            (false, true) => depth,
            (true, true) => format!("{plane}; {depth}"),
        };
        Some(format!("note: the size is not a multiple of the wavelength {asked}; {rounded}"))
    }

    fn words(&self) -> String {
        let (width, height) = (self.width, self.height);
        let size = match (self.args.frames, self.args.volume) {
            (Some(frames), _) => format!("{frames} frames of {width} x {height}"),
            (_, Some(slices)) => format!("{slices} slices of {width} x {height}"),
            _ => format!("{width} x {height}"),
        };
        format!("{}: {}; {size} samples\n", self.out.display(), self.description())
    }
}
