//! Noise on graphics cards, compared with the processor.

use orogen_engine::declare::Declared;
use orogen_engine::field::Gullies;
use orogen_engine::lower::Lowering;
use orogen_engine::op::{Field, Inputs, WorldParams};
use orogen_gpu::gpu::Options;
use orogen_gpu::job::{Dispatch, Job};
use orogen_gpu::{Choice, Gpu};
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::lattice::Positions;
use orogen_noise::{
    Basis, Classic, ClassicVariant, Distance, Fade, Falloff, Feature, Fractal, Kind, OpenSimplex2, Perlin, Points,
    Simplex, Smoothness, Value, White, Worley,
};
use std::collections::BTreeSet;
use std::time::Instant;

type Fill = Box<dyn Fn(&Points, &mut [f32])>;

/// A function on the card and on the processor.
struct Noise {
    name: String,
    shader: Shader,
    fill: Fill,
    outliers: Outliers,
}

/// Samples that may differ by more than the others: their maximum share and difference.
#[derive(Clone, Copy, PartialEq)]
struct Outliers {
    share: f64,
    most: f32,
}

/// No outliers.
const SMOOTH: Outliers = Outliers { share: 0.0, most: 0.0 };
/// Values jump between cells, so a sample may be on the other side.
const JUMPS: Outliers = Outliers { share: 1e-3, most: 2.0 };
/// Displacements by the steep slopes of simplex noise grow from octave to octave. Such noise changes by 2e-3 over 5e-8
/// wavelengths on the processor, too.
const STEEP: Outliers = Outliers { share: 5e-2, most: 5e-3 };

macro_rules! noise {
    ($name:expr, $outliers:expr, $noise:expr) => {{
        let noise = $noise;
        let shader = noise.prepare_in(2).shader();
        let fill = move |points: &Points, out: &mut [f32]| noise.fill(points, out).unwrap();
        Noise { name: $name.to_string(), shader, fill: Box::new(fill), outliers: $outliers }
    }};
}

fn kinds(strength: f64) -> Vec<Kind> {
    let weighted = [Falloff::Reciprocal, Falloff::Exponential, Falloff::SquareRoot, Falloff::Smoothstep]
        .map(|falloff| Kind::Weighted { k: strength, falloff });
    let plain = [
        Kind::Fbm,
        Kind::Ridged,
        Kind::Billow,
        Kind::PingPong { strength: 2.0 * strength },
        Kind::Hybrid { offset: 0.7 * strength },
        Kind::Hetero { offset: 0.7 * strength },
        Kind::Swiss { warp: 0.15 * strength },
        Kind::Jordan { warp: 0.35 * strength, damp: 0.8 * strength },
    ];
    plain.into_iter().chain(weighted).collect()
}

/// Every single noise.
fn singles(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = vec![
        noise!("white", JUMPS, White::new(seed, wavelength)),
        noise!("perlin", SMOOTH, Perlin::new(seed, wavelength)),
        noise!("simplex", SMOOTH, Simplex::new(seed, wavelength)),
    ];
    for fade in [Fade::Step, Fade::Linear, Fade::Cubic, Fade::Quintic] {
        let value = Value::new(seed, wavelength).with_fade(fade);
        let outliers = if fade == Fade::Step { JUMPS } else { SMOOTH };
        list.push(noise!(format!("value {fade:?}"), outliers, value));
    }
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        let classic = Classic::new(seed, wavelength).with_variant(variant);
        list.push(noise!(format!("classic {variant:?}"), SMOOTH, classic));
    }
    for smoothness in [Smoothness::Fast, Smoothness::Smooth] {
        let open = OpenSimplex2::new(seed, wavelength).with_smoothness(smoothness);
        list.push(noise!(format!("opensimplex2 {smoothness:?}"), SMOOTH, open));
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let worley = Worley::new(seed, wavelength).with_feature(feature).with_distance(distance);
            let name = format!("worley {feature:?} {distance:?}");
            let outliers = if feature == Feature::Value { JUMPS } else { SMOOTH };
            list.push(noise!(name, outliers, worley.with_jitter(0.9)));
        }
    }
    list
}

/// Every basis in every kind of fractal.
fn fractals(seed: u64, wavelength: f64, octaves: u32, strength: f64) -> Vec<Noise> {
    let mut list = Vec::new();
    for kind in kinds(strength) {
        for &basis in Basis::all() {
            let fractal = Fractal::new(seed, wavelength).with_basis(basis).with_kind(kind).with_octaves(octaves);
            let outliers = match (basis, kind) {
                (Basis::White, _) => JUMPS,
                (Basis::Simplex | Basis::OpenSimplex2, Kind::Swiss { .. } | Kind::Jordan { .. }) => STEEP,
                _ => SMOOTH,
            };
            list.push(noise!(format!("{kind:?} of {}", basis.name()), outliers, fractal));
        }
    }
    list
}

