//! Conversion of samples to bytes and back, as little-endian f32. The functions process whole slices: crates that are
//! compiled without optimization call them instead of their own loops.

use orogen_grid::grid::Grid;

/// Appends samples to bytes.
pub fn append_bytes(bytes: &mut Vec<u8>, samples: &[f32]) {
    bytes.extend(samples.iter().flat_map(|sample| sample.to_le_bytes()));
}

/// Samples as bytes.
#[must_use]
pub fn to_bytes(samples: &[f32]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(4 * samples.len());
    append_bytes(&mut bytes, samples);
    bytes
}

/// Copies samples to bytes, as many as both slices have.
pub fn write_bytes(bytes: &mut [u8], samples: &[f32]) {
    for (bytes, sample) in bytes.as_chunks_mut().0.iter_mut().zip(samples) {
        *bytes = sample.to_le_bytes();
    }
}

/// Copies bytes to samples, as many as both slices have.
pub fn read_bytes(samples: &mut [f32], bytes: &[u8]) {
    for (sample, bytes) in samples.iter_mut().zip(bytes.as_chunks().0) {
        *sample = f32::from_le_bytes(*bytes);
    }
}

/// The samples in bytes. An incomplete sample at the end is ignored.
#[must_use]
pub fn from_bytes(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
}

/// Interleaves three rows sample by sample. The second row is negated if `flipped`.
#[must_use]
pub fn interleaved([first, second, third]: [&[f32]; 3], flipped: bool) -> Vec<f32> {
    let sign = if flipped { -1.0 } else { 1.0 };
    first.iter().zip(second).zip(third).flat_map(|((a, b), c)| [*a, sign * b, *c]).collect()
}

/// The samples of some columns and rows, row by row.
#[must_use]
pub fn pick(grid: &Grid, columns: &[usize], rows: &[usize]) -> Vec<f32> {
    rows.iter().flat_map(|j| columns.iter().map(move |i| grid[(*i, *j)])).collect()
}

/// Reduces a square of `side` x `side` samples to half of them along each side, with the mean of 2 x 2 samples.
#[must_use]
pub fn halved(samples: &[f32], side: usize) -> Vec<f32> {
    let half = side / 2;
    let mean = |(i, j): (usize, usize)| {
        let at = 2 * j * side + 2 * i;
        let sum: f64 = [at, at + 1, at + side, at + side + 1].iter().map(|at| f64::from(samples[*at])).sum();
        (sum * 0.25) as f32
    };
    (0..half).flat_map(|j| (0..half).map(move |i| (i, j))).map(mean).collect()
}

/// Samples rounded to multiples of a step.
#[must_use]
pub fn rounded_to(samples: &[f32], step: f64) -> Vec<f32> {
    samples.iter().map(|sample| ((f64::from(*sample) / step).round() * step) as f32).collect()
}

/// Values above this are not heights, because some programs write the largest float as nodata.
const HIGHEST: f32 = 1e30;

/// Whether `bytes` contain the sequence `part`.
#[must_use]
pub fn contains(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len().max(1)).any(|own| own == part)
}

/// A vector of `count` samples with one value.
#[must_use]
pub fn filled(value: f32, count: usize) -> Vec<f32> {
    vec![value; count]
}

/// Sets all samples that are not heights to NaN. Returns whether a height is left.
pub fn keep_heights(samples: &mut [f32]) -> bool {
    let is_height = |sample: &f32| sample.abs() < HIGHEST;
    let mut found = false;
    for piece in samples.chunks_mut(64) {
        // Almost all pieces contain only heights and do not change.
        if piece.iter().fold(true, |all, sample| all & is_height(sample)) {
            found = true;
            continue;
        }
        for sample in piece {
            match is_height(sample) {
                true => found = true,
                false => *sample = f32::NAN,
            }
        }
    }
    found
}

/// Whether any sample is not NaN.
#[must_use]
pub fn has_height(samples: &[f32]) -> bool {
    samples.iter().any(|sample| !sample.is_nan())
}

/// Number of samples that are NaN.
#[must_use]
pub fn missing(samples: &[f32]) -> usize {
    samples.iter().filter(|sample| sample.is_nan()).count()
}

/// Sets samples with the value `nodata` to NaN.
pub fn hide(samples: &mut [f32], nodata: f64) {
    samples.iter_mut().filter(|sample| f64::from(**sample) == nodata).for_each(|sample| *sample = f32::NAN);
}

/// Appends samples with one value until there are `length`.
pub fn grow(samples: &mut Vec<f32>, length: usize, value: f32) {
    samples.resize(length, value);
}

/// Replaces samples with the value `value` by `by`.
pub fn replace(samples: &mut [f32], value: f32, by: f32) {
    samples.iter_mut().filter(|sample| **sample == value).for_each(|sample| *sample = by);
}

/// Copies samples over those below. Where a sample is NaN, the one below stays, unless it equals `nothing`.
pub fn lay(below: &mut [f32], above: &[f32], nothing: f32) {
    for (sample, own) in below.iter_mut().zip(above) {
        if !own.is_nan() || *sample == nothing {
            *sample = *own;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_come_back_bit_for_bit() {
        let samples = [0.1, -0.0, f32::NAN, f32::from_bits(0x7FC0_1234), f32::MIN_POSITIVE];
        let mut bytes = to_bytes(&samples);
        assert_eq!(bytes[..4], 0.1f32.to_le_bytes());
        bytes.push(7);
        let bits = |samples: &[f32]| samples.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&from_bytes(&bytes)), bits(&samples));
        let mut same = vec![1; bytes.len()];
        write_bytes(&mut same, &samples);
        assert_eq!((&same[..20], same[20]), (&bytes[..20], 1));
        let mut few = [9.0; 2];
        read_bytes(&mut few, &bytes);
        assert_eq!(bits(&few), bits(&samples[..2]));
    }
}
