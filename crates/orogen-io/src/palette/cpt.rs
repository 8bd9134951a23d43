//! Colour palette tables (`.cpt`) of GMT, the Generic Mapping Tools.
//!
//! A line has a height, its colour, a higher height, its colour: `0 20/40/60 500 120/160/90`; components may be
//! separated by blanks. Colours are red/green/blue, hue-saturation-value, cyan/magenta/yellow/black, #rrggbb, a grey
//! level or a name. `B`, `F` and `N` are the colours below, above, and for missing samples. `# COLOR_MODEL`, `# RANGE`
//! and `# HINGE` are supported.

use super::color::Rgb;
use super::fitted::of_hsv;
use super::names::{hexadecimal, named};
use super::palette::{Mix, Palette, Position, Stop};

#[derive(Clone, Copy, PartialEq)]
enum Model {
    Rgb,
    Hsv,
    Cmyk,
}

/// Parses a table.
///
/// Heights are metres, unless the table is normalised (from 0 to 1, or from -1 to 1): then it is stretched over its
/// `RANGE` or, if it has none, from the lowest height to the highest; a `HINGE` is kept at sea level.
///
/// # Errors
/// A message with the line that cannot be parsed.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let mut palette = Palette { name: name.to_string(), mix: Mix::Rgb, ..Palette::default() };
    let (mut model, mut range, mut hinge) = (Model::Rgb, None, false);
    let mut stops: Vec<(f64, Rgb)> = Vec::new();
    for (number, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
        let at = |why: String| format!("line {number}: {why}");
        if let Some(comment) = line.strip_prefix('#') {
            let Some((key, value)) = comment.split_once('=') else {
                hinge |= matches!(comment.trim(), "HINGE" | "SOFT_HINGE" | "HARD_HINGE");
                continue;
            };
            match key.trim() {
                "COLOR_MODEL" => (model, palette.mix) = color_model(value.trim()).map_err(at)?,
                "RANGE" => range = span(value.trim()),
                "HINGE" | "SOFT_HINGE" | "HARD_HINGE" => hinge = true,
                _ => {}
            }
            continue;
        }
        // A label may follow.
        let words: Vec<&str> = line.split(';').next().unwrap_or_default().split_whitespace().collect();
        match &words[..] {
            [] => {}
            [which @ ("B" | "F" | "N"), color @ ..] => {
                // A minus sign means that nothing is painted.
                let color = if color == ["-"] { None } else { Some(colors(color, model).map_err(at)?) };
                match *which {
                    "B" => palette.below = color,
                    "F" => palette.above = color,
                    _ => palette.missing = color,
                }
            }
            words => stops.extend(slice(words, model).map_err(at)?),
        }
    }
    if stops.is_empty() {
        return Err("it has no line of two heights and their colours, such as `0 20/40/60 500 120/160/90`".into());
    }
    if !stops.is_sorted_by(|a, b| a.0 <= b.0) {
        return Err("its heights are not in ascending order".into());
    }
    stops.dedup();
    let (first, last) = (stops[0].0, stops[stops.len() - 1].0);
    let both_signs = (first, last) == (-1.0, 1.0);
    let normal = both_signs || (first, last) == (0.0, 1.0);
    let place = |at: f64| match (normal, range, hinge && both_signs) {
        (true, Some([low, high]), _) => Position::Value(low + (at - first) / (last - first) * (high - low)),
        (true, None, true) => Position::Sea(at),
        (true, None, false) => Position::Share((at - first) / (last - first)),
        (false, ..) => Position::Value(at),
    };
    palette.stops = stops.into_iter().map(|(at, color)| Stop { at: place(at), color }).collect();
    Ok(palette)
}

fn color_model(text: &str) -> Result<(Model, Mix), String> {
    // A plus sign means that colours are also mixed in this model.
    match text.to_ascii_uppercase().as_str() {
        "RGB" | "+RGB" => Ok((Model::Rgb, Mix::Rgb)),
        "HSV" => Ok((Model::Hsv, Mix::Rgb)),
        "+HSV" => Ok((Model::Hsv, Mix::Hsv)),
        "CMYK" | "+CMYK" => Ok((Model::Cmyk, Mix::Rgb)),
        _ => Err(format!("unknown colour model {text}; supported are RGB, HSV and CMYK")),
    }
}

