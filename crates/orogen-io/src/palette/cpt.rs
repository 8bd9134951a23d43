//! Color palette tables (`.cpt`) of GMT, the Generic Mapping Tools.
//!
//! A line has a height, its color, a higher height, its color: `0 20/40/60 500 120/160/90`; components may be separated
//! by blanks. Colors are red/green/blue, hue-saturation-value, cyan/magenta/yellow/black, #rrggbb, a gray level or a
//! name. `B`, `F` and `N` are the colors below the table, above the table, and for missing samples. `# COLOR_MODEL`, `#
//! RANGE` and `# HINGE` are supported.
//!
//! The color model determines the meaning of three or four numbers. In lower case (`hsv`) or with a plus sign (`+HSV`),
//! it is also the model in which GMT interpolates colors: hue, saturation and value each change linearly. The hue does
//! not take the shorter way, so `0-1-1` to `360-1-1` passes through all hues. Such a slice becomes several stops,
//! between which red, green and blue change linearly.

use super::color::Rgb;
use super::fitted::{hsv, of_hsv};
use super::names::{hexadecimal, named};
use super::palette::{Mix, Palette, Position, Stop};

#[derive(Clone, Copy, PartialEq)]
enum Model {
    Rgb,
    Hsv,
    Cmyk,
}

/// A color as written: hues of 0 and 360 degrees are distinct.
#[derive(Clone, Copy, PartialEq)]
enum Color {
    Rgb([f64; 3]),
    Hsv([f64; 3]),
}

impl Color {
    fn rgb(self) -> Rgb {
        let parts = match self {
            Color::Rgb(rgb) => rgb,
            Color::Hsv(hsv) => of_hsv(hsv.map(|part| part as f32)).map(f64::from),
        };
        parts.map(|part| (part * 255.0).round().clamp(0.0, 255.0) as u8)
    }

    /// Hue in degrees, saturation and value from 0 to 1. The hue of a gray is 0.
    fn hsv(self) -> [f64; 3] {
        match self {
            Color::Hsv(hsv) => hsv,
            Color::Rgb(_) => hsv(self.rgb()).map(f64::from),
        }
    }
}

/// The stops of a slice that is interpolated by hue, saturation and value. Between multiples of 60 degrees, where red,
/// green and blue have kinks, they are at most quadratic. The stops divide them into pieces that differ by less than
/// half a level of 255 from straight lines.
fn hsv_stops([start, end]: [(f64, Color); 2]) -> Vec<(f64, Rgb)> {
    let (from, to) = (start.1.hsv(), end.1.hsv());
    let at = |share: f64| std::array::from_fn(|k| from[k] + share * (to[k] - from[k]));
    let [turn, saturation, value] = [0, 1, 2].map(|k| to[k] - from[k]);
    let mut shares = vec![0.0];
    let (low, high) = (from[0].min(to[0]), from[0].max(to[0]));
    let kinks = (1..6).map(|sixth| 60.0 * f64::from(sixth)).filter(|hue| *hue > low && *hue < high);
    shares.extend(kinks.map(|hue| (hue - from[0]) / turn));
    shares.push(1.0);
    shares.sort_by(f64::total_cmp);
    let mut stops = vec![(start.0, start.1.rgb())];
    for pair in shares.windows(2) {
        let [first, last] = [pair[0], pair[1]];
        // Bound of the second derivative along the piece.
        let part = last - first;
        let [turn, saturation, value] = [turn / 60.0, saturation, value].map(|change| (change * part).abs());
        let bend = 2.0 * (value * saturation + value * turn + saturation * turn);
        let pieces = (bend / 8.0 * 2.0 * 255.0).sqrt().ceil().max(1.0) as usize;
        stops.extend((1..=pieces).map(|piece| {
            let share = first + part * piece as f64 / pieces as f64;
            (start.0 + share * (end.0 - start.0), Color::Hsv(at(share)).rgb())
        }));
    }
    if let Some(last) = stops.last_mut() {
        *last = (end.0, end.1.rgb());
    }
    stops
}

