//! The one list of noises for the tests that ask as a user asks: a new basis, kind, feature or distance joins every law by being here.

use orogen_noise::{
    Basis, Classic, ClassicVariant, Depth, Distance, Fade, Falloff, Feature, Fractal, Kind, Level, Mismatch, Perlin,
    Points, Value, White, Worley,
};
use std::sync::{Mutex, PoisonError};

/// Values, then slopes along x, y and z.
pub type Columns = [Vec<f32>; 4];

/// What a noise is asked.
pub struct Ask<'a> {
    pub points: Points<'a>,
    /// None in the plane.
    pub depth: Option<Depth<'a>>,
    /// Whether slopes are wanted too.
    pub slopes: bool,
}

type Fill = Box<dyn Fn(&Ask, &mut Columns) -> Result<(), Mismatch>>;

/// A noise that can be asked anything.
pub struct Noise {
    pub name: String,
    /// Whether it offers slopes.
    pub has_slopes: bool,
    fill: Fill,
}

impl Noise {
    /// Answers, in columns of the points' length; those that were not asked for are empty.
    pub fn ask(&self, ask: &Ask) -> Result<Columns, Mismatch> {
        let count = ask.points.len();
        let slopes = if ask.slopes && self.has_slopes { count } else { 0 };
        let mut out =
            [count, slopes, slopes, if ask.depth.is_some() { slopes } else { 0 }].map(|len| vec![f32::NAN; len]);
        (self.fill)(ask, &mut out)?;
        Ok(out)
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

/// Whether two answers agree in every bit of every column that both have.
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

fn noise(name: impl Into<String>, (has_slopes, fill): (bool, Fill)) -> Noise {
    Noise { name: name.into(), has_slopes, fill }
}

/// Every basis by itself: a fractal of one octave, which moves its lattice and divides by its bound.
pub fn bases(seed: u64, wavelength: f64) -> Vec<Noise> {
    let one = |basis| Fractal { basis, seed, wavelength, octaves: 1, ..Fractal::default() };
    Basis::all().iter().map(|&basis| noise(basis.name(), sloped!(one(basis)))).collect()
}

const FALLOFFS: [Falloff; 4] = [Falloff::Reciprocal, Falloff::Exponential, Falloff::SquareRoot, Falloff::Smoothstep];

/// Every way to sum octaves, with one set of usual parameters each.
pub fn kinds() -> Vec<Kind> {
    let weighted = FALLOFFS.map(|falloff| Kind::Weighted { k: 1.5, falloff });
    [Kind::Fbm, Kind::Ridged, Kind::Billow].into_iter().chain(weighted).collect()
}

/// Weighted fractals of every falloff.
pub fn damped(k: f64, like: Fractal) -> Vec<Noise> {
    let one = |falloff| Fractal { kind: Kind::Weighted { k, falloff }, ..like };
    FALLOFFS.iter().map(|&falloff| noise(format!("{falloff:?}"), sloped!(one(falloff)))).collect()
}

/// Fractals: plain sums over every basis, every other kind over two of them.
pub fn fractals(like: Fractal) -> Vec<Noise> {
    let mut list = Vec::new();
    for kind in kinds() {
        for &basis in Basis::all() {
            if kind == Kind::Fbm || matches!(basis, Basis::Value | Basis::Perlin) {
                list.push(noise(format!("{kind:?} over {}", basis.name()), sloped!(Fractal { basis, kind, ..like })));
            }
        }
    }
    list
}

/// What stands for itself and is no basis: lattices on the origin, other fades, cells.
pub fn singles(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = vec![
        noise("white", sloped!(White { seed, wavelength })),
        noise("perlin", sloped!(Perlin { seed, wavelength })),
    ];
    for fade in [Fade::Step, Fade::Linear, Fade::Cubic, Fade::Quintic] {
        list.push(noise(format!("value {fade:?}"), sloped!(Value { seed, wavelength, fade })));
    }
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        list.push(noise(format!("classic {variant:?}"), sloped!(Classic { seed, wavelength, variant })));
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let worley = Worley { seed, wavelength, distance, feature, jitter: 0.9 };
            list.push(noise(format!("worley {feature:?} {distance:?}"), flat!(worley)));
        }
    }
    list
}

/// Noises that repeat.
pub fn tiled(seed: u64, wavelength: f64) -> Vec<Noise> {
    const PERIOD: [u32; 3] = [6, 3, 2];
    let ridged =
        Fractal { basis: Basis::ClassicEight, kind: Kind::Ridged, seed, wavelength, octaves: 3, ..Fractal::default() };
    let edges = Worley { seed, wavelength, feature: Feature::Edge, ..Worley::default() };
    vec![
        noise("tiled white", sloped!(White { seed, wavelength }.tiled(PERIOD).unwrap())),
        noise("tiled perlin", sloped!(Perlin { seed, wavelength }.tiled(PERIOD).unwrap())),
        noise("tiled ridged", sloped!(ridged.tiled(PERIOD).unwrap())),
        noise("tiled edges", sloped!(edges.tiled(PERIOD).unwrap())),
    ]
}

/// All of them.
pub fn all(seed: u64, wavelength: f64) -> Vec<Noise> {
    let fractal = Fractal { seed, wavelength, octaves: 4, lacunarity: 1.9, gain: 0.6, ..Fractal::default() };
    let mut list = bases(seed, wavelength);
    list.extend(fractals(fractal));
    list.extend(singles(seed, wavelength));
    list.extend(tiled(seed, wavelength));
    list
}

/// Runs `law` once per level, while no other law of the process forces one.
pub fn at_each_level(mut law: impl FnMut(Level)) {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    for level in Level::available() {
        Level::force(level).unwrap();
        law(level);
    }
}
