//! Parsers of numbers: seeds, metres and plain numbers.

use clap::builder::TypedValueParser;
pub use orogen::view::finite;
use orogen::world::check_cell;

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

/// `--width`: width of a map, in kilometres.
pub fn kilometres(text: &str) -> Result<f64, String> {
    let width = text.trim().parse().ok().filter(|width: &f64| (1.0..=40_000.0).contains(width));
    width.ok_or_else(|| "the width of a map must be a number of kilometres from 1 to 40000, such as 1200".into())
}

/// `--dpi`: pixels per inch of a page.
pub fn dpi() -> impl TypedValueParser<Value = u16> {
    clap::value_parser!(u16).range(20..=1200)
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
