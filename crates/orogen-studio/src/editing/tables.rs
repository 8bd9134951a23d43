//! Tables of a TOML document that is changed in place, so that comments and order are kept.

use orogen::value::Value;
use toml_edit::{DocumentMut, Item, Table, TableLike};

/// The table with this name in another table, if it exists.
pub fn table<'a>(parent: &'a mut dyn TableLike, key: &str) -> Option<&'a mut dyn TableLike> {
    parent.get_mut(key)?.as_table_like_mut()
}

/// The top-level table with this name; it is created if it does not exist.
pub fn top<'a>(document: &'a mut DocumentMut, key: &str) -> Option<&'a mut dyn TableLike> {
    let item = document.entry(key).or_insert_with(|| {
        let mut table = Table::new();
        // `[nodes]` need not be written, because `[nodes.NAME]` implies it.
        table.set_implicit(key != "outputs" && key != "world");
        Item::Table(table)
    });
    item.as_table_like_mut()
}

/// The table of a node.
pub fn node<'a>(document: &'a mut DocumentMut, name: &str) -> Option<&'a mut dyn TableLike> {
    table(top(document, "nodes")?, name)
}

/// Adds a node with this table.
pub fn add_node(document: &mut DocumentMut, name: &str, mut own: Table) -> Result<(), String> {
    own.decor_mut().set_prefix("\n");
    let nodes = top(document, "nodes").ok_or("`nodes` is no table")?;
    match nodes.contains_key(name) {
        true => Err(format!("there is a node `{name}` already")),
        false => {
            nodes.insert(name, Item::Table(own));
            Ok(())
        }
    }
}

/// Converts a value for the document; `None` if it cannot be written.
pub fn value_of(value: &Value) -> Option<toml_edit::Value> {
    value.to_toml().parse().ok()
}

/// Sets a key. A comment after its value is kept.
pub fn set(table: &mut dyn TableLike, key: &str, mut value: toml_edit::Value) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        None => {
            table.insert(key, Item::Value(value));
        }
    }
}