/// Parses a table.
///
/// Heights are metres, unless the table is normalized (from 0 to 1, or from -1 to 1). A normalized table is stretched
/// over its `RANGE` or, if it has none, from the lowest height to the highest. With a `HINGE`, both halves of a table
/// from -1 to 1 are stretched separately, with 0 at the hinge. The hinge is at a height of 0 m unless it states
/// another, or without a range at sea level.
///
/// # Errors
/// A message with the line that cannot be parsed.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let mut palette = Palette::new(name, Vec::new());
    palette.mix = Mix::Rgb;
    let (mut model, mut mixed, mut range, mut hinge) = (Model::Rgb, Model::Rgb, None, None);
    let mut stops: Vec<(f64, Rgb)> = Vec::new();
    for (number, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
        let at = |why: String| format!("line {number}: {why}");
        if let Some(comment) = line.strip_prefix('#') {
            let Some((key, value)) = comment.split_once('=') else {
                if matches!(comment.trim(), "HINGE" | "SOFT_HINGE" | "HARD_HINGE") {
                    hinge = Some(0.0);
                }
                continue;
            };
            match key.trim() {
                "COLOR_MODEL" => (model, mixed) = color_model(value.trim()).map_err(at)?,
                "RANGE" => range = span(value.trim()),
                "HINGE" | "SOFT_HINGE" | "HARD_HINGE" => {
                    hinge = Some(value.trim().parse().ok().filter(|at: &f64| at.is_finite()).unwrap_or(0.0));
                }
                _ => {}
            }
            continue;
        }
        // A label may follow.
        let words: Vec<&str> = line.split(';').next().unwrap_or_default().split_whitespace().collect();
        match &words[..] {
            [] => {}
            [which @ ("B" | "F" | "N"), color @ ..] => {
                // A minus sign means that nothing is drawn.
                let color = if color == ["-"] { None } else { Some(colors(color, model).map_err(at)?.rgb()) };
                match *which {
                    "B" => palette.below = color,
                    "F" => palette.above = color,
                    _ => palette.missing = color,
                }
            }
            words => {
                let slice = slice(words, model).map_err(at)?;
                match mixed {
                    Model::Hsv => stops.extend(hsv_stops(slice)),
                    Model::Rgb | Model::Cmyk => stops.extend(slice.map(|(at, color)| (at, color.rgb()))),
                }
            }
        }
    }
    if stops.is_empty() {
        return Err("it has no line of two heights and their colors, such as `0 20/40/60 500 120/160/90`".into());
    }
    if !stops.is_sorted_by(|a, b| a.0 <= b.0) {
        return Err("its heights are not in ascending order".into());
    }
    stops.dedup();
    let (first, last) = (stops[0].0, stops[stops.len() - 1].0);
    let both_signs = (first, last) == (-1.0, 1.0);
    let normal = both_signs || (first, last) == (0.0, 1.0);
    let place = |at: f64| match (normal, range, hinge.filter(|_| both_signs)) {
        (true, Some([low, high]), Some(hinge)) if low < hinge && hinge < high => {
            Position::Value(hinge + at * if at < 0.0 { hinge - low } else { high - hinge })
        }
        (true, Some([low, high]), _) => Position::Value(low + (at - first) / (last - first) * (high - low)),
        (true, None, Some(_)) => Position::Sea(at),
        (true, None, None) => Position::Share((at - first) / (last - first)),
        (false, ..) => Position::Value(at),
    };
    palette.stops = stops.into_iter().map(|(at, color)| Stop { at: place(at), color }).collect();
    Ok(palette)
}

/// The model of colors, and the model in which they are interpolated.
fn color_model(text: &str) -> Result<(Model, Model), String> {
    let name = text.strip_prefix('+').unwrap_or(text);
    let model = match name.to_ascii_uppercase().as_str() {
        "RGB" => Model::Rgb,
        "HSV" => Model::Hsv,
        "CMYK" => Model::Cmyk,
        _ => return Err(format!("unknown color model `{text}`; supported are RGB, HSV and CMYK")),
    };
    let mixes = name != text || !name.contains(|c: char| c.is_ascii_uppercase());
    Ok((model, if mixes { model } else { Model::Rgb }))
}

fn span(text: &str) -> Option<[f64; 2]> {
    let (low, high) = text.split_once('/')?;
    let [low, high] = [low.trim().parse::<f64>().ok()?, high.trim().parse::<f64>().ok()?];
    (low.abs() <= 1e9 && high.abs() <= 1e9 && low < high).then_some([low, high])
}

