//! Levels of contours.

use crate::error::{Error, ErrorKind, Result};

/// Maximum number of levels.
pub const MOST: usize = 65_000;

/// The multiples of `interval` metres that are above `low` and at most `high`.
///
/// # Errors
/// If the interval is not above 0, or there would be more than [`MOST`] levels.
pub fn levels_every(interval: f64, low: f64, high: f64) -> Result<Vec<f64>> {
    let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
    if !(interval > 0.0 && interval.is_finite()) {
        return fault(format!("the contour interval must be greater than 0 m, not {interval}"));
    }
    if !(low.is_finite() && high > low) {
        return Ok(Vec::new());
    }
    let (first, last) = ((low / interval).floor() + 1.0, (high / interval).floor());
    if last - first + 1.0 > MOST as f64 || first.abs().max(last.abs()) > 9e15 {
        return fault(format!(
            "an interval of {interval} m gives {:.0} contours between {low} and {high} m, and at most {MOST} are supported; use a larger interval",
            last - first + 1.0
        ));
    }
    // Multiples instead of a running sum, so that the levels do not depend on the lowest height.
    Ok((first as i64..=last as i64).map(|k| k as f64 * interval).collect())
}

/// The given levels in ascending order, without duplicates.
///
/// # Errors
/// If a level is not finite, or there are more than [`MOST`].
pub fn given(levels: &[f64]) -> Result<Vec<f64>> {
    let fault = |message: String| Err(Error::new(ErrorKind::Request, message));
    if let Some(level) = levels.iter().find(|level| !level.is_finite()) {
        return fault(format!("{level} is not a valid contour height"));
    }
    let mut levels = levels.to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    match levels.len() > MOST {
        true => fault(format!("there are {} contour heights, and at most {MOST} are supported", levels.len())),
        false => Ok(levels),
    }
}

/// A round interval (1, 2 or 5 times a power of ten) that gives at most `most` levels within `relief` metres; 1 if
/// there is no relief.
#[must_use]
pub fn round_interval(relief: f64, most: usize) -> f64 {
    let least = relief / most.max(1) as f64;
    if !(least > 1e-9 && least < 1e12) {
        return 1.0;
    }
    let power = libm::pow(10.0, libm::log10(least).floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|n| n * power).find(|step| *step >= least).unwrap_or(10.0 * power)
}

/// Whether a level is an index contour: every fifth, counted from 0.
#[must_use]
pub fn is_index(level: f64, interval: f64) -> bool {
    let fifth = level / (5.0 * interval);
    (fifth - fifth.round()).abs() < 1e-6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_within_the_ground() {
        for (interval, low, high, expect) in [
            (100.0, 95.0, 310.0, vec![100.0, 200.0, 300.0]),
            // All samples are at or above the lowest height, so it has no line. The highest height is included.
            (100.0, 100.0, 300.0, vec![200.0, 300.0]),
            (0.1, -0.25, 0.05, vec![-0.2, -0.1, 0.0]),
            (50.0, 7.0, 7.0, vec![]),
            (50.0, f64::NAN, 7.0, vec![]),
        ] {
            assert_eq!(levels_every(interval, low, high).unwrap(), expect, "{interval} {low} {high}");
        }
        for interval in [0.0, -5.0, f64::NAN, f64::INFINITY] {
            assert!(levels_every(interval, 0.0, 1.0).unwrap_err().to_string().contains("must be greater than 0 m"));
        }
        assert!(levels_every(1e-3, 0.0, 3000.0).unwrap_err().to_string().contains("use a larger interval"));
        assert!(levels_every(1e-300, 0.0, 1.0).is_err());
    }

    #[test]
    fn levels_given_are_sorted_and_single() {
        assert_eq!(given(&[5.0, -1.0, 5.0, 2.5]).unwrap(), [-1.0, 2.5, 5.0]);
        assert!(given(&[f64::NAN]).unwrap_err().to_string().contains("NaN is not a valid contour height"));
    }

    #[test]
    fn intervals_are_round() {
        for (relief, most, expect) in
            [(3000.0, 30, 100.0), (3100.0, 30, 200.0), (4.0, 20, 0.2), (0.0, 20, 1.0), (f64::NAN, 9, 1.0)]
        {
            assert!((round_interval(relief, most) - expect).abs() < 1e-9, "{relief} {most}");
        }
        assert!(is_index(500.0, 100.0) && is_index(0.0, 100.0) && !is_index(600.0, 100.0) && is_index(-0.5, 0.1));
    }
}
