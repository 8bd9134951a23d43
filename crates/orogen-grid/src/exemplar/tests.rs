//! The texture beside its example.

use super::*;
use crate::grid::Window;
use crate::random::Random;

/// An example with ridges, steep on one side, and a tail of high values; its mean is far from 0.
fn example(width: usize, height: usize) -> Grid {
    let mut random = Random::new(5, 2);
    let waves: Vec<[f64; 4]> = (0..60)
        .map(|_| {
            let (angle, length) = (std::f64::consts::TAU * random.share(), 6.0 + 14.0 * random.share());
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            [cos / length, sin / length, random.share(), length]
        })
        .collect();
    let height_at = |k: usize| {
        let (x, y) = ((k % width) as f64, (k / width) as f64);
        let wave = |[along_x, along_y, phase, length]: &[f64; 4]| {
            length * libm::sin(std::f64::consts::TAU * (x * along_x + y * along_y + phase))
        };
        let sum = waves.iter().map(wave).sum::<f64>() / 80.0;
        (500.0 + 60.0 * libm::exp(0.5 * sum)) as f32
    };
    let data = (0..width * height).map(height_at).collect();
    Grid::from_data(Window::new(width, height, 10.0), data).unwrap()
}

fn sampled(texture: &Texture, seed: u64, [width, height]: [usize; 2], cell: f64) -> Vec<f32> {
    let mut sampler = texture.sampler(seed);
    let position = |k: usize| ((k % width) as f64 * cell, (k / width) as f64 * cell);
    (0..width * height).map(position).map(|(x, y)| sampler.at(x, y)).collect()
}

fn moments(samples: &[f32]) -> [f64; 2] {
    let mean = samples.iter().map(|sample| f64::from(*sample)).sum::<f64>() / samples.len() as f64;
    let square = samples.iter().map(|sample| (f64::from(*sample) - mean) * (f64::from(*sample) - mean)).sum::<f64>();
    [mean, (square / samples.len() as f64).sqrt()]
}

/// The largest distance between two distribution functions (Kolmogorov and Smirnov).
fn kolmogorov_smirnov(one: &[f32], other: &[f32]) -> f64 {
    let sorted = |samples: &[f32]| {
        let mut sorted = samples.to_vec();
        sorted.sort_by(f32::total_cmp);
        sorted
    };
    let (one, other) = (sorted(one), sorted(other));
    let share =
        |samples: &[f32], value: f32| samples.partition_point(|sample| *sample <= value) as f64 / samples.len() as f64;
    one.iter().fold(0.0, |most, value| (share(&one, *value) - share(&other, *value)).abs().max(most))
}

#[test]
fn the_histogram_and_the_variance_are_those_of_the_example() {
    let example = example(256, 224);
    for rotate in [false, true] {
        let texture = Exemplar::default().with_patch(600.0).with_rotate(rotate).prepare(&example).unwrap();
        let made = sampled(&texture, 7, [1000, 1000], 10.0);
        let distance = kolmogorov_smirnov(&made, example.data());
        let ([mean, deviation], [expected_mean, expected]) = (moments(&made), moments(example.data()));
        assert!(distance < 0.03, "{rotate}: {distance}");
        let close = (mean - expected_mean).abs() < 0.05 * expected && (deviation / expected - 1.0).abs() < 0.05;
        assert!(close, "{mean} of {expected_mean}, {deviation} of {expected}");
        // Slopes, too: a blend without its correction would halve their variance.
        let slopes = |samples: &[f32], width: usize| -> Vec<f32> {
            samples.chunks(width).flat_map(|row| row.windows(2).map(|pair| pair[1] - pair[0])).collect()
        };
        let ratio = moments(&slopes(&made, 1000))[1] / moments(&slopes(example.data(), 256))[1];
        assert!((ratio - 1.0).abs() < 0.1, "{rotate}: {ratio}");
    }
}

#[test]
fn there_are_no_seams() {
    // The example is a plane: patches differ by constants only, so that slopes show how they are blended.
    let plane = Grid::from_data(Window::new(64, 64, 1.0), (0..4096).map(|k| (k / 64 + k % 64) as f32).collect());
    let texture = Exemplar::default().prepare(&plane.unwrap()).unwrap();
    let mut sampler = texture.sampler(1);
    // The largest change of the slope from one step to the next.
    let mut largest = |step: f64| {
        let mut largest = 0.0f64;
        for line in 0..40 {
            let y = 3.3 * f64::from(line) + 0.1;
            let steps = 0..(100.0 / step) as u32;
            let values: Vec<f64> = steps.map(|i| f64::from(sampler.at(f64::from(i) * step, y))).collect();
            let slopes: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
            largest = slopes.windows(2).fold(largest, |largest, pair| (pair[1] - pair[0]).abs().max(largest));
        }
        largest
    };
    // Where slopes are continuous it is as much smaller as the step. At a seam it stays.
    let [coarse, fine] = [largest(0.125), largest(0.015_625)];
    assert!(fine < 0.2 * coarse, "{fine} of {coarse}");
}

