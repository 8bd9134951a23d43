//! Lists of tables.

use super::key::Part;
use super::reader::{Table, ValueReader};
use crate::recipe::condition::read::CONDITIONS;
use orogen_grid::words::suggestion;
use orogen_ops::value::{Span, Spanned, Value};
use serde_json::{Map, Value as Json, json};
use std::fmt::Write as _;

/// The declaration of a list of tables.
pub struct List<T: 'static> {
    /// The key of the list.
    pub key: &'static str,
    pub doc: &'static str,
    /// What messages call one table, and several.
    pub names: [&'static str; 2],
    /// Minimum and maximum number of tables.
    pub count: [usize; 2],
    /// The keys that every table has, each with what the message says of it where it is missing.
    pub needs: &'static [(&'static str, &'static str)],
    pub parts: &'static [&'static dyn Part<T>],
    /// Reads a table, with [`List::table`], after the entries before it.
    pub entry: fn(&Table, &mut ValueReader, &[(T, Span)]) -> T,
}

impl<T: Clone> List<T> {
    /// Reads the list: its entries with the positions of their tables.
    pub fn read(&self, value: &Spanned<Value>, values: &mut ValueReader) -> Vec<(T, Span)> {
        let (key, [least, most]) = (self.key, self.count);
        let problem = match &value.value {
            Value::List(items) if items.len() < least => {
                format!("`{key}` needs at least one entry; add a table `[[{key}]]` with a `name`")
            }
            Value::List(items) if items.len() > most => {
                format!("there are {} {}; a recipe has at most {most}", items.len(), self.names[1])
            }
            Value::List(items) => {
                let mut out: Vec<(T, Span)> = Vec::new();
                for item in items {
                    let Some(entries) = values.table(self.names[0], item) else { continue };
                    let entry = (self.entry)(&Table { span: &item.span, entries }, values, &out);
                    out.push((entry, item.span.clone()));
                }
                return out;
            }
            other => format!("`{key}` must be a list of tables, `[[{key}]]`, not {}", other.describe()),
        };
        values.diagnostic(&value.span, problem);
        Vec::new()
    }

    /// Reads a table into an entry.
    pub fn table(&self, table: &Table, values: &mut ValueReader, mut entry: T) -> T {
        for (_, what) in self.needs.iter().filter(|(key, _)| !table.has(key)) {
            values.diagnostic(table.span, format!("{} needs a {what}", self.names[0]));
        }
        self.parts.iter().for_each(|part| part.read(table, values, &mut entry));
        let mut known: Vec<&str> = self.parts.iter().flat_map(|part| part.keys()).collect();
        known.sort_by_key(|key| CONDITIONS.contains(key));
        for (key, _) in table.entries.iter().filter(|(key, _)| !known.contains(&key.value.as_str())) {
            let hint = suggestion(&key.value, known.iter().copied());
            values.diagnostic(&key.span, format!("unknown key `{}` in {}; {hint}", key.value, self.names[0]));
        }
        entry
    }

    /// Appends an entry to a recipe's text.
    pub fn write(&self, entry: &T, text: &mut String) {
        let _ = writeln!(text, "\n[[{}]]", self.key);
        let mut entry = entry.clone();
        self.parts.iter().for_each(|part| part.write(&mut entry, text));
    }

    /// The schema of the list.
    pub fn schema(&self) -> Json {
        let keys = self.parts.iter().flat_map(|part| part.keys().into_iter().zip(part.schemas()));
        let properties: Map<String, Json> = keys.map(|(key, schema)| (key.to_string(), schema)).collect();
        let [least, most] = self.count;
        let mut schema = json!({
            "type": "array",
            "maxItems": most,
            "description": self.doc,
            "items": {
                "type": "object",
                "required": self.needs.iter().map(|(key, _)| key).collect::<Vec<_>>(),
                "additionalProperties": false,
                "properties": properties,
            },
        });
        if least > 0 {
            schema["minItems"] = json!(least);
        }
        schema
    }
}
