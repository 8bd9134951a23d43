//! The coloring of a surface: a color, a gradient or a picture.

use crate::recipe::table::key::Key;
use crate::recipe::table::part::{OfKey, Part, described, entry};
use crate::recipe::table::reader::{Entry, Table, ValueReader};
use orogen_io::dem::file_ref::FileRef;
use orogen_io::palette::color::{Light, Rgb, decode, hex, linear, mix, oklab};
use orogen_ops::declare::Param;
use orogen_ops::value::{Span, Spanned, Value};
use serde_json::{Value as Json, json};
/// Number of colors of a gradient or a picture, including the first and the last.
pub const RAMP: usize = 128;

/// Maximum number of colors in a gradient.
pub const MAX_COLORS: usize = 256;

/// Default wavelength of the noise along which a gradient runs, in metres.
pub const DEFAULT_GRAIN: f64 = 200.0;

/// The coloring of a surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Coloring {
    /// A single color.
    Plain(Rgb),
    /// Colors along a quantity, mixed in Oklab.
    Gradient(Vec<Rgb>, Along),
    /// The colors of a picture along a quantity, each with its frequency in the picture (histogram).
    Picture(FileRef, Along),
}

/// The quantity along which a gradient runs from its first color to its last.
#[derive(Debug, Clone, PartialEq)]
pub enum Along {
    /// Noise with this wavelength in metres; every color covers the same area.
    Noise(f64),
    /// Height above sea level, over this range in metres.
    Height([f64; 2]),
    /// Slope, over this range in degrees.
    Slope([f64; 2]),
    /// A node or layer, over this range of values.
    Layer(String, [f64; 2]),
}

impl Default for Along {
    fn default() -> Along {
        Along::Noise(DEFAULT_GRAIN)
    }
}

impl Coloring {
    /// The colors in linear light, evenly spaced; empty for a picture that was not read yet.
    pub fn ramp(&self) -> Vec<Light> {
        match self {
            Coloring::Plain(color) => vec![color.map(decode)],
            Coloring::Picture(..) => Vec::new(),
            Coloring::Gradient(colors, _) => {
                let stops: Vec<[f32; 3]> = colors.iter().map(|color| oklab(color.map(decode))).collect();
                let last = stops.len().saturating_sub(1);
                let step = |k: usize| {
                    let at = k as f32 / (RAMP - 1) as f32 * last as f32;
                    let from = (at as usize).min(last.saturating_sub(1));
                    mix(stops[from], stops[(from + 1).min(last)], at - from as f32)
                };
                (0..RAMP).map(|k| linear(step(k)).map(|part| part.clamp(0.0, 1.0))).collect()
            }
        }
    }
}

pub const COLOR: Key<'static> = Key::new("color", "A color: #rrggbb, #rgb or a name.");

const GRAIN: Key<'static> = Key {
    range: Some([1e-3, 1e9]),
    stated: Some(DEFAULT_GRAIN),
    ..Key::new("grain", "Wavelength of the gradient's noise. Unit: m.")
};

/// The keys that give a coloring.
const COLORINGS: [&str; 3] = ["color", "gradient", "picture"];

/// The keys of the quantity along which a gradient runs.
const ALONG: [&str; 3] = ["along", "span", "grain"];

/// An entry with a coloring.
pub trait Colored {
    /// The coloring.
    fn coloring(&mut self) -> &mut Coloring;
}

/// The part that has the coloring.
pub struct Colors;

impl<T: Colored> Part<T> for Colors {
    fn keys(&self) -> Vec<&'static str> {
        COLORINGS.into_iter().chain(ALONG).collect()
    }

    fn schemas(&self) -> Vec<Json> {
        let color = described::<Rgb>(&COLOR);
        vec![
            color.clone(),
            json!({
                "type": "array", "minItems": 2, "maxItems": MAX_COLORS, "items": color,
                "description": "Colors of a gradient over noise, height, slope or a layer, mixed in Oklab.",
            }),
            json!({
                "type": "string",
                "description": "Path of a .png, such as a satellite picture. Its colors are used in proportion to their frequency in the picture.",
            }),
            json!({ "type": "string", "default": "noise", "description": "Quantity of the gradient: `noise`, `height`, `slope` or the name of a node." }),
            json!({
                "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": "number" },
                "description": "Values of the first and the last color, in the unit of the gradient's quantity.",
            }),
            described::<f64>(&GRAIN),
        ]
    }

    fn read(&self, table: &Table, values: &mut ValueReader, out: &mut T) {
        let given: Vec<&Entry> =
            table.entries.iter().filter(|(key, _)| COLORINGS.contains(&key.value.as_str())).collect();
        let along = along(table, values);
        let coloring = match given.as_slice() {
            [(key, value)] => coloring(&key.value, value, table, values, along),
            [] => {
                let example = "a `color`, such as \"#6d675f\", a `gradient` of colors or a `picture`";
                Err((table.span, format!("a surface needs {example}")))
            }
            [_, (second, _), ..] => {
                let message = "a surface can have only one of `color`, `gradient` and `picture`; remove the others";
                Err((&second.span, message.to_string()))
            }
        };
        match coloring {
            Ok(coloring) => *out.coloring() = coloring,
            Err((span, message)) => values.diagnostic(span, message),
        }
    }

    fn write(&self, of: &mut T, entries: &mut Vec<Entry>) {
        let text = |color: &Rgb| Value::Text(hex(*color).to_string());
        let list = |colors: &Vec<Rgb>| colors.iter().map(|color| Spanned::unplaced(text(color))).collect();
        let coloring = of.coloring();
        entries.push(match coloring {
            Coloring::Plain(color) => entry("color", text(color)),
            Coloring::Gradient(colors, _) => entry("gradient", Value::List(list(colors))),
            Coloring::Picture(file, _) => entry("picture", file.write()),
        });
        let (Coloring::Gradient(_, along) | Coloring::Picture(_, along)) = coloring else { return };
        let (along, span) = match along {
            Along::Noise(grain) => return entries.push(entry("grain", Value::Number(*grain))),
            Along::Height(span) => ("height", span),
            Along::Slope(span) => ("slope", span),
            Along::Layer(name, span) => (name.as_str(), span),
        };
        entries.extend([entry("along", Value::Text(along.to_string())), entry("span", Param::write(span))]);
    }
}

