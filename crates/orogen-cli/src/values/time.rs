//! Ages.

use std::str::FromStr;
use std::time::Duration;

/// `--older-than`: the time since the last use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Age(pub Duration);

const UNITS: [(char, u64); 5] = [('s', 1), ('m', 60), ('h', 3600), ('d', 86_400), ('w', 604_800)];

impl FromStr for Age {
    type Err = String;

    fn from_str(text: &str) -> Result<Age, String> {
        let age = UNITS.iter().find_map(|(unit, seconds)| {
            let number: u64 = text.trim().strip_suffix(*unit)?.trim().parse().ok()?;
            number.checked_mul(*seconds)
        });
        age.map(|seconds| Age(Duration::from_secs(seconds)))
            .ok_or_else(|| "an age must be a number with a unit of s, m, h, d or w, such as 30d".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ages() {
        for (text, expect) in [
            ("30d", Some(2_592_000)),
            ("12h", Some(43_200)),
            ("90 m", Some(5400)),
            ("0s", Some(0)),
            ("5", None),
            ("-1d", None),
            ("d", None),
            ("99999999999999999999d", None),
            ("999999999999999999w", None),
        ] {
            assert_eq!(text.parse::<Age>().ok().map(|age| age.0.as_secs()), expect, "{text}");
        }
    }
}
