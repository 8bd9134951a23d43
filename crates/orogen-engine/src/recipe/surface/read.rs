//! Conversion of `[[surface]]` tables to surfaces.

use std::collections::HashSet;

use super::document::{
    Along, Coloring, Condition, DEFAULT_GRAIN, MAX_ALTERNATIVES, MAX_COLORS, MAX_SURFACES, Noise, Quantity, Surface,
};
use crate::declare::Input;
use crate::value::{Span, Spanned, Value};
use orogen_grid::words::suggestion;
use orogen_io::dem::file_ref::FileRef;
use orogen_io::palette::color::Rgb;
use orogen_io::palette::names;

type Entry = (Spanned<String>, Spanned<Value>);

/// Bounds of the ends of each condition, and the default scale of a curvature in metres.
const HEIGHTS: [f64; 2] = [-1e6, 1e6];
const SLOPES: [f64; 2] = [0.0, 90.0];
const CURVATURES: [f64; 2] = [-1e3, 1e3];
const FLOWS: [f64; 2] = [0.0, 1e18];
const NOISES: [f64; 2] = [-1.0, 1.0];
const LAYERS: [f64; 2] = [-1e9, 1e9];
const SCALE: f64 = 50.0;

/// The keys of conditions.
pub const CONDITIONS: [&str; 6] = ["height", "slope", "curvature", "flow", "noise", "layers"];

/// The other keys of a surface.
pub const KEYS: [&str; 11] =
    ["name", "color", "gradient", "picture", "along", "span", "grain", "roughness", "opacity", "any", "mask"];

/// The surfaces of a recipe with the positions of their tables, and their problems.
#[derive(Debug, Default)]
pub struct Read {
    /// The surfaces.
    pub surfaces: Vec<Surface>,
    /// The position of each.
    pub places: Vec<Span>,
    /// The problems, with positions.
    pub diagnostics: Vec<(Span, String)>,
}

/// Reads the list of surfaces. `bounded` tells whether the world is bounded: only then are drainage areas known.
pub fn read(value: &Spanned<Value>, bounded: bool) -> Read {
    let mut reader = Reader { out: Read::default(), bounded };
    match &value.value {
        Value::List(items) if items.len() > MAX_SURFACES => {
            reader.diagnostic(
                &value.span,
                format!("there are {} surfaces; a recipe has at most {MAX_SURFACES}", items.len()),
            );
        }
        Value::List(items) => items.iter().for_each(|item| reader.surface(item)),
        other => reader.diagnostic(
            &value.span,
            format!("`surface` must be a list of tables, `[[surface]]`, not {}", other.describe()),
        ),
    }
    reader.out
}

struct Reader {
    out: Read,
    bounded: bool,
}

impl Reader {
    fn diagnostic(&mut self, span: &Span, message: impl Into<String>) {
        self.out.diagnostics.push((span.clone(), message.into()));
    }

