//! The options of a drawn noise.

use crate::options::Condition::Is;
use crate::options::{Choice, OptionSpec, Options, ValueKind};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_noise::{Basis, Falloff, Fractal, Kind, MAX_OCTAVES, TileError};
use orogen_output::noise_pictures::look::Look;
use orogen_output::noise_pictures::slice::Slice;
use orogen_output::noise_pictures::texture::Texture;

/// A noise to draw: a picture, an array, an animation or a volume.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct NoiseJob {
    /// The noise.
    pub noise: Fractal,
    /// How octaves are combined: a choice of `fractal`.
    pub fractal: &'static str,
    /// The appearance of the samples in a picture.
    pub look: Look,
    /// Samples east and south.
    pub size: [usize; 2],
    /// Whether the noise repeats at the edges, and through frames and slices.
    pub is_tileable: bool,
    /// Depth of a slice of 3D noise; `None` for 2D noise.
    pub depth: Option<f64>,
    /// Whether pictures have 16 bits per component.
    pub is_deep: bool,
    /// The values of an array in place of -1 and 1.
    pub range: Option<[f64; 2]>,
    /// Number of frames of an animation.
    pub frames: Option<u32>,
    /// Number of slices of a volume.
    pub volume: Option<u64>,
}

/// Maximum number of samples along a side.
const MAX_SIDE: usize = 1_000_000_000;

/// Mean number of frames of an animation per wavelength.
const FRAMES_A_WAVELENGTH: f64 = 24.0;

const ANY: ValueKind = ValueKind::Number(f64::NEG_INFINITY, f64::INFINITY);
const NOT_NEGATIVE: ValueKind = ValueKind::Number(0.0, f64::INFINITY);

const FBM: &str = "fbm";

const FRACTALS: &[Choice] = &[
    Choice::new(FBM, "Fractional Brownian motion: the weighted sum of octaves"),
    Choice::new("ridged", "Sharp crests, round valleys"),
    Choice::new("billow", "Round hills, sharp valleys"),
    Choice::new("weighted", "Each octave is damped by the slope of those before it"),
    Choice::new("ping-pong", "Contour bands, as in agate"),
    Choice::new("hybrid", "Hybrid multifractal: smooth lowlands, rough heights"),
    Choice::new("hetero", "Heterogeneous terrain: the higher, the rougher"),
    Choice::new("swiss", "Swiss turbulence: branching crests"),
    Choice::new("jordan", "Jordan turbulence: rounded massifs with worn flanks"),
];

const FALLOFFS: &[Choice] = &[
    Choice::new("reciprocal", "1 / (1 + k m)"),
    Choice::new("exponential", "e^(-k m)"),
    Choice::new("square-root", "1 / (1 + k sqrt m)"),
    Choice::new("smoothstep", "1 - smoothstep(k m): 0 beyond k m = 1"),
];

const fn texture(texture: Texture) -> Choice {
    Choice::new(texture.name(), texture.about())
}

