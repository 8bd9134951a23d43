//! Palettes in TOML, for writing by hand.
//!
//! ```toml
//! name = "Autumn"
//! unit = "m"              # or "range" (0 the lowest, 1 the highest),
//!                         # or "sea" (-1 the deepest, 0 the shore, 1 the highest)
//! mix = "oklab"           # or "rgb", "hsv", or "nearest" (the color of the nearest stop)
//! stops = [[0, "#2c5f2d"], [900, [0.59, 0.74, 0.38]], [1800, "white"]]
//! missing = "#dddddd"
//! ```
//!
//! A color is #rrggbb, a name, or a list of red, green and blue: from 0 to 1 if a number of the list has a decimal
//! point, else integers from 0 to 255.

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
    stops: Vec<(f64, toml::Value)>,
    below: Option<toml::Value>,
    above: Option<toml::Value>,
    missing: Option<toml::Value>,
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
        Some("nearest") => Mix::Nearest,
        Some(other) => {
            let known = "supported are \"oklab\", \"rgb\", \"hsv\" and \"nearest\"";
            return Err(format!("unknown mix \"{other}\"; {known}"));
        }
    };
    if file.stops.is_empty() {
        return Err("it has no stops, such as stops = [[0, \"#2c5f2d\"], [1800, \"white\"]]".into());
    }
    let mut stops = Vec::new();
    for (at, value) in &file.stops {
        if !(-1e9..=1e9).contains(at) {
            return Err(format!("{at} is not a valid position of a color"));
        }
        stops.push(Stop { at: place(*at), color: color(value)? });
    }
    if !file.stops.is_sorted_by(|a, b| a.0 <= b.0) {
        return Err("its stops are not in ascending order".into());
    }
    let optional = |value: &Option<toml::Value>| value.as_ref().map(color).transpose();
    let mut palette = Palette::new(file.name.as_deref().unwrap_or(name), stops);
    palette.mix = mix;
    palette.below = optional(&file.below)?;
    palette.above = optional(&file.above)?;
    palette.missing = optional(&file.missing)?;
    Ok(palette)
}

/// A palette as a text that [`parse`] reads. `None` if the positions of its colors are of several kinds, or depend on
/// the relief, which the format cannot express.
#[must_use]
pub fn write(palette: &Palette) -> Option<String> {
    let first = palette.stops.first()?.at;
    let unit = first.unit();
    let is_one_kind = palette.stops.iter().all(|stop| discriminant(&stop.at) == discriminant(&first));
    if !is_one_kind || palette.follows_relief {
        return None;
    }
    let mix = palette.mix.word();
    let mut text = format!(
        "name = {}\nunit = \"{unit}\"\nmix = \"{mix}\"\nstops = [\n",
        serde_json::Value::from(palette.name.replace('\u{7f}', " "))
    );
    for Stop { at, color } in &palette.stops {
        let at = at.number();
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

fn color(value: &toml::Value) -> Result<Rgb, String> {
    let found = match value {
        toml::Value::String(text) => hexadecimal(text).or_else(|| named(text)),
        toml::Value::Array(parts) => components(parts),
        _ => None,
    };
    let text = match value {
        toml::Value::Array(parts) => format!("[{}]", parts.iter().map(written).collect::<Vec<_>>().join(", ")),
        value => written(value),
    };
    found.ok_or_else(|| {
        format!("`{text}` is not a color; write #rrggbb, a name such as white, or red, green and blue such as [0.2, 0.5, 1.0] or [51, 128, 255]")
    })
}

/// A text or a number as written; for other values, their type.
fn written(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        toml::Value::Integer(number) => number.to_string(),
        toml::Value::Float(number) => number.to_string(),
        other => other.type_str().to_string(),
    }
}

/// Red, green and blue.
fn components(parts: &[toml::Value]) -> Option<Rgb> {
    let of_one = parts.iter().any(toml::Value::is_float);
    let part = |value: &toml::Value| {
        let number = value.as_float().or(value.as_integer().map(|whole| whole as f64))?;
        let [most, scale] = if of_one { [1.0, 255.0] } else { [255.0, 1.0] };
        (0.0..=most).contains(&number).then(|| (number * scale).round() as u8)
    };
    match parts {
        [red, green, blue] => Some([part(red)?, part(green)?, part(blue)?]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::named;
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for named in named::all() {
            let mut palette = named.palette();
            (palette.follows_relief, palette.mix, palette.above) = (false, Mix::Hsv, Some([1, 2, 3]));
            assert_eq!(parse("", &write(&palette).unwrap()), Ok(palette.clone()));
            let nearest = palette.clone().nearest();
            assert_eq!(parse("", &write(&nearest).unwrap()), Ok(nearest));
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
        let text = "stops = [[0, [0, 0.5, 1]], [1, [0, 1, 255]], [2, [1.0, 1.0, 1.0]]]\nmissing = [0.2, 0.2, 0.2]";
        let palette = parse("file", text).unwrap();
        let colors: Vec<Rgb> = palette.stops.iter().map(|stop| stop.color).collect();
        assert_eq!((colors, palette.missing), (vec![[0, 128, 255], [0, 1, 255], [255; 3]], Some([51; 3])));
    }

    #[test]
    fn what_is_wrong_is_told() {
        for (text, expect) in [
            ("stops = []", "no stops"),
            ("name = \"x\"", "stops"),
            ("stops = [[0, \"#12\"]]", "`#12` is not a color"),
            ("stops = [[0, [1.5, 0, 0]]]", "`[1.5, 0, 0]` is not a color; write #rrggbb, a name such as white, or red"),
            ("stops = [[0, [0, 0, 256]]]", "`[0, 0, 256]` is not a color"),
            ("stops = [[0, [0, 0]]]", "is not a color"),
            ("stops = [[0, 7]]", "`7` is not a color"),
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