#[test]
fn it_does_not_repeat() {
    let example = example(160, 128);
    let texture = Exemplar::default().prepare(&example).unwrap();
    let size = 700;
    let made = sampled(&texture, 3, [size, size], 10.0);
    let [mean, deviation] = moments(&made);
    let normal: Vec<f64> = made.iter().map(|sample| (f64::from(*sample) - mean) / deviation).collect();
    // Shifts of the triangles, and any others from the size of a patch on.
    let correlation = |dx: usize, dy: usize| {
        let pairs = (0..size - dy).step_by(2).flat_map(|j| {
            let normal = &normal;
            (0..size - dx).step_by(2).map(move |i| normal[j * size + i] * normal[(j + dy) * size + i + dx])
        });
        let (sum, count) = pairs.fold((0.0, 0), |(sum, count), product| (sum + product, count + 1));
        sum / f64::from(count)
    };
    let mut shifts: Vec<(usize, usize)> = (1..8).flat_map(|k| [(37 * k, 0), (0, 32 * k), (18 * k, 32 * k)]).collect();
    shifts.retain(|(dx, dy)| dx.max(dy) >= &64);
    shifts.extend((64..260).step_by(7).flat_map(|shift| [(shift, 0), (0, shift), (shift, shift)]));
    for (dx, dy) in shifts {
        let found = correlation(dx, dy);
        assert!(found.abs() < 0.12, "{dx}, {dy}: {found}");
    }
    let other = sampled(&texture, 4, [size, size], 10.0);
    let same = made.iter().zip(&other).filter(|(one, other)| one == other).count();
    assert!(same < made.len() / 1000, "{same}");
}

#[test]
fn positions_are_independent_of_their_order_and_of_the_distance() {
    let example = example(40, 50);
    for rotate in [false, true] {
        let texture = Exemplar::default().with_rotate(rotate).prepare(&example).unwrap();
        for (x0, y0) in [(0.0, 0.0), (-1e6, 2e6), (1e12, -1e12)] {
            let place = |k: u32| (x0 + f64::from(k * 7919 % 640) * 1.25, y0 + f64::from(k * 104_729 % 640) * 1.25);
            let mut sampler = texture.sampler(9);
            for k in 0..640 {
                let (x, y) = place(k);
                let value = sampler.at(x, y);
                assert_eq!(value.to_bits(), texture.sampler(9).at(x, y).to_bits(), "{x}, {y}");
                assert!((400.0..1000.0).contains(&value), "{value}");
            }
        }
        let mut sampler = texture.sampler(9);
        assert!(sampler.at(f64::NAN, 0.0).is_nan() && sampler.at(0.0, f64::INFINITY).is_nan());
        assert!(sampler.at(1e300, -1e300).is_finite());
    }
}

#[test]
fn a_sample_of_the_lattice_equals_the_limit_of_its_neighborhood() {
    let example = example(40, 50);
    let texture = Exemplar::default().with_rotate(true).prepare(&example).unwrap();
    let mut sampler = texture.sampler(2);
    for k in 0..200 {
        let (x, y) = (f64::from(k % 20) * 70.0, f64::from(k / 20) * 110.0);
        let [on, beside] = [sampler.at(x, y), sampler.at(x + 1e-3, y + 1e-3)];
        assert!((on - beside).abs() < 0.05, "{x}, {y}: {on}, {beside}");
    }
}

#[test]
fn lengths_are_those_of_the_world() {
    let example = example(64, 64);
    let made = |law: Exemplar, cell: f64| sampled(&law.prepare(&example).unwrap(), 1, [80, 80], cell);
    let law = Exemplar::default().with_patch(300.0).with_wavelength(Some(200.0));
    // Twice the cell, and all lengths twice as large: the same samples.
    let twice = law.with_cell(20.0).with_patch(600.0).with_wavelength(Some(400.0));
    assert_eq!(made(law, 10.0), made(twice, 20.0));
    assert_eq!(made(law.with_cell(10.0), 10.0), made(law, 10.0));
    // Without the trend heights are around 0.
    let [mean, deviation] = moments(&made(law, 10.0));
    assert!(mean.abs() < 0.3 * deviation, "{mean}, {deviation}");
}

#[test]
fn small_and_flat_examples_do_no_harm() {
    assert!(Exemplar::default().prepare(&Grid::filled(Window::new(15, 90, 1.0), 1.0)).is_none());
    for (width, height) in [(16, 16), (17, 40), (300, 16)] {
        for patch in [0.0, 1e-3, 1e9] {
            let flat = Grid::filled(Window::new(width, height, 1.0), 7.5);
            let texture = Exemplar::default().with_patch(patch).with_rotate(true).prepare(&flat).unwrap();
            assert!(sampled(&texture, 1, [50, 50], 0.7).iter().all(|value| *value == 7.5));
            let rough = example(width, height);
            let texture = Exemplar::default().with_patch(patch).with_rotate(true).prepare(&rough).unwrap();
            assert!(sampled(&texture, 1, [50, 50], 7.0).iter().all(|value| value.is_finite()));
        }
    }
}
