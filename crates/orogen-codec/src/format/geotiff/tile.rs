//! Encoding of one tile: extraction, predictor, compression.

use crate::format::deflate;

/// Compresses the tile in column `column` of a row of tiles. `rows` are the samples, with `width` per row. The part of
/// the tile beyond the raster repeats the edge: readers do not show it, and it compresses well.
#[must_use]
pub fn pack(rows: &[f32], width: usize, column: usize, side: usize) -> Vec<u8> {
    let first = column * side;
    let mut samples = vec![0.0; side];
    let mut planes = vec![0; 4 * side];
    let mut filtered = Vec::with_capacity(4 * side * side);
    for row in rows.chunks_exact(width) {
        let inside = &row[first..width.min(first + side)];
        samples[..inside.len()].copy_from_slice(inside);
        samples[inside.len()..].fill(inside[inside.len() - 1]);
        split(&samples, &mut planes);
        filtered.push(planes[0]);
        filtered.extend(planes.windows(2).map(|pair| pair[1].wrapping_sub(pair[0])));
    }
    // Each row is filtered separately, so the last one can be repeated unchanged.
    while filtered.len() < 4 * side * side {
        filtered.extend_from_within(filtered.len() - 4 * side..);
    }
    deflate::pack(&filtered, side)
}

/// Stores all highest bytes, then all second highest bytes, and so on, which groups similar bytes.
fn split(samples: &[f32], planes: &mut [u8]) {
    for (k, plane) in planes.chunks_exact_mut(samples.len()).enumerate() {
        let shift = 24 - 8 * k;
        for (byte, sample) in plane.iter_mut().zip(samples) {
            *byte = (sample.to_bits() >> shift) as u8;
        }
    }
}
