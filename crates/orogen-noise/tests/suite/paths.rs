//! Code paths for many points in few cells give the same bits as the general code paths.

use crate::noises::at_each_level;
use orogen_noise::{
    Basis, Classic, ClassicVariant, Depth, Fractal, LengthMismatch, OpenSimplex2, Perlin, Points, Simplex, Value,
    White, Worley,
};

type Fill = Box<dyn Fn(&Points, Option<f64>, &mut [f32]) -> Result<(), LengthMismatch>>;

macro_rules! list {
    ($($noise:expr),* $(,)?) => {
        vec![$({
            let noise = $noise;
            let name = format!("{noise:?}");
            let fill: Fill = Box::new(move |points, z, out| match z {
                None => noise.fill(points, out),
                Some(z) => noise.fill3(points, &Depth::Slice(z), out),
            });
            (name, fill)
        }),*]
    };
}

fn bits(noise: &(String, Fill), points: &Points, z: Option<f64>) -> Vec<u32> {
    let mut out = vec![f32::NAN; points.len()];
    (noise.1)(points, z, &mut out).unwrap();
    out.into_iter().map(f32::to_bits).collect()
}

/// Evaluates only a few points at a time, too few for tables.
fn few(noise: &(String, Fill), x: &[f64], y: &[f64], z: Option<f64>) -> Vec<u32> {
    x.chunks(97).zip(y.chunks(97)).flat_map(|(x, y)| bits(noise, &Points::Scattered { x, y }, z)).collect()
}

/// Random numbers from 0 to 1.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn many_scattered_points_have_the_bits_of_few() {
    let mut state = 7;
    // The center of the points in cells, the number of cells that they cover, the interval of points that are
    // elsewhere, and where these are.
    let places = [
        ((0.0, 0.0), 1.0, 0, 0.0),
        ((0.3, -0.2), 14.9, 0, 0.0),
        ((-3.0, 8.0), 15.9, 301, 40.0),
        ((5.5, -70.0), 11.0, 17, f64::NAN),
        ((-1e6, 1e9), 12.0, 700, f64::INFINITY),
        ((4_294_967_296.0, -4_294_967_296.0), 9.0, 64, -1e300),
        ((1e14, -3e14), 7.0, 1000, 1e15),
        ((1.1e15, -1.1e15), 7.0, 0, 0.0),
        ((0.0, 0.0), 200.0, 0, 0.0),
    ];
    let cases: Vec<(Vec<f64>, Vec<f64>)> = places
        .iter()
        .map(|&((x, y), wide, every, elsewhere)| {
            (0..2731_usize)
                .map(|i| {
                    // Later points are some cells away, and some points are on corners of the lattice.
                    let on = if i > 1500 { 20.0 } else { 0.0 };
                    let mut at = [x + on, y].map(|middle| middle + (random(&mut state) - 0.5) * wide);
                    if i % 29 == 0 {
                        at = at.map(f64::floor);
                    }
                    if every > 0 && i % every == every - 1 {
                        at[i / every % 2] = elsewhere;
                    }
                    (at[0] * 3.7, at[1] * 3.7)
                })
                .unzip()
        })
        .collect();
    at_each_level(|level| {
        let wavelength = 3.7;
        let noises = list![
            Perlin::new(1, wavelength),
            Value::new(2, wavelength),
            White::new(3, wavelength),
            Classic::new(4, wavelength).with_variant(ClassicVariant::Eight),
            Classic::new(5, wavelength).with_variant(ClassicVariant::Angle),
            Simplex::new(6, wavelength),
            Fractal::new(7, wavelength).with_octaves(1),
            Fractal::new(8, wavelength).with_octaves(3),
            Perlin::new(9, -3.7),
            Perlin::new(10, 0.0),
        ];
        for noise in &noises {
            for (number, (x, y)) in cases.iter().enumerate() {
                let (many, few) = (bits(noise, &Points::Scattered { x, y }, None), few(noise, x, y, None));
                assert!(many == few, "{} at level {level}, places {number}", noise.0);
            }
        }
    });
}

