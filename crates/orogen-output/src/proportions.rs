//! Checks whether land is so steep as a whole that a picture or model of it is useless. The usual cause is that heights
//! and lengths have different units.

use orogen_grid::words::number;

/// Ratio of relief to width above which land is too high, and the ratio that is advised. Real mountains are below 0.2.
const MOST: f64 = 1.0;
const GOOD: f64 = 0.25;

/// Minimum exaggeration that the warning advises.
const LEAST: f64 = 0.01;

/// A warning that advises an exaggeration, if land with this relief and width in metres is too high with its current
/// exaggeration; `None` otherwise.
#[must_use]
pub fn warning(relief: f64, width: f64, exaggeration: f64) -> Option<String> {
    let ratio = relief * exaggeration / width;
    if !ratio.is_finite() || ratio <= MOST {
        return None;
    }
    // Rounded to two digits.
    let advised = (GOOD * width / relief).max(LEAST);
    let step = libm::pow(10.0, libm::log10(advised).floor() - 1.0);
    let advised = (advised / step).round() * step;
    let shown = match exaggeration {
        1.0 => String::new(),
        _ => format!(" and shown {} times as high", number(exaggeration)),
    };
    Some(format!(
        "the land is {} m high{shown} but only {} m wide; use an exaggeration of about {} (or are its lengths in another unit than its heights?)",
        number((relief * 10.0).round() / 10.0),
        number(width),
        number(advised)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn land_higher_than_wide_is_told_with_the_factor_to_use() {
        assert_eq!(warning(512.0, 512.0, 1.0), None);
        assert_eq!(warning(8848.0, 40_000.0, 4.0), None);
        let told = warning(9848.0, 512.0, 1.0).unwrap();
        assert!(told.contains("9848 m high but only 512 m wide; use an exaggeration of about 0.013 ("), "{told}");
        let told = warning(500.0, 1000.0, 10.0).unwrap();
        assert!(told.contains("500 m high and shown 10 times as high but") && told.contains("about 0.5 ("), "{told}");
        assert_eq!(warning(0.0, 0.0, 1.0), None);
        assert_eq!(warning(f64::INFINITY, 1.0, 1.0), None);
    }
}
