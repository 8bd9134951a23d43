//! Numbers over many samples: mean, range, independence of seeds, smoothness far away; and what odd arguments give.

use crate::{Basis, Classic, ClassicVariant, Depth, Falloff, Fractal, Kind, Mismatch, Perlin, Points, Value, White};

fn axis(start: f64, cell: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| start + i as f64 * cell).collect()
}

/// A lattice of 400 x 400 samples a bit more than a third of a cell apart.
fn field(fill: impl Fn(&Points, &mut [f32])) -> Vec<f32> {
    let side = axis(-60.0, 0.371, 400);
    let mut out = vec![f32::NAN; side.len() * side.len()];
    fill(&Points::Lattice { xs: &side, ys: &side }, &mut out);
    out
}

fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let moment = |f: &dyn Fn(f64, f64) -> f64| {
        a.iter().zip(b).map(|(&a, &b)| f(f64::from(a), f64::from(b))).sum::<f64>() / a.len() as f64
    };
    let (ma, mb) = (moment(&|a, _| a), moment(&|_, b| b));
    let covariance = moment(&|a, b| (a - ma) * (b - mb));
    covariance / (moment(&|a, _| (a - ma) * (a - ma)) * moment(&|_, b| (b - mb) * (b - mb))).sqrt()
}

#[test]
fn means_are_near_zero_and_ranges_within_bounds() {
    let mut fields = vec![];
    for seed in 0..3 {
        fields.push(("white", field(|p, out| White { seed, wavelength: 1.0 }.fill(p, out).unwrap())));
        fields.push(("value", field(|p, out| Value { seed, ..Default::default() }.fill(p, out).unwrap())));
        fields.push(("perlin", field(|p, out| Perlin { seed, wavelength: 1.0 }.fill(p, out).unwrap())));
        let slice = Depth::Slice(0.4);
        fields.push(("perlin 3D", field(|p, out| Perlin { seed, wavelength: 1.0 }.fill3(p, &slice, out).unwrap())));
        for variant in [ClassicVariant::Diagonal, ClassicVariant::Eight, ClassicVariant::Angle] {
            let noise = Classic { seed, wavelength: 1.0, variant };
            fields.push(("classic", field(|p, out| noise.fill(p, out).unwrap())));
        }
        for &basis in Basis::all() {
            let noise = Fractal { basis, seed, wavelength: 0.9, ..Default::default() };
            fields.push(("fbm", field(|p, out| noise.fill(p, out).unwrap())));
        }
    }
    for (name, values) in &fields {
        let mean = values.iter().map(|&x| f64::from(x)).sum::<f64>() / values.len() as f64;
        assert!(mean.abs() < 0.01, "{name}: mean {mean}");
        assert!(values.iter().all(|x| x.abs() <= 1.0), "{name}");
        let spread = values.iter().fold(0.0_f32, |most, x| most.max(x.abs()));
        assert!(spread > 0.4, "{name}: reaches only {spread}");
    }
    for kind in [Kind::Ridged, Kind::Billow, Kind::Weighted { k: 2.0, falloff: Falloff::Exponential }] {
        let noise = Fractal { kind, wavelength: 4.0, gain: 0.7, ..Default::default() };
        assert!(field(|p, out| noise.fill(p, out).unwrap()).iter().all(|x| x.abs() <= 1.0), "{kind:?}");
    }
}

#[test]
fn seeds_are_strangers() {
    let seeds = [0, 1, 2, 3, 255, 256, u64::MAX, 1 << 32, 1 << 63];
    let noises: Vec<(u64, [Vec<f32>; 3])> = seeds
        .iter()
        .map(|&seed| {
            let fields = [
                field(|p, out| White { seed, wavelength: 0.371 }.fill(p, out).unwrap()),
                field(|p, out| Value { seed, wavelength: 0.2, ..Default::default() }.fill(p, out).unwrap()),
                field(|p, out| Perlin { seed, wavelength: 0.2 }.fill(p, out).unwrap()),
            ];
            (seed, fields)
        })
        .collect();
    for (i, (a, left)) in noises.iter().enumerate() {
        for (b, right) in &noises[i + 1..] {
            for (left, right) in left.iter().zip(right) {
                let found = correlation(left, right);
                assert!(found.abs() < 0.01, "seeds {a} and {b}: {found}");
            }
        }
    }
}