#[test]
fn points_around_an_origin_are_near_the_exact_ones() {
    let noise = Perlin::new(11, 3.7);
    let mut state = 9;
    let origins =
        [(0.0, 0.0), (-50.3, 70.9), (2e9 + 0.3, -4e9), (3.7 * 4_294_967_295.5, -3.7 * 4_294_967_296.5), (1e15, 1e15)];
    // The distance between points in wavelengths, and the interval of points that are far away.
    for (wide, every) in [(0.5, 0), (13.0, 0), (12.0, 700), (300.0, 0)] {
        let (x, y): (Vec<f32>, Vec<f32>) = (0..2731_usize)
            .map(|i| {
                let far = if every > 0 && i % every == every - 1 { 90.0 } else { 1.0 };
                let mut at = || ((random(&mut state) - 0.5) * wide * 3.7 * far) as f32;
                (at(), at())
            })
            .unzip();
        for origin in origins {
            let mut expected: Vec<u32> = Vec::new();
            at_each_level(|level| {
                let (mut whole, mut parts) = (vec![f32::NAN; x.len()], vec![f32::NAN; x.len()]);
                noise.fill_around(origin, &x, &y, &mut whole).unwrap();
                for ((x, y), part) in x.chunks(97).zip(y.chunks(97)).zip(parts.chunks_mut(97)) {
                    noise.fill_around(origin, x, y, part).unwrap();
                }
                let found: Vec<u32> = whole.iter().map(|x| x.to_bits()).collect();
                assert!(parts.iter().map(|x| x.to_bits()).eq(found.iter().copied()), "{level}, {origin:?}, {wide}");
                if expected.is_empty() {
                    expected = found;
                } else {
                    assert!(found == expected, "{level}, {origin:?}, {wide}");
                }
                // Far away, the results of the exact method are also only as exact as their positions.
                let allowed = 4.0 * (wide * 90.0 / 16_777_216.0 + (origin.0 / 3.7 * f64::EPSILON).abs()) + 1e-6;
                for (k, found) in whole.iter().enumerate() {
                    let exact = noise.sample(origin.0 + f64::from(x[k]), origin.1 + f64::from(y[k]));
                    assert!(f64::from((found - exact).abs()) <= allowed, "{found} and {exact}, {origin:?}, {wide}");
                }
            });
        }
    }
    // Any arguments give a result.
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e12, -1e12, 0.0, -0.0];
    for (wavelength, origin) in
        [(1.0, (f64::NAN, f64::INFINITY)), (0.0, (1.0, 2.0)), (1e-300, (0.0, 1e300)), (-2.0, (1e18, -1e18))]
    {
        let mut value = [f32::NAN; 512];
        let x: [f32; 512] = std::array::from_fn(|i| odd[i % 8]);
        let y: [f32; 512] = std::array::from_fn(|i| odd[i / 8 % 8]);
        Perlin::new(1, wavelength).fill_around(origin, &x, &y, &mut value).unwrap();
        assert!(value.iter().all(|value| value.abs() <= 1.0), "{wavelength}, {origin:?}");
    }
    let mut value = [7.0; 2];
    assert!(noise.fill_around((0.0, 0.0), &[1.0; 2], &[1.0; 3], &mut value).is_err());
    assert!(noise.fill_around((0.0, 0.0), &[1.0; 3], &[1.0; 3], &mut value).is_err());
    assert_eq!(value, [7.0; 2]);
}

#[test]
fn lattices_of_wide_cells_have_the_bits_of_points() {
    let axis = |start: f64, count: usize| (0..count).map(|i| start + i as f64).collect::<Vec<f64>>();
    let mut mixed = axis(-40.0, 333);
    mixed.swap(3, 5);
    mixed.swap(100, 101);
    mixed[200] = mixed[190];
    let windows = [
        (axis(-300.0, 517), axis(-7.0, 19)),
        (axis(3e9 + 0.25, 270), axis(-2e9, 18)),
        (mixed, axis(0.0, 17)),
        (axis(0.0, 1), axis(-20.0, 40)),
        (axis(-2.0, 15), axis(90.0, 17)),
    ];
    // Whether a point beyond the neighboring cells was the nearest.
    let mut beyond = false;
    at_each_level(|level| {
        for wavelength in [2.5, 7.0, 15.9, 20.0, 33.0, 64.0, 100.0, 777.0] {
            let noises = list![
                Worley::new(1, wavelength),
                Worley::new(2, wavelength).with_jitter(0.3),
                Simplex::new(3, wavelength),
                OpenSimplex2::new(4, wavelength),
                Fractal::new(5, wavelength).with_basis(Basis::Simplex).with_octaves(3),
                Fractal::new(6, wavelength).with_basis(Basis::Worley).with_octaves(1),
            ];
            for (number, (xs, ys)) in windows.iter().enumerate() {
                let lattice = Points::Lattice { xs, ys };
                let (x, y): (Vec<f64>, Vec<f64>) = (0..lattice.len()).map(|k| lattice.position(k).unwrap()).unzip();
                for noise in &noises {
                    for z in [None, Some(-12.25), Some(60.0)] {
                        let (found, expected) = (bits(noise, &lattice, z), few(noise, &x, &y, z));
                        assert!(
                            found == expected,
                            "{} at level {level}, window {number}, z {z:?}, differs first at {:?}",
                            noise.0,
                            found.iter().zip(&expected).position(|(a, b)| a != b)
                        );
                        beyond |= noise.0.starts_with("Worley")
                            && z.is_none()
                            && found.iter().any(|&x| f32::from_bits(x) > std::f32::consts::SQRT_2 - 1.0);
                    }
                }
            }
        }
    });
    assert!(beyond);
}