    fn table<'v>(&mut self, what: &str, value: &'v Spanned<Value>) -> Option<&'v [Entry]> {
        match &value.value {
            Value::Table(entries) => {
                let mut seen = HashSet::new();
                for (key, _) in entries {
                    if !seen.insert(key.value.as_str()) {
                        self.diagnostic(&key.span, format!("the key `{}` appears twice in this table", key.value));
                    }
                }
                Some(entries)
            }
            other => {
                self.diagnostic(&value.span, format!("{what} must be a table, not {}", other.describe()));
                None
            }
        }
    }

    fn surface(&mut self, value: &Spanned<Value>) {
        let Some(entries) = self.table("a surface", value) else { return };
        let find = |name: &str| entries.iter().find(|(key, _)| key.value == name);
        let mut surface = Surface::default();
        match find("name") {
            Some((_, name)) => match &name.value {
                Value::Text(text) if is_name(text) => surface.name = text.clone(),
                other => {
                    let message =
                        format!("`name` must be 1 to 64 letters, digits, `_` and `-`, not {}", other.describe());
                    self.diagnostic(&name.span, message);
                }
            },
            None => self.diagnostic(&value.span, "a surface needs a `name`, such as \"rock\""),
        }
        surface.color = self.coloring(value, entries);
        for (key, value) in entries {
            match key.value.as_str() {
                "roughness" => surface.roughness = self.share("roughness", value),
                "opacity" => surface.opacity = self.share("opacity", value),
                "mask" => surface.mask = self.input("mask", value),
                "any" => surface.any = self.alternatives(value),
                known if KEYS.contains(&known) => {}
                condition if CONDITIONS.contains(&condition) => surface.all.extend(self.condition(condition, value)),
                unknown => {
                    let hint = suggestion(unknown, KEYS.into_iter().chain(CONDITIONS));
                    self.diagnostic(&key.span, format!("unknown key `{unknown}` in a surface; {hint}"));
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
                self.diagnostic(&key.span, message);
            }
        }
        self.out.surfaces.push(surface);
        self.out.places.push(value.span.clone());
    }

    fn coloring(&mut self, table: &Spanned<Value>, entries: &[Entry]) -> Coloring {
        let given: Vec<&Entry> =
            entries.iter().filter(|(key, _)| matches!(key.value.as_str(), "color" | "gradient" | "picture")).collect();
        let along = self.along(entries);
        let follows = |key: &str| matches!(key, "along" | "span" | "grain");
        match given.as_slice() {
            [(key, value)] if key.value == "color" => {
                if let Some((key, _)) = entries.iter().find(|(key, _)| follows(&key.value)) {
                    self.diagnostic(
                        &key.span,
                        format!("`{}` applies to a `gradient` or a `picture`, not to a `color`", key.value),
                    );
                }
                Coloring::Plain(self.color(value).unwrap_or([128; 3]))
            }
            [(key, value)] if key.value == "picture" => match &value.value {
                Value::Text(path) if !path.is_empty() => Coloring::Picture(FileRef::from(path.as_str()), along),
                other => {
                    self.diagnostic(
                        &value.span,
                        format!("`picture` must be the path of a .png, not {}", other.describe()),
                    );
                    Coloring::Plain([128; 3])
                }
            },
            [(_, value)] => match &value.value {
                Value::List(items) if (2..=MAX_COLORS).contains(&items.len()) => {
                    Coloring::Gradient(items.iter().filter_map(|item| self.color(item)).collect(), along)
                }
                other => {
                    let message =
                        format!("`gradient` must be a list of 2 to {MAX_COLORS} colors, not {}", other.describe());
                    self.diagnostic(&value.span, message);
                    Coloring::Plain([128; 3])
                }
            },
            [] => {
                self.diagnostic(
                    &table.span,
                    "a surface needs a `color`, such as \"#6d675f\", a `gradient` of colors or a `picture`",
                );
                Coloring::Plain([128; 3])
            }
            [_, (second, _), ..] => {
                self.diagnostic(
                    &second.span,
                    "a surface can have only one of `color`, `gradient` and `picture`; remove the others",
                );
                Coloring::Plain([128; 3])
            }
        }
    }

    fn color(&mut self, value: &Spanned<Value>) -> Option<Rgb> {
        let color = match &value.value {
            Value::Text(text) => names::hexadecimal(text).or_else(|| names::named(text)),
            _ => None,
        };
        if color.is_none() {
            let message =
                format!("a color must be \"#rrggbb\" or a name such as \"khaki\", not {}", value.value.describe());
            self.diagnostic(&value.span, message);
        }
        color
    }

    fn along(&mut self, entries: &[Entry]) -> Along {
        let find = |name: &str| entries.iter().find(|(key, _)| key.value == name);
        let grain = match find("grain") {
            Some((_, value)) => self.number("grain", value, [1e-3, 1e9]).unwrap_or(DEFAULT_GRAIN),
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
                    self.diagnostic(&value.span, message);
                    "noise".to_string()
                }
            },
        };
        match (along.as_str(), find("span"), find("grain")) {
            ("noise", Some((key, _)), _) => {
                self.diagnostic(&key.span, "`span` applies to `along = \"height\"`, \"slope\" or a node; for noise use `grain`, its wavelength in metres");
                Along::default()
            }
            ("noise", ..) => Along::Noise(grain),
            (_, _, Some((key, _))) => {
                self.diagnostic(
                    &key.span,
                    "`grain` is the wavelength of noise, but this gradient does not follow noise",
                );
                Along::default()
            }
            (_, None, _) => {
                let span = find("along").map_or(0..0, |(key, _)| key.span.clone());
                self.diagnostic(
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
                    layer => Along::Layer(layer.to_string(), span),
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
        self.diagnostic(
            &value.span,
            format!("`span` must be two different numbers [FROM, TO], not {}", value.value.describe()),
        );
        [0.0, 1.0]
    }

    fn alternatives(&mut self, value: &Spanned<Value>) -> Vec<Vec<Condition>> {
        let Value::List(items) = &value.value else {
            self.diagnostic(
                &value.span,
                format!("`any` must be a list of tables of conditions, not {}", value.value.describe()),
            );
            return Vec::new();
        };
        if items.is_empty() || items.len() > MAX_ALTERNATIVES {
            self.diagnostic(
                &value.span,
                format!("`any` takes 1 to {MAX_ALTERNATIVES} alternatives, not {}", items.len()),
            );
            return Vec::new();
        }
        items.iter().map(|item| self.conditions(item)).collect()
    }

    fn conditions(&mut self, value: &Spanned<Value>) -> Vec<Condition> {
        let Some(entries) = self.table("an alternative", value) else { return Vec::new() };
        let mut all = Vec::new();
        for (key, value) in entries {
            if CONDITIONS.contains(&key.value.as_str()) {
                all.extend(self.condition(&key.value, value));
            } else {
                let hint = suggestion(&key.value, CONDITIONS);
                self.diagnostic(&key.span, format!("unknown condition `{}`; {hint}", key.value));
            }
        }
        if all.is_empty() {
            self.diagnostic(&value.span, "an alternative needs a condition, such as `slope = { min = 40 }`");
        }
        all
    }

    /// The conditions of a key: one, or one per layer.
    fn condition(&mut self, key: &str, value: &Spanned<Value>) -> Vec<Condition> {
        if key == "layers" {
            let Some(entries) = self.table("`layers`", value) else { return Vec::new() };
            return (entries.iter())
                .map(|(name, value)| self.range(Quantity::Layer(name.value.clone()), "layers", value, LAYERS))
                .collect();
        }
        if key == "flow" && !self.bounded {
            self.diagnostic(&value.span, "`flow` needs a bounded world; set `size` in `world`, or remove `flow`");
        }
        let (of, bounds) = match key {
            "height" => (Quantity::Height, HEIGHTS),
            "slope" => (Quantity::Slope, SLOPES),
            "curvature" => (Quantity::Curvature { scale: SCALE }, CURVATURES),
            "flow" => (Quantity::Flow, FLOWS),
            _ => (Quantity::Noise(Noise { wavelength: 0.0, octaves: 4, seed: 0 }), NOISES),
        };
        vec![self.range(of, key, value, bounds)]
    }

    /// A range: `[MIN, MAX]` or a table of `min`, `max`, `fade` and further keys of the quantity.
    fn range(&mut self, of: Quantity, key: &str, value: &Spanned<Value>, bounds: [f64; 2]) -> Condition {
        let mut condition = Condition::new(of, None, None, [0.0; 2]);
        match &value.value {
            Value::List(items) if items.len() == 2 => {
                condition.min = self.number("min", &items[0], bounds);
                condition.max = self.number("max", &items[1], bounds);
            }
            Value::Table(_) => {
                let Some(entries) = self.table(key, value) else { return condition };
                for (name, value) in entries {
                    self.part(&mut condition, key, name, value, bounds);
                }
            }
            other => {
                let message = format!(
                    "`{key}` must be [MIN, MAX] or a table such as {{ min = 30, fade = 5 }}, not {}",
                    other.describe()
                );
                self.diagnostic(&value.span, message);
                return condition;
            }
        }
        if condition.min.zip(condition.max).is_some_and(|(min, max)| min > max) {
            self.diagnostic(
                &value.span,
                format!("the lower bound of `{key}` must not be greater than its upper bound"),
            );
            condition.max = condition.min;
        }
        if condition.min.is_none() && condition.max.is_none() {
            self.diagnostic(&value.span, format!("`{key}` needs a `min` or a `max`"));
        }
        if matches!(&condition.of, Quantity::Noise(noise) if noise.wavelength == 0.0) {
            self.diagnostic(
                &value.span,
                "`noise` needs a `wavelength` in metres, such as { min = 0, wavelength = 400 }",
            );
        }
        condition
    }

    fn part(
        &mut self,
        condition: &mut Condition,
        key: &str,
        name: &Spanned<String>,
        value: &Spanned<Value>,
        bounds: [f64; 2],
    ) {
        match (name.value.as_str(), &mut condition.of) {
            ("min", _) => condition.min = self.number("min", value, bounds),
            ("max", _) => condition.max = self.number("max", value, bounds),
            // Powers of ten.
            ("fade", Quantity::Flow) => condition.fade = self.fade(value, 20.0),
            ("fade", _) => condition.fade = self.fade(value, (bounds[1] - bounds[0]).min(1e9)),
            ("scale", Quantity::Curvature { scale }) => {
                *scale = self.number("scale", value, [0.0, 1e6]).unwrap_or(SCALE)
            }
            ("wavelength", Quantity::Noise(noise)) => {
                noise.wavelength = self.number("wavelength", value, [1e-3, 1e9]).unwrap_or(1.0);
            }
            ("octaves", Quantity::Noise(noise)) => noise.octaves = self.whole("octaves", value, 32).max(1) as u32,
            ("seed", Quantity::Noise(noise)) => noise.seed = self.whole("seed", value, i64::MAX) as u64,
            (unknown, of) => {
                let more: &[&str] = match of {
                    Quantity::Curvature { .. } => &["scale"],
                    Quantity::Noise(_) => &["wavelength", "octaves", "seed"],
                    _ => &[],
                };
                let known: Vec<&str> = ["min", "max", "fade"].into_iter().chain(more.iter().copied()).collect();
                let hint = suggestion(unknown, known.iter().copied());
                self.diagnostic(&name.span, format!("unknown key `{unknown}` in `{key}`; {hint}"));
            }
        }
    }

    /// One width for both ends, or [BELOW, ABOVE].
    fn fade(&mut self, value: &Spanned<Value>, most: f64) -> [f64; 2] {
        match &value.value {
            Value::List(items) if items.len() == 2 => {
                [0, 1].map(|k| self.number("fade", &items[k], [0.0, most]).unwrap_or(0.0))
            }
            _ => [self.number("fade", value, [0.0, most]).unwrap_or(0.0); 2],
        }
    }

    fn number(&mut self, key: &str, value: &Spanned<Value>, [low, high]: [f64; 2]) -> Option<f64> {
        let number = value.value.number().filter(|number| (low..=high).contains(number));
        if number.is_none() {
            let message = format!("`{key}` must be a number from {low:?} to {high:?}, not {}", value.value.describe());
            self.diagnostic(&value.span, message);
        }
        number
    }

    fn whole(&mut self, key: &str, value: &Spanned<Value>, most: i64) -> i64 {
        match value.value {
            Value::Integer(number) if (0..=most).contains(&number) => number,
            _ => {
                let message =
                    format!("`{key}` must be a whole number from 0 to {most}, not {}", value.value.describe());
                self.diagnostic(&value.span, message);
                1
            }
        }
    }

    fn share(&mut self, key: &str, value: &Spanned<Value>) -> f64 {
        self.number(key, value, [0.0, 1.0]).unwrap_or(1.0)
    }

    fn input(&mut self, key: &str, value: &Spanned<Value>) -> Input {
        match (&value.value, value.value.number()) {
            (Value::Text(name), _) => Input::Node(name.clone()),
            (_, Some(number)) if number.is_finite() => Input::Value(number),
            (other, _) => {
                let message = format!("`{key}` must name a node or a layer, or be a number, not {}", other.describe());
                self.diagnostic(&value.span, message);
                Input::None
            }
        }
    }
}

fn is_name(name: &str) -> bool {
    (1..=64).contains(&name.len()) && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-')
}
