//! The keys of conditions, `any` and `mask`, which tables of several lists have.

use super::document::{Condition, Quantity, entries};
use super::read::CONDITIONS;
use super::schema::{any, conditions};
use crate::recipe::table::key::{Key, OfKey, Part, described, write};
use crate::recipe::table::reader::{Table, ValueReader};
use orogen_ops::declare::Input;
use orogen_ops::value::Spanned;
use serde_json::Value as Json;
use std::fmt::Write as _;

/// The conditions of an entry.
pub struct Conditions<'t> {
    pub all: &'t mut Vec<Condition>,
    pub any: &'t mut Vec<Vec<Condition>>,
    pub mask: &'t mut Input,
}

impl Conditions<'_> {
    /// Renames the nodes and layers that they read.
    pub fn rename_inputs(self, of: &impl Fn(&str) -> Option<Input>) {
        rename_input(self.mask, of);
        for condition in self.all.iter_mut().chain(self.any.iter_mut().flatten()) {
            if let Quantity::Layer(layer) = &mut condition.of {
                rename_layer(layer, of);
            }
        }
    }
}

/// Renames the node of an input.
pub fn rename_input(input: &mut Input, of: &impl Fn(&str) -> Option<Input>) {
    if let Input::Node(name) = input
        && let Some(other) = of(name)
    {
        *input = other;
    }
}

/// Renames a node or layer that cannot become a number.
pub fn rename_layer(layer: &mut String, of: &impl Fn(&str) -> Option<Input>) {
    if let Some(Input::Node(name)) = of(layer) {
        *layer = name;
    }
}

/// The part of a table that has the conditions of a `T`.
pub struct Where<T> {
    /// The key `mask`.
    pub mask: Key,
    pub of: fn(&mut T) -> Conditions<'_>,
}

impl<T> Part<T> for Where<T> {
    fn keys(&self) -> Vec<&'static str> {
        ["any", "mask"].into_iter().chain(CONDITIONS).collect()
    }

    fn schemas(&self) -> Vec<Json> {
        [any(), described::<Input>(&self.mask)].into_iter().chain(conditions()).collect()
    }

    fn read(&self, table: &Table, values: &mut ValueReader, out: &mut T) {
        let conditions = (self.of)(out);
        for (key, value) in table.entries {
            match key.value.as_str() {
                "mask" => *conditions.mask = Input::read(&self.mask, value, values).unwrap_or(Input::None),
                "any" => *conditions.any = values.alternatives(value),
                key if CONDITIONS.contains(&key) => conditions.all.extend(values.condition(key, value)),
                _ => {}
            }
        }
    }

    fn write(&self, entry: &mut T, text: &mut String) {
        let Conditions { all, any, mask } = (self.of)(entry);
        for entry in entries(all) {
            let _ = writeln!(text, "{entry}");
        }
        if !any.is_empty() {
            text.push_str("any = [\n");
            for alternative in any {
                let _ = writeln!(text, "  {{ {} }},", entries(alternative).join(", "));
            }
            text.push_str("]\n");
        }
        write(mask, &self.mask, text);
    }
}

/// Whether a key limits where an entry is.
pub fn is_limit(key: &str) -> bool {
    matches!(key, "any" | "mask") || CONDITIONS.contains(&key)
}

/// Reports a key of the first table that limits where it is.
pub fn refuse_limit(values: &mut ValueReader, noun: &str, key: &Spanned<String>) {
    let message = format!("the first {noun} is everywhere and cannot have `{}`; list the base {noun} first", key.value);
    values.diagnostic(&key.span, message);
}
