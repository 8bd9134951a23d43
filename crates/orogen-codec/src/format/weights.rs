//! Weights of surface materials as bytes.

use orogen_grid::grid::Grid;

/// Row `row` of weights as bytes, where `weights` has one grid for each surface. The bytes of a sample are adjacent and
/// add up to 255.
///
/// Weights are rounded down, and the remainder is given to those with the largest rounding loss; of equal ones to the
/// first. All bytes are 0 where no weight is positive.
#[must_use]
pub fn row_bytes(weights: &[Grid], row: usize) -> Vec<u8> {
    let mut of_sample = vec![0.0; weights.len()];
    let mut bytes = vec![0; weights.len() * weights.first().map_or(0, Grid::width)];
    for (i, bytes) in bytes.chunks_exact_mut(weights.len().max(1)).enumerate() {
        of_sample.iter_mut().zip(weights).for_each(|(weight, grid)| *weight = grid[(i, row)]);
        to_bytes(&of_sample, bytes);
    }
    bytes
}

/// Copies some of the `count` bytes of each sample to pixels of `pixel` bytes, in the order of `channels`.
pub fn select(bytes: &[u8], count: usize, channels: &[usize], pixels: &mut [u8], pixel: usize) {
    for (pixel, weights) in pixels.chunks_exact_mut(pixel).zip(bytes.chunks_exact(count)) {
        pixel.iter_mut().zip(channels).for_each(|(byte, k)| *byte = weights[*k]);
    }
}

fn to_bytes(weights: &[f32], bytes: &mut [u8]) {
    let total: f64 = weights.iter().map(|weight| f64::from(weight.max(0.0))).sum();
    bytes.fill(0);
    if !(total > 0.0 && total.is_finite()) {
        return;
    }
    let exact = |k: usize| f64::from(weights[k].max(0.0)) * 255.0 / total;
    let mut left = 255u32;
    for (k, byte) in bytes.iter_mut().enumerate() {
        *byte = exact(k).floor().min(f64::from(left)) as u8;
        left -= u32::from(*byte);
    }
    while left > 0 {
        let lost = |k: usize| exact(k) - f64::from(bytes[k]);
        let most = (0..bytes.len()).fold(0, |most, k| if lost(k) > lost(most) { k } else { most });
        bytes[most] += 1;
        left -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_add_up_to_255() {
        let mut bytes = [0; 6];
        for k in 0..500u16 {
            let weights: Vec<f32> = (0..6).map(|n| f32::from((k * 37 + n * n * 91) % 113)).collect();
            to_bytes(&weights, &mut bytes);
            assert_eq!(bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>(), 255);
        }
        to_bytes(&[1.0, 1.0, 1.0, 0.0, 0.0, 0.0], &mut bytes);
        assert_eq!(bytes, [85, 85, 85, 0, 0, 0]);
        to_bytes(&[0.5, 0.5], &mut bytes[..2]);
        assert_eq!(bytes[..2], [128, 127]);
        to_bytes(&[0.0; 6], &mut bytes);
        assert_eq!(bytes, [0; 6]);
    }
}
