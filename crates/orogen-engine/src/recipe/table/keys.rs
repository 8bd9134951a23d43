//! The keys of a table.

use super::part::Part;
use super::reader::{Entry, Table, ValueReader};
use orogen_grid::words::suggestion;
use orogen_ops::value::toml_key;
use serde_json::{Map, Value as Json, json};
use std::fmt::Write as _;

/// The keys of a table that makes a `T`.
pub struct Keys<'k, T> {
    /// The required keys, each with the message for when it is missing.
    pub needs: &'k [(&'static str, &'static str)],
    pub parts: &'k [&'k dyn Part<T>],
}

impl<T: Clone> Keys<'_, T> {
    /// Reads a table into `out`, which has the defaults.
    pub fn read(&self, table: &Table, values: &mut ValueReader, mut out: T) -> T {
        for (_, what) in self.needs.iter().filter(|(key, _)| !table.has(key)) {
            values.diagnostic(table.span, format!("{} needs a {what}", table.name));
        }
        self.parts.iter().for_each(|part| part.read(table, values, &mut out));
        let known: Vec<&str> = self.parts.iter().flat_map(|part| part.keys()).collect();
        for (key, _) in table.entries.iter().filter(|(key, _)| !known.contains(&key.value.as_str())) {
            let hint = suggestion(&key.value, known.iter().copied());
            values.diagnostic(&key.span, format!("unknown key `{}` in {}; {hint}", key.value, table.name));
        }
        out
    }

    /// The entries of a table.
    pub fn entries(&self, of: &T) -> Vec<Entry> {
        let (mut of, mut entries) = (of.clone(), Vec::new());
        self.parts.iter().for_each(|part| part.write(&mut of, &mut entries));
        entries
    }

    /// Appends a table to a recipe's text, with a heading such as `[world]`.
    pub fn write(&self, heading: &str, of: &T, text: &mut String) {
        let _ = writeln!(text, "\n{heading}");
        for (key, value) in self.entries(of) {
            let _ = writeln!(text, "{} = {}", toml_key(&key.value), value.value.to_toml_lines());
        }
    }

    /// The problems of values that were set in code, without positions.
    pub fn problems(&self, name: &str, of: &T) -> Vec<String> {
        let mut values = ValueReader::new(true);
        self.read(&Table { name, span: &(0..0), entries: &self.entries(of) }, &mut values, of.clone());
        values.diagnostics.into_iter().map(|(_, message)| message).collect()
    }

    /// The schema of a table.
    pub fn schema(&self) -> Json {
        let keys = self.parts.iter().flat_map(|part| part.keys().into_iter().zip(part.schemas()));
        let properties: Map<String, Json> = keys.map(|(key, schema)| (key.to_string(), schema)).collect();
        let mut schema = json!({ "type": "object", "additionalProperties": false, "properties": properties });
        if !self.needs.is_empty() {
            schema["required"] = self.needs.iter().map(|(key, _)| *key).collect();
        }
        schema
    }
}
