//! The list of noises for all tests of the public API. To test a new basis, kind, feature or distance, add it here.

use orogen_noise::{
    Basis, Classic, ClassicVariant, Depth, Distance, Fade, Falloff, Feature, Fractal, Kind, LengthMismatch, Level,
    OpenSimplex2, Perlin, Points, Simplex, Smoothness, Value, White, Worley,
};
use std::sync::{Mutex, PoisonError};

/// Values, then slopes along x, y and z.
pub type Columns = [Vec<f32>; 4];

/// The arguments of an evaluation.
pub struct Ask<'a> {
    pub points: Points<'a>,
    /// The depth; `None` in the plane.
    pub depth: Option<Depth<'a>>,
    /// Whether slopes are requested.
    pub slopes: bool,
}

type Fill = Box<dyn Fn(&Ask, &mut Columns) -> Result<(), LengthMismatch>>;

/// The accuracy of a noise's slopes according to its documentation.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Slope {
    /// Zero, or not available.
    Flat,
    /// Exact.
    Exact,
    /// Exact except on creases.
    Creased,
    /// Incomplete.
    Approximate,
}

/// A noise that can be evaluated with any arguments.
pub struct Noise {
    pub name: String,
    pub slope: Slope,
    /// Whether its mean is zero.
    pub centered: bool,
    /// Whether the noise has methods that return slopes.
    offers_slopes: bool,
    fill: Fill,
}

impl Noise {
    /// The results, with columns as long as the points. Columns that were not requested are empty.
    pub fn ask(&self, ask: &Ask) -> Result<Columns, LengthMismatch> {
        let count = ask.points.len();
        let slopes = if ask.slopes && self.offers_slopes { count } else { 0 };
        let mut out =
            [count, slopes, slopes, if ask.depth.is_some() { slopes } else { 0 }].map(|len| vec![f32::NAN; len]);
        (self.fill)(ask, &mut out)?;
        Ok(out)
    }

    /// The maximum absolute values in the plane and in space, as documented.
    pub fn bounds(&self) -> [f32; 2] {
        [1.0, if self.name.starts_with("classic ") { 1.036_36 } else { 1.0 }]
    }

    /// The values in the plane.
    pub fn values(&self, points: &Points) -> Vec<f32> {
        let [values, ..] = self.ask(&Ask { points: *points, depth: None, slopes: false }).unwrap();
        values
    }
}

fn bits(columns: &Columns) -> [Vec<u32>; 4] {
    columns.each_ref().map(|column| column.iter().map(|x| x.to_bits()).collect())
}

/// Whether two results have the same bits in every column that both have.
pub fn same_bits(a: &Columns, b: &Columns) -> bool {
    bits(a).iter().zip(&bits(b)).all(|(a, b)| a.is_empty() || b.is_empty() || a == b)
}

macro_rules! sloped {
    ($noise:expr) => {{
        let noise = $noise;
        let fill: Fill = Box::new(move |ask, [value, dx, dy, dz]| match (&ask.depth, ask.slopes) {
            (None, false) => noise.fill(&ask.points, value),
            (None, true) => noise.fill_with_gradient(&ask.points, value, dx, dy),
            (Some(depth), false) => noise.fill3(&ask.points, depth, value),
            (Some(depth), true) => noise.fill3_with_gradient(&ask.points, depth, value, [dx, dy, dz]),
        });
        (true, fill)
    }};
}

macro_rules! flat {
    ($noise:expr) => {{
        let noise = $noise;
        let fill: Fill = Box::new(move |ask, [value, ..]| match &ask.depth {
            None => noise.fill(&ask.points, value),
            Some(depth) => noise.fill3(&ask.points, depth, value),
        });
        (false, fill)
    }};
}

fn noise(name: impl Into<String>, slope: Slope, (offers_slopes, fill): (bool, Fill)) -> Noise {
    // Noises that count absolute values or distances are one-sided.
    Noise { name: name.into(), slope, centered: true, offers_slopes, fill }
}

impl Noise {
    fn one_sided(self, one_sided: bool) -> Noise {
        Noise { centered: !one_sided, ..self }
    }
}

fn slope_of(basis: Basis, kind: Kind) -> Slope {
    match kind {
        _ if !basis.has_gradient() => Slope::Flat,
        Kind::Fbm => Slope::Exact,
        Kind::Ridged | Kind::Billow | Kind::PingPong { .. } | Kind::Hybrid { .. } => Slope::Creased,
        Kind::Hetero { .. } => Slope::Exact,
        Kind::Weighted { .. } | Kind::Swiss { .. } | Kind::Jordan { .. } => Slope::Approximate,
        _ => unreachable!("{kind:?} has no entry in this list"),
    }
}

/// Every basis as a fractal of one octave, which displaces its lattice and divides by its bound.
pub fn bases(seed: u64, wavelength: f64) -> Vec<Noise> {
    let one = |&basis: &Basis| {
        let fractal = Fractal::new(seed, wavelength).with_basis(basis).with_octaves(1);
        noise(basis.name(), slope_of(basis, Kind::Fbm), sloped!(fractal)).one_sided(basis.name().starts_with("worley"))
    };
    Basis::all().iter().map(one).collect()
}

