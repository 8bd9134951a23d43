//! The keys of conditions, `any` and `mask`, which several lists of tables share.

use super::document::{Condition, Quantity};
use super::kinds::{KINDS, Kind, entries, is_condition};
use crate::recipe::table::key::Key;
use crate::recipe::table::part::{OfKey, Part, described, entry};
use crate::recipe::table::reader::{Entry, Table, ValueReader};
use orogen_ops::declare::Input;
use orogen_ops::value::Spanned;
use serde_json::Value as Json;

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

/// The part of a table with the conditions of a `T`.
pub struct Where<T> {
    /// The key `mask`.
    pub mask: Key<'static>,
    pub of: fn(&mut T) -> Conditions<'_>,
}

const ANY: Key = Key::new("any", "Alternatives: the largest share of them is used.");

impl<T> Part<T> for Where<T> {
    fn keys(&self) -> Vec<&'static str> {
        [ANY.name, self.mask.name].into_iter().chain(KINDS.iter().map(|kind| kind.name)).collect()
    }

    fn schemas(&self) -> Vec<Json> {
        let conditions = KINDS.iter().map(Kind::schema);
        [described::<Vec<Vec<Condition>>>(&ANY), described::<Input>(&self.mask)].into_iter().chain(conditions).collect()
    }

    fn read(&self, table: &Table, values: &mut ValueReader, out: &mut T) {
        let conditions = (self.of)(out);
        for (key, value) in table.entries {
            if key.value == self.mask.name {
                *conditions.mask = Input::read(&self.mask, value, values).unwrap_or(Input::None);
            } else if key.value == ANY.name {
                *conditions.any = OfKey::read(&ANY, value, values).unwrap_or_default();
            } else if let Some(kind) = Kind::named(&key.value) {
                conditions.all.extend(kind.read(value, values));
            }
        }
    }

    fn write(&self, of: &mut T, out: &mut Vec<Entry>) {
        let Conditions { all, any, mask } = (self.of)(of);
        out.extend(entries(all));
        out.extend(any.write(&ANY).map(|value| entry(ANY.name, value)));
        out.extend(mask.write(&self.mask).map(|value| entry(self.mask.name, value)));
    }
}

/// Whether a key limits where an entry is.
pub fn is_limit(key: &str) -> bool {
    matches!(key, "any" | "mask") || is_condition(key)
}

/// Reports a key that limits where the first entry is: the first entry must be everywhere.
pub fn refuse_limit(values: &mut ValueReader, noun: &str, key: &Spanned<String>) {
    let message = format!("the first {noun} is everywhere and cannot have `{}`; list the base {noun} first", key.value);
    values.diagnostic(&key.span, message);
}