/// The coloring by the value of one of its keys.
fn coloring<'a>(
    key: &str,
    value: &'a Spanned<Value>,
    table: &'a Table,
    values: &mut ValueReader,
    along: Along,
) -> Result<Coloring, (&'a Span, String)> {
    match (key, &value.value) {
        ("color", _) => {
            let color = Rgb::read(&COLOR, value, values).unwrap_or_default();
            match table.entries.iter().find(|(key, _)| ALONG.contains(&key.value.as_str())) {
                Some((Spanned { value: key, span }, _)) => {
                    Err((span, format!("`{key}` applies to a `gradient` or a `picture`, not to a `color`")))
                }
                None => Ok(Coloring::Plain(color)),
            }
        }
        ("picture", Value::Text(path)) if !path.is_empty() => Ok(Coloring::Picture(path.as_str().into(), along)),
        ("picture", other) => {
            Err((&value.span, format!("`picture` must be the path of a .png, not {}", other.describe())))
        }
        (_, Value::List(items)) if (2..=MAX_COLORS).contains(&items.len()) => {
            let colors = items.iter().filter_map(|item| Rgb::read(&COLOR, item, values)).collect();
            Ok(Coloring::Gradient(colors, along))
        }
        (_, other) => {
            let found = other.describe();
            Err((&value.span, format!("`gradient` must be a list of 2 to {MAX_COLORS} colors, not {found}")))
        }
    }
}

/// The quantity of the gradient of a table.
fn along(table: &Table, values: &mut ValueReader) -> Along {
    let [along, span, grain] = ALONG.map(|key| table.find(key));
    let wavelength = grain.and_then(|(_, value)| <f64 as OfKey>::read(&GRAIN, value, values)).unwrap_or(DEFAULT_GRAIN);
    let quantity = match along.map(|(_, value)| (&value.value, &value.span)) {
        None => "noise",
        Some((Value::Text(text), _)) => text,
        Some((other, at)) => {
            let expected = "\"noise\", \"height\", \"slope\" or a node's name";
            values.diagnostic(at, format!("`along` must be {expected}, not {}", other.describe()));
            "noise"
        }
    };
    match (quantity, span, grain) {
        ("noise", Some((key, _)), _) => {
            values.diagnostic(&key.span, "`span` applies to `along = \"height\"`, \"slope\" or a node; for noise use `grain`, its wavelength in metres");
        }
        ("noise", ..) => return Along::Noise(wavelength),
        (_, _, Some((key, _))) => {
            let message = "`grain` is the wavelength of noise, but this gradient does not follow noise";
            values.diagnostic(&key.span, message);
        }
        (_, None, _) => {
            let at = along.map_or(0..0, |(key, _)| key.span.clone());
            let message = format!(
                "a gradient along `{quantity}` needs `span = [FROM, TO]`: the values of its first and last color"
            );
            values.diagnostic(&at, message);
        }
        ("height", Some((_, span)), _) => return Along::Height(ends(span, values)),
        ("slope", Some((_, span)), _) => return Along::Slope(ends(span, values)),
        (layer, Some((_, span)), _) => {
            let at = along.map_or(0..0, |(_, value)| value.span.clone());
            values.names.push((layer.to_string(), at));
            return Along::Layer(layer.to_string(), ends(span, values));
        }
    }
    Along::default()
}

/// The values of the first and the last color.
fn ends(value: &Spanned<Value>, values: &mut ValueReader) -> [f64; 2] {
    let ends = <[f64; 2] as Param>::read(&value.value);
    let is_span = |ends: &[f64; 2]| ends[0] != ends[1] && ends.iter().all(|end| end.abs() <= 1e9);
    ends.filter(is_span).unwrap_or_else(|| {
        let found = value.value.describe();
        values.diagnostic(&value.span, format!("`span` must be two different numbers [FROM, TO], not {found}"));
        [0.0, 1.0]
    })
}
