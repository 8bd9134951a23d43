//! Reading of values, with diagnostics at their keys.

use std::collections::HashSet;

use super::key::Key;
use orogen_grid::words::number;
use orogen_ops::value::{Span, Spanned, Value};

/// A key with its value.
pub type Entry = (Spanned<String>, Spanned<Value>);

/// A table to read.
pub struct Table<'a> {
    /// Its name in messages, such as "a surface".
    pub name: &'a str,
    /// Where problems of the whole table are reported.
    pub span: &'a Span,
    pub entries: &'a [Entry],
}

impl Table<'_> {
    /// The entry of a key.
    pub fn find(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|(name, _)| name.value == key)
    }

    /// Whether it has a key.
    pub fn has(&self, key: &str) -> bool {
        self.find(key).is_some()
    }
}

/// Reads values, and collects their problems.
pub struct ValueReader {
    /// The problems, with positions.
    pub diagnostics: Vec<(Span, String)>,
    /// The names of nodes and layers with their positions, for problems that appear only in the nodes that compute
    /// tables.
    pub names: Vec<(String, Span)>,
    /// Whether the world is bounded: only then are drainage areas and shares known.
    pub bounded: bool,
}

impl ValueReader {
    /// A reader for a recipe whose world is bounded or not.
    pub fn new(bounded: bool) -> ValueReader {
        ValueReader { diagnostics: Vec::new(), names: Vec::new(), bounded }
    }

    /// Reports a problem.
    pub fn diagnostic(&mut self, span: &Span, message: impl Into<String>) {
        self.diagnostics.push((span.clone(), message.into()));
    }

    /// The entries of a table; `None` if the value is not one.
    pub fn table<'v>(&mut self, what: &str, value: &'v Spanned<Value>) -> Option<&'v [Entry]> {
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

    /// A finite number within the bounds of a key.
    pub fn number(&mut self, key: &Key, value: &Spanned<Value>) -> Option<f64> {
        let bounds =
            key.range.map_or(String::new(), |[low, high]| format!(" from {} to {}", number(low), number(high)));
        let [low, high] = key.range.unwrap_or([f64::MIN, f64::MAX]);
        let found = value.value.number().filter(|number| (low..=high).contains(number));
        if found.is_none() {
            let what = if key.range.is_some() { "a number" } else { "a finite number" };
            let message = format!("`{}` must be {what}{bounds}, not {}", key.name, value.value.describe());
            self.diagnostic(&value.span, message);
        }
        found
    }

    /// A whole number from `least` to `most`.
    pub fn whole(&mut self, key: &Key, value: &Spanned<Value>, [least, most]: [i64; 2]) -> Option<i64> {
        match value.value {
            Value::Integer(number) if (least..=most).contains(&number) => Some(number),
            _ => {
                let found = value.value.describe_as_integer();
                let message = format!("`{}` must be a whole number from {least} to {most}, not {found}", key.name);
                self.diagnostic(&value.span, message);
                None
            }
        }
    }
}
