//! Color files of `gdaldem color-relief`.
//!
//! A line has a height and three numbers from 0 to 255, or a color name, separated by blanks, tabs, commas or colons.
//! A fourth number, the opacity, is ignored. The height may be a percentage of the range, or `nv` for missing samples.
//!
//! Two other kinds of files are supported. Colors may be from 0 to 1, if no number of the file is larger and one has a
//! decimal point. Lines may also have three such numbers without heights (matplotlib's color maps, Scientific Color
//! Maps); they are evenly spaced over the range.

use super::color::Rgb;
use super::names::named;
use super::palette::{Mix, Palette, Position, Stop};

/// Parses a color file.
///
/// # Errors
/// A message with the line that cannot be parsed.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let mut palette = Palette::new(name, Vec::new());
    palette.mix = Mix::Rgb;
    let lines: Vec<(usize, Vec<&str>)> = (text.lines().enumerate())
        .map(|(k, line)| (k + 1, line.split('#').next().unwrap_or_default()))
        .map(|(k, line)| (k, line.split([' ', '\t', ',', ':', '\r']).filter(|word| !word.is_empty()).collect()))
        .filter(|(_, words): &(usize, Vec<&str>)| !words.is_empty())
        .collect();
    if let Some(colors) = colors_alone(&lines) {
        let last = (colors.len() - 1).max(1) as f64;
        let stop = |(k, color)| Stop { at: Position::Share(k as f64 / last), color };
        palette.stops = colors.into_iter().enumerate().map(stop).collect();
        return Ok(palette);
    }
    let scale = scale_of(lines.iter().flat_map(|(_, words)| match words.get(1..) {
        Some(color @ [_, _, _, ..]) => color[..3].iter().copied(),
        _ => [].iter().copied(),
    }));
    for (number, words) in &lines {
        let [at, rest @ ..] = &words[..] else { continue };
        let color = color(rest, scale).map_err(|why| format!("line {number}: {why}"))?;
        if at.eq_ignore_ascii_case("nv") {
            palette.missing = Some(color);
            continue;
        }
        // `gdaldem`'s color for values without a line; here they get the nearest stops instead.
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
        true => Err("it has no line of a height and a color, such as `1200 230 220 190`".into()),
        false => Ok(ordered(palette)),
    }
}

/// The colors of a file whose lines are all three numbers from 0 to 1; `None` for other files.
fn colors_alone(lines: &[(usize, Vec<&str>)]) -> Option<Vec<Rgb>> {
    let is_alone = lines.len() > 1 && lines.iter().all(|(_, words)| words.len() == 3);
    let scale = scale_of(lines.iter().flat_map(|(_, words)| words.iter().copied()));
    let colors = || lines.iter().map(|(_, words)| color(words, scale).ok()).collect();
    if is_alone && scale == 255.0 { colors() } else { None }
}

/// The factor that converts components to bytes: 255 if none is larger than 1 and one has a decimal point, else 1.
fn scale_of<'a>(components: impl Iterator<Item = &'a str> + Clone) -> f64 {
    let is_small = |text: &str| text.parse::<f64>().is_ok_and(|value| (0.0..=1.0).contains(&value));
    match components.clone().any(|text| text.contains('.')) && components.clone().all(is_small) {
        true => 255.0,
        false => 1.0,
    }
}

/// The color of a name in `gdaldem`, whose gray, brown and others differ from the web colors; `None` for other names.
fn of_gdaldem(name: &str) -> Option<Rgb> {
    Some(match name.to_ascii_lowercase().as_str() {
        "green" => [0, 255, 0],
        "aqua" => [0, 191, 191],
        "grey" | "gray" => [191; 3],
        "orange" => [255, 127, 0],
        "brown" => [191, 127, 63],
        "purple" | "violet" => [127, 0, 255],
        "indigo" => [0, 127, 255],
        _ => return None,
    })
}