#[test]
fn neighbours_on_the_lattice_are_strangers() {
    // One sample per cell: along, across, diagonal, mirrored.
    let side = 500;
    let at = axis(0.5, 1.0, side);
    let mut white = vec![0.0; side * side];
    White { seed: 9, wavelength: 1.0 }.fill(&Points::Lattice { xs: &at, ys: &at }, &mut white).unwrap();
    for (dx, dy) in [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (7, 3), (64, 0), (0, 64), (256, 0), (0, 256)] {
        let n = (side - dx) * (side - dy);
        let pick = |ox: usize, oy: usize| -> Vec<f32> {
            (0..n).map(|k| white[(k / (side - dx) + oy) * side + k % (side - dx) + ox]).collect()
        };
        let found = correlation(&pick(0, 0), &pick(dx, dy));
        // Three standard deviations of unrelated numbers.
        assert!(found.abs() < 4.0 / (n as f64).sqrt(), "({dx}, {dy}): {found}");
    }
    let mirrored: Vec<f32> = (0..side * side).map(|k| white[k % side * side + k / side]).collect();
    assert!(correlation(&white, &mirrored).abs() < 0.02);
}

#[test]
fn far_away_is_as_smooth_as_here() {
    for start in [0.0, 1e6, 1e9, -1e9] {
        let xs = axis(start, 0.125, 4001);
        let mut out = vec![0.0; xs.len()];
        Perlin { seed: 2, wavelength: 10.0 }.fill(&Points::Lattice { xs: &xs, ys: &[start] }, &mut out).unwrap();
        let bend = out.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).fold(0.0, f32::max);
        // The noise's own curvature is about 10 per squared wavelength; rounding adds some 1e-7.
        assert!(bend < 2.5e-3 && bend > 2e-4, "at {start}: {bend}");
        let repeated = out.windows(2).filter(|w| w[0] == w[1]).count();
        assert!(repeated < 40, "at {start}: {repeated} repeated samples");
    }
}

#[test]
fn chunks_join_without_a_seam() {
    let noise = Fractal {
        kind: Kind::Weighted { k: 1.0, falloff: Falloff::SquareRoot },
        wavelength: 31.0,
        ..Default::default()
    };
    let (xs, ys) = (axis(-1234.5, 1.0 / 3.0, 300), axis(77.0, 0.1, 40));
    let mut whole = vec![0.0; xs.len() * ys.len()];
    noise.fill(&Points::Lattice { xs: &xs, ys: &ys }, &mut whole).unwrap();
    for (x, y, width, height) in [(0, 0, 300, 1), (13, 5, 1, 30), (255, 0, 45, 40), (100, 39, 17, 1), (1, 1, 280, 33)] {
        let mut part = vec![0.0; width * height];
        noise.fill(&Points::Lattice { xs: &xs[x..x + width], ys: &ys[y..y + height] }, &mut part).unwrap();
        for (k, &value) in part.iter().enumerate() {
            assert_eq!(value.to_bits(), whole[(y + k / width) * xs.len() + x + k % width].to_bits());
        }
    }
}

#[test]
fn odd_arguments_give_finite_results() {
    let odd =
        [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300, f64::MAX, f64::MIN_POSITIVE, -0.0, 4.5e15, 1e19];
    let wavelengths = [0.0, -0.0, f64::NAN, f64::INFINITY, 5e-324, 1e-300, f64::MAX, -7.0, 1.0];
    for wavelength in wavelengths {
        for (octaves, gain, lacunarity) in
            [(0, 0.5, 2.0), (1_000_000, 0.5, 2.0), (6, 5.0, 2.0), (6, f64::NAN, 2.0), (6, -0.5, -2.0), (32, 1e9, 1e30)]
        {
            for kind in [Kind::Fbm, Kind::Ridged, Kind::Weighted { k: f64::NAN, falloff: Falloff::Exponential }] {
                let noise = Fractal { wavelength, octaves, gain, lacunarity, kind, ..Default::default() };
                let mut lattice = vec![0.0; odd.len() * odd.len()];
                noise.fill(&Points::Lattice { xs: &odd, ys: &odd }, &mut lattice).unwrap();
                assert!(lattice.iter().all(|x| x.abs() <= 1.0), "{noise:?}: {lattice:?}");
                let scattered: Vec<f32> = odd.iter().flat_map(|&y| odd.map(|x| noise.sample(x, y))).collect();
                assert_eq!(lattice, scattered, "{noise:?}");
                assert!(noise.sample3(odd[0], odd[1], odd[3]).is_finite());
            }
        }
    }
}

#[test]
fn wrong_lengths_are_named() {
    let noise = Perlin::default();
    let points = Points::Lattice { xs: &[0.0, 1.0, 2.0], ys: &[0.0, 1.0] };
    let wrong = |slice, length| Err(Mismatch { slice, length, expected: 6 });
    assert_eq!(noise.fill(&points, &mut [0.0; 5]), wrong("value", 5));
    assert_eq!(noise.fill_with_gradient(&points, &mut [0.0; 6], &mut [0.0; 7], &mut [0.0; 6]), wrong("dx", 7));
    assert_eq!(noise.fill3(&points, &Depth::Each(&[0.0]), &mut [0.0; 6]), wrong("depth", 1));
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
    assert_eq!(Basis::from_name("simplex"), None);
}
