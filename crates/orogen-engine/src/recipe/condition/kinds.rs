//! The kinds of conditions: for each quantity its key, the bounds of its ranges, and the further keys of its table.

use super::document::{Condition, MAX_ALTERNATIVES, Noise, Quantity};
use crate::recipe::table::key::Key;
use crate::recipe::table::keys::Keys;
use crate::recipe::table::part::{OfKey, entry};
use crate::recipe::table::reader::{Entry, Table, ValueReader};
use orogen_grid::words::suggestion;
use orogen_ops::value::{Spanned, Value};
use serde_json::{Value as Json, json};

/// A kind of condition.
pub struct Kind {
    /// The key of a condition; for layers, the key of the table that has their conditions.
    pub name: &'static str,
    doc: &'static str,
    /// The quantity with its defaults.
    of: fn() -> Quantity,
    /// The keys of a range.
    keys: Keys<'static, Condition>,
}

/// Declares a kind: its range within bounds, with transitions of at most `FADE`, and further keys of the quantity.
macro_rules! kind {
    ($name:literal $doc:literal, $of:expr, $bounds:expr, $fade:expr, needs $needs:expr $(, $more:expr)*) => {
        Kind {
            name: $name,
            doc: $doc,
            of: || $of,
            keys: Keys {
                needs: $needs,
                parts: &[
                    key!(Condition.min, "Lower bound.", range $bounds),
                    key!(Condition.max, "Upper bound.", range $bounds),
                    key!(Condition.fade, "Width of the transition outside the range: one number, or [below, above].",
                        range [0.0, $fade], pair "[BELOW, ABOVE]", single true),
                    $($more,)*
                ],
            },
        }
    };
}

/// A further key of noise.
macro_rules! of_noise {
    ($field:ident, $doc:literal $(, $fact:ident $value:expr)*) => {
        key!(Condition, stringify!($field), $doc $(, $fact $value)*, |condition| match &mut condition.of {
            Quantity::Noise(noise) => Some(&mut noise.$field),
            _ => None,
        })
    };
}

/// Default distance of the heights of a curvature, in metres.
const SCALE: f64 = 50.0;

/// All kinds; layers are last.
pub static KINDS: [Kind; 6] = [
    kind!("height" "Height above the sea. Unit: m.", Quantity::Height, [-1e6, 1e6], 2e6, needs &[]),
    kind!("slope" "Slope. Unit: degrees.", Quantity::Slope, [0.0, 90.0], 90.0, needs &[]),
    kind!("curvature" "Total curvature, positive where the ground is convex. Unit: 1/m.",
    Quantity::Curvature { scale: SCALE }, [-1e3, 1e3], 2e3, needs &[],
    key!(Condition, "scale", "Distance between the heights that the curvature is computed from. Unit: m.",
        range [0.0, 1e6], stated SCALE, |condition| match &mut condition.of {
            Quantity::Curvature { scale } => Some(scale),
            _ => None,
        })),
    // Powers of ten.
    kind!("flow" "Drainage area. `fade` is in powers of ten. Unit: m^2.", Quantity::Flow, [0.0, 1e18], 20.0, needs &[]),
    kind!("noise" "Fractal noise, -1 to 1.", Quantity::Noise(Noise { wavelength: 0.0, octaves: 4, seed: 0 }),
        [-1.0, 1.0], 2.0,
        needs &[("wavelength", "`wavelength` in metres, such as { min = 0, wavelength = 400 }")],
        of_noise!(wavelength, "Unit: m.", range [1e-3, 1e9]),
        of_noise!(octaves, "Number of octaves.", range [1.0, 32.0], stated 4.0),
        of_noise!(seed, "Hashed with the world's seed.", stated 0.0)),
    kind!("layers" "A node or layer, in its own unit.", Quantity::Layer(String::new()), [-1e9, 1e9], 1e9, needs &[]),
];

/// Whether a key is the key of a condition.
pub fn is_condition(key: &str) -> bool {
    KINDS.iter().any(|kind| kind.name == key)
}

