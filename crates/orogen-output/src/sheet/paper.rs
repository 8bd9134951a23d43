//! Paper sizes.

use std::str::FromStr;

/// Width and height in millimetres, in portrait orientation unless given otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paper([f64; 2]);

/// Named paper sizes, in portrait orientation.
pub const NAMES: [(&str, [f64; 2]); 8] = [
    ("a0", [841.0, 1189.0]),
    ("a1", [594.0, 841.0]),
    ("a2", [420.0, 594.0]),
    ("a3", [297.0, 420.0]),
    ("a4", [210.0, 297.0]),
    ("a5", [148.0, 210.0]),
    ("letter", [215.9, 279.4]),
    ("legal", [215.9, 355.6]),
];

/// Minimum and maximum length of a side, in millimetres.
const SIDES: [f64; 2] = [50.0, 2000.0];

impl Paper {
    /// Width and height in millimetres, in landscape orientation on request.
    #[must_use]
    pub fn sides(self, landscape: bool) -> [f64; 2] {
        let [width, height] = self.0;
        if landscape { [width.max(height), width.min(height)] } else { [width, height] }
    }
}

impl FromStr for Paper {
    type Err = String;

    fn from_str(text: &str) -> Result<Paper, String> {
        let text = text.trim().to_ascii_lowercase();
        if let Some((_, sides)) = NAMES.iter().find(|(name, _)| *name == text) {
            return Ok(Paper(*sides));
        }
        let sides = text.strip_suffix("mm").and_then(|sides| sides.split_once('x'));
        let number = |side: &str| side.trim().parse::<f64>().ok().filter(|side| (SIDES[0]..=SIDES[1]).contains(side));
        match sides.map(|(width, height)| (number(width), number(height))) {
            Some((Some(width), Some(height))) => Ok(Paper([width, height])),
            _ => Err(format!(
                "the paper size must be a0 to a5, letter, legal, or WxHmm such as 300x200mm, with sides from {} to {} mm",
                SIDES[0], SIDES[1]
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn papers() {
        for (text, expect) in [
            ("a4", Some([210.0, 297.0])),
            ("Letter", Some([215.9, 279.4])),
            ("300x200mm", Some([300.0, 200.0])),
            ("300x200", None),
            ("10x200mm", None),
            ("nanxnanmm", None),
            ("a9", None),
            ("", None),
        ] {
            assert_eq!(text.parse::<Paper>().ok().map(|paper| paper.sides(false)), expect, "{text}");
        }
        assert_eq!("a4".parse::<Paper>().unwrap().sides(true), [297.0, 210.0]);
    }
}
