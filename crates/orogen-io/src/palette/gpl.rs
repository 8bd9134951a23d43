//! Palettes of GIMP, Inkscape and Krita (`.gpl`): a list of colors, here evenly spaced from the lowest to the highest
//! value.

use super::color::Rgb;
use super::palette::{Palette, Position, Stop};

/// Parses a palette.
///
/// # Errors
/// A message with the line that cannot be parsed.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let mut lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
    if lines.next().is_none_or(|(_, first)| first.trim_start_matches('\u{feff}') != "GIMP Palette") {
        return Err("its first line is not `GIMP Palette`".into());
    }
    let mut colors: Vec<Rgb> = Vec::new();
    let mut title = name.to_string();
    for (number, line) in lines {
        if let Some(told) = line.strip_prefix("Name:") {
            title = told.trim().to_string();
        } else if !line.is_empty() && !line.starts_with('#') && !line.starts_with("Columns:") {
            let mut parts = line.split_whitespace();
            let mut part = || parts.next().and_then(|word| word.parse::<u8>().ok());
            let color = part().zip(part()).zip(part()).map(|((red, green), blue)| [red, green, blue]);
            let wrong = || format!("line {number}: it does not start with red, green and blue from 0 to 255");
            colors.push(color.ok_or_else(wrong)?);
        }
    }
    let last = colors.len().saturating_sub(1).max(1) as f64;
    match colors.is_empty() {
        true => Err("it has no colors".into()),
        false => {
            let stop = |(k, color)| Stop { at: Position::Share(k as f64 / last), color };
            Ok(Palette::new(&title, colors.into_iter().enumerate().map(stop).collect()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_stand_at_even_distances() {
        let text =
            "GIMP Palette\r\nName: Hills\nColumns: 3\n# by hand\n  0 10 20\tdeep\n 30 40 50\n255 255 255 white snow\n";
        let palette = parse("file", text).unwrap();
        assert_eq!(palette.name, "Hills");
        let places: Vec<Position> = palette.stops.iter().map(|stop| stop.at).collect();
        assert_eq!(places, [0.0, 0.5, 1.0].map(Position::Share));
        assert_eq!(palette.stops[2].color, [255; 3]);
        assert_eq!(parse("one", "GIMP Palette\n1 2 3").unwrap().stops.len(), 1);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, expect) in [
            ("", "first line"),
            ("JASC-PAL\n", "first line"),
            ("GIMP Palette\nName: x\n", "no colors"),
            ("GIMP Palette\n1 2 3\n1 2 256", "line 3"),
            ("GIMP Palette\n1 2", "line 2"),
        ] {
            let why = parse("t", text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
