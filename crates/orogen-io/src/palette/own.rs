//! Palettes in TOML, for writing by hand.
//!
//! ```toml
//! name = "Autumn"
//! unit = "m"              # or "range" (0 the lowest, 1 the highest) or "sea" (-1 the deepest, 0 the shore, 1 the highest)
//! mix = "oklab"           # or "rgb" or "hsv"
//! stops = [[0, "#2c5f2d"], [900, "#97bc62"], [1800, "white"]]
//! missing = "#dddddd"
//! ```

use serde::Deserialize;

use super::color::Rgb;
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

fn color(text: &str) -> Result<Rgb, String> {
    let found = hexadecimal(text).or_else(|| named(text));
    found.ok_or_else(|| format!("`{text}` is not a colour; write #rrggbb or a name such as white"))
}

#[cfg(test)]
mod tests {
    use super::*;

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