const FALLOFFS: [Falloff; 4] = [Falloff::Reciprocal, Falloff::Exponential, Falloff::SquareRoot, Falloff::Smoothstep];

/// Every combination of octaves, each with one set of typical parameters.
pub fn kinds() -> Vec<Kind> {
    let weighted = FALLOFFS.map(|falloff| Kind::Weighted { k: 1.5, falloff });
    let plain = [
        Kind::Fbm,
        Kind::Ridged,
        Kind::Billow,
        Kind::PingPong { strength: 2.0 },
        Kind::Hybrid { offset: 0.7 },
        Kind::Hetero { offset: 0.7 },
        Kind::Swiss { warp: 0.15 },
        Kind::Jordan { warp: 0.35, damp: 0.8 },
    ];
    plain.into_iter().chain(weighted).collect()
}

/// Weighted fractals with every falloff.
pub fn damped(k: f64, like: Fractal) -> Vec<Noise> {
    let one = |&falloff: &Falloff| {
        let fractal = like.with_kind(Kind::Weighted { k, falloff });
        noise(format!("{falloff:?}"), slope_of(like.basis, fractal.kind), sloped!(fractal))
    };
    FALLOFFS.iter().map(one).collect()
}

/// Fractals: plain sums over every basis, and every other kind over two bases.
pub fn fractals(like: Fractal) -> Vec<Noise> {
    let mut list = Vec::new();
    for kind in kinds() {
        for &basis in Basis::all() {
            if kind == Kind::Fbm || matches!(basis, Basis::Value | Basis::Perlin | Basis::Simplex) {
                let name = format!("{kind:?} over {}", basis.name());
                let symmetric = matches!(kind, Kind::Fbm | Kind::Weighted { .. });
                let one_sided = !symmetric || basis.name().starts_with("worley");
                let fractal = like.with_basis(basis).with_kind(kind);
                list.push(noise(name, slope_of(basis, kind), sloped!(fractal)).one_sided(one_sided));
            }
        }
    }
    list
}

/// Single noises that are not a basis: lattices at the origin, other fades, cells.
pub fn singles(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = vec![
        noise("white noise", Slope::Flat, sloped!(White::new(seed, wavelength))),
        noise("perlin noise", Slope::Exact, sloped!(Perlin::new(seed, wavelength))),
    ];
    for (fade, slope) in [
        (Fade::Step, Slope::Flat),
        (Fade::Linear, Slope::Creased),
        (Fade::Cubic, Slope::Exact),
        (Fade::Quintic, Slope::Exact),
    ] {
        list.push(noise(format!("value {fade:?}"), slope, sloped!(Value::new(seed, wavelength).with_fade(fade))));
    }
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        let name = format!("classic {variant:?}");
        list.push(noise(name, Slope::Exact, sloped!(Classic::new(seed, wavelength).with_variant(variant))));
    }
    list.push(noise("simplex noise", Slope::Exact, sloped!(Simplex::new(seed, wavelength))));
    for smoothness in [Smoothness::Fast, Smoothness::Smooth] {
        let name = format!("opensimplex2 {smoothness:?}");
        list.push(noise(name, Slope::Exact, sloped!(OpenSimplex2::new(seed, wavelength).with_smoothness(smoothness))));
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let worley = Worley::new(seed, wavelength).with_distance(distance).with_feature(feature).with_jitter(0.9);
            let name = format!("worley {feature:?} {distance:?}");
            list.push(noise(name, Slope::Flat, flat!(worley)).one_sided(feature != Feature::Value));
        }
    }
    list
}

/// Noises that repeat.
pub fn tiled(seed: u64, wavelength: f64) -> Vec<Noise> {
    const PERIOD: [u32; 3] = [6, 3, 2];
    let ridged = Fractal::new(seed, wavelength).with_basis(Basis::ClassicEight).with_kind(Kind::Ridged).with_octaves(3);
    let edges = Worley::new(seed, wavelength).with_feature(Feature::Edge);
    vec![
        noise("tiled white", Slope::Flat, sloped!(White::new(seed, wavelength).tiled(PERIOD).unwrap())),
        noise("tiled perlin", Slope::Exact, sloped!(Perlin::new(seed, wavelength).tiled(PERIOD).unwrap())),
        noise("tiled ridged", Slope::Creased, sloped!(ridged.tiled(PERIOD).unwrap())).one_sided(true),
        noise("tiled edges", Slope::Flat, sloped!(edges.tiled(PERIOD).unwrap())).one_sided(true),
    ]
}

/// All noises that never repeat.
pub fn endless(seed: u64, wavelength: f64) -> Vec<Noise> {
    let fractal = Fractal::new(seed, wavelength).with_octaves(4).with_lacunarity(1.9).with_gain(0.6);
    let mut list = bases(seed, wavelength);
    list.extend(fractals(fractal));
    list.extend(singles(seed, wavelength));
    list
}

/// All noises.
pub fn all(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = endless(seed, wavelength);
    list.extend(tiled(seed, wavelength));
    list
}

/// Runs `law` once per level. Only one such test can force a level at a time.
pub fn at_each_level(mut law: impl FnMut(Level)) {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    for level in Level::available() {
        Level::force(level).unwrap();
        law(level);
    }
}
