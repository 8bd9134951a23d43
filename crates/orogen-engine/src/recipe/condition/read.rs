//! Conversion of keys to conditions, with diagnostics at their keys.

use super::document::{Condition, MAX_ALTERNATIVES, Noise, Quantity};
use crate::recipe::table::reader::ValueReader;
use orogen_grid::words::suggestion;
use orogen_ops::value::{Spanned, Value};

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

impl ValueReader {
    /// The alternatives of an `any`.
    pub fn alternatives(&mut self, value: &Spanned<Value>) -> Vec<Vec<Condition>> {
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
    pub fn condition(&mut self, key: &str, value: &Spanned<Value>) -> Vec<Condition> {
        if key == "layers" {
            let Some(entries) = self.table("`layers`", value) else { return Vec::new() };
            self.names.extend(entries.iter().map(|(name, _)| (name.value.clone(), name.span.clone())));
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
}
