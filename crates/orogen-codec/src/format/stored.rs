//! Samples as stored in files: numbers of one to eight bytes.

use super::conversion::Conversion;
use super::half;

/// Number of samples that are converted at once.
const PIECE: usize = 256;

/// The number type of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// An unsigned integer.
    Unsigned,
    /// A signed integer, in two's complement.
    Signed,
    /// A float of IEEE 754, of 16, 32 or 64 bits.
    Float,
}

/// The storage format of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stored {
    /// The number type.
    pub kind: Kind,
    /// Number of bytes per sample.
    pub size: usize,
    /// Whether the highest byte comes first.
    pub big_endian: bool,
}

impl Stored {
    /// The bits of a sample, right-aligned in 64 bits.
    fn bits(&self, bytes: &[u8]) -> u64 {
        match self.big_endian {
            true => bytes.iter().fold(0, |bits, byte| bits << 8 | u64::from(*byte)),
            false => bytes.iter().rev().fold(0, |bits, byte| bits << 8 | u64::from(*byte)),
        }
    }

    /// Appends the bits of samples, right-aligned in 64 bits.
    pub(crate) fn append_bits(&self, bytes: &[u8], out: &mut Vec<u64>) {
        match (self.size, self.big_endian) {
            (2, false) => out.extend(bytes.as_chunks().0.iter().map(|pair| u64::from(u16::from_le_bytes(*pair)))),
            (4, false) => out.extend(bytes.as_chunks().0.iter().map(|four| u64::from(u32::from_le_bytes(*four)))),
            _ => out.extend(bytes.chunks_exact(self.size).map(|bytes| self.bits(bytes))),
        }
    }

    /// The value of a sample's bits.
    pub(crate) fn number(&self, bits: u64) -> f64 {
        let shift = 64 - 8 * self.size as u32;
        match (self.kind, self.size) {
            (Kind::Unsigned, _) => bits as f64,
            (Kind::Signed, _) => ((bits << shift) as i64 >> shift) as f64,
            (Kind::Float, 2) => f64::from(half::to_f32(bits as u16)),
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
        }
    }

    /// The value of a sample.
    #[must_use]
    pub fn value(&self, bytes: &[u8]) -> f64 {
        self.number(self.bits(bytes))
    }

    /// Converts samples to values, as many as both slices have.
    fn values(&self, bytes: &[u8], values: &mut [f64]) {
        fn all<const N: usize>(bytes: &[u8], values: &mut [f64], number: impl Fn([u8; N]) -> f64) {
            values.iter_mut().zip(bytes.as_chunks().0).for_each(|(value, bytes)| *value = number(*bytes));
        }
        // The most common formats, without a loop over the bytes of a sample.
        match (self.kind, self.size, self.big_endian) {
            (Kind::Unsigned, 2, false) => all(bytes, values, |pair| f64::from(u16::from_le_bytes(pair))),
            (Kind::Unsigned, 2, true) => all(bytes, values, |pair| f64::from(u16::from_be_bytes(pair))),
            (Kind::Signed, 2, false) => all(bytes, values, |pair| f64::from(i16::from_le_bytes(pair))),
            (Kind::Float, 4, false) => all(bytes, values, |four| f64::from(f32::from_le_bytes(four))),
            _ => {
                let samples = bytes.chunks_exact(self.size);
                values.iter_mut().zip(samples).for_each(|(value, bytes)| *value = self.value(bytes));
            }
        }
    }

    /// Calls `take` with the values of samples, in pieces.
    fn pieces(&self, bytes: &[u8], take: &mut dyn FnMut(&[f64])) {
        let mut values = [0.0; PIECE];
        for piece in bytes.chunks(PIECE * self.size) {
            let count = piece.len() / self.size;
            self.values(piece, &mut values[..count]);
            take(&values[..count]);
        }
    }

    /// Appends the values of samples.
    pub fn append_values(&self, bytes: &[u8], values: &mut Vec<f64>) {
        self.pieces(bytes, &mut |piece| values.extend_from_slice(piece));
    }

