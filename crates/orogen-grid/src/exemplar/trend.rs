//! The trend of an example: what is longer than a wavelength.

use crate::parallel;

/// Standard deviation of a Gaussian that halves the amplitude of waves of length 1: sqrt(ln 2 / 2) / pi.
const HALF: f64 = 0.187_390_625_129_277_6;

/// Reach of a Gaussian, in standard deviations.
const REACH: f64 = 4.0;

/// Blocks whose means are smoothed, per standard deviation.
const BLOCKS: f64 = 4.0;

/// Minimum number of blocks along a side.
const MIN_BLOCKS: usize = 16;

/// The weights of blocks for one sample.
struct Taps {
    first: usize,
    weights: Vec<f64>,
}

/// Takes the trend out of samples in rows of `width`: their mean weighted with a Gaussian that halves waves of
/// `wavelength` samples. At the border, where the Gaussian has one side only, weights are those of a local line
/// (W. S. Cleveland, "Robust locally weighted regression and smoothing scatterplots", Journal of the American
/// Statistical Association 74, 1979), so that slopes are taken out everywhere, and far longer waves leave a plane.
pub(super) fn remove(samples: &mut [f32], width: usize, wavelength: f64) {
    let height = samples.len() / width.max(1);
    let sigma = (HALF * wavelength).max(1e-3);
    let most = width.min(height) / MIN_BLOCKS;
    let block = ((sigma / BLOCKS) as usize).clamp(1, most.max(1));
    let (columns, rows) = (taps(width, block, sigma), taps(height, block, sigma));
    // Means of blocks, smoothed along x.
    let blocks = samples.chunks(width * block);
    let smoothed = parallel::map(blocks, |rows| {
        let share = width as f64 / rows.len() as f64;
        let mut sums = vec![0.0; width];
        for row in rows.chunks(width) {
            sums.iter_mut().zip(row).for_each(|(sum, sample)| *sum += f64::from(*sample));
        }
        let means: Vec<f64> =
            sums.chunks(block).map(|part| part.iter().sum::<f64>() * share / part.len() as f64).collect();
        let smooth = |taps: &Taps| {
            let parts = taps.weights.iter().zip(means.get(taps.first..).unwrap_or_default());
            parts.fold(0.0, |sum, (weight, mean)| sum + weight * mean)
        };
        columns.iter().map(smooth).collect::<Vec<f64>>()
    });
    parallel::for_each(samples.chunks_mut(width).zip(&rows), |(row, taps)| {
        let mut trend = vec![0.0; width];
        for (weight, smoothed) in taps.weights.iter().zip(smoothed.get(taps.first..).unwrap_or_default()) {
            trend.iter_mut().zip(smoothed).for_each(|(sum, value)| *sum += weight * value);
        }
        for (sample, trend) in row.iter_mut().zip(trend) {
            *sample = (f64::from(*sample) - trend) as f32;
        }
    });
}

/// The weights of blocks of samples for each of `length` samples: those of a Gaussian times a line, with a sum of 1 and
/// a middle at the sample.
fn taps(length: usize, block: usize, sigma: f64) -> Vec<Taps> {
    let count = length.div_ceil(block);
    let weights = |sample: usize| {
        // Whole blocks within reach, and at least three.
        let reach = ((REACH * sigma / block as f64).ceil() as usize).max(1);
        let (first, last) = ((sample / block).saturating_sub(reach), (sample / block + reach).min(count - 1));
        let of_block = |number: usize| {
            let (start, end) = (number * block, ((number + 1) * block).min(length));
            let distance = 0.5 * (start + end - 1) as f64 - sample as f64;
            (distance, (end - start) as f64 * libm::exp(-0.5 * (distance / sigma) * (distance / sigma)))
        };
        let blocks: Vec<(f64, f64)> = (first..=last).map(of_block).collect();
        let moment = |power: fn(f64) -> f64| blocks.iter().fold(0.0, |sum, (at, weight)| sum + weight * power(*at));
        let (sum, mean, square) = (moment(|_| 1.0), moment(|at| at), moment(|at| at * at));
        let size = sum * square - mean * mean;
        let line = |(at, weight): &(f64, f64)| match size > 1e-12 * sum * sum {
            true => weight * (square - mean * at) / size,
            false => weight / sum,
        };
        Taps { first, weights: blocks.iter().map(line).collect() }
    };
    (0..length).map(weights).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [200, 150];

    fn samples(of: impl Fn(f64, f64) -> f64) -> Vec<f32> {
        let [width, height] = SIZE;
        (0..width * height).map(|k| of((k % width) as f64, (k / width) as f64) as f32).collect()
    }

    fn largest(samples: &[f32]) -> f32 {
        samples.iter().fold(0.0, |largest, sample| sample.abs().max(largest))
    }

    #[test]
    fn planes_are_taken_out_up_to_the_border() {
        for wavelength in [1.0, 10.0, 40.0, 300.0, 1e7] {
            let mut plane = samples(|x, y| 500.0 + 3.0 * x - 2.0 * y);
            remove(&mut plane, SIZE[0], wavelength);
            assert!(largest(&plane) < 0.01, "{wavelength}: {}", largest(&plane));
        }
    }

    #[test]
    fn a_wave_of_the_wavelength_is_halved() {
        let wave = |x: f64| libm::sin(2.0 * std::f64::consts::PI * x / 50.0);
        let of_wave = samples(|x, _| wave(x));
        for (wavelength, expect) in [(50.0, 0.5), (200.0, 1.0), (15.0, 0.0605)] {
            let mut left = of_wave.clone();
            remove(&mut left, SIZE[0], wavelength);
            // In the middle, at a crest.
            let share = left[75 * SIZE[0] + 112] / of_wave[75 * SIZE[0] + 112];
            assert!((share - expect).abs() < 0.01, "{wavelength}: {share}");
        }
    }
}
