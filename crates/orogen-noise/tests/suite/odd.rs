//! Odd arguments: every level and every method returns finite numbers within the bounds, or an error.

use crate::noises::{Ask, Columns, Noise, all, at_each_level, damped, fractals, same_bits};
use orogen_noise::{Basis, Depth, Fractal, LengthMismatch, MAX_OCTAVES, Perlin, Points};

/// Positions that do not occur on maps.
const PLACES: [f64; 12] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    -1e300,
    4.5e15,
    5e-324,
    12.75,
    f64::MAX,
    -1e19,
    -1e9,
    f64::MIN_POSITIVE,
    -0.0,
];

/// Wavelengths that do not occur on maps, and one that does.
const WAVELENGTHS: [f64; 13] =
    [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, 1e-300, 3e-39, -1e-30, 1e300, f64::MAX, -7.0, 1.0];

fn sound(noise: &Noise, columns: &Columns, what: &str) {
    let [values, slopes @ ..] = columns;
    let name = &noise.name;
    assert!(values.iter().all(|x| x.abs() <= 1.0), "{name}, {what}: {values:?}");
    assert!(slopes.iter().flatten().all(|x| x.is_finite()), "{name}, {what}: slopes {slopes:?}");
}

/// Evaluates all pairs of odd positions with every method, and checks each result.
fn ask_everywhere(noise: &Noise, what: &str) -> Columns {
    // Every position along x is combined with every kind of position along y.
    let (xs, ys) = (&PLACES, &PLACES[..7]);
    let lattice = Points::Lattice { xs, ys };
    let n = lattice.len();
    let (x, y): (Vec<f64>, Vec<f64>) = (0..n).map(|k| lattice.position(k).unwrap()).unzip();
    let z: Vec<f64> = (0..n).map(|k| PLACES[(k * 7 + k / 5) % PLACES.len()]).collect();
    // Displacements can be odd, too.
    let odd32 = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e-40, -0.0];
    let shift: Vec<f32> = (0..n).map(|k| odd32[k * 3 % odd32.len()]).collect();
    let displaced = Points::Displaced { xs, ys, dx: &shift, dy: &shift };
    let (dx, dy): (Vec<f64>, Vec<f64>) = (0..n).map(|k| displaced.position(k).unwrap()).unzip();
    let ask = |points, depth| {
        let columns = noise.ask(&Ask { points, depth, slopes: true }).unwrap();
        sound(noise, &columns, what);
        columns
    };
    let (scattered, moved) = (Points::Scattered { x: &x, y: &y }, Points::Scattered { x: &dx, y: &dy });
    let mut all = Columns::default();
    for depth in [None, Some(Depth::Each(&z)), Some(Depth::Slice(f64::NAN))] {
        let first = ask(lattice, depth);
        for (points, expected) in [(scattered, &first), (displaced, &ask(moved, depth))] {
            assert!(same_bits(&ask(points, depth), expected), "{}, {what}: {points:?}", noise.name);
        }
        for (to, from) in all.iter_mut().zip(first) {
            to.extend(from);
        }
    }
    all
}

/// Checks that the results are valid, and the same at every level.
fn hold(noises: impl Fn() -> Vec<(Noise, String)>) {
    let mut expected: Vec<Columns> = Vec::new();
    at_each_level(|level| {
        for (number, (noise, what)) in noises().iter().enumerate() {
            let found = ask_everywhere(noise, &format!("{what}, level {level}"));
            match expected.get(number) {
                Some(expected) => assert!(same_bits(&found, expected), "{}, {what}, level {level}", noise.name),
                None => expected.push(found),
            }
        }
    });
}

#[test]
fn odd_places_and_wavelengths() {
    hold(|| {
        let each = |&wavelength| {
            let what = format!("wavelength {wavelength:e}");
            all(5, wavelength).into_iter().map(move |noise| (noise, what.clone()))
        };
        WAVELENGTHS.iter().flat_map(each).collect()
    });
}

#[test]
fn odd_octaves_gains_and_lacunarities() {
    let usual = Fractal::new(5, 30.0);
    let mut odd = vec![
        usual.with_octaves(0),
        usual.with_octaves(1_000_000),
        usual.with_octaves(u32::MAX).with_gain(1e9).with_lacunarity(1e30),
        usual.with_octaves(MAX_OCTAVES).with_gain(0.99).with_lacunarity(0.1),
        usual.with_octaves(MAX_OCTAVES).with_gain(-1024.0).with_lacunarity(-3.0).with_wavelength(1e-300),
    ];
    for factor in
        [0.0, -0.0, 1.0, -1.0, -2.0, 5.0, 1e30, 1e300, f64::MAX, 5e-324, f64::NAN, f64::INFINITY, f64::NEG_INFINITY]
    {
        odd.push(usual.with_gain(factor));
        odd.push(usual.with_lacunarity(factor));
        if factor.abs() > 4.0 || factor.is_nan() {
            odd.push(usual.with_gain(factor).with_lacunarity(factor));
        }
    }
    hold(|| odd.iter().flat_map(|&like| fractals(like).into_iter().map(move |n| (n, format!("{like:?}")))).collect());
}

