//! Parsers of sizes: samples, bytes, and other numbers.

use std::str::FromStr;

/// Maximum number of samples per side: far beyond any memory, and small enough to avoid overflow.
pub const MOST: u64 = 1_000_000_000;

/// `--size`: samples along the longer side, or both sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// N: the longer side; the other follows from the aspect ratio of the world.
    Longer(usize),
    /// WxH.
    Both(usize, usize),
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Size, String> {
        match text.split_once(['x', 'X', '×']) {
            Some((width, height)) => Ok(Size::Both(samples(width)?, samples(height)?)),
            None => Ok(Size::Longer(samples(text)?)),
        }
    }
}

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
    match text.trim().parse::<f64>() {
        Ok(cell) if cell.is_finite() && cell > 0.0 => Ok(cell),
        Ok(_) => Err("a cell size must be greater than 0 m".into()),
        Err(_) => Err("a cell size must be a number of metres, such as 10 or 2.5".into()),
    }
}

/// `--wavelength`: wavelength of a noise in samples.
pub fn wavelength(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(wavelength) if wavelength.is_finite() && wavelength > 0.0 => Ok(wavelength),
        Ok(_) => Err("a wavelength must be greater than 0 samples".into()),
        Err(_) => Err("a wavelength must be a number of samples, such as 64 or 2.5".into()),
    }
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

/// A time of day, as hours after midnight.
pub fn clock(text: &str) -> Result<f64, String> {
    let number = |text: &str, end: u32| text.trim().parse::<u32>().ok().filter(|n| *n < end).map(f64::from);
    let time = text.split_once(':').and_then(|(hour, minute)| Some(number(hour, 24)? + number(minute, 60)? / 60.0));
    time.ok_or_else(|| "a time must be from 00:00 to 23:59, such as 17:30".into())
}

/// `--memory`: bytes, with or without a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bytes(pub u64);

const UNITS: [(&str, u64); 14] = [
    ("", 1),
    ("b", 1),
    ("k", 1 << 10),
    ("kib", 1 << 10),
    ("kb", 1000),
    ("m", 1 << 20),
    ("mib", 1 << 20),
    ("mb", 1_000_000),
    ("g", 1 << 30),
    ("gib", 1 << 30),
    ("gb", 1_000_000_000),
    ("t", 1 << 40),
    ("tib", 1 << 40),
    ("tb", 1_000_000_000_000),
];

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Bytes, String> {
        let text = text.trim();
        let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
        let unit = text[digits..].trim().to_lowercase();
        let unit = UNITS.iter().find(|(name, _)| *name == unit);
        let (Ok(number), Some((_, unit))) = (text[..digits].parse::<f64>(), unit) else {
            return Err("the memory limit must be a number of bytes, such as 512MiB, 2GiB or 1.5GB".into());
        };
        match number * *unit as f64 {
            bytes if bytes >= 1.0 && bytes < u64::MAX as f64 => Ok(Bytes(bytes as u64)),
            bytes if bytes < 1.0 => Err("the memory limit must be at least 1 byte".into()),
            _ => Err("the memory limit is too large".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        for (text, expect) in [
            ("1", Some(Size::Longer(1))),
            ("1024", Some(Size::Longer(1024))),
            ("1024x768", Some(Size::Both(1024, 768))),
            ("64 x 32", Some(Size::Both(64, 32))),
            ("0", None),
            ("0x5", None),
            ("-5", None),
            ("1.5", None),
            ("NaN", None),
            ("", None),
            ("x", None),
            ("1x2x3", None),
            ("99999999999999999999", None),
        ] {
            assert_eq!(text.parse::<Size>().ok(), expect, "{text}");
        }
    }

    #[test]
    fn cells() {
        for (text, expect) in [
            ("2.5", Some(2.5)),
            ("1e3", Some(1000.0)),
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
    fn lists_and_times() {
        assert_eq!("200, -24.5".parse(), Ok(Numbers(vec![200.0, -24.5])));
        for text in ["", "a", "1,", "1,nan", "1;2"] {
            assert!(text.parse::<Numbers>().is_err(), "{text}");
        }
        for (text, expect) in [
            ("17:30", Some(17.5)),
            ("0:00", Some(0.0)),
            ("24:00", None),
            ("12:60", None),
            ("12", None),
            ("-1:00", None),
        ] {
            assert_eq!(clock(text).ok(), expect, "{text}");
        }
    }

    #[test]
    fn memory() {
        for (text, expect) in [
            ("512MiB", Some(512 << 20)),
            ("2GiB", Some(2 << 30)),
            ("2 gib", Some(2 << 30)),
            ("2G", Some(2 << 30)),
            ("1.5GB", Some(1_500_000_000)),
            ("123456", Some(123_456)),
            ("0", None),
            ("-1GiB", None),
            ("1.5.5GB", None),
            ("GiB", None),
            ("5 parsecs", None),
            ("99999999TiB", None),
            ("nan", None),
        ] {
            assert_eq!(text.parse::<Bytes>().ok(), expect.map(Bytes), "{text}");
        }
    }
}
