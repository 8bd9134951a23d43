//! Numbers as text.

use std::fmt::Write as _;

/// Number of decimals that resolve a thousandth of `step`.
#[must_use]
pub fn decimals(step: f64) -> usize {
    (3.0 - libm::log10(step).floor()).clamp(0.0, 15.0) as usize
}

/// Appends a number with at most `decimals` decimals and without trailing zeros.
pub fn number(text: &mut String, value: f64, decimals: usize) {
    let power = POWERS[decimals.min(POWERS.len() - 1)];
    let scaled = (value * power).round();
    // Integers are formatted much faster than fractions.
    if scaled.abs() < 9e15 && decimals < POWERS.len() {
        let (whole, part) = ((scaled.abs() as u64) / power as u64, (scaled.abs() as u64) % power as u64);
        if scaled < 0.0 {
            text.push('-');
        }
        let _ = write!(text, "{whole}");
        if part > 0 {
            let _ = write!(text, ".{part:0decimals$}");
            text.truncate(text.trim_end_matches('0').len());
        }
    } else {
        let _ = write!(text, "{value}");
    }
}

const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// Appends a line for each sample: its position and its value. A sample that is not finite has no value.
pub fn append_samples(text: &mut String, places: &[[f64; 2]], decimals: usize, samples: &[f32]) {
    for (place, sample) in places.iter().zip(samples) {
        for position in place {
            number(text, *position, decimals);
            text.push(',');
        }
        if sample.is_finite() {
            let _ = write!(text, "{sample}");
        }
        text.push('\n');
    }
}

/// Appends a row of numbers, separated by blanks. Numbers that are not finite are written as `nodata`.
pub fn append_row(text: &mut String, row: &[f32], nodata: f32) {
    for (i, height) in row.iter().enumerate() {
        if i > 0 {
            text.push(' ');
        }
        let height = if height.is_finite() { *height } else { nodata };
        // Writing to a string does not fail.
        let _ = write!(text, "{height}");
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        for (value, decimals, expect) in [
            (0.0, 2, "0"),
            (-0.001, 2, "0"),
            (12.5, 3, "12.5"),
            (-12.0625, 4, "-12.0625"),
            (1e6 / 3.0, 2, "333333.33"),
            (7.0, 0, "7"),
            (1e300, 3, &format!("{}", 1e300)),
        ] {
            let mut text = String::new();
            number(&mut text, value, decimals);
            assert_eq!(text, expect, "{value}");
        }
        assert_eq!([0.01, 1.0, 30.0, 1e5, 1e-4].map(decimals), [5, 3, 2, 0, 7]);
    }

    #[test]
    fn a_row_has_blanks_between_its_numbers() {
        let mut text = String::new();
        append_row(&mut text, &[1.5, f32::NAN, -2.0], -9999.0);
        assert_eq!(text, "1.5 -9999 -2\n");
    }
}