/// The two stops of a line.
fn slice(words: &[&str], model: Model) -> Result<[(f64, Color); 2], String> {
    // L, U and B at the end request annotations on GMT's color bar.
    let words = match words {
        [init @ .., "L" | "U" | "B"] if init.len() > 2 => init,
        words => words,
    };
    if words.len() < 4 || words.len() % 2 == 1 {
        let message = "each line must have a height and its color, then a greater height and its color; categorical palettes are not supported";
        return Err(message.into());
    }
    let (start, end) = words.split_at(words.len() / 2);
    let stop = |words: &[&str]| {
        let height = words[0].parse::<f64>().ok().filter(|height| height.abs() <= 1e9);
        let height = height.ok_or_else(|| format!("`{}` is not a height", words[0]))?;
        Ok::<(f64, Color), String>((height, colors(&words[1..], model)?))
    };
    Ok([stop(start)?, stop(end)?])
}

fn colors(words: &[&str], model: Model) -> Result<Color, String> {
    let text = words.join(" ");
    let wrong = || format!("`{text}` is not a color");
    if let [word] = words
        && let Some(color) = hexadecimal(word).or_else(|| named(word))
    {
        return Ok(Color::Rgb(color.map(|part| f64::from(part) / 255.0)));
    }
    let (separator, model) = match words {
        [word] if word.contains('/') && word.split('/').count() == 4 => ('/', Model::Cmyk),
        [word] if word.contains('/') => ('/', model),
        // The sign of a number is not a separator.
        [word] if word.trim_start_matches('-').contains('-') => ('-', Model::Hsv),
        _ => (' ', model),
    };
    let parts: Vec<f64> =
        text.split(separator).map(|part| part.parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    let within = |parts: &[f64], most: &[f64]| parts.iter().zip(most).all(|(part, most)| (0.0..=*most).contains(part));
    match (&parts[..], model) {
        ([grey], _) if within(&parts, &[255.0]) => Ok(Color::Rgb([grey / 255.0; 3])),
        ([r, g, b], Model::Rgb) if within(&parts, &[255.0; 3]) => Ok(Color::Rgb([r, g, b].map(|part| part / 255.0))),
        ([h, s, v], Model::Hsv) if within(&parts, &[360.0, 1.0, 1.0]) => Ok(Color::Hsv([*h, *s, *v])),
        ([c, m, y, k], Model::Cmyk) if within(&parts, &[100.0; 4]) => {
            Ok(Color::Rgb([c, m, y].map(|part| (1.0 - part / 100.0) * (1.0 - k / 100.0))))
        }
        _ => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::color::Encoder;
    use super::super::fitted::Fitted;
    use super::*;

    fn stops(text: &str) -> Vec<(Position, Rgb)> {
        parse("t", text).unwrap().stops.into_iter().map(|stop| (stop.at, stop.color)).collect()
    }

    #[test]
    fn tables_in_every_spelling() {
        use Position::Value;
        let text = "# COLOR_MODEL = RGB\n-100 0/0/80 0 100/150/200 ; shelf\n0 0/100/0 500.5 #ffeeaa L\n500.5 white 900 128\n\
                    B black\nF 255/0/0\nN gray50\n";
        assert_eq!(
            stops(text),
            [
                (Value(-100.0), [0, 0, 80]),
                (Value(0.0), [100, 150, 200]),
                (Value(0.0), [0, 100, 0]),
                (Value(500.5), [255, 238, 170]),
                (Value(500.5), [255; 3]),
                (Value(900.0), [128; 3])
            ]
        );
        let palette = parse("t", text).unwrap();
        assert_eq!([palette.below, palette.above, palette.missing], [Some([0; 3]), Some([255, 0, 0]), Some([128; 3])]);
    }

    #[test]
    fn other_models_and_normalised_tables() {
        use Position::{Sea, Share, Value};
        assert_eq!(stops("0 0/100/0/0 10 0/0/0/50")[1].1, [128; 3]);
        assert_eq!(stops("# HINGE = 0\n-1 navy 0 aqua\n0 green 1 white")[1].0, Sea(0.0));
        assert_eq!(stops("-1 navy 1 white")[0].0, Share(0.0));
        assert_eq!(stops("# RANGE = -8000/4000\n0 navy 1 white")[1].0, Value(4000.0));
        // Adjacent slices with equal colors have no step between them.
        // Both sides of a hinge are stretched separately, as GMT does for etopo1, whose range is not symmetric.
        for (hinge, expect) in
            [("HARD_HINGE", 0.0), ("SOFT_HINGE", 0.0), ("HINGE = 500", 500.0), ("HINGE = 9e9", -1250.0)]
        {
            let text = format!("# {hinge}\n# RANGE = -11000/8500\n-1 navy 0 aqua\n0 green 1 white");
            let places: Vec<Position> = stops(&text).into_iter().map(|(at, _)| at).collect();
            assert_eq!(places, [-11000.0, expect, expect, 8500.0].map(Value), "{hinge}");
        }
        assert_eq!(stops("0 red 1 blue\n1 blue 2 red").len(), 3);
    }

    /// The colors of GMT 6 at 0, 1/12, ... 1: hue, saturation and value change linearly.
    #[test]
    fn hues_are_mixed_as_gmt_mixes_them() {
        let at = |text: &str, height: f32| {
            let fitted = Fitted::new(&parse("t", text).unwrap(), 0.0, 1.0, 0.0);
            Encoder::new().bytes(fitted.at(height))
        };
        let near = |a: Rgb, b: Rgb| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1);
        for model in ["hsv", "+hsv", "+HSV"] {
            let cycle = format!("# COLOR_MODEL = {model}\n0\t0-1-1\t1\t360-1-1\n");
            let expect =
                [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255], [255, 0, 0]];
            for (k, expect) in expect.into_iter().enumerate() {
                let found = at(&cycle, k as f32 / 6.0);
                assert!(near(found, expect), "{model} {k}: {found:?}");
            }
            assert!(near(at(&cycle, 0.25), [128, 255, 0]) && near(at(&cycle, 0.875), [255, 0, 191]));
            // Backwards, in columns, and with all three components changing: 180 0.5 0.75 in the middle.
            let text = format!("# COLOR_MODEL = {model}\n0 300 1 1 1 60 0 0.5\nB 240-1-1\n");
            assert!(near(at(&text, 0.5), [96, 191, 191]), "{:?}", at(&text, 0.5));
            for step in 0..=100 {
                let share = f64::from(step) / 100.0;
                let hsv = [300.0 - 240.0 * share, 1.0 - share, 1.0 - 0.5 * share];
                let found = at(&text, share as f32);
                assert!(near(found, Color::Hsv(hsv).rgb()), "{share}: {found:?}");
            }
            assert_eq!(at(&text, -1.0), [0, 0, 255]);
            // Names have hues as well; 240 is reached through 120, not through 300.
            assert!(near(at(&format!("# COLOR_MODEL = {model}\n0 red 1 blue"), 0.5), [0, 255, 0]));
        }
        // In capitals without a plus sign, colors are read as hues and interpolated as red, green and blue.
        assert!(near(at("# COLOR_MODEL = HSV\n0 0-1-1 1 120-1-1", 0.5), [128, 128, 0]));
        for model in ["rgb", "+RGB", "RGB"] {
            assert!(near(at(&format!("# COLOR_MODEL = {model}\n0 255/0/0 1 0/0/255"), 0.5), [128, 0, 128]));
        }
        for model in ["cmyk", "+cmyk", "CMYK"] {
            assert!(near(at(&format!("# COLOR_MODEL = {model}\n0 0 100 0 0 1 100 100 0 0"), 1.0), [0, 0, 255]));
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, expect) in [
            ("", "no line of two heights"),
            ("0 red 1", "line 1: each line must have a height"),
            ("0 red 1 blurple", "line 1: `blurple` is not a color"),
            ("# x\n0 red 1 1/2/256", "line 2: `1/2/256`"),
            ("x red 1 blue", "line 1: `x` is not a height"),
            ("# COLOR_MODEL = LAB", "line 1: unknown color model `LAB`; supported are RGB, HSV and CMYK"),
            ("5 red 9 blue\n0 red 5 blue", "ascending"),
            ("0 400-1-1 1 red", "`400-1-1`"),
            ("B", "line 1: `` is not a color"),
        ] {
            let why = parse("t", text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
