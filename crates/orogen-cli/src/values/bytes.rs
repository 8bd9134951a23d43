//! `--memory`, `--cache-limit` and other numbers of bytes.

use std::str::FromStr;

/// Bytes, with or without a unit.
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
            return Err("it must be a number of bytes, such as 512MiB, 2GiB or 1.5GB".into());
        };
        match number * *unit as f64 {
            bytes if bytes >= 1.0 && bytes < u64::MAX as f64 => Ok(Bytes(bytes as u64)),
            bytes if bytes < 1.0 => Err("it must be at least 1 byte".into()),
            _ => Err("it must be less than 16384 PiB".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_no_option_because_several_have_such_values() {
        for (text, expect) in [
            ("0", "it must be at least 1 byte"),
            ("5 parsecs", "it must be a number of bytes, such as 512MiB, 2GiB or 1.5GB"),
            ("99999999TiB", "it must be less than 16384 PiB"),
        ] {
            assert_eq!(text.parse::<Bytes>(), Err(expect.to_string()));
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
