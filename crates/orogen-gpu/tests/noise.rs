//! Noise on graphics cards against the processor's.

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

/// A noise on both.
struct Noise {
    name: String,
    /// Whether values jump, so that a sample may be on the other side of a jump.
    jumps: bool,
    shader: Shader,
    fill: Box<dyn Fn(&Points, &mut [f32])>,
}

macro_rules! noise {
    ($name:expr, $jumps:expr, $noise:expr) => {{
        let noise = $noise;
        let fill = move |points: &Points, out: &mut [f32]| noise.fill(points, out).unwrap();
        Noise { name: $name.to_string(), jumps: $jumps, shader: noise.shader(), fill: Box::new(fill) }
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

/// Every noise by itself.
fn singles(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = vec![
        noise!("white", true, White::new(seed, wavelength)),
        noise!("perlin", false, Perlin::new(seed, wavelength)),
        noise!("simplex", false, Simplex::new(seed, wavelength)),
    ];
    for fade in [Fade::Step, Fade::Linear, Fade::Cubic, Fade::Quintic] {
        let value = Value::new(seed, wavelength).with_fade(fade);
        list.push(noise!(format!("value {fade:?}"), fade == Fade::Step, value));
    }
    for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
        let classic = Classic::new(seed, wavelength).with_variant(variant);
        list.push(noise!(format!("classic {variant:?}"), false, classic));
    }
    for smoothness in [Smoothness::Fast, Smoothness::Smooth] {
        let open = OpenSimplex2::new(seed, wavelength).with_smoothness(smoothness);
        list.push(noise!(format!("opensimplex2 {smoothness:?}"), false, open));
    }
    for feature in [Feature::F1, Feature::F2, Feature::Difference, Feature::Product, Feature::Value, Feature::Edge] {
        for distance in [Distance::Euclidean, Distance::Manhattan, Distance::Chebyshev] {
            let worley = Worley::new(seed, wavelength).with_feature(feature).with_distance(distance);
            let name = format!("worley {feature:?} {distance:?}");
            list.push(noise!(name, matches!(feature, Feature::Value | Feature::Edge), worley.with_jitter(0.9)));
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
            // Displacements follow the slopes of noise whose slopes jump, too.
            let jumps = matches!(basis, Basis::White | Basis::WorleyEdge);
            list.push(noise!(format!("{kind:?} of {}", basis.name()), jumps, fractal));
        }
    }
    list
}

fn all(seed: u64, wavelength: f64) -> Vec<Noise> {
    let mut list = singles(seed, wavelength);
    list.extend(fractals(seed, wavelength, 6, 1.0));
    list
}

/// Samples: their columns and rows, and how far each is displaced.
struct Window {
    name: &'static str,
    size: [usize; 2],
    positions: Positions,
    displaced: [Vec<f32>; 2],
    /// Greatest difference.
    most: f32,
}

impl Window {
    /// A window of square cells whose first sample is at `from`, rotated by an angle whose cosine and sine are given.
    fn new(name: &'static str, size: [usize; 2], from: [f64; 2], cell: f64, [cos, sin]: [f64; 2], most: f32) -> Window {
        let steps = |count: usize, first: f64, by: f64| (0..count).map(|i| first + i as f64 * by).collect::<Vec<f64>>();
        let [columns, rows] = size;
        let straight = sin == 0.0;
        let positions = Positions {
            columns: [steps(columns, from[0], cell * cos), if straight { vec![] } else { steps(columns, 0.0, cell * sin) }],
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

    fn points(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|axis| {
            let at = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
            let [columns, rows] = self.size;
            (0..columns * rows)
                .map(|k| {
                    let position = at(&self.positions.columns[axis], k % columns) + at(&self.positions.rows[axis], k / columns);
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
        Window::new("displaced by 10 km", [61, 47], [-130.0, -71.5], 7.3, STRAIGHT, 1e-3).displaced(1e4),
        Window::new("at 1000 km", [61, 47], [1e6, -1e6], 7.3, STRAIGHT, 1e-3),
        Window::new("at 1000 km, turned and displaced", [61, 47], [-1e6, 1e6], 7.3, TURNED, 1e-3).displaced(1e3),
        Window::new("at a million km", [61, 47], [-1e9, 1e9], 7.3, STRAIGHT, 1e-3),
        Window::new("at a million km, turned", [61, 47], [1e9, -1e9], 7.3, TURNED, 1e-3),
    ]
}

/// The text of a kernel that writes a noise's samples from `frame.step` on. The displacements come first.
fn kernel(shader: &Shader) -> String {
    let mut text = shader.code.concat();
    text += "@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n\
        if (id.x >= frame.width || id.y >= frame.height) { return; }\n\
        let at = id.y * frame.width + id.x;\n\
        let moved = vec2<f32>(samples[at], samples[at + frame.width * frame.height]);\n\
        samples[frame.step + at] = ";
    text += shader.name;
    text += "(frame.base, Place(id.x, id.y, moved));\n}\n";
    text
}

/// The samples of noises on the device.
fn computed(gpu: &Gpu, noises: &[Noise], window: &Window) -> Vec<Vec<f32>> {
    let texts: Vec<String> = noises.iter().map(|noise| kernel(&noise.shader)).collect();
    let count = window.size[0] * window.size[1];
    // Index 0 stands for tables that are not there.
    let mut data = vec![0];
    let size = window.size.map(|side| side as u32);
    let dispatches = noises.iter().zip(&texts).enumerate().map(|(n, (noise, text))| {
        let base = noise.shader.encode(&window.positions, &mut data);
        Dispatch { text, base, size, step: (count * (2 + n)) as u32 }
    });
    let dispatches = dispatches.collect();
    let downloads = (0..noises.len()).map(|n| (count * (2 + n), count)).collect();
    let [dx, dy] = &window.displaced;
    let uploads: Vec<(usize, &[f32])> = vec![(0, dx), (count, dy)];
    let job = Job { data, samples: count * (2 + noises.len()), uploads, dispatches, downloads };
    job.run(gpu, || false).unwrap().unwrap()
}

/// Compares noises in a window; returns the worst difference of samples that are not beyond a jump, and its noise.
fn compare(gpu: &Gpu, noises: &[Noise], window: &Window) -> (f32, String) {
    let made = computed(gpu, noises, window);
    let [x, y] = window.points();
    let mut worst = (0.0, String::new());
    for (noise, made) in noises.iter().zip(&made) {
        let mut expect = vec![0.0; x.len()];
        (noise.fill)(&Points::Scattered { x: &x, y: &y }, &mut expect);
        let mut differences: Vec<f32> = made.iter().zip(&expect).map(|(made, expect)| (made - expect).abs()).collect();
        assert!(made.iter().all(|value| value.abs() <= 1.0), "{} {}: beyond 1", noise.name, window.name);
        differences.sort_by(f32::total_cmp);
        // Samples at jumps may be on the other side.
        let aside = if noise.jumps { x.len() / 1000 } else { 0 };
        let most = differences[x.len() - 1 - aside];
        if std::env::var_os("NOISE_DIFFERENCES").is_some() {
            println!("{:8.1e} {:8.1e} {} {}", most, differences[x.len() - 1], noise.name, window.name);
        } else {
            assert!(most <= window.most, "{} {}: {most} off", noise.name, window.name);
        }
        if most > worst.0 {
            worst = (most, noise.name.clone());
        }
    }
    worst
}

#[test]
fn noises_are_those_of_the_processor() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let noises = all(7, 100.0);
    let texts: BTreeSet<String> = noises.iter().map(|noise| kernel(&noise.shader)).collect();
    let mut slowest = (0.0, "");
    let mut seen = BTreeSet::new();
    let one = Window::new("of one sample", [1, 1], [0.0; 2], 1.0, STRAIGHT, 1e-4);
    for noise in &noises {
        if seen.insert(noise.shader.name) {
            let start = Instant::now();
            computed(&gpu, std::slice::from_ref(noise), &one);
            let took = start.elapsed().as_secs_f64();
            println!("{} compiled in {took:.3} s", noise.shader.name);
            if took > slowest.0 {
                slowest = (took, noise.shader.name);
            }
        }
    }
    assert_eq!(gpu.shaders_compiled(), texts.len() as u64);
    println!("{} shaders, the slowest {} in {:.3} s", texts.len(), slowest.1, slowest.0);
    for window in windows() {
        let start = Instant::now();
        let (worst, name) = compare(&gpu, &noises, &window);
        println!("{}: {worst:.1e} off ({name}), {:.2} s", window.name, start.elapsed().as_secs_f64());
    }
    // Other parameters are other numbers.
    let mut others = singles(u64::MAX, 31.7);
    others.extend(fractals(11, 513.0, 3, 0.6));
    others.push(noise!("no octaves", false, Fractal::new(1, 10.0).with_octaves(0)));
    others.push(noise!("without a wavelength", false, Fractal::new(1, 0.0)));
    others.push(noise!("of many octaves", false, Fractal::new(1, 1e5).with_octaves(14).with_lacunarity(1.9)));
    compare(&gpu, &others, &Window::new("near the origin", [61, 47], [-130.0, -71.5], 7.3, STRAIGHT, 1e-4));
    assert_eq!(gpu.shaders_compiled(), texts.len() as u64);
}