const TEXTURES: &[Choice] = &[texture(Texture::Clouds), texture(Texture::Marble), texture(Texture::Wood)];

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("size", "N|WxH", ValueKind::Size(MAX_SIDE))
        .with_about("Samples of the picture, along both sides or WxH")
        .with_default("512"),
    OptionSpec::new("seed", "N", ValueKind::Whole(0, i64::MAX as u64))
        .with_about("Seed of the noise")
        .with_default("0"),
    OptionSpec::new("wavelength", "N", ValueKind::Positive)
        .with_about(
            "Wavelength in samples, also --scale: the approximate distance between hills, or the side of the squares \
             of white noise [default: 64, of white noise 1; textures have their own]",
        )
        .with_aliases(&["scale"]),
    OptionSpec::new("frequency", "F", ValueKind::Positive)
        .with_about("Frequency of the noise in waves per sample: 1 / wavelength")
        .without(&["wavelength"]),
    OptionSpec::new("octaves", "N", ValueKind::Whole(1, MAX_OCTAVES as u64)).with_about(
        "Number of octaves, each finer and weaker than the one before [default: 1, with --fractal 6; textures have \
             their own]",
    ),
    OptionSpec::new("gain", "G", ANY)
        .with_about("Amplitude ratio between successive octaves, also --persistence")
        .with_default("0.5")
        .with_aliases(&["persistence"]),
    OptionSpec::new("lacunarity", "L", ValueKind::Positive)
        .with_about("Frequency ratio between successive octaves")
        .with_default("2"),
    OptionSpec::new("fractal", "FRACTAL", ValueKind::Choice(FRACTALS))
        .with_about("Kind of fractal [default: fbm]")
        .without(&["texture"]),
    OptionSpec::new("k", "K", NOT_NEGATIVE)
        .with_about("How strongly slope damps the octaves of `weighted` [default: 1]")
        .when(Is("fractal", &["weighted"])),
    OptionSpec::new("falloff", "FALLOFF", ValueKind::Choice(FALLOFFS))
        .with_about("Damping function of `weighted`, with m the squared slope [default: reciprocal]")
        .when(Is("fractal", &["weighted"])),
    OptionSpec::new("strength", "S", NOT_NEGATIVE)
        .with_about(
            "How often `ping-pong` folds the noise (2 S - 1 times): 0.5 not at all, 1 like ridged, 4 in many bands \
             [default: 2]",
        )
        .when(Is("fractal", &["ping-pong"])),
    OptionSpec::new("offset", "O", ANY)
        .with_about(
            "Value added to the noise of `hybrid` and `hetero`: where the sum is small, ground is smooth [default: \
             0.7]",
        )
        .when(Is("fractal", &["hybrid", "hetero"])),
    OptionSpec::new("warp", "W", ANY)
        .with_about(
            "How far slopes displace later octaves, in wavelengths of the first octave (`swiss`) or in cells of the \
             octave (`jordan`) [default: 0.15; 0.35]",
        )
        .when(Is("fractal", &["swiss", "jordan"])),
    OptionSpec::new("damp", "D", NOT_NEGATIVE)
        .with_about(
            "How far slopes let the finer octaves of `jordan` through; 0 leaves only the first octave [default: 0.8]",
        )
        .when(Is("fractal", &["jordan"])),
    OptionSpec::switch("tileable").with_about(
        "Make the noise tileable horizontally and vertically, and through the frames or the slices of a volume. \
             Wavelengths are adjusted slightly so that a whole number of them fits",
    ),
    OptionSpec::new("z", "Z", ANY)
        .with_about("Draw a slice of 3D noise at this depth (in samples) instead of 2D noise"),
    OptionSpec::switch("gradient")
        .with_about(
            "Draw the slope as a normal map of ground a quarter of a wavelength high: red is east, green is north \
             (up), blue is up. As .npy: the slopes along x and y per sample, of shape (2, H, W)",
        )
        .without(&["texture", "volume"]),
    OptionSpec::new("range", "A,B", ValueKind::Point)
        .with_about(
            "Values of an array in place of -1 and 1: the noise is mapped linearly, so that -1 becomes A and 1 becomes \
             B",
        )
        .without(&["gradient", "texture"]),
    OptionSpec::new("texture", "TEXTURE", ValueKind::Choice(TEXTURES))
        .with_about("Draw a textbook texture made from the noise")
        .without(&["volume"]),
    OptionSpec::new("bits", "8|16", ValueKind::Word(&["8", "16"]))
        .with_about("Bits per grey value, or per component of a normal")
        .with_default("8"),
    OptionSpec::new("frames", "N", ValueKind::Whole(1, 1_000_000))
        .with_about(
            "Write an animation of N frames (animated .png, .gif, or files such as noise-%03d.png). Each frame is a \
             slice of 3D noise: from --z forward and back, slowing down at the turns, so that it loops smoothly; with \
             --tileable it moves forward all the time",
        )
        .without(&["volume"]),
    OptionSpec::new("volume", "N", ValueKind::Whole(1, MAX_SIDE as u64))
        .with_about("Write a volume of N slices, one sample apart, starting at --z, as .npy of shape (N, H, W)"),
];

