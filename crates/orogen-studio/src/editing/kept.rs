//! What the studio keeps in a recipe, in the table `[studio]`: a list of exports, frames and reroutes of the
//! graph, and locked nodes. It has no effect on the world.

use std::collections::BTreeMap;

use orogen::recipe::Recipe;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use toml_edit::{Array, DocumentMut, InlineTable, Item, Table, Value};

use super::reroutes::{self, Reroute};

/// What is kept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Kept {
    /// Exports that are made together.
    pub exports: Vec<KeptExport>,
    /// Frames around boxes of the graph.
    pub frames: Vec<Frame>,
    /// Points through which wires of the graph run.
    #[serde(deserialize_with = "reroutes::lenient")]
    pub reroutes: Vec<Reroute>,
    /// Nodes that cannot be changed.
    pub locked: Vec<String>,
}

/// An export. Empty texts and absent numbers are defaults.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptExport {
    /// The name of its kind.
    pub kind: String,
    /// The file or folder, relative to the recipe's folder if it is in it.
    pub file: String,
    /// The layer.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub layer: String,
    /// The format or the game engine.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub format: String,
    /// Number of samples along the longer side.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<usize>,
    /// Number of tiles, east and south.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tiles: Option<[usize; 2]>,
    /// The part of the world: its center, east and south, and its side, in metres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<[f64; 3]>,
    /// Options by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, String>,
    /// Options of the layer by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub layer_options: BTreeMap<String, String>,
}

/// A frame around boxes of the graph.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Frame {
    /// Its title.
    pub title: String,
    /// The nodes in it.
    pub nodes: Vec<String>,
}

/// The key of the table.
const KEY: &str = "studio";

/// The part of a recipe with the table.
#[derive(Deserialize)]
struct Part {
    #[serde(default)]
    studio: Kept,
}

impl Kept {
    /// What a recipe's text keeps; nothing if that cannot be read.
    #[must_use]
    pub fn of(text: &str) -> Kept {
        if !text.contains(KEY) {
            return Kept::default();
        }
        toml::from_str::<Part>(text).map(|part| part.studio).unwrap_or_default()
    }

    /// Writes it into a document.
    pub(super) fn write(&self, document: &mut DocumentMut) -> Result<(), String> {
        let Ok(Json::Object(keys)) = serde_json::to_value(self) else { return Err("it cannot be written".into()) };
        let table = document.entry(KEY).or_insert_with(|| Item::Table(Table::new()));
        let table = table.as_table_like_mut().ok_or("`studio` is no table")?;
        for (key, value) in &keys {
            match value {
                Json::Array(list) if list.is_empty() => drop(table.remove(key)),
                value => drop(table.insert(key, Item::Value(lines(value)))),
            }
        }
        if table.is_empty() {
            document.remove(KEY);
        }
        Ok(())
    }

    /// It after nodes were renamed, without nodes and wires that are gone.
    #[must_use]
    pub fn after(&self, renames: &[(String, String)], recipe: &Recipe) -> Kept {
        let is_there = |name: &str| recipe.nodes().iter().any(|named| named.name == name);
        let follow = |names: &[String]| -> Vec<String> {
            let new = |name: &String| renames.iter().find(|(from, _)| from == name).map(|(_, to)| to.clone());
            let renamed = names.iter().map(|name| new(name).unwrap_or_else(|| name.clone()));
            renamed.filter(|name| is_there(name)).collect()
        };
        let frames = self.frames.iter().map(|frame| Frame { nodes: follow(&frame.nodes), ..frame.clone() });
        Kept {
            exports: self.exports.clone(),
            frames: frames.filter(|frame| !frame.nodes.is_empty()).collect(),
            reroutes: self.reroutes.iter().filter_map(|reroute| reroute.after(renames, recipe)).collect(),
            locked: follow(&self.locked),
        }
    }
}

/// A value of the document; the items of a list are on lines of their own.
fn lines(value: &Json) -> Value {
    let mut value = item(value);
    if let Value::Array(list) = &mut value {
        list.iter_mut().for_each(|item| item.decor_mut().set_prefix("\n  "));
        list.set_trailing("\n");
        list.set_trailing_comma(true);
    }
    value
}

fn item(value: &Json) -> Value {
    match value {
        Json::Bool(yes) => (*yes).into(),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => whole.into(),
            None => number.as_f64().unwrap_or_default().into(),
        },
        Json::String(text) => text.as_str().into(),
        Json::Array(list) => Value::Array(list.iter().map(item).collect::<Array>()),
        Json::Object(keys) => {
            Value::InlineTable(keys.iter().map(|(key, value)| (key.as_str(), item(value))).collect::<InlineTable>())
        }
        // Absent values are not written.
        Json::Null => "".into(),
    }
}
