//! Conversion of `[[surface]]` tables to surfaces.

use super::document::{Along, Coloring, DEFAULT_GRAIN, MAX_COLORS, MAX_SURFACES, Surface};
use crate::recipe::condition::read::{CONDITIONS, Entry, Places, ValueReader};
use orogen_grid::words::suggestion;
use orogen_io::dem::file_ref::FileRef;
use orogen_ops::value::{Span, Spanned, Value};

/// The other keys of a surface.
pub const KEYS: [&str; 11] =
    ["name", "color", "gradient", "picture", "along", "span", "grain", "roughness", "opacity", "any", "mask"];

/// The surfaces of a recipe with the positions of their tables, and their problems.
#[derive(Debug, Default)]
pub struct Read {
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// The positions of their tables and of the names in those.
    pub places: Places,
    /// The problems, with positions.
    pub diagnostics: Vec<(Span, String)>,
}

/// Reads the list of surfaces. `bounded` tells whether the world is bounded: only then are drainage areas known.
pub fn read(value: &Spanned<Value>, bounded: bool) -> Read {
    let mut reader = Reader { out: Read::default(), values: ValueReader::new(bounded) };
    match &value.value {
        Value::List(items) if items.len() > MAX_SURFACES => {
            reader.values.diagnostic(
                &value.span,
                format!("there are {} surfaces; a recipe has at most {MAX_SURFACES}", items.len()),
            );
        }
        Value::List(items) => items.iter().for_each(|item| reader.surface(item)),
        other => reader.values.diagnostic(
            &value.span,
            format!("`surface` must be a list of tables, `[[surface]]`, not {}", other.describe()),
        ),
    }
    reader.out.places.names = reader.values.names;
    Read { diagnostics: reader.values.diagnostics, ..reader.out }
}

struct Reader {
    out: Read,
    values: ValueReader,
}

impl Reader {
    fn surface(&mut self, value: &Spanned<Value>) {
        let Some(entries) = self.values.table("a surface", value) else { return };
        let name = self.values.name(entries, &value.span, "a surface", "rock");
        let mut surface = Surface { name, ..Surface::default() };
        surface.color = self.coloring(value, entries);
        for (key, value) in entries {
            match key.value.as_str() {
                "roughness" => surface.roughness = self.values.share("roughness", value),
                "opacity" => surface.opacity = self.values.share("opacity", value),
                "mask" => surface.mask = self.values.input("mask", value),
                "any" => surface.any = self.values.alternatives(value),
                known if KEYS.contains(&known) => {}
                condition if CONDITIONS.contains(&condition) => {
                    surface.all.extend(self.values.condition(condition, value))
                }
                unknown => {
                    let hint = suggestion(unknown, KEYS.into_iter().chain(CONDITIONS));
                    self.values.diagnostic(&key.span, format!("unknown key `{unknown}` in a surface; {hint}"));
                }
            }
        }
        if self.out.surfaces.is_empty() {
            let limits = entries.iter().find(|(key, _)| {
                matches!(key.value.as_str(), "any" | "mask" | "opacity") || CONDITIONS.contains(&key.value.as_str())
            });
            if let Some((key, _)) = limits {
                let message = format!(
                    "the first surface is everywhere and cannot have `{}`; list the base surface first",
                    key.value
                );
                self.values.diagnostic(&key.span, message);
            }
        }
        self.out.surfaces.push(surface);
        self.out.places.tables.push(value.span.clone());
    }

