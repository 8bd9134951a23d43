//! Tables of a TOML document that is changed in place, so that comments and order stay.

use orogen::value::Value;
use toml_edit::{DocumentMut, Item, Table, TableLike};

/// The table of this name in another one, if it is there.
pub fn table<'a>(parent: &'a mut dyn TableLike, key: &str) -> Option<&'a mut dyn TableLike> {
    parent.get_mut(key)?.as_table_like_mut()
}

/// The table of this name at the top of a document; it is made if it is missing.
pub fn top<'a>(document: &'a mut DocumentMut, key: &str) -> Option<&'a mut dyn TableLike> {
    let item = document.entry(key).or_insert_with(|| {
        let mut table = Table::new();
        // `[nodes]` need not be written: `[nodes.NAME]` says it.
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

/// A value as one of the document; `None` if it cannot be written.
pub fn value_of(value: &Value) -> Option<toml_edit::Value> {
    value.to_toml().parse().ok()
}

/// Sets a key. The comment beside a value stays.
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
