//! Parsers of numbers: samples, seeds, metres and plain numbers.

use std::str::FromStr;

use clap::builder::TypedValueParser;
use orogen::world::check_cell;

/// Maximum number of samples per side: far beyond any memory, and small enough to avoid overflow.
pub const MOST: u64 = 1_000_000_000;

/// Number of samples of a side.
pub fn samples(text: &str) -> Result<usize, String> {
    match text.trim().parse::<u64>() {
        Ok(n) if (1..=MOST).contains(&n) => Ok(n as usize),
        Ok(n) => Err(format!("a side must have 1 to {MOST} samples, not {n}")),
        Err(_) => Err("a size must be a number of samples, such as 1024 or 1024x768".into()),
    }
}

/// `--seed`: in the range that recipes allow.
pub fn seed(text: &str) -> Result<u64, String> {
    let seed = text.trim().parse().ok().filter(|&seed| seed <= i64::MAX as u64);
    seed.ok_or_else(|| format!("a seed must be a whole number from 0 to {}", i64::MAX))
}

/// `--cell`: distance between samples, in metres.
pub fn cell(text: &str) -> Result<f64, String> {
    let cell = length(text, "a cell size", ["0 m", "metres, such as 10 or 2.5"])?;
    check_cell(cell).map(|()| cell).map_err(|error| error.to_string())
}

/// `--wavelength`: wavelength of a noise in samples.
pub fn wavelength(text: &str) -> Result<f64, String> {
    length(text, "a wavelength", ["0 samples", "samples, such as 64 or 2.5"])
}

/// `--frequency`: waves of a noise per sample.
pub fn frequency(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(frequency) if frequency > 0.0 && frequency.is_finite() && (1.0 / frequency).is_finite() => Ok(frequency),
        Ok(_) => Err("a frequency must be greater than 0 waves per sample".into()),
        Err(_) => Err("a frequency must be a number of waves per sample, such as 0.02".into()),
    }
}

/// `--range`: the values that -1 and 1 become.
pub fn range(text: &str) -> Result<[f64; 2], String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| finite(part).ok()).collect();
    match parts.as_deref() {
        Some(&[low, high]) if low != high && low.abs().max(high.abs()) <= f64::from(f32::MAX) => Ok([low, high]),
        Some(&[_, _]) => Err("the values of a range must be different 32-bit numbers".into()),
        _ => Err("a range must be A,B: the values that -1 and 1 become, such as 0,1".into()),
    }
}

/// A positive length; `zero` and `of` are the parts of its messages.
fn length(text: &str, what: &str, [zero, of]: [&str; 2]) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(length) if length.is_finite() && length > 0.0 => Ok(length),
        Ok(_) => Err(format!("{what} must be greater than {zero}")),
        Err(_) => Err(format!("{what} must be a number of {of}")),
    }
}

/// `--dpi`: pixels per inch of a page.
pub fn dpi() -> impl TypedValueParser<Value = u16> {
    clap::value_parser!(u16).range(20..=1200)
}

/// A finite number.
pub fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "the value must be a number, such as 2 or 0.5".into())
}

/// A positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|&number| number > 0.0)
        .ok_or_else(|| "the value must be greater than 0, such as 2 or 0.5".into())
}

/// A number that is not negative.
pub fn not_negative(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|&number| number >= 0.0)
        .ok_or_else(|| "the value must be 0 or greater, such as 1.5".into())
}

/// Several numbers separated by commas: a position or a direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbers(pub Vec<f64>);

impl FromStr for Numbers {
    type Err = String;

    fn from_str(text: &str) -> Result<Numbers, String> {
        text.split(',')
            .map(finite)
            .collect::<Result<Vec<f64>, String>>()
            .map(Numbers)
            .map_err(|_| format!("`{text}` is not a list of numbers separated by commas, such as 200,24"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells() {
        for (text, expect) in [
            ("2.5", Some(2.5)),
            ("1e3", Some(1000.0)),
            ("1e-6", Some(1e-6)),
            ("9e-7", None),
            ("1e-300", None),
            ("1e12", Some(1e12)),
            ("1.1e12", None),
            ("1e300", None),
            ("0", None),
            ("-1", None),
            ("nan", None),
            ("inf", None),
            ("1e999", None),
            ("m", None),
        ] {
            assert_eq!(cell(text).ok(), expect, "{text}");
        }
    }

    #[test]
    fn numbers() {
        for (text, wave, any, above, from) in [
            ("2.5", true, true, true, true),
            ("0", false, true, false, true),
            ("-3", false, true, false, false),
            ("nan", false, false, false, false),
            ("inf", false, false, false, false),
            ("", false, false, false, false),
        ] {
            let got = [wavelength(text), finite(text), positive(text), not_negative(text)].map(|parsed| parsed.is_ok());
            assert_eq!(got, [wave, any, above, from], "{text}");
        }
    }

    #[test]
    fn lists() {
        assert_eq!("200, -24.5".parse(), Ok(Numbers(vec![200.0, -24.5])));
        for text in ["", "a", "1,", "1,nan", "1;2"] {
            assert!(text.parse::<Numbers>().is_err(), "{text}");
        }
    }
}
