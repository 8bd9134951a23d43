//! Serialization of recipes with `serde`, as part of other programs' documents. The keys are the same as in recipe
//! files.

use std::fmt;

use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde::ser::{self, Serializer};
use serde::{Deserialize, Serialize};

use super::document::Recipe;
use super::text::Text;
use super::toml;
use orogen_grid::error::{Diagnostic, Error};
use orogen_ops::value::{Spanned, Value, toml_key};

/// The name in messages of a recipe that is not in a file.
const NAME: &str = "the recipe";

/// Maximum nesting. A recipe needs four levels; the limit protects the stack during recursion.
const DEEPEST: usize = 64;

/// Serializes the document that [`Recipe::to_toml`] writes: the same keys in the same order, with all defaults.
/// Deserializing it gives an equal recipe. Nodes that compute its surfaces are not included; opening a world adds them
/// again.
impl Serialize for Recipe {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let text = self.to_toml();
        let tree = toml::read(&Text { name: NAME, text: &text }).map_err(ser::Error::custom)?;
        Tree(&tree.value).serialize(serializer)
    }
}

/// Deserializes the keys of a recipe file, with the same checks as [`Recipe::parse`]. An error has all diagnostics,
/// each after its key (`nodes.hills.radius: ...`).
///
/// The format must be self-describing, as JSON and TOML are. Nodes are in the order in which the format provides keys.
/// Relative paths start at the folder set with [`Recipe::set_base_dir`].
impl<'de> Deserialize<'de> for Recipe {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Recipe, D::Error> {
        let Value::Table(entries) = deserializer.deserialize_map(Reader { depth: 0 })? else {
            return Err(de::Error::custom("a recipe must be a table of keys"));
        };
        let mut lines = Lines::default();
        // Line 1 is empty: problems of no particular key are reported at the start of a text.
        lines.push("", "");
        lines.table("", "", &entries);
        Recipe::parse(&lines.text, NAME).map_err(|error| de::Error::custom(lines.keyed(&error)))
    }
}

/// A value to write.
struct Tree<'a>(&'a Value);

impl Serialize for Tree<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Value::Flag(flag) => serializer.serialize_bool(*flag),
            Value::Integer(integer) => serializer.serialize_i64(*integer),
            Value::Number(number) => serializer.serialize_f64(*number),
            Value::Text(text) => serializer.serialize_str(text),
            Value::List(items) => serializer.collect_seq(items.iter().map(|item| Tree(&item.value))),
            Value::Table(entries) => {
                serializer.collect_map(entries.iter().map(|(key, value)| (&key.value, Tree(&value.value))))
            }
            Value::Other(what) => Err(ser::Error::custom(format!("a recipe cannot hold {what}"))),
        }
    }
}

/// Reads any value of a self-describing format.
#[derive(Clone, Copy)]
struct Reader {
    depth: usize,
}

impl Reader {
    /// The reader of the values in a list or table.
    fn within<E: de::Error>(self) -> Result<Reader, E> {
        match self.depth < DEEPEST {
            true => Ok(Reader { depth: self.depth + 1 }),
            false => Err(E::custom(format!("the recipe is nested more than {DEEPEST} levels deep"))),
        }
    }
}

impl<'de> DeserializeSeed<'de> for Reader {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Reader {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(if self.depth == 0 { "a recipe" } else { "a number, a string, true, false, a list or a table" })
    }

    fn visit_bool<E: de::Error>(self, flag: bool) -> Result<Value, E> {
        Ok(Value::Flag(flag))
    }

    fn visit_i64<E: de::Error>(self, integer: i64) -> Result<Value, E> {
        Ok(Value::Integer(integer))
    }