impl Kind {
    /// The kind with this key.
    pub fn named(key: &str) -> Option<&'static Kind> {
        KINDS.iter().find(|kind| kind.name == key)
    }

    fn is_layers(&self) -> bool {
        matches!((self.of)(), Quantity::Layer(_))
    }

    /// Reads the conditions of the key: one, or one for each layer.
    pub fn read(&self, value: &Spanned<Value>, values: &mut ValueReader) -> Vec<Condition> {
        if self.is_layers() {
            let Some(entries) = values.table("`layers`", value) else { return Vec::new() };
            values.names.extend(entries.iter().map(|(name, _)| (name.value.clone(), name.span.clone())));
            let of = |name: &Spanned<String>| Quantity::Layer(name.value.clone());
            return entries.iter().map(|(name, value)| self.range(of(name), value, values)).collect();
        }
        let of = (self.of)();
        if of == Quantity::Flow && !values.bounded {
            values.diagnostic(&value.span, "`flow` needs a bounded world; set `size` in `world`, or remove `flow`");
        }
        vec![self.range(of, value, values)]
    }

    /// Reads a range: `[MIN, MAX]` or a table of its keys.
    fn range(&self, of: Quantity, value: &Spanned<Value>, values: &mut ValueReader) -> Condition {
        let key = self.name;
        let mut condition = Condition::new(of, None, None, [0.0; 2]);
        let pair: Vec<Entry>;
        let entries = match &value.value {
            Value::List(ends) if ends.len() == 2 => {
                let end = |(key, end): (&str, &Spanned<Value>)| {
                    (Spanned { value: key.to_string(), span: end.span.clone() }, end.clone())
                };
                pair = ["min", "max"].into_iter().zip(ends).map(end).collect();
                Some(pair.as_slice())
            }
            Value::Table(_) => values.table(key, value),
            other => {
                let found = other.describe();
                let message =
                    format!("`{key}` must be [MIN, MAX] or a table such as {{ min = 30, fade = 5 }}, not {found}");
                values.diagnostic(&value.span, message);
                None
            }
        };
        let Some(entries) = entries else { return condition };
        let table = Table { name: &format!("`{key}`"), span: &value.span, entries };
        condition = self.keys.read(&table, values, condition);
        match (condition.min, condition.max) {
            (Some(min), Some(max)) if min > max => {
                let message = format!("the lower bound of `{key}` must not be greater than its upper bound");
                values.diagnostic(&value.span, message);
                condition.max = condition.min;
            }
            (None, None) => values.diagnostic(&value.span, format!("`{key}` needs a `min` or a `max`")),
            _ => {}
        }
        condition
    }

    /// The schema of the key.
    pub fn schema(&self) -> Json {
        let pair = <[f64; 2]>::schema(&Key::new("", ""));
        let range = json!({ "anyOf": [pair, self.keys.schema()], "description": self.doc });
        match self.is_layers() {
            true => json!({
                "type": "object",
                "additionalProperties": range,
                "description": "Conditions on nodes or layers of the recipe, by name.",
            }),
            false => range,
        }
    }
}

/// The entries of conditions.
pub fn entries(conditions: &[Condition]) -> Vec<Entry> {
    let kind_of = |condition: &Condition| {
        let is_its = |kind: &&Kind| std::mem::discriminant(&(kind.of)()) == std::mem::discriminant(&condition.of);
        KINDS.iter().find(is_its)
    };
    let (mut out, mut layers) = (Vec::new(), Vec::new());
    for condition in conditions {
        let Some(kind) = kind_of(condition) else { continue };
        let value = Value::Table(kind.keys.entries(condition));
        match &condition.of {
            Quantity::Layer(name) => layers.push(entry(name, value)),
            _ => out.push(entry(kind.name, value)),
        }
    }
    out.extend((!layers.is_empty()).then(|| entry("layers", Value::Table(layers))));
    out
}

/// Alternatives: a list of tables of conditions.
impl OfKey for Vec<Vec<Condition>> {
    fn schema(_: &Key) -> Json {
        let properties: serde_json::Map<String, Json> =
            KINDS.iter().map(|kind| (kind.name.to_string(), kind.schema())).collect();
        json!({
            "type": "array", "minItems": 1, "maxItems": MAX_ALTERNATIVES,
            "items": { "type": "object", "additionalProperties": false, "minProperties": 1, "properties": properties },
        })
    }

    fn read(_: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Self> {
        let message = match &value.value {
            Value::List(items) if (1..=MAX_ALTERNATIVES).contains(&items.len()) => {
                return Some(items.iter().map(|item| alternative(item, values)).collect());
            }
            Value::List(items) => format!("`any` takes 1 to {MAX_ALTERNATIVES} alternatives, not {}", items.len()),
            other => format!("`any` must be a list of tables of conditions, not {}", other.describe()),
        };
        values.diagnostic(&value.span, message);
        None
    }

    fn write(&self, _: &Key) -> Option<Value> {
        let item = |conditions: &Vec<Condition>| Spanned::unplaced(Value::Table(entries(conditions)));
        (!self.is_empty()).then(|| Value::List(self.iter().map(item).collect()))
    }
}

fn alternative(value: &Spanned<Value>, values: &mut ValueReader) -> Vec<Condition> {
    let Some(table) = values.table("an alternative", value) else { return Vec::new() };
    let mut all = Vec::new();
    for (key, value) in table {
        match Kind::named(&key.value) {
            Some(kind) => all.extend(kind.read(value, values)),
            None => {
                let hint = suggestion(&key.value, KINDS.iter().map(|kind| kind.name));
                values.diagnostic(&key.span, format!("unknown condition `{}`; {hint}", key.value));
            }
        }
    }
    if all.is_empty() {
        values.diagnostic(&value.span, "an alternative needs a condition, such as `slope = { min = 40 }`");
    }
    all
}
