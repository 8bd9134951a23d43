//! Color maps that QGIS exports from the raster symbology, `.txt`: a comment, `INTERPOLATION:` with a kind, and lines
//! of a value, red, green, blue, opacity and a label, separated by commas. The opacity and the label are ignored.

use super::palette::{Mix, Palette, Position, Stop};

/// How colors between values are determined.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// Interpolated.
    Interpolated,
    /// The color of the next higher value, which may be `inf`.
    Discrete,
}

/// The start of the line with the kind.
const KIND: &str = "INTERPOLATION:";

/// Whether a text is such a color map.
pub fn is_qgis(text: &str) -> bool {
    text.lines().take(3).any(|line| line.trim().starts_with(KIND))
}

/// Parses a color map.
///
/// # Errors
/// A message with the line that cannot be parsed.
pub fn parse(name: &str, text: &str) -> Result<Palette, String> {
    let mut kind = Kind::Interpolated;
    let mut rows: Vec<(f64, [u8; 3])> = Vec::new();
    for (number, line) in text.lines().enumerate().map(|(k, line)| (k + 1, line.trim())) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(stated) = line.strip_prefix(KIND) {
            kind = match stated.trim() {
                "INTERPOLATED" => Kind::Interpolated,
                "DISCRETE" => Kind::Discrete,
                other => {
                    return Err(format!(
                        "line {number}: the interpolation `{}` is not supported; choose Linear or Discrete in QGIS",
                        other.escape_debug()
                    ));
                }
            };
            continue;
        }
        let mut words = line.split(',').map(str::trim);
        let value = words.next().and_then(|text| text.parse::<f64>().ok());
        let value = value.filter(|value| value.abs() <= 1e9 || *value == f64::INFINITY);
        let value = value.ok_or_else(|| format!("line {number}: it does not begin with a height"))?;
        let mut color = [0; 3];
        for part in &mut color {
            let component = words.next().and_then(|text| text.parse().ok());
            *part = component
                .ok_or_else(|| format!("line {number}: red, green and blue must be whole numbers from 0 to 255"))?;
        }
        rows.push((value, color));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut palette = Palette::new(name, Vec::new());
    palette.mix = Mix::Rgb;
    let stop = |value: f64, color| Stop { at: Position::Value(value), color };
    for (k, (value, color)) in rows.iter().enumerate() {
        // A discrete color begins at the value of the color below it.
        if let (Kind::Discrete, Some((below, _))) = (kind, k.checked_sub(1).and_then(|k| rows.get(k))) {
            palette.stops.push(stop(*below, *color));
        }
        if value.is_finite() {
            palette.stops.push(stop(*value, *color));
        }
    }
    match palette.stops.is_empty() {
        true => Err("it has no line of a height and a color".into()),
        false => Ok(palette),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# QGIS Generated Color Map Export File\nINTERPOLATION:";

    #[test]
    fn linear_and_discrete_maps_are_read() {
        let text = format!("{HEAD}INTERPOLATED\n0,0,97,71,255,0,0\n1500.5,255,255,255,255,1500 m: snow\n");
        assert!(is_qgis(&text) && !is_qgis("0 1 2 3"));
        let stop = |value, color| Stop { at: Position::Value(value), color };
        let palette = parse("t", &text).unwrap();
        assert_eq!(palette.stops, [stop(0.0, [0, 97, 71]), stop(1500.5, [255; 3])]);
        let text = format!("{HEAD}DISCRETE\n100,1,2,3,255,<= 100\n200,4,5,6,255,a\ninf,7,8,9,255,> 200\n");
        let palette = parse("t", &text).unwrap();
        let [low, middle, high] = [[1, 2, 3], [4, 5, 6], [7, 8, 9]];
        assert_eq!(palette.stops, [stop(100.0, low), stop(100.0, middle), stop(200.0, middle), stop(200.0, high)]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, expect) in [
            ("EXACT\n0,1,2,3,255,a", "line 2: the interpolation `EXACT`"),
            ("INTERPOLATED\nx,1,2,3,255,a", "line 3: it does not begin with a height"),
            ("INTERPOLATED\n0,1,2,300,255,a", "line 3: red, green and blue"),
            ("INTERPOLATED\n", "no line of a height"),
        ] {
            let why = parse("t", &format!("{HEAD}{text}")).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
