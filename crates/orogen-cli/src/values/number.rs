//! Parsers of numbers: samples, seeds, metres and plain numbers.

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
    let cell = text.trim().parse::<f64>().map_err(|_| "a cell size must be a number of metres, such as 10 or 2.5")?;
    if !cell.is_finite() || cell <= 0.0 {
        return Err("a cell size must be greater than 0 m".into());
    }
    check_cell(cell).map(|()| cell).map_err(|error| error.to_string())
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
}
