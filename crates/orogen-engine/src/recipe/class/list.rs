//! The list of `[[class]]` tables.

use super::document::{End, MAX_CLASSES, Share, TerrainClass};
use crate::recipe::condition::part::{is_limit, refuse_limit};
use crate::recipe::outputs::HEIGHT;
use crate::recipe::table::key::Key;
use crate::recipe::table::keys::Keys;
use crate::recipe::table::list::List;
use crate::recipe::table::part::OfKey;
use crate::recipe::table::reader::{Entry, Table, ValueReader};
use orogen_grid::words::suggestion;
use orogen_ops::value::{Span, Spanned, Value};
use serde_json::{Value as Json, json};

/// The list.
pub static CLASSES: List<TerrainClass> = List {
    key: "class",
    doc: "Terrain classes. The first one is everywhere; each takes the cells where its conditions hold, and covers those before it.",
    names: ["a class", "tables `[[class]]`"],
    count: [1, MAX_CLASSES],
    keys: Keys { needs: &[("name", "`name`, such as \"water\"")], parts: TerrainClass::PARTS },
    entry: class,
};

fn class(table: &Table, values: &mut ValueReader, before: &[(TerrainClass, Span)]) -> TerrainClass {
    let limits = |(key, _): &Entry| before.is_empty() && (is_limit(&key.value) || key.value == "share");
    let (limits, entries): (Vec<Entry>, Vec<Entry>) = table.entries.iter().cloned().partition(limits);
    limits.iter().for_each(|(key, _)| refuse_limit(values, "class", key));
    let class = CLASSES.keys.read(&Table { entries: &entries, ..*table }, values, TerrainClass::default());
    if !class.name.is_empty() && before.iter().any(|(other, _)| other.name == class.name) {
        let message = format!(
            "there are two classes `{}`; give one another name, or join them by `any`, a list of alternatives",
            class.name
        );
        values.diagnostic(table.span, message);
    }
    class
}

/// A table with the quantity by which cells are ordered, and the share that is selected from one end.
impl OfKey for Share {
    fn schema(_: &Key) -> Json {
        let part = |about: &str| json!({ "type": "number", "minimum": 0, "maximum": 1, "description": about });
        json!({
            "type": "object",
            "required": ["of"],
            "oneOf": End::ALL.map(|(key, _)| json!({ "required": [key] })),
            "additionalProperties": false,
            "properties": {
                "of": { "type": "string", "description": "What cells are ordered by: `height`, or the name of a node or layer." },
                "lowest": part("The class takes this share of all cells from the lowest values."),
                "highest": part("The class takes this share of all cells from the highest values."),
            },
        })
    }

    fn read(_: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Share> {
        const EXAMPLE: &str = "{ of = \"height\", lowest = 0.4 }";
        let Value::Table(_) = &value.value else {
            let message = format!("`share` must be a table such as {EXAMPLE}, not {}", value.value.describe());
            values.diagnostic(&value.span, message);
            return None;
        };
        let entries = values.table("`share`", value)?;
        if !values.bounded {
            let message = "`share` needs a bounded world; set `size` in `world`, or use a condition instead";
            values.diagnostic(&value.span, message);
        }
        let (mut of, mut ends) = (None, Vec::new());
        for (key, value) in entries {
            let end = End::ALL.iter().find(|(name, _)| *name == key.value);
            match (key.value.as_str(), end, &value.value) {
                ("of", _, Value::Text(name)) if !name.is_empty() => {
                    values.names.push((name.clone(), value.span.clone()));
                    of = Some(name.clone());
                }
                ("of", _, other) => {
                    let found = other.describe();
                    let message = format!("`of` must be \"{HEIGHT}\" or name a node or a layer, not {found}");
                    values.diagnostic(&value.span, message);
                    of = Some(HEIGHT.to_string());
                }
                (_, Some((name, end)), _) => ends.push((
                    *end,
                    values.number(&Key { range: Some([0.0, 1.0]), ..Key::new(name, "") }, value).unwrap_or(1.0),
                )),
                (unknown, None, _) => {
                    let hint = suggestion(unknown, ["of"].into_iter().chain(End::ALL.map(|(name, _)| name)));
                    values.diagnostic(&key.span, format!("unknown key `{unknown}` in `share`; {hint}"));
                }
            }
        }
        if of.is_none() {
            values.diagnostic(&value.span, format!("`share` needs `of`, what cells are ordered by, such as {EXAMPLE}"));
        }
        let [(end, part)] = ends[..] else {
            let message = format!("`share` needs either `lowest` or `highest`, a part of all cells, such as {EXAMPLE}");
            values.diagnostic(&value.span, message);
            return None;
        };
        Some(Share { of: of?, end, part })
    }

    fn write(&self, _: &Key) -> Option<Value> {
        let (end, _) = End::ALL.into_iter().find(|(_, end)| *end == self.end)?;
        let entries = [("of", Value::Text(self.of.clone())), (end, Value::Number(self.part))];
        let entry = |(key, value): (&str, Value)| (Spanned::unplaced(key.to_string()), Spanned::unplaced(value));
        Some(Value::Table(entries.map(entry).into()))
    }
}
