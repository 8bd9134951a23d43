//! The list of `[[scatter]]` tables.

use super::document::{InWater, MAX_SCATTERS, Scatter, Turn};
use crate::recipe::table::key::Key;
use crate::recipe::table::keys::Keys;
use crate::recipe::table::list::List;
use crate::recipe::table::part::OfKey;
use crate::recipe::table::reader::ValueReader;
use orogen_ops::value::{Spanned, Value};
use serde_json::{Value as Json, json};

/// The list.
pub static SCATTERS: List<Scatter> = List {
    key: "scatter",
    doc: "Objects that stand on the ground where their conditions hold, such as trees. Each entry keeps a distance to the objects of those before it.",
    names: ["an entry of `scatter`", "tables `[[scatter]]`"],
    count: [0, MAX_SCATTERS],
    keys: Keys {
        needs: &[
            ("name", "`name`, such as \"tree\""),
            ("spacing", "`spacing`: the smallest distance of two objects, in metres"),
        ],
        parts: Scatter::PARTS,
    },
    entry: |table, values, before| {
        let seed = before.len() as u64;
        let entry = SCATTERS.keys.read(table, values, Scatter { seed, ..Scatter::default() });
        let clearance = if table.has("clearance") { entry.clearance } else { entry.spacing };
        Scatter { clearance, ..entry }
    },
};

impl OfKey for Turn {
    fn schema(_: &Key) -> Json {
        let degrees = json!({ "type": "number", "minimum": 0, "exclusiveMaximum": 360 });
        json!({ "anyOf": [{ "type": "string", "enum": ["random"] }, degrees], "default": "random" })
    }

    fn read(_: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Turn> {
        match (&value.value, value.value.number()) {
            (Value::Text(text), _) if text == "random" => Some(Turn::Random),
            (_, Some(degrees)) if (0.0..360.0).contains(&degrees) => Some(Turn::Fixed(degrees)),
            (other, _) => {
                let expected = "\"random\" or a number of degrees from 0 to less than 360";
                values.diagnostic(&value.span, format!("`turn` must be {expected}, not {}", other.describe()));
                None
            }
        }
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(match self {
            Turn::Random => Value::Text("random".to_string()),
            Turn::Fixed(degrees) => Value::Number(*degrees),
        })
    }
}

impl OfKey for InWater {
    fn schema(_: &Key) -> Json {
        let names = InWater::ALL.map(|(name, _)| name);
        json!({ "type": "string", "enum": names, "default": names[0] })
    }

    fn read(_: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<InWater> {
        let is_it = |name: &str| matches!(&value.value, Value::Text(text) if text == name);
        let known = InWater::ALL.into_iter().find(|(name, _)| is_it(name));
        if known.is_none() {
            let found = value.value.describe();
            values.diagnostic(&value.span, format!("`water` must be \"avoid\", \"any\" or \"only\", not {found}"));
        }
        known.map(|(_, way)| way)
    }

    fn write(&self, _: &Key) -> Option<Value> {
        let name = InWater::ALL.iter().find(|(_, way)| way == self);
        name.map(|(name, _)| Value::Text((*name).to_string()))
    }
}