fn color(words: &[&str], scale: f64) -> Result<Rgb, String> {
    match words {
        [name] => of_gdaldem(name)
            .or_else(|| named(name))
            .ok_or_else(|| format!("`{name}` is not a color; write a name or three numbers")),
        [red, green, blue] | [red, green, blue, _] => {
            let mut color = [0; 3];
            for (part, text) in color.iter_mut().zip([red, green, blue]) {
                let value = text.parse::<f64>().ok().filter(|value| (0.0..=255.0).contains(value));
                let value = value.ok_or_else(|| {
                    format!("`{text}` is not a color component; write numbers from 0 to 255, or all from 0 to 1")
                })?;
                *part = if scale > 1.0 { (value * scale).round() as u8 } else { value as u8 };
            }
            Ok(color)
        }
        _ => Err("the height must be followed by a color name or by red, green and blue".into()),
    }
}

/// The stops in ascending order; stops with equal positions keep their order.
fn ordered(mut palette: Palette) -> Palette {
    palette.stops.sort_by(|a, b| a.at.number().total_cmp(&b.at.number()));
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
    fn names_have_the_colors_of_gdaldem() {
        // As `gdaldem color-relief` of GDAL 3.6 draws them; names that it does not know are web colors.
        let expect = [
            ("green", [0, 255, 0]),
            ("Aqua", [0, 191, 191]),
            ("gray", [191; 3]),
            ("orange", [255, 127, 0]),
            ("brown", [191, 127, 63]),
            ("purple", [127, 0, 255]),
            ("violet", [127, 0, 255]),
            ("indigo", [0, 127, 255]),
            ("magenta", [255, 0, 255]),
            ("navy", [0, 0, 128]),
        ];
        for (name, color) in expect {
            assert_eq!(parse("t", &format!("7 {name}")).unwrap().stops[0].color, color, "{name}");
        }
    }

    #[test]
    fn colors_from_0_to_1() {
        let stop = |at, color| Stop { at, color };
        let palette = parse("t", "nv .5 .5 .5\n0 0 0.5 1\n1200, 1.0, 0.2, 0, 0.9\n3e3 white\n").unwrap();
        let value = Position::Value;
        let expect = [stop(value(0.0), [0, 128, 255]), stop(value(1200.0), [255, 51, 0]), stop(value(3e3), [255; 3])];
        assert_eq!((&palette.stops[..], palette.missing), (&expect[..], Some([128; 3])));
        // Integers are bytes, and so are numbers in a file with a number above 1.
        for text in ["0 0 1 1\n5 1 1 0", "0 0.5 1 1\n5 1 2 1"] {
            assert!(
                parse("t", text).unwrap().stops.iter().all(|stop| stop.color.iter().all(|part| *part < 3)),
                "{text}"
            );
        }
        // Lines without heights.
        let palette = parse("t", "0.0 0.5 1.0\n0.2 0.2 0.2\n1.000000 0.000000 0.000000\n").unwrap();
        let share = Position::Share;
        assert_eq!(
            palette.stops,
            [stop(share(0.0), [0, 128, 255]), stop(share(0.5), [51; 3]), stop(share(1.0), [255, 0, 0])]
        );
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, expect) in [
            ("10 1 2 3\nhigh 1 2 3", "line 2: `high` is not a height"),
            ("10 1 2", "line 1: the height must be followed"),
            ("10 1 2 256", "line 1: `256` is not a color component"),
            (
                "10 0.1 0.2 -0.3",
                "line 1: `-0.3` is not a color component; write numbers from 0 to 255, or all from 0 to 1",
            ),
            ("0.1 0.2 0.3\n0.1 0.2 3", "line 1: the height must be followed"),
            ("10 blurple", "line 1: `blurple` is not a color"),
            ("1e300 1 2 3", "line 1: `1e300`"),
            ("# nothing\n", "no line of a height"),
        ] {
            let why = parse("t", text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
