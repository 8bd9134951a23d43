//! Heights in integer metres of 16 bits, as in SRTM's `.hgt` (two's complement) and in DTED (a separate sign bit).

/// The value of a missing height in `.hgt`.
const VOID: i16 = -32768;

/// Appends heights in the format of `.hgt`, which is big-endian.
pub fn append_bytes(bytes: &mut Vec<u8>, heights: &[f32]) {
    bytes.extend(heights.iter().flat_map(|height| {
        let whole = if height.is_nan() { VOID } else { height.round().clamp(-32767.0, 32767.0) as i16 };
        whole.to_be_bytes()
    }));
}

/// The heights of an `.hgt` file; missing ones are NaN.
#[must_use]
pub fn heights(bytes: &[u8]) -> Vec<f32> {
    let height = |pair: &[u8; 2]| match i16::from_be_bytes(*pair) {
        VOID => f32::NAN,
        height => f32::from(height),
    };
    bytes.as_chunks().0.iter().map(height).collect()
}

/// Copies the samples of DTED's column `i`, which begins in the south, into rows of `width` heights.
pub fn dted_column(bytes: &[u8], heights: &mut [f32], width: usize, i: usize) {
    let rows = heights.chunks_exact_mut(width).rev();
    for (row, pair) in rows.zip(bytes.as_chunks().0) {
        row[i] = signed(u16::from_be_bytes(*pair));
    }
}

/// A height with a sign bit. -32767 is missing. Some programs write two's complement instead, which is recognized
/// because no land is below -16 000 m.
#[must_use]
fn signed(bits: u16) -> f32 {
    match (bits >> 15, bits & 0x7fff) {
        (0, height) => f32::from(height),
        (_, 0x7fff) => f32::NAN,
        (_, depth) if depth > 16_000 => f32::from(bits as i16),
        (_, depth) => -f32::from(depth),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_begins_in_the_south() {
        let mut heights = vec![0.0; 6];
        dted_column(&[0, 7, 0x80, 5, 0xff, 0xff], &mut heights, 2, 1);
        assert!(heights[1].is_nan());
        assert_eq!((heights[3], heights[5], heights[0]), (-5.0, 7.0, 0.0));
    }
}
