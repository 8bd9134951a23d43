//! Reference implementations of every noise in f64, as in textbooks. Values are compared with them, and gradients with
//! differences of values.

use crate::programs::{programs, run};
use crate::rng::Rng;
use orogen_noise::internals::reference::{self, TABLE};
use orogen_noise::internals::{Combine, Octave, Program, Shape, Source, directions, program};
use orogen_noise::{Classic, ClassicVariant, Depth, Fade, Falloff, Fractal, Kind, Level, Points, Smoothness, Value};

fn lerp(t: f64, a: f64, b: f64) -> f64 {
    a + t * (b - a)
}

fn quintic(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// `ImprovedNoise.noise` of the 2002 reference, with the same operations.
fn improved_noise(x: f64, y: f64, z: f64) -> f64 {
    let p = |i: i64| i64::from(TABLE[(i & 255) as usize]);
    let grad = |hash: i64, x: f64, y: f64, z: f64| {
        let h = hash & 15;
        let u = if h < 8 { x } else { y };
        let v = if h < 4 {
            y
        } else if h == 12 || h == 14 {
            x
        } else {
            z
        };
        (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
    };
    let cell = |c: f64| c.floor() as i64 & 255;
    let (cx, cy, cz) = (cell(x), cell(y), cell(z));
    let (x, y, z) = (x - x.floor(), y - y.floor(), z - z.floor());
    let (u, v, w) = (quintic(x), quintic(y), quintic(z));
    let (a, b) = (p(cx) + cy, p(cx + 1) + cy);
    let (aa, ab, ba, bb) = (p(a) + cz, p(a + 1) + cz, p(b) + cz, p(b + 1) + cz);
    lerp(
        w,
        lerp(
            v,
            lerp(u, grad(p(aa), x, y, z), grad(p(ba), x - 1.0, y, z)),
            lerp(u, grad(p(ab), x, y - 1.0, z), grad(p(bb), x - 1.0, y - 1.0, z)),
        ),
        lerp(
            v,
            lerp(u, grad(p(aa + 1), x, y, z - 1.0), grad(p(ba + 1), x - 1.0, y, z - 1.0)),
            lerp(u, grad(p(ab + 1), x, y - 1.0, z - 1.0), grad(p(bb + 1), x - 1.0, y - 1.0, z - 1.0)),
        ),
    )
}

/// Published values of the 2002 reference, which are tests of independent ports. The first is from Rosetta Code
/// ("Perlin noise"), and most ports use it. The values up to the origin are from ports to Zig; one of them has the
/// positions of the first two at z = 0, where the sign of the second one changes. There is one value at a negative
/// position, and one beyond the 256 entries of the table.
const PUBLISHED: [([f64; 3], f64); 9] = [
    #[allow(clippy::approx_constant)] // no pi: the place of the published value
    ([3.14, 42.0, 7.0], 0.136_919_958_784_000_12),
    ([-4.2, 10.0, 6.0], 0.142_080_000_000_000_43),
    #[allow(clippy::approx_constant)]
    ([3.14, 42.0, 0.0], 0.136_919_958_784_000_12),
    ([-4.2, 10.0, 0.0], -0.142_080_000_000_000_43),
    ([123.64, 456.3, 567.69], 0.207_417_247_084_922_98),
    ([0.0, -37.603, 0.0], -0.461_327_430_182_440_55),
    ([0.5, 0.5, 0.5], -0.25),
    ([0.1, 0.1, 0.1], 0.186_160_714_354_483_2),
    ([-1.0, -1.0, -1.0], 0.0),
];

/// Published values along the diagonal x = y = z, from a port to Java that first rounds positions to f32.
const PUBLISHED_DIAGONAL: [(f32, f64); 11] = [
    (0.1, 0.186_160_716_667_925_97),
    (0.5, -0.25),
    (1.25, -0.395_530_935_376_882_55),
    (1.5, -0.5),
    (2.3, 0.303_202_912_418_742_1),
    (2.5, 0.25),
    (3.65, 0.171_395_828_917_756_95),
    (3.3, -0.413_601_658_234_819_9),
    (4.5, -0.125),
    (4.7, -0.106_944_244_036_597_89),
    (5.0, 0.0),
];

#[test]
fn the_reference_values_are_met() {
    let diagonal = PUBLISHED_DIAGONAL.map(|(at, value)| ([f64::from(at); 3], value));
    let noise = Classic::default();
    let near = |[x, y, z]: [f64; 3], expected: f64| {
        let found = f64::from(noise.sample3(x, y, z));
        assert!((found - expected).abs() < 1e-6, "({x}, {y}, {z}): {found} is not {expected}");
    };
    for ([x, y, z], published) in PUBLISHED.into_iter().chain(diagonal) {
        assert_eq!(improved_noise(x, y, z), published, "({x}, {y}, {z})");
        near([x, y, z], published);
    }
    let mut rng = Rng(1);
    for _ in 0..20_000 {
        let at = [0; 3].map(|_| rng.between(-300.0, 300.0));
        near(at, improved_noise(at[0], at[1], at[2]));
    }
}

/// The hash of a lattice point. `cells` has an entry for each dimension.
pub fn hash(source: Source, octave: &Octave, cells: &[f64]) -> u32 {
    if let Source::Classic(_) = source {
        let step = |sum: u32, (cell, words): (&f64, &[u32; 2])| {
            TABLE[(sum.wrapping_add(*cell as i64 as u32).wrapping_add(words[0]) & 255) as usize]
        };
        return cells.iter().zip(&octave.words).fold(0, step);
    }
    let joined = cells.iter().zip(&octave.words).fold(0, |joined, (cell, words)| {
        let bits = (cell + 6_755_399_441_055_744.0).to_bits();
        let (low, high) = (bits as u32, (bits >> 32) as u32);
        let first = low.wrapping_mul(0x915F_77F5).wrapping_add(words[0]);
        joined ^ (first ^ first >> 15 ^ high ^ words[1]).wrapping_mul(0x93D7_65DD)
    });
    (joined ^ joined >> 15).wrapping_mul(0xADB4_A92D)
}

/// The contribution of a lattice point at an offset from it.
fn corner(source: Source, octave: &Octave, cells: &[f64], from: &[f64]) -> f64 {
    let hash = hash(source, octave, cells);
    let dot = |gradient: &[f64]| gradient.iter().zip(from).map(|(g, d)| g * d).sum::<f64>();
    let pick = |tables: &[&[f32]], i: usize| -> Vec<f64> { tables.iter().map(|table| f64::from(table[i])).collect() };
    match source {
        Source::Value(_) => f64::from(hash as i32) / 2_147_483_648.0 * (1.0 - 1.0 / 1_048_576.0),
        Source::Perlin => {
            let sign = if hash >> 31 == 1 { -1.0 } else { 1.0 };
            let index = (hash >> 27 & 15) as usize;
            match from.len() {
                2 => {
                    // 16 directions, 22.5 degrees apart, scaled to a maximum of 1.
                    let angle = (f64::from(hash >> 28 & 7) + 0.5) * std::f64::consts::PI / 8.0;
                    sign * 1.438_117_6 * dot(&[libm::cos(angle), libm::sin(angle)])
                }
                3 => sign * dot(&pick(&[&directions::X_3D, &directions::Y_3D, &directions::Z_3D], index)),
                _ => {
                    let tables: [&[f32]; 4] =
                        [&directions::X_4D, &directions::Y_4D, &directions::Z_4D, &directions::W_4D];
                    sign * dot(&pick(&tables, index))
                }
            }
        }
        Source::OpenSimplex2(_) if from.len() == 4 => corner(Source::Perlin, octave, cells, from),
        Source::OpenSimplex2(_) => {
            let twelfths = (hash >> 16) * 12;
            let index = (twelfths >> 16) as usize;
            let sign = |bit: u32| if twelfths >> bit & 1 == 1 { -1.0 } else { 1.0 };
            if from.len() == 2 {
                let angle = (index as f64 + 0.5) * std::f64::consts::PI / 12.0;
                sign(15) * dot(&[libm::cos(angle), libm::sin(angle)])
            } else {
                let sizes = pick(&[&directions::OPEN_X_3D, &directions::OPEN_Y_3D, &directions::OPEN_Z_3D], index);
                dot(&[sign(15) * sizes[0], sign(14) * sizes[1], sign(13) * sizes[2]])
            }
        }
        Source::Simplex => corner(Source::Perlin, octave, cells, from),
        // These have a separate reference implementation.
        Source::Worley(_) => 0.0,
        Source::Classic(_) if from.len() == 4 => {
            // As in the 4D reference.
            let axes = [[0, 1, 2], [3, 0, 1], [2, 3, 0], [1, 2, 3]][(hash >> 3 & 3) as usize];
            (0..3).map(|k| if hash >> (2 - k) & 1 == 0 { from[axes[k]] } else { -from[axes[k]] }).sum()
        }
        Source::Classic(_) if from.len() == 3 => dot(&pick(
            &[&reference::REFERENCE_X, &reference::REFERENCE_Y, &reference::REFERENCE_Z],
            (hash & 15) as usize,
        )),
        Source::Classic(ClassicVariant::Angle) => {
            let angle = f64::from(hash) * std::f64::consts::PI / 128.0;
            dot(&[libm::cos(angle), libm::sin(angle)]) * std::f64::consts::SQRT_2
        }
        Source::Classic(ClassicVariant::Diagonal) => {
            // As in ports of the reference: u and v are x and y, or swapped, each with a sign.
            let (u, v) = if hash & 7 < 4 { (from[0], from[1]) } else { (from[1], from[0]) };
            (if hash & 1 == 0 { u } else { -u }) + (if hash & 2 == 0 { v } else { -v })
        }
        Source::Classic(ClassicVariant::Eight) => {
            dot(&pick(&[&reference::EIGHT_X, &reference::EIGHT_Y], (hash & 7) as usize))
        }
        Source::Classic(variant) => unreachable!("{variant:?} has no reference implementation"),
    }
}

/// Noise on corners of simplices, computed slowly with every corner of a lattice that may contribute.
fn corners_at(source: Source, octave: &Octave, at: &[f64]) -> f64 {
    let n = at.len();
    let smooth = matches!(source, Source::OpenSimplex2(Smoothness::Smooth));
    let reach = if smooth { [2.0 / 3.0, 0.75, 0.8][n - 2] } else { 0.5 };
    let scale = match source {
        Source::Simplex => [69.129_1, 93.230_6, 96.463_1],
        _ if smooth => [18.241_9, 11.867_1, 8.491_0],
        _ => [99.836_6, 108.291_0, 96.463_1],
    }[n - 2];
    let cubes = n == 3 && !matches!(source, Source::Simplex);
    // For each lattice: the position of the sample in it, the length that is subtracted for a step along all axes, and
    // the salt that distinguishes the lattices.
    let lattices: Vec<(Vec<f64>, f64, u32)> = if cubes {
        let third = 1.0 / libm::sqrt(3.0);
        let both = (at[0] + at[1]) * (third - 1.0) / 2.0 + at[2] * third;
        let turned = [at[0] + both, at[1] + both, (at[2] - at[0] - at[1]) * third];
        vec![(turned.to_vec(), 0.0, 0), (turned.map(|x| x - 0.5).to_vec(), 0.0, 0x5851_F42D)]
    } else {
        let root = libm::sqrt(n as f64 + 1.0);
        let skew = at.iter().sum::<f64>() * (root - 1.0) / n as f64;
        vec![(at.iter().map(|x| x + skew).collect(), (1.0 - 1.0 / root) / n as f64, 0)]
    };
    let mut sum = 0.0;
    for (place, unskew, salt) in lattices {
        for number in 0..4_usize.pow(n as u32) {
            let cells: Vec<f64> =
                (0..n).map(|axis| place[axis].floor() + f64::from(number as u32 >> (2 * axis) & 3) - 1.0).collect();
            let way: Vec<f64> = place.iter().zip(&cells).map(|(place, cell)| place - cell).collect();
            let back = way.iter().sum::<f64>() * unskew;
            let way: Vec<f64> = way.iter().map(|x| x - back).collect();
            let left = reach - way.iter().map(|x| x * x).sum::<f64>();
            if left > 0.0 {
                // The second lattice of cubes has the same keys, except for these bits.
                let mut octave = *octave;
                let hashed = if salt == 0 { cells.clone() } else { salted(&mut octave, &cells, salt) };
                sum += left * left * left * left * corner(source, &octave, &hashed, &way);
            }
        }
    }
    sum * scale
}

/// An octave and cells whose combined keys equal those of the given ones xor the salt. The key along x is chosen
/// accordingly.
fn salted(octave: &mut Octave, cells: &[f64], salt: u32) -> Vec<f64> {
    let key = |words: &[u32; 2], cell: f64| {
        let bits = (cell + 6_755_399_441_055_744.0).to_bits();
        let (low, high) = (bits as u32, (bits >> 32) as u32);
        let first = low.wrapping_mul(0x915F_77F5).wrapping_add(words[0]);
        (first, high, (first ^ first >> 15 ^ high ^ words[1]).wrapping_mul(0x93D7_65DD))
    };
    let (first, high, wanted) = key(&octave.words[0], cells[0]);
    // Reverts the last multiplication with the inverse of an odd number modulo 2^32, by Newton's method.
    let mut inverse = 0x93D7_65DD_u32;
    for _ in 0..5 {
        inverse = inverse.wrapping_mul(2_u32.wrapping_sub(0x93D7_65DD_u32.wrapping_mul(inverse)));
    }
    octave.words[0][1] = (wanted ^ salt).wrapping_mul(inverse) ^ first ^ first >> 15 ^ high;
    cells.to_vec()
}

/// One octave without its amplitude, at coordinates in cells.
fn octave_at(source: Source, octave: &Octave, at: &[f64]) -> f64 {
    if matches!(source, Source::Simplex | Source::OpenSimplex2(_)) {
        return corners_at(source, octave, at);
    }
    let mut sum = 0.0;
    for corner_bits in 0..1 << at.len() {
        let (mut cells, mut from, mut weight) = (Vec::new(), Vec::new(), 1.0);
        for (axis, u) in at.iter().enumerate() {
            let step = f64::from(corner_bits >> axis & 1);
            let t = u - u.floor();
            let fade = match source {
                Source::Value(Fade::Step) => 0.0,
                Source::Value(Fade::Linear) => t,
                Source::Value(Fade::Cubic) => t * t * (3.0 - 2.0 * t),
                _ => quintic(t),
            };
            weight *= if step == 1.0 { fade } else { 1.0 - fade };
            let (cell, period) = (u.floor() + step, octave.period[axis]);
            cells.push(if period > 0.0 { cell.rem_euclid(period) } else { cell });
            from.push(t - step);
        }
        sum += weight * corner(source, octave, &cells, &from);
    }
    sum
}

/// The value of a whole program at a position in metres.
fn twin(program: &Program, position: &[f64]) -> f64 {
    let coordinates = |octave: &Octave| -> Vec<f64> {
        position.iter().zip(octave.offset).map(|(x, offset)| x * octave.frequency + offset).collect()
    };
    let values =
        || program.octaves().iter().map(|o| f64::from(o.amplitude) * octave_at(program.source, o, &coordinates(o)));
    match program.combine {
        Combine::Sum => values().sum(),
        Combine::Sizes { sign } => (values().map(f64::abs).sum::<f64>() - 1.0) * f64::from(sign),
        Combine::Weighted { k, falloff, .. } => {
            let mut slope = vec![0.0; position.len()];
            let mut sum = 0.0;
            for (octave, value) in program.octaves().iter().zip(values()) {
                let at = coordinates(octave);
                for (axis, slope) in slope.iter_mut().enumerate() {
                    *slope += f64::from(octave.slope)
                        * difference(&at, axis, 1e-5, |at| octave_at(program.source, octave, at));
                }
                let m = slope.iter().map(|d| d * d).sum::<f64>();
                let k = f64::from(k);
                sum += value
                    * match falloff {
                        Falloff::Reciprocal => 1.0 / (1.0 + k * m),
                        Falloff::Exponential => libm::exp(-k * m),
                        Falloff::SquareRoot => 1.0 / (1.0 + k * m.sqrt()),
                        Falloff::Smoothstep => {
                            let t = (k * m).min(1.0);
                            1.0 - t * t * (3.0 - 2.0 * t)
                        }
                        _ => unreachable!("{falloff:?} has no reference implementation"),
                    };
            }
            sum
        }
        Combine::Shaped { shape, scale, .. } => shaped(program, shape, f64::from(scale), &coordinates),
    }
}

/// The shapes as documented in [`Kind`].
fn shaped(program: &Program, shape: Shape, scale: f64, coordinates: &dyn Fn(&Octave) -> Vec<f64>) -> f64 {
    let (mut h, mut w, mut d) = (0.0_f64, 1.0_f64, [0.0; 4]);
    for octave in program.octaves() {
        let mut at = coordinates(octave);
        let noise = |at: &[f64]| f64::from(octave.amplitude) * octave_at(program.source, octave, at);
        let (gain, ratio) = (f64::from(octave.gain), octave.ratio);
        let moved = match shape {
            Shape::Swiss { warp } => f64::from(warp) * ratio,
            Shape::Jordan { warp, .. } => f64::from(warp),
            _ => 0.0,
        };
        for (u, d) in at.iter_mut().zip(&d) {
            *u += moved * d;
        }
        let n = noise(&at);
        let slopes: Vec<f64> = (0..at.len()).map(|axis| difference(&at, axis, 1e-5, noise)).collect();
        match shape {
            Shape::PingPong { strength } => {
                let t = (f64::from(strength) * (n + 1.0)).rem_euclid(2.0);
                h += gain * (2.0 * t.min(2.0 - t) - 1.0);
            }
            Shape::Hybrid { offset } => {
                let s = gain * (n + f64::from(offset));
                h += w * s;
                w = (w * s).clamp(0.0, 1.0);
            }
            Shape::Hetero { offset } => {
                let s = gain * (n + f64::from(offset));
                h += w * s;
                w = h;
            }
            Shape::Swiss { .. } => {
                let a = w * gain;
                h += a * (1.0 - n.abs());
                d.iter_mut().zip(&slopes).for_each(|(d, slope)| *d -= a * n * slope);
                w *= h.clamp(0.0, 1.0);
            }
            Shape::Jordan { damp, .. } => {
                h += gain * w * n * n;
                d.iter_mut().zip(&slopes).for_each(|(d, slope)| *d += n * slope);
                let damped = d.iter().map(|d| d * d).sum::<f64>() * f64::from(damp) * f64::from(damp);
                w = 1.0 - 1.0 / (1.0 + damped);
            }
        }
    }
    match shape {
        Shape::Swiss { .. } | Shape::Jordan { .. } => 2.0 * h * scale - 1.0,
        _ => h * scale,
    }
}

fn difference(at: &[f64], axis: usize, step: f64, f: impl Fn(&[f64]) -> f64) -> f64 {
    let [mut ahead, mut behind] = [at.to_vec(), at.to_vec()];
    ahead[axis] += step;
    behind[axis] -= step;
    (f(&ahead) - f(&behind)) / (ahead[axis] - behind[axis])
}

#[test]
fn values_and_gradients_are_those_of_the_twins() {
    const WAVELENGTH: f64 = 37.0;
    for dims in 2..=4 {
        for (name, program) in programs(WAVELENGTH, dims) {
            if matches!(program.source, Source::Worley(_)) {
                continue;
            }
            let mut rng = Rng(7);
            let n = [600, 600, 60][dims - 2];
            let mut axis = || (0..n).map(|_| rng.between(-2000.0, 2000.0)).collect::<Vec<f64>>();
            let (x, y, z, w) = (axis(), axis(), axis(), axis());
            let points = Points::Scattered { x: &x, y: &y };
            let depths = &[Depth::Each(&z), Depth::Each(&w)][..dims - 2];
            let out = run(Level::current(), &program, &points, depths, true);
            let weighted = matches!(program.combine, Combine::Weighted { .. }) || program.combine.moves();
            let creased = matches!(program.combine, Combine::Sizes { .. } | Combine::Shaped { .. });
            let on_simplices = matches!(program.source, Source::Simplex | Source::OpenSimplex2(_));
            let (mut error, mut size) = (0.0, 0.0);
            for k in 0..n {
                let position = [x[k], y[k], z[k], w[k]];
                let position = &position[..dims];
                let expected = twin(&program, position);
                let tolerance = match () {
                    // Positions are displaced by slopes, which are f32 and steep.
                    () if program.combine.moves() => 1e-4,
                    () if weighted || creased || on_simplices => 3e-6,
                    () => 1e-6,
                };
                assert!(
                    (f64::from(out[0][k]) - expected).abs() < tolerance,
                    "{name} at {position:?}: {} is not {expected}",
                    out[0][k]
                );
                // There is no slope to compare with if a crease is within the step, or at the edge of a step or linear
                // fade.
                let fade_edge = matches!(program.source, Source::Value(Fade::Step | Fade::Linear));
                if weighted || fade_edge {
                    continue;
                }
                for axis in 0..position.len() {
                    let central = difference(position, axis, WAVELENGTH * 1e-5, |at| twin(&program, at));
                    let found = f64::from(out[1 + axis][k]);
                    if creased {
                        let wider = difference(position, axis, WAVELENGTH * 2e-5, |at| twin(&program, at));
                        if (wider - central).abs() * WAVELENGTH > 1e-2 {
                            continue;
                        }
                    }
                    error += (found - central) * (found - central);
                    size += central * central;
                }
            }
            if size > 0.0 {
                let relative = libm::sqrt(error / size);
                assert!(relative < 1e-3, "{name}, {dims} dimensions: the gradient is {relative} off");
            }
        }
    }
}

#[test]
fn the_linear_fade_has_its_slope_inside_cells() {
    let noise = Value::new(3, 10.0).with_fade(Fade::Linear);
    let program = program(noise.prepare_in(2));
    let (mut value, mut dx, mut dy) = ([0.0], [0.0], [0.0]);
    let points = Points::Scattered { x: &[33.0], y: &[-7.5] };
    noise.fill_with_gradient(&points, &mut value, &mut dx, &mut dy).unwrap();
    for (axis, found) in [dx[0], dy[0]].into_iter().enumerate() {
        let central = difference(&[33.0, -7.5], axis, 1e-3, |at| twin(&program, at));
        assert!((f64::from(found) - central).abs() < 1e-5);
    }
}

#[test]
fn the_weighted_gradient_without_weights_is_the_plain_one() {
    let plain = Fractal::new(0, 50.0).with_octaves(5);
    let weighted = plain.with_kind(Kind::Weighted { k: 0.0, falloff: Falloff::Reciprocal });
    let x: Vec<f64> = (0..200).map(|i| f64::from(i) * 1.7).collect();
    let points = Points::Lattice { xs: &x, ys: &x[..3] };
    let run = |noise: &Fractal| {
        let mut out = [0; 3].map(|_| vec![0.0_f32; points.len()]);
        let [value, dx, dy] = &mut out;
        noise.fill_with_gradient(&points, value, dx, dy).unwrap();
        out
    };
    for (a, b) in run(&plain).iter().flatten().zip(run(&weighted).iter().flatten()) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

/// The maximum of a gradient noise whose gradients can be chosen freely: the sum of the maxima of the corners. It is
/// found by search on a fine grid, and on finer and finer grids around the best position.
fn supremum(gradients: &[Vec<f64>]) -> f64 {
    let axes = gradients[0].len();
    let value = |at: &[f64]| {
        (0..1_u32 << axes)
            .map(|corner| {
                let step = |axis: usize| f64::from(corner >> axis & 1);
                let weight: f64 = (0..axes)
                    .map(|axis| if step(axis) == 1.0 { quintic(at[axis]) } else { 1.0 - quintic(at[axis]) })
                    .product();
                let best = gradients
                    .iter()
                    .map(|g| (0..axes).map(|axis| g[axis] * (at[axis] - step(axis))).sum::<f64>())
                    .fold(f64::MIN, f64::max);
                weight * best
            })
            .sum::<f64>()
    };
    let (mut best, mut center, mut span) = (f64::MIN, vec![0.5; axes], 0.5);
    for _ in 0..10 {
        let from = center.clone();
        let side = 17_i32;
        for k in 0..side.pow(axes as u32) {
            let at: Vec<f64> = (0..axes)
                .map(|axis| {
                    let place = k / side.pow(axis as u32) % side;
                    (from[axis] + span * (f64::from(place) / 8.0 - 1.0)).clamp(0.0, 1.0)
                })
                .collect();
            let found = value(&at);
            if found > best {
                (best, center) = (found, at);
            }
        }
        span /= 3.0;
    }
    best
}

#[test]
fn the_stated_maxima_are_the_true_ones() {
    let columns = |tables: &[&[f32]]| -> Vec<Vec<f64>> {
        (0..tables[0].len()).map(|i| tables.iter().map(|table| f64::from(table[i])).collect()).collect()
    };
    let both = |half: Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        half.iter().cloned().chain(half.iter().map(|g| g.iter().map(|x| -x).collect())).collect()
    };
    let near = |found: f64, stated: f64| assert!((found - stated).abs() < 3e-6, "{found} is not {stated}");
    near(supremum(&both(columns(&[&directions::X_2D, &directions::Y_2D]))), 1.0);
    near(supremum(&both(columns(&[&directions::X_3D, &directions::Y_3D, &directions::Z_3D]))), 1.0);
    near(supremum(&columns(&[&reference::DIAGONAL_X, &reference::DIAGONAL_Y])), 1.0);
    near(supremum(&columns(&[&reference::EIGHT_X, &reference::EIGHT_Y])), 1.0);
    let angles: Vec<f32> = (0..256).map(|i| reference::SINE[(i + 64) & 255]).collect();
    near(supremum(&columns(&[&angles, &reference::SINE])), 1.0);
    near(
        supremum(&columns(&[&reference::REFERENCE_X, &reference::REFERENCE_Y, &reference::REFERENCE_Z])),
        reference::BOUND_3D,
    );
}