fn span(text: &str) -> Option<[f64; 2]> {
    let (low, high) = text.split_once('/')?;
    let [low, high] = [low.trim().parse::<f64>().ok()?, high.trim().parse::<f64>().ok()?];
    (low.abs() <= 1e9 && high.abs() <= 1e9 && low < high).then_some([low, high])
}

/// The two stops of a line.
fn slice(words: &[&str], model: Model) -> Result<[(f64, Rgb); 2], String> {
    // L, U and B at the end request annotations on GMT's colour bar.
    let words = match words {
        [init @ .., "L" | "U" | "B"] if init.len() > 2 => init,
        words => words,
    };
    if words.len() < 4 || words.len() % 2 == 1 {
        let message = "each line must have a height and its colour, then a greater height and its colour; categorical palettes are not supported";
        return Err(message.into());
    }
    let (start, end) = words.split_at(words.len() / 2);
    let stop = |words: &[&str]| {
        let height = words[0].parse::<f64>().ok().filter(|height| height.abs() <= 1e9);
        let height = height.ok_or_else(|| format!("`{}` is not a height", words[0]))?;
        Ok::<(f64, Rgb), String>((height, colors(&words[1..], model)?))
    };
    Ok([stop(start)?, stop(end)?])
}

fn colors(words: &[&str], model: Model) -> Result<Rgb, String> {
    let text = words.join(" ");
    let wrong = || format!("`{text}` is not a colour");
    if let [word] = words
        && let Some(color) = hexadecimal(word).or_else(|| named(word))
    {
        return Ok(color);
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
    let bytes = |color: [f64; 3]| color.map(|part| (part * 255.0).round().clamp(0.0, 255.0) as u8);
    match (&parts[..], model) {
        ([grey], _) if within(&parts, &[255.0]) => Ok(bytes([grey / 255.0; 3])),
        ([r, g, b], Model::Rgb) if within(&parts, &[255.0; 3]) => Ok(bytes([r / 255.0, g / 255.0, b / 255.0])),
        ([h, s, v], Model::Hsv) if within(&parts, &[360.0, 1.0, 1.0]) => {
            Ok(bytes(of_hsv([*h as f32, *s as f32, *v as f32]).map(f64::from)))
        }
        ([c, m, y, k], Model::Cmyk) if within(&parts, &[100.0; 4]) => {
            Ok(bytes([c, m, y].map(|part| (1.0 - part / 100.0) * (1.0 - k / 100.0))))
        }
        _ => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
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
        let hsv = parse("t", "# COLOR_MODEL = +HSV\n0 120-1-1 5 240-1-0.5\nN -\n").unwrap();
        assert_eq!((hsv.mix, hsv.stops[0].color, hsv.stops[1].color), (Mix::Hsv, [0, 255, 0], [0, 0, 128]));
        assert_eq!(stops("0 0/100/0/0 10 0/0/0/50")[1].1, [128; 3]);
        assert_eq!(stops("# HINGE = 0\n-1 navy 0 aqua\n0 green 1 white")[1].0, Sea(0.0));
        assert_eq!(stops("-1 navy 1 white")[0].0, Share(0.0));
        assert_eq!(stops("# RANGE = -8000/4000\n0 navy 1 white")[1].0, Value(4000.0));
        // Adjacent slices with equal colours have no step between them.
        assert_eq!(stops("0 red 1 blue\n1 blue 2 red").len(), 3);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, expect) in [
            ("", "no line of two heights"),
            ("0 red 1", "line 1: each line must have a height"),
            ("0 red 1 blurple", "line 1: `blurple` is not a colour"),
            ("# x\n0 red 1 1/2/256", "line 2: `1/2/256`"),
            ("x red 1 blue", "line 1: `x` is not a height"),
            ("# COLOR_MODEL = LAB", "line 1: unknown colour model LAB"),
            ("5 red 9 blue\n0 red 5 blue", "ascending"),
            ("0 400-1-1 1 red", "`400-1-1`"),
            ("B", "line 1: `` is not a colour"),
        ] {
            let why = parse("t", text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
