//! Tests of repeating noise: both sides of every seam have the same bits, and noise that cannot repeat returns an
//! error.

use orogen_noise::{Basis, Classic, Depth, Falloff, Fractal, Kind, Perlin, Points, TileError, Tiled, Value, White};

const PERIOD: [u32; 3] = [6, 5, 2];

fn noises(wavelength: f64) -> Vec<(String, Tiled)> {
    let mut list = vec![
        ("white".into(), White::new(1, wavelength).tiled(PERIOD).unwrap()),
        ("value".into(), Value::new(2, wavelength).tiled(PERIOD).unwrap()),
        ("perlin".into(), Perlin::new(3, wavelength).tiled(PERIOD).unwrap()),
        ("classic".into(), Classic::new(4, wavelength).tiled(PERIOD).unwrap()),
    ];
    for &basis in Basis::all().iter().filter(|basis| basis.is_tileable()) {
        for (kind, lacunarity) in
            [(Kind::Fbm, 2.0), (Kind::Ridged, 3.0), (Kind::Weighted { k: 1.0, falloff: Falloff::Reciprocal }, -2.0)]
        {
            let noise = Fractal::new(5, wavelength).with_basis(basis).with_kind(kind);
            let noise = noise.with_octaves(5).with_lacunarity(lacunarity).with_gain(0.6);
            list.push((format!("{noise:?}"), noise.tiled(PERIOD).unwrap()));
        }
    }
    list
}

/// Values and slopes of a window, as bits.
fn bits(noise: &Tiled, xs: &[f64], ys: &[f64], z: Option<f64>) -> Vec<[u32; 4]> {
    let points = Points::Lattice { xs, ys };
    let mut out = [0; 4].map(|_| vec![0.0_f32; points.len()]);
    let [value, dx, dy, dz] = &mut out;
    match z {
        None => noise.fill_with_gradient(&points, value, dx, dy).unwrap(),
        Some(z) => noise.fill3_with_gradient(&points, &Depth::Slice(z), value, [dx, dy, dz]).unwrap(),
    }
    (0..points.len()).map(|k| [0, 1, 2, 3].map(|place| out[place][k].to_bits())).collect()
}

#[test]
fn seams_are_equal_to_the_bit() {
    for wavelength in [12.8, 100.0, 7.3, 1.0 / 3.0] {
        for (name, noise) in noises(wavelength) {
            // Numbers of samples that divide nothing, and windows before, on and after the origin.
            let side = |axis: usize, count: usize, turn: i32| -> Vec<f64> {
                let cell = f64::from(PERIOD[axis]) * wavelength / count as f64;
                (0..count as i32).map(|i| f64::from(i + turn * count as i32) * cell).collect()
            };
            let (columns, rows, depth) = (67, 23, 1.3 * wavelength);
            let home = bits(&noise, &side(0, columns, 0), &side(1, rows, 0), None);
            assert!(home.windows(2).any(|pair| pair[0] != pair[1]), "{name}");
            for (right, down) in [(1, 0), (0, 1), (-1, 2), (40, -40)] {
                let there = bits(&noise, &side(0, columns, right), &side(1, rows, down), None);
                assert!(home == there, "{name}, {wavelength}, {right} {down}");
            }
            let deep = bits(&noise, &side(0, columns, 0), &side(1, rows, 0), Some(depth));
            let turn = f64::from(PERIOD[2]) * wavelength;
            for (right, down, turns) in [(1, 0, 0.0), (0, -1, 0.0), (0, 0, 1.0), (3, 2, -2.0)] {
                let z = Some(depth + turns * turn);
                let there = bits(&noise, &side(0, columns, right), &side(1, rows, down), z);
                assert!(deep == there, "{name} in space, {wavelength}, {right} {down} {turns}");
            }
        }
    }
}

#[test]
fn an_axis_may_stay_endless_and_no_period_changes_nothing() {
    let noise = Perlin::new(3, 8.0);
    let ring = noise.tiled([4, 0, 0]).unwrap();
    assert_eq!(ring.sample(3.0, 5.0), ring.sample(35.0, 5.0));
    assert_ne!(ring.sample(3.0, 5.0), ring.sample(3.0, 37.0));
    let fractal = Fractal::new(0, 9.0);
    assert_eq!(fractal.tiled([0; 3]).unwrap().sample3(1.0, 2.0, 3.0), fractal.sample3(1.0, 2.0, 3.0));
    // Only the integer numbers of cells matter, not how they come about.
    assert!(fractal.with_lacunarity(1.5).with_octaves(3).tiled([4, 8, 12]).is_ok());
    assert!(fractal.with_wavelength(0.0).tiled([4, 8, 12]).is_ok());
}

#[test]
fn what_cannot_repeat_says_where() {
    let fractal = Fractal::default().with_octaves(3);
    let error = fractal.with_lacunarity(1.5).tiled([0, 2, 0]).unwrap_err();
    assert_eq!(error, TileError::Octave { octave: 2, axis: 1, cells: 4.5 });
    assert!(error.to_string().starts_with("octave 2 would have to repeat after 4.5 cells along y"));
    let error = fractal.with_octaves(32).tiled([4, 0, 0]).unwrap_err();
    assert_eq!(error, TileError::Octave { octave: 25, axis: 0, cells: 134_217_728.0 });
    let error = fractal.with_lacunarity(0.25).tiled([2; 3]).unwrap_err();
    assert_eq!(error, TileError::Octave { octave: 1, axis: 0, cells: 0.5 });
    let error = fractal.with_basis(Basis::Simplex).tiled([2, 2]).unwrap_err();
    assert_eq!(error, TileError::Slanted);
    // Constant octaves repeat without a change.
    assert!(fractal.with_lacunarity(f64::NAN).tiled([2; 3]).is_ok());
    assert!(Perlin::default().tiled([u32::MAX, 1, 1]).is_err());
}