fn all(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = singles(seed, wavelength);
    list.extend(fractals(seed, wavelength, 6, 1.0));
    list
}

/// Samples: their columns and rows, and their displacements.
struct Window {
    name: &'static str,
    size: [usize; 2],
    positions: Positions,
    displaced: [Vec<f32>; 2],
    /// Maximum difference.
    most: f32,
}

impl Window {
    /// A window of square cells whose first sample is at `from`, rotated by an angle whose cosine and sine are given.
    fn new(name: &'static str, size: [usize; 2], from: [f64; 2], cell: f64, [cos, sin]: [f64; 2], most: f32) -> Window {
        let steps = |count: usize, first: f64, by: f64| (0..count).map(|i| first + i as f64 * by).collect::<Vec<f64>>();
        let [columns, rows] = size;
        let straight = sin == 0.0;
        let positions = Positions {
            columns: [
                steps(columns, from[0], cell * cos),
                if straight { vec![] } else { steps(columns, 0.0, cell * sin) },
            ],
            rows: [if straight { vec![] } else { steps(rows, 0.0, -cell * sin) }, steps(rows, from[1], cell * cos)],
        };
        Window { name, size, positions, displaced: [vec![], vec![]].map(|_: Vec<f32>| vec![0.0; columns * rows]), most }
    }

    /// With samples displaced by up to this many metres.
    fn displaced(mut self, metres: f32) -> Window {
        let [dx, dy] = &mut self.displaced;
        for (k, (dx, dy)) in dx.iter_mut().zip(dy).enumerate() {
            let chaos = |factor: f32| ((k as f32 * factor).fract() * 2.0 - 1.0) * metres;
            (*dx, *dy) = (chaos(0.618_034), chaos(0.754_877_7));
        }
        self
    }

    /// Whether samples are displaced from their columns and rows.
    fn is_displaced(&self) -> bool {
        let is_turned = self.positions.columns.iter().all(|columns| !columns.is_empty());
        is_turned || self.displaced.iter().flatten().any(|by| *by != 0.0)
    }

    fn points(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|axis| {
            let at = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
            let [columns, rows] = self.size;
            (0..columns * rows)
                .map(|k| {
                    let position =
                        at(&self.positions.columns[axis], k % columns) + at(&self.positions.rows[axis], k / columns);
                    position + f64::from(self.displaced[axis][k])
                })
                .collect()
        })
    }
}

const STRAIGHT: [f64; 2] = [1.0, 0.0];
const TURNED: [f64; 2] = [0.8, 0.6];

fn windows() -> Vec<Window> {
    vec![
        Window::new("near the origin", [61, 47], [-130.0, -71.5], 7.3, STRAIGHT, 1e-4),
        Window::new("of small cells", [33, 29], [12.25, -3.5], 0.31, STRAIGHT, 1e-4),
        Window::new("of large cells", [33, 29], [-9000.0, 4000.0], 563.7, STRAIGHT, 1e-4),
        Window::new("of one sample", [1, 1], [17.3, -5.1], 1.0, STRAIGHT, 1e-4),
        Window::new("turned", [61, 47], [-130.0, -71.5], 7.3, TURNED, 1e-4),
        Window::new("displaced", [61, 47], [-130.0, -71.5], 7.3, STRAIGHT, 1e-4).displaced(40.0),
        Window::new("turned and displaced", [61, 47], [-130.0, -71.5], 7.3, TURNED, 1e-4).displaced(40.0),
        Window::new("displaced by 10 km", [61, 47], [-130.0, -71.5], 7.3, STRAIGHT, 1e-4).displaced(1e4),
        Window::new("at 1000 km", [61, 47], [1e6, -1e6], 7.3, STRAIGHT, 1e-3),
        Window::new("at 1000 km, turned and displaced", [61, 47], [-1e6, 1e6], 7.3, TURNED, 1e-3).displaced(1e3),
        Window::new("at a million km", [61, 47], [-1e9, 1e9], 7.3, STRAIGHT, 1e-3),
        Window::new("at a million km, turned", [61, 47], [1e9, -1e9], 7.3, TURNED, 1e-3),
    ]
}

/// The text of a kernel that writes the samples of a function from `frame.step` on. The displacements and the
/// function's inputs are before that position.
fn kernel(shader: &Shader, inputs: usize, is_displaced: bool) -> String {
    let (name, code) = shader.function(is_displaced);
    let inputs: String = (0..inputs).map(|i| format!(", samples[at + {}u * count]", 2 + i)).collect();
    format!(
        "{}@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
            if (id.x >= frame.width || id.y >= frame.height) {{ return; }}
            let count = frame.width * frame.height;
            let at = id.y * frame.width + id.x;
            let place = Placement(id.x, id.y, vec2<f32>(samples[at], samples[at + count]));
            samples[frame.step + at] = {name}(frame.base, place{inputs});
        }}",
        code.concat(),
    )
}

