//! Conversion of `[[scatter]]` tables.

use super::document::{InWater, MAX_SCATTERS, SIZES, SPACINGS, Scatter, Turn};
use crate::recipe::condition::read::{CONDITIONS, Places, ValueReader};
use orogen_grid::words::suggestion;
use orogen_ops::value::{Span, Spanned, Value};

/// The keys of an entry, beside conditions.
pub const KEYS: [&str; 11] =
    ["name", "spacing", "density", "size", "turn", "water", "clearance", "cell", "seed", "any", "mask"];

/// Bounds of `clearance` and of `cell`, in metres.
const CLEARANCES: [f64; 2] = [0.0, 1e6];
const CELLS: [f64; 2] = [1e-4, 1e7];

/// The entries of a recipe with the positions of their tables, and their problems.
#[derive(Debug, Default)]
pub struct Read {
    /// The entries.
    pub entries: Vec<Scatter>,
    /// The positions of their tables and of the names in those.
    pub places: Places,
    /// The problems, with positions.
    pub diagnostics: Vec<(Span, String)>,
}

/// Reads the list of entries. `bounded` tells whether the world is bounded: only then are drainage areas known.
pub fn read(value: &Spanned<Value>, bounded: bool) -> Read {
    let mut out = Read::default();
    let mut values = ValueReader::new(bounded);
    match &value.value {
        Value::List(items) if items.len() > MAX_SCATTERS => values.diagnostic(
            &value.span,
            format!("there are {} tables `[[scatter]]`; a recipe has at most {MAX_SCATTERS}", items.len()),
        ),
        Value::List(items) => {
            for (seed, item) in (0..).zip(items) {
                out.entries.extend(entry(&mut values, item, seed));
                out.places.tables.push(item.span.clone());
            }
        }
        other => values.diagnostic(
            &value.span,
            format!("`scatter` must be a list of tables, `[[scatter]]`, not {}", other.describe()),
        ),
    }
    out.places.names = values.names;
    Read { diagnostics: values.diagnostics, ..out }
}

fn entry(values: &mut ValueReader, table: &Spanned<Value>, seed: u64) -> Option<Scatter> {
    let entries = values.table("an entry of `scatter`", table)?;
    let name = values.name(entries, &table.span, "an entry of `scatter`", "tree");
    let mut out = Scatter { name, seed, ..Scatter::default() };
    match entries.iter().find(|(key, _)| key.value == "spacing") {
        Some((_, value)) => out.spacing = values.number("spacing", value, SPACINGS).unwrap_or(out.spacing),
        None => values.diagnostic(
            &table.span,
            "an entry of `scatter` needs a `spacing`: the smallest distance of two objects, in metres",
        ),
    }
    out.clearance = out.spacing;
    for (key, value) in entries {
        match key.value.as_str() {
            "density" => {
                out.density = match value.value.number() {
                    Some(_) => values.share("density", value).into(),
                    None => values.input("density", value),
                }
            }
            "size" => out.size = size(values, value).unwrap_or(out.size),
            "turn" => out.turn = turn(values, value),
            "water" => out.water = water(values, value),
            "clearance" => out.clearance = values.number("clearance", value, CLEARANCES).unwrap_or(out.clearance),
            "cell" => out.cell = values.number("cell", value, CELLS),
            "seed" => out.seed = values.whole("seed", value, i64::MAX) as u64,
            "mask" => out.mask = values.input("mask", value),
            "any" => out.any = values.alternatives(value),
            known if KEYS.contains(&known) => {}
            condition if CONDITIONS.contains(&condition) => out.all.extend(values.condition(condition, value)),
            unknown => {
                let hint = suggestion(unknown, KEYS.into_iter().chain(CONDITIONS));
                values.diagnostic(&key.span, format!("unknown key `{unknown}` in an entry of `scatter`; {hint}"));
            }
        }
    }
    Some(out)
}

/// One scale factor, or the range [SMALLEST, LARGEST].
fn size(values: &mut ValueReader, value: &Spanned<Value>) -> Option<[f64; 2]> {
    match &value.value {
        Value::List(items) if items.len() == 2 => {
            let [low, high] = [0, 1].map(|k| values.number("size", &items[k], SIZES));
            let size = [low?, high?];
            if size[0] > size[1] {
                values.diagnostic(&value.span, "the smallest `size` must not be greater than the largest");
                return None;
            }
            Some(size)
        }
        Value::List(_) => {
            values.diagnostic(&value.span, "`size` must be one scale factor or [SMALLEST, LARGEST]");
            None
        }
        _ => values.number("size", value, SIZES).map(|size| [size; 2]),
    }
}

fn turn(values: &mut ValueReader, value: &Spanned<Value>) -> Turn {
    match (&value.value, value.value.number()) {
        (Value::Text(text), _) if text == "random" => Turn::Random,
        (_, Some(degrees)) if (0.0..360.0).contains(&degrees) => Turn::Fixed(degrees),
        (other, _) => {
            let message = format!(
                "`turn` must be \"random\" or a number of degrees from 0 to less than 360, not {}",
                other.describe()
            );
            values.diagnostic(&value.span, message);
            Turn::Random
        }
    }
}

fn water(values: &mut ValueReader, value: &Spanned<Value>) -> InWater {
    let known = |text: &String| InWater::ALL.into_iter().find(|(name, _)| name == text);
    match &value.value {
        Value::Text(text) if known(text).is_some() => known(text).map_or(InWater::Avoid, |(_, way)| way),
        other => {
            let message = format!("`water` must be \"avoid\", \"any\" or \"only\", not {}", other.describe());
            values.diagnostic(&value.span, message);
            InWater::Avoid
        }
    }
}
