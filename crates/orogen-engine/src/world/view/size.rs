//! Numbers of samples.

use std::str::FromStr;

use super::number::samples;

/// Samples along the longer side, or both sides.
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
}