impl NoiseJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// A noise with all that is chosen by [`OPTIONS`](NoiseJob::OPTIONS).
    ///
    /// # Errors
    /// If an option does not apply, or the noise cannot be drawn so.
    pub fn new(basis: Basis, options: &Options) -> Result<NoiseJob> {
        options.check(OPTIONS)?;
        let texture = options.word("texture").and_then(|word| Texture::ALL.into_iter().find(|one| one.name() == word));
        // Textbooks show white noise with one value per sample.
        let usual = texture.map_or(if basis == Basis::White { 1.0 } else { 64.0 }, Texture::wavelength);
        let wavelength = options.number("frequency").map(|frequency| 1.0 / frequency);
        if wavelength.is_some_and(f64::is_infinite) {
            return refuse("--frequency is too low: its wavelength would be infinite".into());
        }
        let octaves = texture.map_or(if options.has("fractal") { 6 } else { 1 }, Texture::octaves);
        let fractal = options.word("fractal").unwrap_or(FBM);
        let noise = Fractal::new(
            options.whole("seed").unwrap_or(0),
            wavelength.or(options.number("wavelength")).unwrap_or(usual),
        )
        .with_basis(basis)
        .with_kind(kind(fractal, options))
        .with_octaves(options.whole("octaves").map_or(octaves, |octaves| octaves as u32))
        .with_lacunarity(options.number("lacunarity").unwrap_or(2.0))
        .with_gain(options.number("gain").unwrap_or(0.5));
        let job = NoiseJob {
            noise,
            fractal,
            look: match texture {
                Some(texture) => Look::Texture(texture),
                None if options.has("gradient") => Look::Normal,
                None => Look::Grey,
            },
            size: match options.numbers("size") {
                Some(&[width, height]) => [width as usize, height as usize],
                Some(&[side]) => [side as usize; 2],
                _ => [512; 2],
            },
            is_tileable: options.has("tileable"),
            depth: options.number("z"),
            is_deep: options.word("bits") == Some("16"),
            range: options.pair("range"),
            frames: options.whole("frames").map(|frames| frames as u32),
            volume: options.whole("volume"),
        };
        job.check()?;
        Ok(job)
    }

    /// Checks that the noise can be drawn.
    fn check(&self) -> Result<()> {
        let basis = self.noise.basis;
        let is_gradient = self.look == Look::Normal;
        let wrong = match self.range {
            _ if is_gradient && basis == Basis::White => {
                "white noise has no slope; leave out --gradient, or choose another noise".into()
            }
            _ if is_gradient && !basis.has_gradient() => format!(
                "the slope of {} is not implemented; use perlin, value or simplex, or leave out --gradient",
                basis.name()
            ),
            Some([low, high]) if low == high || low.abs().max(high.abs()) > f64::from(f32::MAX) => {
                "the values of a range must be different 32-bit numbers".into()
            }
            _ if matches!(self.look, Look::Texture(_)) && self.is_deep => {
                "--bits 16 applies to grey pictures and normal maps, not to textures".into()
            }
            _ => match self.look.made_of(&self.slice(None)).tiled() {
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
        refuse(wrong)
    }

    /// The samples at a depth, or of 2D noise.
    #[must_use]
    pub fn slice(&self, depth: Option<f64>) -> Slice {
        let [width, height] = self.size;
        let through = match (self.frames, self.volume) {
            (Some(frames), _) => waves(frames) * self.noise.wavelength,
            (_, Some(slices)) => slices as f64,
            _ => 0.0,
        };
        let repeat = if self.is_tileable { [width as f64, height as f64, through] } else { [0.0; 3] };
        Slice { noise: self.noise, width, depth, stretch: 1.0, repeat }
    }

    /// The depth of a frame. Tileable noise is passed once; in other noise a circular path would need a fourth
    /// dimension, so the path goes forward and back along a cosine.
    #[must_use]
    pub fn depth_of(&self, frame: u32, frames: u32) -> f64 {
        let turn = f64::from(frame) / f64::from(frames);
        let way = match self.is_tileable {
            true => waves(frames) * self.noise.wavelength * turn,
            false => {
                let farthest = f64::from(frames) / 2.0 * self.noise.wavelength / FRAMES_A_WAVELENGTH;
                farthest * (1.0 - libm::cos(std::f64::consts::TAU * turn)) / 2.0
            }
        };
        self.depth.unwrap_or(0.0) + way
    }
}

/// Number of whole wavelengths that an animation passes.
fn waves(frames: u32) -> f64 {
    (f64::from(frames) / FRAMES_A_WAVELENGTH).round().max(1.0)
}

/// How octaves are combined.
fn kind(fractal: &str, options: &Options) -> Kind {
    let number = |name: &str, default: f64| options.number(name).unwrap_or(default);
    let falloff = match options.word("falloff") {
        Some("exponential") => Falloff::Exponential,
        Some("square-root") => Falloff::SquareRoot,
        Some("smoothstep") => Falloff::Smoothstep,
        _ => Falloff::Reciprocal,
    };
    match fractal {
        "ridged" => Kind::Ridged,
        "billow" => Kind::Billow,
        "weighted" => Kind::Weighted { k: number("k", 1.0), falloff },
        "ping-pong" => Kind::PingPong { strength: number("strength", 2.0) },
        "hybrid" => Kind::Hybrid { offset: number("offset", 0.7) },
        "hetero" => Kind::Hetero { offset: number("offset", 0.7) },
        "swiss" => Kind::Swiss { warp: number("warp", 0.15) },
        "jordan" => Kind::Jordan { warp: number("warp", 0.35), damp: number("damp", 0.8) },
        _ => Kind::Fbm,
    }
}

fn refuse<T>(message: String) -> Result<T> {
    Err(Error::new(ErrorKind::Request, message))
}
