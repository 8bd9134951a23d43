//! The parser of colors.

use orogen::palette::color::Rgb;
use orogen::palette::names::{hexadecimal, named};

/// A color: `#rrggbb`, `#rgb`, or a name.
pub fn color(text: &str) -> Result<Rgb, String> {
    let text = text.trim();
    let found = hexadecimal(text).or_else(|| named(text));
    found.ok_or_else(|| "a color must be #rrggbb or a name, such as #fdf6e3 or ivory".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors() {
        for (text, expect) in [
            ("#fdf6e3", Some([0xfd, 0xf6, 0xe3])),
            ("#fff", Some([255; 3])),
            (" Ivory", Some([255, 255, 240])),
            ("fdf6e3", None),
            ("#12345", None),
            ("", None),
        ] {
            assert_eq!(color(text).ok(), expect, "{text}");
        }
    }
}