    fn coloring(&mut self, table: &Spanned<Value>, entries: &[Entry]) -> Coloring {
        let given: Vec<&Entry> =
            entries.iter().filter(|(key, _)| matches!(key.value.as_str(), "color" | "gradient" | "picture")).collect();
        let along = self.along(entries);
        let follows = |key: &str| matches!(key, "along" | "span" | "grain");
        match given.as_slice() {
            [(key, value)] if key.value == "color" => {
                if let Some((key, _)) = entries.iter().find(|(key, _)| follows(&key.value)) {
                    self.values.diagnostic(
                        &key.span,
                        format!("`{}` applies to a `gradient` or a `picture`, not to a `color`", key.value),
                    );
                }
                Coloring::Plain(self.values.color(value).unwrap_or([128; 3]))
            }
            [(key, value)] if key.value == "picture" => match &value.value {
                Value::Text(path) if !path.is_empty() => Coloring::Picture(FileRef::from(path.as_str()), along),
                other => {
                    self.values.diagnostic(
                        &value.span,
                        format!("`picture` must be the path of a .png, not {}", other.describe()),
                    );
                    Coloring::Plain([128; 3])
                }
            },
            [(_, value)] => match &value.value {
                Value::List(items) if (2..=MAX_COLORS).contains(&items.len()) => {
                    Coloring::Gradient(items.iter().filter_map(|item| self.values.color(item)).collect(), along)
                }
                other => {
                    let message =
                        format!("`gradient` must be a list of 2 to {MAX_COLORS} colors, not {}", other.describe());
                    self.values.diagnostic(&value.span, message);
                    Coloring::Plain([128; 3])
                }
            },
            [] => {
                self.values.diagnostic(
                    &table.span,
                    "a surface needs a `color`, such as \"#6d675f\", a `gradient` of colors or a `picture`",
                );
                Coloring::Plain([128; 3])
            }
            [_, (second, _), ..] => {
                self.values.diagnostic(
                    &second.span,
                    "a surface can have only one of `color`, `gradient` and `picture`; remove the others",
                );
                Coloring::Plain([128; 3])
            }
        }
    }

    fn along(&mut self, entries: &[Entry]) -> Along {
        let find = |name: &str| entries.iter().find(|(key, _)| key.value == name);
        let grain = match find("grain") {
            Some((_, value)) => self.values.number("grain", value, [1e-3, 1e9]).unwrap_or(DEFAULT_GRAIN),
            None => DEFAULT_GRAIN,
        };
        let along = match find("along") {
            None => "noise".to_string(),
            Some((_, value)) => match &value.value {
                Value::Text(text) => text.clone(),
                other => {
                    let message = format!(
                        "`along` must be \"noise\", \"height\", \"slope\" or a node's name, not {}",
                        other.describe()
                    );
                    self.values.diagnostic(&value.span, message);
                    "noise".to_string()
                }
            },
        };
        match (along.as_str(), find("span"), find("grain")) {
            ("noise", Some((key, _)), _) => {
                self.values.diagnostic(&key.span, "`span` applies to `along = \"height\"`, \"slope\" or a node; for noise use `grain`, its wavelength in metres");
                Along::default()
            }
            ("noise", ..) => Along::Noise(grain),
            (_, _, Some((key, _))) => {
                self.values.diagnostic(
                    &key.span,
                    "`grain` is the wavelength of noise, but this gradient does not follow noise",
                );
                Along::default()
            }
            (_, None, _) => {
                let span = find("along").map_or(0..0, |(key, _)| key.span.clone());
                self.values.diagnostic(
                    &span,
                    format!(
                        "a gradient along `{along}` needs `span = [FROM, TO]`: the values of its first and last color"
                    ),
                );
                Along::default()
            }
            (along, Some((_, span)), _) => {
                let span = self.span(span);
                match along {
                    "height" => Along::Height(span),
                    "slope" => Along::Slope(span),
                    layer => {
                        let place = find("along").map_or(0..0, |(_, value)| value.span.clone());
                        self.values.names.push((layer.to_string(), place));
                        Along::Layer(layer.to_string(), span)
                    }
                }
            }
        }
    }

    fn span(&mut self, value: &Spanned<Value>) -> [f64; 2] {
        if let Value::List(items) = &value.value
            && let [from, to] = items.as_slice()
            && let (Some(from), Some(to)) = (from.value.number(), to.value.number())
            && from.abs() <= 1e9
            && to.abs() <= 1e9
            && from != to
        {
            return [from, to];
        }
        self.values.diagnostic(
            &value.span,
            format!("`span` must be two different numbers [FROM, TO], not {}", value.value.describe()),
        );
        [0.0, 1.0]
    }
}