    fn visit_u64<E: de::Error>(self, integer: u64) -> Result<Value, E> {
        Ok(i64::try_from(integer).map_or(Value::Number(integer as f64), Value::Integer))
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Value, E> {
        Ok(Value::Number(number))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Value, E> {
        Ok(Value::Text(text.to_string()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let reader = self.within()?;
        let mut list = Vec::new();
        while let Some(item) = items.next_element_seed(reader)? {
            list.push(Spanned::unplaced(item));
        }
        Ok(Value::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let reader = self.within()?;
        let mut table = Vec::new();
        while let Some(key) = entries.next_key::<String>()? {
            let value = entries.next_value_seed(reader)?;
            table.push((Spanned::unplaced(key), Spanned::unplaced(value)));
        }
        Ok(Value::Table(table))
    }
}

/// A recipe's text that is written only to be parsed, with the key of each line.
#[derive(Default)]
struct Lines {
    text: String,
    keys: Vec<String>,
}

impl Lines {
    fn push(&mut self, key: &str, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
        self.keys.push(key.to_string());
    }

    /// Writes the entries of a table that is called `name` in TOML and `key` in messages. Entries of one line come
    /// first, as TOML requires.
    fn table(&mut self, name: &str, key: &str, entries: &[(Spanned<String>, Spanned<Value>)]) {
        let joined = |parent: &str, name: &str| match parent {
            "" => name.to_string(),
            parent => format!("{parent}.{name}"),
        };
        let (blocks, lines): (Vec<_>, Vec<_>) = entries.iter().partition(|(_, value)| is_block(&value.value));
        for (entry, value) in lines {
            let line = format!("{} = {}", toml_key(&entry.value), value.value.to_toml());
            self.push(&joined(key, &entry.value), &line);
        }
        for (entry, value) in blocks {
            let (name, key) = (joined(name, &toml_key(&entry.value)), joined(key, &entry.value));
            match &value.value {
                Value::Table(entries) => {
                    self.push(&key, &format!("[{name}]"));
                    self.table(&name, &key, entries);
                }
                Value::List(items) => {
                    for (at, item) in items.iter().enumerate() {
                        if let Value::Table(entries) = &item.value {
                            let key = format!("{key}[{at}]");
                            self.push(&key, &format!("[[{name}]]"));
                            self.table(&name, &key, entries);
                        }
                    }
                }
                _ => {}
            }
        }
    }

    /// The error with keys in place of line numbers, because the user did not write these lines.
    fn keyed(&self, error: &Error) -> Error {
        let keyed = |diagnostic: &Diagnostic| {
            let Some(place) = diagnostic.place.as_ref().filter(|place| place.file == NAME) else {
                return diagnostic.clone();
            };
            let message = match self.keys.get(place.line - 1).map_or("", String::as_str) {
                "" => diagnostic.message.clone(),
                key => format!("{key}: {}", diagnostic.message),
            };
            Diagnostic::new(message)
        };
        Error::from_diagnostics(error.kind(), error.diagnostics().iter().map(keyed).collect())
    }
}

/// Whether a value is written as tables of several lines.
fn is_block(value: &Value) -> bool {
    match value {
        Value::Table(_) => true,
        Value::List(items) => !items.is_empty() && items.iter().all(|item| matches!(item.value, Value::Table(_))),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::presets;
    use crate::Recipe;

    fn message(document: serde_json::Value) -> String {
        serde_json::from_str::<Recipe>(&document.to_string()).unwrap_err().to_string()
    }

    #[test]
    fn presets_are_read_as_they_were_written() {
        for preset in presets::all() {
            let recipe = preset.recipe().unwrap();
            let text = serde_json::to_string(&recipe).unwrap();
            assert_eq!(serde_json::from_str::<Recipe>(&text).unwrap(), recipe, "{}", preset.name);
            // The text gives the same document, and the document the same text.
            assert_eq!(Recipe::parse(&text, "text").unwrap(), recipe, "{}", preset.name);
            assert_eq!(serde_json::from_str::<Recipe>(&text).unwrap().to_toml(), recipe.to_toml(), "{}", preset.name);
        }
    }

    #[test]
    fn the_keys_are_those_of_the_file() {
        let text = "orogen = 1\n[world]\nseed = 3\n[nodes.hills]\nop = \"fbm\"\n[outputs]\nheight = \"hills\"\n";
        let recipe = Recipe::parse(text, "text").unwrap();
        let document = serde_json::to_value(&recipe).unwrap();
        assert_eq!(document["orogen"], json!(1));
        assert_eq!(document["world"]["seed"], json!(3));
        assert_eq!(document["nodes"]["hills"]["op"], json!("fbm"));
        assert_eq!(document["outputs"], json!({ "height": "hills" }));
        assert_eq!(::toml::from_str::<Recipe>(text).unwrap(), recipe);
    }

    #[test]
    fn recipes_in_documents_pass_the_same_checks() {
        let wrong = json!({
            "orogen": 1,
            "world": { "cell": -1.0 },
            "nodes": { "hills": { "op": "fbm", "octaves": "many" }, "low": { "op": "blurr", "source": "hills" } },
            "outputs": { "height": "hills" },
        });
        let from_text = Recipe::parse(&wrong.to_string(), "text").unwrap_err();
        let message = message(wrong);
        let lines: Vec<&str> = message.lines().collect();
        assert_eq!(lines.len(), from_text.diagnostics().len(), "{message}");
        for diagnostic in from_text.diagnostics() {
            assert!(
                lines.iter().any(|line| line.ends_with(&diagnostic.message)),
                "{message}\nlacks {}",
                diagnostic.message
            );
        }
        for key in ["world.cell: ", "nodes.hills.octaves: ", "nodes.low.op: "] {
            assert!(lines.iter().any(|line| line.starts_with(key)), "{message}\nlacks {key}");
        }
    }

    #[test]
    fn what_is_no_recipe() {
        assert!(message(json!([1, 2])).contains("expected a recipe"));
        assert!(message(json!({})).contains("the recipe is empty"), "{}", message(json!({})));
        assert!(message(json!({ "orogen": 1, "about": null })).contains("expected a number, a string"));
        let none = message(json!({ "orogen": 1, "nodes": { "a": { "op": "fbm" } } }));
        assert!(none.starts_with("the recipe has no outputs"), "{none}");
        let deep = (0..100).fold(json!(1), |inner, _| json!([inner]));
        assert!(message(json!({ "about": deep })).contains("nested more than 64 levels"));
    }

    #[test]
    fn lists_of_tables_are_named_by_their_place() {
        let nodes = json!({ "hills": { "op": "fbm" } });
        let surface = json!([{ "name": "rock", "color": "#808080" }, { "name": "grass", "color": 7 }]);
        let wrong = json!({ "orogen": 1, "nodes": nodes, "outputs": { "height": "hills" }, "surface": surface });
        let message = message(wrong);
        assert!(message.starts_with("surface[1].color: "), "{message}");
    }
}
