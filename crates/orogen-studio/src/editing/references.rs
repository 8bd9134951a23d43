//! The references of a recipe to nodes by name.

use orogen::node::Node;
use toml_edit::{Array, DocumentMut, Item, TableLike, Value};

/// The kind of position of a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// An input that its op requires, or a name in an expression.
    Required,
    /// An optional input, a mask, or a condition.
    Optional,
    /// An output.
    Output,
}

/// A change of a reference.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// Keeps it.
    Keep,
    /// Replaces it by another node or layer.
    Name(String),
    /// Replaces it by a number.
    Number(f64),
    /// Removes it with its key.
    Remove,
}

/// Calls a function with each reference in a document, and applies the change that it returns.
pub fn change(document: &mut DocumentMut, of: &mut dyn FnMut(Site, &str) -> Change) {
    if let Some(nodes) = document.get_mut("nodes").and_then(Item::as_table_like_mut) {
        for (_, node) in nodes.iter_mut() {
            let Some(node) = node.as_table_like_mut() else { continue };
            let spec = node.get("op").and_then(Item::as_str).and_then(Node::named).map(|node| node.spec());
            let site = |key: &str| match spec {
                _ if key == "mask" => Some(Site::Optional),
                Some(spec) => match spec.input_named(key) {
                    Some(input) if spec.inputs[input].required => Some(Site::Required),
                    Some(_) => Some(Site::Optional),
                    None if spec.named_inputs && spec.param_named(key).is_none() && key != "op" => Some(Site::Required),
                    None => None,
                },
                None => None,
            };
            change_keys(node, &site, of);
        }
    }
    if let Some(uses) = document.get_mut("use").and_then(Item::as_table_like_mut) {
        for (_, used) in uses.iter_mut() {
            let inputs =
                used.as_table_like_mut().and_then(|used| used.get_mut("inputs")).and_then(Item::as_table_like_mut);
            if let Some(inputs) = inputs {
                change_keys(inputs, &|_| Some(Site::Optional), of);
            }
        }
    }
    if let Some(outputs) = document.get_mut("outputs").and_then(Item::as_table_like_mut) {
        change_keys(outputs, &|_| Some(Site::Output), of);
    }
    for list in ["surface", "scatter", "class"] {
        match document.get_mut(list) {
            Some(Item::ArrayOfTables(tables)) => tables.iter_mut().for_each(|table| change_conditions(table, of)),
            Some(Item::Value(Value::Array(tables))) => change_items(tables, of),
            _ => {}
        }
    }
}

/// Changes the references among the values of a table's keys.
fn change_keys(
    table: &mut dyn TableLike,
    site: &dyn Fn(&str) -> Option<Site>,
    of: &mut dyn FnMut(Site, &str) -> Change,
) {
    let mut removed = Vec::new();
    for (key, item) in table.iter_mut() {
        let Some(site) = site(key.get()) else { continue };
        let Some(name) = item.as_str().map(str::to_owned) else { continue };
        let new = match of(site, &name) {
            Change::Keep => continue,
            Change::Name(name) => Value::from(name),
            Change::Number(number) => Value::from(number),
            Change::Remove => {
                removed.push(key.get().to_owned());
                continue;
            }
        };
        if let Some(old) = item.as_value_mut() {
            let decor = old.decor().clone();
            *old = new;
            *old.decor_mut() = decor;
        }
    }
    for key in removed {
        table.remove(&key);
    }
}

/// Changes the references in a table of conditions, and in the tables within it.
fn change_conditions(table: &mut dyn TableLike, of: &mut dyn FnMut(Site, &str) -> Change) {
    change_keys(table, &|key| matches!(key, "mask" | "of").then_some(Site::Optional), of);
    if let Some(layers) = table.get_mut("layers").and_then(Item::as_table_like_mut) {
        let names: Vec<String> = layers.iter().map(|(key, _)| key.to_owned()).collect();
        for name in names {
            match of(Site::Optional, &name) {
                Change::Name(new) => {
                    if let Some(item) = layers.remove(&name) {
                        layers.insert(&new, item);
                    }
                }
                Change::Remove | Change::Number(_) => {
                    layers.remove(&name);
                }
                Change::Keep => {}
            }
        }
    }
    for (_, item) in table.iter_mut() {
        match item {
            Item::Value(Value::Array(items)) => change_items(items, of),
            Item::ArrayOfTables(tables) => tables.iter_mut().for_each(|table| change_conditions(table, of)),
            other => {
                if let Some(inner) = other.as_table_like_mut() {
                    change_conditions(inner, of);
                }
            }
        }
    }
}

fn change_items(items: &mut Array, of: &mut dyn FnMut(Site, &str) -> Change) {
    for item in items.iter_mut() {
        if let Value::InlineTable(table) = item {
            change_conditions(table, of);
        }
    }
}