/// The samples of functions on the device.
fn computed(gpu: &Gpu, noises: &[Noise], window: &Window, inputs: &[Vec<f32>]) -> Vec<Vec<f32>> {
    let texts: Vec<String> =
        noises.iter().map(|noise| kernel(&noise.shader, inputs.len(), window.is_displaced())).collect();
    let count = window.size[0] * window.size[1];
    let before = 2 + inputs.len();
    // Index 0 means no table.
    let mut data = vec![0];
    let size = window.size.map(|side| side as u32);
    let dispatches = noises.iter().zip(&texts).enumerate().map(|(n, (noise, text))| {
        let base = noise.shader.encode(&window.positions, window.is_displaced(), &mut data);
        Dispatch { text, base, size, step: (count * (before + n)) as u32, ..Dispatch::default() }
    });
    let dispatches = dispatches.collect();
    let downloads = (0..noises.len()).map(|n| (count * (before + n), count)).collect();
    let uploads =
        window.displaced.iter().chain(inputs).enumerate().map(|(i, grid)| (i * count, grid[..].into())).collect();
    let job = Job { data, samples: count * (before + noises.len()), uploads, dispatches, downloads, ..Job::default() };
    job.run(gpu, || false).unwrap().unwrap()
}

/// Compares functions in a window. Returns the maximum difference without outliers and without noises that are
/// [`STEEP`], and the name of the function that has it.
fn compare(gpu: &Gpu, noises: &[Noise], window: &Window, inputs: &[Vec<f32>]) -> (f32, String) {
    let made = computed(gpu, noises, window, inputs);
    let [x, y] = window.points();
    let mut worst = (0.0, String::new());
    for (noise, made) in noises.iter().zip(&made) {
        let mut expect = vec![0.0; x.len()];
        (noise.fill)(&Points::Scattered { x: &x, y: &y }, &mut expect);
        let mut differences: Vec<f32> = made.iter().zip(&expect).map(|(made, expect)| (made - expect).abs()).collect();
        differences.sort_by(f32::total_cmp);
        let Outliers { share, most } = noise.outliers;
        let last = x.len() - 1;
        let usual = differences[last - (x.len() as f64 * share) as usize];
        let about = format!("{} {}: {usual:.1e} off, outliers {:.1e}", noise.name, window.name, differences[last]);
        assert!(usual <= window.most && differences[last] <= most.max(window.most), "{about}");
        if usual > worst.0 && noise.outliers != STEEP {
            worst = (usual, noise.name.clone());
        }
    }
    worst
}

#[test]
fn noises_are_those_of_the_processor() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let noises = all(7, 100.0);
    let texts_of = |is_displaced| noises.iter().map(move |noise| kernel(&noise.shader, 0, is_displaced));
    let undisplaced: BTreeSet<String> = texts_of(false).collect();
    let texts: BTreeSet<String> = texts_of(false).chain(texts_of(true)).collect();
    assert!(texts.len() > undisplaced.len());
    let mut slowest = (0.0, "");
    let mut seen = BTreeSet::new();
    let one = Window::new("of one sample", [1, 1], [0.0; 2], 1.0, STRAIGHT, 1e-4);
    for noise in &noises {
        let (name, _) = noise.shader.function(false);
        if seen.insert(name) {
            let start = Instant::now();
            computed(&gpu, std::slice::from_ref(noise), &one, &[]);
            let took = start.elapsed().as_secs_f64();
            println!("{name} compiled in {took:.3} s");
            if took > slowest.0 {
                slowest = (took, name);
            }
        }
    }
    assert_eq!(gpu.shaders_compiled(), undisplaced.len() as u64);
    println!("{} shaders, the slowest {} in {:.3} s", texts.len(), slowest.1, slowest.0);
    for window in windows() {
        let start = Instant::now();
        let (worst, name) = compare(&gpu, &noises, &window, &[]);
        println!("{}: {worst:.1e} off ({name}), {:.2} s", window.name, start.elapsed().as_secs_f64());
    }
    // Other parameters change only numbers, not shaders.
    let mut others = singles(u64::MAX, 31.7);
    others.extend(fractals(11, 513.0, 3, 0.6));
    others.push(noise!("no octaves", SMOOTH, Fractal::new(1, 10.0).with_octaves(0)));
    others.push(noise!("without a wavelength", SMOOTH, Fractal::new(1, 0.0)));
    others.push(noise!("of many octaves", SMOOTH, Fractal::new(1, 1e5).with_octaves(14).with_lacunarity(1.9)));
    compare(&gpu, &others, &windows()[0], &[]);
    assert_eq!(gpu.shaders_compiled(), texts.len() as u64);
}

