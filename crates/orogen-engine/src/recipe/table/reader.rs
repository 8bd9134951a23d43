//! Reading of values, with diagnostics at their keys.

use std::collections::HashSet;

use orogen_ops::value::{Span, Spanned, Value};

/// A key with its value.
pub type Entry = (Spanned<String>, Spanned<Value>);

/// A table of a list.
pub struct Table<'a> {
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
    /// Reads values of a recipe with such a world.
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

    /// A number within these bounds.
    pub fn number(&mut self, key: &str, value: &Spanned<Value>, [low, high]: [f64; 2]) -> Option<f64> {
        let number = value.value.number().filter(|number| (low..=high).contains(number));
        if number.is_none() {
            let message = format!("`{key}` must be a number from {low:?} to {high:?}, not {}", value.value.describe());
            self.diagnostic(&value.span, message);
        }
        number
    }

    /// A whole number from 0 to `most`.
    pub fn whole(&mut self, key: &str, value: &Spanned<Value>, most: i64) -> i64 {
        match value.value {
            Value::Integer(number) if (0..=most).contains(&number) => number,
            _ => {
                let message = format!(
                    "`{key}` must be a whole number from 0 to {most}, not {}",
                    value.value.describe_as_integer()
                );
                self.diagnostic(&value.span, message);
                1
            }
        }
    }
}