#[test]
fn odd_dampings() {
    let usual = Fractal::new(5, 30.0);
    let steep = usual.with_gain(1024.0).with_lacunarity(-900.0).with_octaves(MAX_OCTAVES);
    let flat = usual.with_wavelength(f64::INFINITY);
    hold(|| {
        let mut list = Vec::new();
        for k in [0.0, -3.0, 1e30, 1e300, f64::INFINITY, f64::NAN, 5e-324] {
            for like in [usual, steep, flat] {
                list.extend(damped(k, like).into_iter().map(|noise| (noise, format!("k {k}, {like:?}"))));
            }
        }
        list
    });
}

#[test]
fn too_many_octaves_are_the_most_there_are() {
    let usual = Fractal::default().with_wavelength(30.0);
    let side = [0.0, 3.25, -777.5];
    let points = Points::Lattice { xs: &side, ys: &side };
    let ask = |octaves| -> Vec<Vec<f32>> {
        fractals(usual.with_octaves(octaves)).iter().map(|noise| noise.values(&points)).collect()
    };
    assert_eq!(ask(1_000_000), ask(MAX_OCTAVES));
    assert_ne!(ask(MAX_OCTAVES), ask(3));
}

#[test]
fn nothing_and_single_samples() {
    at_each_level(|level| {
        for noise in all(5, 3.0) {
            for (xs, ys) in [(&[][..], &[][..]), (&[], &[1.0, 2.0]), (&[1.0, 2.0], &[]), (&[1.5], &[2.5])] {
                let lattice = Points::Lattice { xs, ys };
                let (x, y): (Vec<f64>, Vec<f64>) = (0..lattice.len()).map(|k| lattice.position(k).unwrap()).unzip();
                let none = vec![0.0; x.len()];
                for points in
                    [lattice, Points::Displaced { xs, ys, dx: &none, dy: &none }, Points::Scattered { x: &x, y: &y }]
                {
                    for depth in [None, Some(Depth::Slice(0.5)), Some(Depth::Each(&vec![0.5; x.len()]))] {
                        let columns = noise.ask(&Ask { points, depth, slopes: true }).unwrap();
                        assert_eq!(columns[0].len(), x.len());
                        sound(&noise, &columns, &format!("level {level}"));
                        if let ([value], None) = (&columns[0][..], depth) {
                            let again = noise.values(&Points::Scattered { x: &[1.5], y: &[2.5] });
                            assert_eq!(again[0].to_bits(), value.to_bits(), "{}", noise.name);
                        }
                    }
                }
            }
        }
    });
}

#[test]
fn wrong_lengths_are_named_and_nothing_is_written() {
    at_each_level(|_| {
        for noise in all(5, 3.0) {
            let (three, two, six) = ([0.0, 1.0, 2.0], [0.0, 1.0], [0.0; 6]);
            let wrong = |slice, length, expected| Err(LengthMismatch { slice, length, expected });
            let ask = |points, depth| noise.ask(&Ask { points, depth, slopes: true });
            let displaced = Points::Displaced { xs: &three, ys: &two, dx: &six, dy: &six[..4] };
            assert_eq!(ask(displaced, None), wrong("dy", 4, 6));
            assert_eq!(ask(Points::Scattered { x: &three, y: &two }, None), wrong("y", 2, 3));
            let lattice = Points::Lattice { xs: &three, ys: &two };
            assert_eq!(ask(lattice, Some(Depth::Each(&three))), wrong("z", 3, 6));
        }
    });
}

#[test]
fn wrong_lengths_are_named() {
    let noise = Perlin::default();
    let points = Points::Lattice { xs: &[0.0, 1.0, 2.0], ys: &[0.0, 1.0] };
    let wrong = |slice, length| Err(LengthMismatch { slice, length, expected: 6 });
    assert_eq!(noise.fill(&points, &mut [0.0; 5]), wrong("value", 5));
    assert_eq!(noise.fill_with_gradient(&points, &mut [0.0; 6], &mut [0.0; 7], &mut [0.0; 6]), wrong("dx", 7));
    assert_eq!(noise.fill3(&points, &Depth::Each(&[0.0]), &mut [0.0; 6]), wrong("z", 1));
    let displaced = Points::Displaced { xs: &[0.0, 1.0, 2.0], ys: &[0.0, 1.0], dx: &[0.0; 6], dy: &[0.0; 4] };
    assert_eq!(noise.fill(&displaced, &mut [0.0; 6]), wrong("dy", 4));
    let none = Points::Lattice { xs: &[], ys: &[0.0] };
    assert_eq!((noise.fill(&none, &mut []), none.position(0), none.is_empty()), (Ok(()), None, true));
    assert_eq!(points.position(5), Some((2.0, 1.0)));
    assert_eq!(points.position(6), None);
}

#[test]
fn names_go_both_ways() {
    for &basis in Basis::all() {
        assert_eq!(Basis::from_name(basis.name()), Some(basis));
    }
    assert_eq!(Basis::from_name("perl"), None);
}
