//! Colour files of `gdaldem color-relief`.
//!
//! A line has a height and three numbers from 0 to 255, or a colour name, separated by blanks, tabs, commas or colons.
//! A fourth number, the opacity, is ignored. The height may be a percentage of the range, or `nv` for missing samples.

use super::color::Rgb;
use super::names::named;
use super::palette::{Mix, Palette, Position, Stop};

/// Parses a colour file.
///
/// # Errors
/// A message with the line that cannot be parsed.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let mut palette = Palette { name: name.to_string(), mix: Mix::Rgb, ..Palette::default() };
    for (number, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line)) {
        let line = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = line.split([' ', '\t', ',', ':', '\r']).filter(|word| !word.is_empty()).collect();
        let [at, rest @ ..] = &words[..] else { continue };
        let color = color(rest).map_err(|why| format!("line {number}: {why}"))?;
        if at.eq_ignore_ascii_case("nv") {
            palette.missing = Some(color);
            continue;
        }
        // `gdaldem`'s colour for values without a line; the nearest stops are better here.
        if at.eq_ignore_ascii_case("default") {
            continue;
        }
        let number_of = |text: &str| text.parse::<f64>().ok().filter(|value| value.abs() <= 1e9);
        let at = match at.strip_suffix('%') {
            Some(percent) => number_of(percent).map(|percent| Position::Share(percent / 100.0)),
            None => number_of(at).map(Position::Value),
        };
        let at = at.ok_or_else(|| format!("line {number}: `{}` is not a height, a percentage or nv", words[0]))?;
        palette.stops.push(Stop { at, color });
    }
    match palette.stops.is_empty() {
        true => Err("it has no line of a height and a colour, such as `1200 230 220 190`".into()),
        false => Ok(ordered(palette)),
    }
}

fn color(words: &[&str]) -> Result<Rgb, String> {
    match words {
        [name] => named(name).ok_or_else(|| format!("`{name}` is not a colour; write a name or three numbers")),
        [red, green, blue] | [red, green, blue, _] => {
            let mut color = [0; 3];
            for (part, text) in color.iter_mut().zip([red, green, blue]) {
                let value = text.parse::<f64>().ok().filter(|value| (0.0..=255.0).contains(value));
                *part = value
                    .ok_or_else(|| format!("`{text}` is not a colour component; write a number from 0 to 255"))?
                    as u8;
            }
            Ok(color)
        }
        _ => Err("the height must be followed by a colour name or by red, green and blue".into()),
    }
}

/// The stops in ascending order; the sort is stable.
fn ordered(mut palette: Palette) -> Palette {
    let place = |stop: &Stop| match stop.at {
        Position::Value(at) | Position::Share(at) | Position::Sea(at) => at,
    };
    palette.stops.sort_by(|a, b| place(a).total_cmp(&place(b)));
    palette
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_percentages_names_and_missing() {
        let text =
            "# a comment\n100%  white\n0% 0 100 0 255\n\n1500:10,20,30 # and another\nnv\tgrey50\ndefault 1 2 3\n";
        let palette = parse("t", text).unwrap();
        let stop = |at, color| Stop { at, color };
        assert_eq!(
            palette.stops,
            [
                stop(Position::Share(0.0), [0, 100, 0]),
                stop(Position::Share(1.0), [255; 3]),
                stop(Position::Value(1500.0), [10, 20, 30])
            ]
        );
        assert_eq!((palette.missing, palette.mix), (Some([128; 3]), Mix::Rgb));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, expect) in [
            ("10 1 2 3\nhigh 1 2 3", "line 2: `high` is not a height"),
            ("10 1 2", "line 1: the height must be followed"),
            ("10 1 2 256", "line 1: `256` is not a colour component"),
            ("10 blurple", "line 1: `blurple` is not a colour"),
            ("1e300 1 2 3", "line 1: `1e300`"),
            ("# nothing\n", "no line of a height"),
        ] {
            let why = parse("t", text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