#[test]
fn functions_of_one_kernel_have_different_names() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let mut shaders: Vec<Shader> = all(1, 1.0).into_iter().map(|noise| noise.shader).collect();
    let Lowering::Shader(gullies) = Gullies::default().lower(0, &WORLD) else { panic!("gullies are not lowered") };
    shaders.push(gullies);
    let mut parts: Vec<&str> = Vec::new();
    for part in
        shaders.iter().flat_map(|shader| [true, false].map(|is_displaced| shader.function(is_displaced).1)).flatten()
    {
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    let text = parts.concat() + "@compute @workgroup_size(8, 8) fn main() { samples[0] = number(frame.base, 0u); }";
    let dispatches = vec![Dispatch { text: &text, size: [1, 1], ..Dispatch::default() }];
    let job = Job { data: vec![1.5f32.to_bits()], samples: 1, dispatches, downloads: vec![(0, 1)], ..Job::default() };
    assert_eq!(job.run(&gpu, || false).unwrap().unwrap(), [[1.5]]);
}

/// A noise op on the card and on the processor.
macro_rules! op {
    ($($op:ident),*) => {
        vec![$({
            let op = $op::default();
            let Lowering::Shader(shader) = op.lower(0, &WORLD) else { panic!("{} is not lowered", stringify!($op)) };
            assert!(matches!($op { vertical: 1.0, ..op.clone() }.lower(0, &WORLD), Lowering::Processor(_)));
            let fill = move |points: &Points, out: &mut [f32]| {
                op.eval(points, &Inputs::new(op.spec(), &[]), &WORLD, out).unwrap();
            };
            Noise { name: stringify!($op).to_string(), shader, fill: Box::new(fill), outliers: JUMPS }
        }),*]
    };
}

const WORLD: WorldParams = WorldParams { seed: 5, size: None, cell: 1.0, sea_level: 0.0 };

#[test]
fn ops_of_noise_are_lowered() {
    use orogen_engine::field::{
        Billow, Classic, Fbm, Hetero, Hybrid, Jordan, OpenSimplex2, Perlin, PingPong, Ridged, Simplex, Swiss, Value,
        WeightedFbm, White, Worley,
    };
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let ops: Vec<Noise> = op![
        Billow,
        Classic,
        Fbm,
        Hetero,
        Hybrid,
        Jordan,
        OpenSimplex2,
        Perlin,
        PingPong,
        Ridged,
        Simplex,
        Swiss,
        Value,
        WeightedFbm,
        White,
        Worley
    ];
    compare(&gpu, &ops, &windows()[0], &[]);
}

#[test]
fn gullies_are_those_of_the_processor() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    for (number, gullies) in [
        Gullies::default(),
        Gullies { wavelength: 100.0, octaves: 3, assumed_slope: 0.0, detail: 3.0, ..Gullies::default() },
        Gullies { wavelength: 80.0, octaves: 1, normalisation: 1.0, lacunarity: 1.7, ..Gullies::default() },
    ]
    .into_iter()
    .enumerate()
    {
        for mut window in windows() {
            // Depths are multiples of the wavelength.
            window.most *= (gullies.strength * gullies.wavelength) as f32;
            let [x, y] = window.points();
            let land = Fractal::new(3, 900.0);
            let inputs: Vec<Vec<f32>> = [[0.0, 0.0], [0.0; 2], [30.0, 0.0], [-30.0, 0.0], [0.0, 30.0], [0.0, -30.0]]
                .into_iter()
                .enumerate()
                .map(|(i, [east, south])| {
                    let moved = |list: &[f64], by: f64| list.iter().map(|at| at + by).collect::<Vec<f64>>();
                    let mut heights = vec![0.0; x.len()];
                    land.fill(&Points::Scattered { x: &moved(&x, east), y: &moved(&y, south) }, &mut heights).unwrap();
                    let height = if i == 1 { 2.0 } else { 300.0 };
                    heights.iter().map(|noise| noise * height).collect()
                })
                .collect();
            let Lowering::Shader(shader) = gullies.lower(0, &WORLD) else { panic!("gullies are not lowered") };
            let (op, slots) = (gullies.clone(), inputs.clone());
            let fill = move |points: &Points, out: &mut [f32]| {
                let slots: Vec<Option<&[f32]>> = slots.iter().map(|slot| Some(&slot[..])).collect();
                op.eval(points, &Inputs::new(op.spec(), &slots), &WORLD, out).unwrap();
            };
            let noise = Noise { name: format!("gullies {number}"), shader, fill: Box::new(fill), outliers: SMOOTH };
            let (worst, _) = compare(&gpu, &[noise], &window, &inputs);
            println!("gullies {number} {}: {worst:.1e} m off, of {:.1e}", window.name, window.most);
        }
    }
    assert_eq!(gpu.shaders_compiled(), 1);
}