    /// Appends the values of samples, unscaled. Samples with the value `nodata` become NaN.
    pub fn append(&self, bytes: &[u8], nodata: Option<f64>, samples: &mut Vec<f32>) {
        // NaN equals no number.
        let nodata = nodata.unwrap_or(f64::NAN);
        self.pieces(bytes, &mut |piece| {
            samples.extend(piece.iter().map(|value| if *value == nodata { f32::NAN } else { *value as f32 }));
        });
    }

    /// Appends the heights of samples: 0 becomes `low`, and `most` becomes `high`. Samples with the value `nodata`
    /// become NaN.
    pub fn append_scaled(
        &self,
        bytes: &[u8],
        most: f64,
        [low, high]: [f64; 2],
        nodata: Option<f64>,
        heights: &mut Vec<f32>,
    ) {
        let nodata = nodata.unwrap_or(f64::NAN);
        let height = |value: &f64| if *value == nodata { f32::NAN } else { (low + value / most * (high - low)) as f32 };
        self.pieces(bytes, &mut |piece| heights.extend(piece.iter().map(height)));
    }

    /// Copies the values of samples, unscaled, as many as both slices have.
    pub fn copy(&self, bytes: &[u8], samples: &mut [f32]) {
        let mut samples = samples.iter_mut();
        self.pieces(bytes, &mut |piece| {
            piece.iter().zip(&mut samples).for_each(|(value, sample)| *sample = *value as f32);
        });
    }

    /// Converts samples to heights, as many as both slices have.
    pub fn convert(&self, bytes: &[u8], conversion: &mut Conversion, heights: &mut [f32]) {
        let mut heights = heights.iter_mut();
        self.pieces(bytes, &mut |piece| {
            let pairs = piece.iter().zip(&mut heights);
            pairs.for_each(|(value, height)| *height = conversion.height(*value, self.size));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_kinds() {
        let value = |kind, big_endian, bytes: &[u8]| Stored { kind, size: bytes.len(), big_endian }.value(bytes);
        assert_eq!(value(Kind::Unsigned, true, &[0xff, 0xfe]), 65_534.0);
        assert_eq!(value(Kind::Unsigned, false, &[0xff, 0xfe]), 65_279.0);
        assert_eq!(value(Kind::Signed, true, &[0xff, 0xfe]), -2.0);
        assert_eq!(value(Kind::Signed, false, &[0x80]), -128.0);
        assert_eq!(value(Kind::Float, false, &[0x00, 0xc0]), -2.0);
        assert_eq!(value(Kind::Float, true, &1.5f32.to_be_bytes()), 1.5);
        assert_eq!(value(Kind::Float, false, &(-0.1f64).to_le_bytes()), -0.1);
    }

    #[test]
    fn many_samples_are_as_one() {
        for kind in [Kind::Unsigned, Kind::Signed, Kind::Float] {
            for size in [1, 2, 4, 8] {
                if kind == Kind::Float && size == 1 {
                    continue;
                }
                for big_endian in [false, true] {
                    let stored = Stored { kind, size, big_endian };
                    let bytes: Vec<u8> = (0..size * (2 * PIECE + 7)).map(|i| (i * 31 % 251) as u8).collect();
                    let mut values = Vec::new();
                    stored.append_values(&bytes, &mut values);
                    let one: Vec<f64> = bytes.chunks(size).map(|bytes| stored.value(bytes)).collect();
                    assert_eq!(values.len(), one.len());
                    assert!(values.iter().zip(&one).all(|(a, b)| a.to_bits() == b.to_bits()), "{stored:?}");
                    let mut samples = vec![0.0; one.len()];
                    stored.copy(&bytes, &mut samples);
                    assert!(samples.iter().zip(&one).all(|(a, b)| a.to_bits() == (*b as f32).to_bits()), "{stored:?}");
                }
            }
        }
    }

    #[test]
    fn scaled_samples_are_between_both_heights() {
        let stored = Stored { kind: Kind::Unsigned, size: 1, big_endian: true };
        let mut heights = Vec::new();
        stored.append_scaled(&[0, 51, 255, 7], 255.0, [100.0, 200.0], Some(7.0), &mut heights);
        assert_eq!(heights[..3], [100.0, 120.0, 200.0]);
        assert!(heights[3].is_nan());
    }
}
