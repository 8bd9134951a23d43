//! Counts of finite samples. Samples that are NaN or infinite are counted, reported, and ignored by every summary.

use crate::error::{Error, ErrorKind};
use crate::words::percent;

/// The number of samples, and how many of them are finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FiniteCount {
    /// Number of samples.
    pub samples: u64,
    /// Number of samples that are neither NaN nor infinite.
    pub finite: u64,
}

impl FiniteCount {
    /// Counts the finite ones among `samples`.
    #[must_use]
    pub fn of(samples: &[f32]) -> FiniteCount {
        let finite = samples.iter().filter(|sample| sample.is_finite()).count();
        FiniteCount { samples: samples.len() as u64, finite: finite as u64 }
    }

    /// The sum of both counts.
    #[must_use]
    pub fn and(self, other: FiniteCount) -> FiniteCount {
        FiniteCount { samples: self.samples + other.samples, finite: self.finite + other.finite }
    }

    /// Returns an error if none of the samples is finite, and a warning if some are not. `what` names the samples in
    /// messages: "the layer `height`".
    ///
    /// # Errors
    /// If there are samples and none of them is finite.
    pub fn check(self, what: &str) -> Result<Option<String>, Error> {
        let FiniteCount { samples, finite } = self;
        match samples - finite {
            0 => Ok(None),
            missing if missing == samples => Err(Error::new(
                ErrorKind::Request,
                format!(
                    "{what} has no finite sample: all {samples} are NaN or infinite. Look in the recipe for values beyond 3.4e38, and for what has no result: 0 / 0, and roots and logarithms of negative numbers"
                ),
            )),
            missing => {
                let share = percent(missing, samples);
                Ok(Some(format!(
                    "{missing} of {samples} samples of {what} ({share}) are NaN or infinite; summaries and colors ignore them"
                )))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_are_told_and_none_is_refused() {
        let (nan, inf) = (f32::NAN, f32::INFINITY);
        let check = |samples: &[f32]| FiniteCount::of(samples).check("it").map_err(|error| error.to_string());
        assert_eq!(check(&[1.0, -2.0, 0.0]), Ok(None));
        assert_eq!(check(&[]), Ok(None));
        assert!(check(&[1.0, nan, -inf]).unwrap().unwrap().starts_with("2 of 3 samples of it (66.67 %) are NaN"));
        assert!(check(&[inf, nan]).unwrap_err().starts_with("it has no finite sample: all 2 are"));
        assert!(check(&[nan, nan]).unwrap_err().ends_with("0 / 0, and roots and logarithms of negative numbers"));
        let many = FiniteCount { samples: 1_000_000, finite: 999_999 };
        assert!(many.check("it").unwrap().unwrap().contains("(less than 0.01 %)"));
        assert_eq!(many.and(FiniteCount::of(&[nan])), FiniteCount { samples: 1_000_001, finite: 999_999 });
    }
}
