//! Strokes of a brush in the text of a recipe.

use orogen::declare::Stroke;
use toml_edit::{Array, DocumentMut, Item, Table, Value};

use super::tables::{add_node, node, set, top, value_of};

/// The op that paints strokes.
pub const OP: &str = "paint";

/// The parameter with the strokes.
const STROKES: &str = "strokes";

/// How a node that is created by its first stroke is connected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Placement {
    /// No node reads it.
    Alone,
    /// It becomes the mask of this node.
    MaskOf(String),
    /// Its background is what this output read before, and the output reads the new node.
    Over(String),
}

/// Writes stroke number `at`, from 0, of a node: a new one at the end, or another form of the last one. A node that
/// does not exist is created.
pub(super) fn write(
    document: &mut DocumentMut,
    name: &str,
    placement: &Placement,
    at: usize,
    stroke: &Stroke,
) -> Result<(), String> {
    if node(document, name).is_none() {
        add(document, name, placement)?;
    }
    let own = node(document, name).ok_or_else(|| format!("the text has no node `{name}`"))?;
    if own.get("op").and_then(Item::as_str) != Some(OP) {
        return Err(format!("the node `{name}` takes no strokes; its op is not `{OP}`"));
    }
    let table = stroke.short_table();
    let Some(mut value) = value_of(&table) else { return Err(format!("a stroke cannot be {}", table.describe())) };
    match own.entry(STROKES).or_insert_with(|| Item::Value(Array::new().into())) {
        Item::Value(Value::Array(list)) if list.len() == at + 1 => drop(list.replace(at, value)),
        Item::Value(Value::Array(list)) => {
            // One line per stroke.
            value.decor_mut().set_prefix("\n  ");
            list.push_formatted(value);
            list.set_trailing("\n");
            list.set_trailing_comma(true);
        }
        Item::ArrayOfTables(list) => {
            let Value::InlineTable(inline) = value else { return Err("a stroke must be a table".into()) };
            if list.len() == at + 1 {
                list.remove(at);
            }
            list.push(inline.into_table());
        }
        _ => return Err(format!("`{STROKES}` of the node `{name}` is no list")),
    }
    Ok(())
}

fn add(document: &mut DocumentMut, name: &str, placement: &Placement) -> Result<(), String> {
    let mut own = Table::new();
    own.insert("op", toml_edit::value(OP));
    match placement {
        Placement::Alone => {}
        Placement::MaskOf(other) => {
            let other = node(document, other).ok_or_else(|| format!("the text has no node `{other}`"))?;
            set(other, "mask", name.into());
        }
        Placement::Over(output) => {
            let outputs = top(document, "outputs").ok_or("the text has no [outputs]")?;
            let before = outputs.get(output).and_then(Item::as_value).cloned();
            let mut before = before.ok_or_else(|| format!("the text has no output `{output}`"))?;
            before.decor_mut().clear();
            own.insert("background", Item::Value(before));
            set(outputs, output, name.into());
        }
    }
    add_node(document, name, own)
}
