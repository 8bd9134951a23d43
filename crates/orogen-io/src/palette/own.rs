//! Palettes in TOML, for writing by hand.
//!
//! ```toml
//! name = "Autumn"
//! unit = "m"              # or "range" (0 the lowest, 1 the highest) or "sea" (-1 the deepest, 0 the shore, 1 the highest)
//! mix = "oklab"           # or "rgb" or "hsv"
//! stops = [[0, "#2c5f2d"], [900, "#97bc62"], [1800, "white"]]
//! missing = "#dddddd"
//! ```

use std::mem::discriminant;

use serde::Deserialize;

use super::color::{Rgb, hex};
use super::names::{hexadecimal, named};
use super::palette::{Mix, Palette, Position, Stop};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    unit: Option<String>,
    mix: Option<String>,
    stops: Vec<(f64, String)>,
    below: Option<String>,
    above: Option<String>,
    missing: Option<String>,
}

/// Parses a palette.
///
/// # Errors
/// A message about what is wrong.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let file: File = toml::from_str(text).map_err(|cause| cause.to_string().trim_end().replace('\n', " "))?;
    let unit = file.unit.as_deref().unwrap_or("m");
    let place = match unit {
        "m" => Position::Value,
        "range" => Position::Share,
        "sea" => Position::Sea,
        other => return Err(format!("unknown unit \"{other}\"; supported are \"m\", \"range\" and \"sea\"")),
    };
    let mix = match file.mix.as_deref() {
        None | Some("oklab") => Mix::Oklab,
        Some("rgb") => Mix::Rgb,
        Some("hsv") => Mix::Hsv,
        Some(other) => return Err(format!("unknown mix \"{other}\"; supported are \"oklab\", \"rgb\" and \"hsv\"")),
    };
    if file.stops.is_empty() {
        return Err("it has no stops, such as stops = [[0, \"#2c5f2d\"], [1800, \"white\"]]".into());
    }
    let mut stops = Vec::new();
    for (at, text) in &file.stops {
        if !(-1e9..=1e9).contains(at) {
            return Err(format!("{at} is not a valid position of a colour"));
        }
        stops.push(Stop { at: place(*at), color: color(text)? });
    }
    if !file.stops.is_sorted_by(|a, b| a.0 <= b.0) {
        return Err("its stops are not in ascending order".into());
    }
    let optional = |text: &Option<String>| text.as_deref().map(color).transpose();
    Ok(Palette {
        name: file.name.unwrap_or_else(|| name.to_string()),
        stops,
        mix,
        below: optional(&file.below)?,
        above: optional(&file.above)?,
        missing: optional(&file.missing)?,
        follows_relief: false,
    })
}

/// A palette as a text that [`parse`] reads. `None` if the positions of its colors are of several kinds, or follow the relief, which the format cannot say.
#[must_use]
pub fn write(palette: &Palette) -> Option<String> {
    let first = palette.stops.first()?.at;
    let unit = match first {
        Position::Value(_) => "m",
        Position::Share(_) => "range",
        Position::Sea(_) => "sea",
    };
    let is_one_kind = palette.stops.iter().all(|stop| discriminant(&stop.at) == discriminant(&first));
    if !is_one_kind || palette.follows_relief {
        return None;
    }
    let mix = match palette.mix {
        Mix::Oklab => "oklab",
        Mix::Rgb => "rgb",
        Mix::Hsv => "hsv",
    };
    let mut text = format!(
        "name = {}\nunit = \"{unit}\"\nmix = \"{mix}\"\nstops = [\n",
        serde_json::Value::from(palette.name.replace('\u{7f}', " "))
    );
    for Stop { at, color } in &palette.stops {
        let (Position::Value(at) | Position::Share(at) | Position::Sea(at)) = at;
        text.push_str(&format!("    [{at:?}, \"{}\"],\n", hex(*color)));
    }
    text.push_str("]\n");
    for (key, color) in [("below", palette.below), ("above", palette.above), ("missing", palette.missing)] {
        if let Some(color) = color {
            text.push_str(&format!("{key} = \"{}\"\n", hex(color)));
        }
    }
    Some(text)
}

fn color(text: &str) -> Result<Rgb, String> {
    let found = hexadecimal(text).or_else(|| named(text));
    found.ok_or_else(|| format!("`{text}` is not a colour; write #rrggbb or a name such as white"))
}

#[cfg(test)]
mod tests {
    use super::super::named;
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for named in named::all() {
            let mut palette =
                Palette { follows_relief: false, mix: Mix::Hsv, above: Some([1, 2, 3]), ..named.palette() };
            assert_eq!(parse("", &write(&palette).unwrap()), Ok(palette.clone()));
            palette.stops[0].at = Position::Value(-3.25e-5);
            assert_eq!(write(&palette).is_some(), matches!(palette.stops[1].at, Position::Value(_)));
        }
        let quoted = Palette::new("a \"b\"\n", vec![Stop { at: Position::Share(0.5), color: [255, 0, 7] }]);
        assert_eq!(parse("", &write(&quoted).unwrap()), Ok(quoted));
    }

    #[test]
    fn a_palette_by_hand() {
        let text = "name = \"Autumn\"\nunit = \"sea\"\nmix = \"hsv\"\nstops = [[-1, \"navy\"], [0.5, \"#fa0\"]]\nabove = \"white\"";
        let palette = parse("file", text).unwrap();
        let stop = |at, color| Stop { at: Position::Sea(at), color };
        assert_eq!(palette.stops, [stop(-1.0, [0, 0, 128]), stop(0.5, [255, 170, 0])]);
        assert_eq!((palette.name.as_str(), palette.mix, palette.above), ("Autumn", Mix::Hsv, Some([255; 3])));
        assert_eq!(parse("file", "stops = [[0, \"red\"]]").unwrap().name, "file");
    }

    #[test]
    fn what_is_wrong_is_told() {
        for (text, expect) in [
            ("stops = []", "no stops"),
            ("name = \"x\"", "stops"),
            ("stops = [[0, \"#12\"]]", "`#12` is not a colour"),
            ("stops = [[1, \"red\"], [0, \"red\"]]", "ascending"),
            ("stops = [[inf, \"red\"]]", "inf is not a valid position"),
            ("unit = \"feet\"\nstops = [[0, \"red\"]]", "unknown unit \"feet\""),
            ("mix = \"lab\"\nstops = [[0, \"red\"]]", "unknown mix \"lab\""),
            ("colour = 1\nstops = [[0, \"red\"]]", "colour"),
            ("stops = [[0", ""),
        ] {
            let why = parse("t", text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
