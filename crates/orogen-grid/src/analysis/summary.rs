//! Summary statistics of a grid.

use crate::hex;
use sha2::{Digest, Sha256};

/// Accumulates a [`Summary`] from samples in row-major order, in chunks of any size. The mean is summed in this order
/// in f64, so it does not depend on the chunks.
#[derive(Debug, Clone)]
pub struct Gatherer {
    sea_level: f32,
    samples: u64,
    finite: u64,
    land: u64,
    min: f32,
    max: f32,
    sum: f64,
    hash: Sha256,
    bytes: Vec<u8>,
}

/// Summary statistics of a grid.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Summary {
    /// Number of samples.
    pub samples: u64,
    /// Number of finite samples. The statistics below use only these, except the hash.
    pub finite: u64,
    /// Minimum; NaN if there are no finite samples.
    pub min: f32,
    /// Maximum; NaN if there are no finite samples.
    pub max: f32,
    /// Mean; NaN if there are no finite samples.
    pub mean: f64,
    /// The share of finite samples above (not at) sea level, 0 to 1.
    pub land_share: f64,
    /// SHA-256 of all samples as f32 little-endian, row-major, in hexadecimal.
    pub sha256: String,
}

impl Gatherer {
    /// An empty summary; samples above `sea_level` count as land.
    #[must_use]
    pub fn new(sea_level: f64) -> Gatherer {
        Gatherer {
            sea_level: sea_level as f32,
            samples: 0,
            finite: 0,
            land: 0,
            min: f32::INFINITY,
            max: f32::NEG_INFINITY,
            sum: 0.0,
            hash: Sha256::new(),
            bytes: Vec::new(),
        }
    }

    /// Adds the next samples.
    pub fn add(&mut self, samples: &[f32]) {
        for piece in samples.chunks(1 << 14) {
            self.bytes.clear();
            self.bytes.extend(piece.iter().flat_map(|sample| sample.to_le_bytes()));
            self.hash.update(&self.bytes);
            for &sample in piece.iter().filter(|sample| sample.is_finite()) {
                self.finite += 1;
                self.land += u64::from(sample > self.sea_level);
                self.min = self.min.min(sample);
                self.max = self.max.max(sample);
                self.sum += f64::from(sample);
            }
        }
        self.samples += samples.len() as u64;
    }

    /// The summary of all added samples.
    #[must_use]
    pub fn finish(self) -> Summary {
        let count = self.finite as f64;
        let none = self.finite == 0;
        Summary {
            samples: self.samples,
            finite: self.finite,
            min: if none { f32::NAN } else { self.min },
            max: if none { f32::NAN } else { self.max },
            mean: self.sum / count,
            land_share: if none { 0.0 } else { self.land as f64 / count },
            sha256: hex::encode(&self.hash.finalize()),
        }
    }
}

/// The summary of the samples of one grid. Samples above `sea_level` count as land.
#[must_use]
pub fn summary(samples: &[f32], sea_level: f64) -> Summary {
    let mut gatherer = Gatherer::new(sea_level);
    gatherer.add(samples);
    gatherer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_counts_what_there_is() {
        let got = summary(&[1.0, -3.0, 0.0, 6.0, f32::NAN, f32::INFINITY], 0.0);
        assert_eq!((got.samples, got.finite), (6, 4));
        assert_eq!((got.min, got.max, got.mean, got.land_share), (-3.0, 6.0, 1.0, 0.5));
    }

    #[test]
    fn nothing_is_not_a_number() {
        for samples in [&[][..], &[f32::NAN]] {
            let got = summary(samples, 0.0);
            assert!(got.min.is_nan() && got.max.is_nan() && got.mean.is_nan());
            assert_eq!(got.land_share, 0.0);
        }
    }

    #[test]
    fn the_hash_is_of_the_little_endian_bytes() {
        // The output of sha256sum for zero bytes, and for the bytes 00 00 80 3f 00 00 00 c0.
        assert_eq!(summary(&[], 0.0).sha256, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        assert_eq!(
            summary(&[1.0, -2.0], 0.0).sha256,
            "ee4ac73c2bd27756ab82780f27c73a7bc4d3f0bb6acb37e008bc27eccd7e588b"
        );
    }

    #[test]
    fn pieces_change_nothing() {
        let samples: Vec<f32> = (0..50_000).map(|i| (i * 7919 % 10_007) as f32 * 0.3 - 500.0).collect();
        let whole = summary(&samples, 20.0);
        let mut gatherer = Gatherer::new(20.0);
        samples.chunks(777).for_each(|piece| gatherer.add(piece));
        assert_eq!(gatherer.finish(), whole);
    }
}
