//! Keys of tables.

use super::reader::{Table, ValueReader};
use orogen_ops::declare::short;
use orogen_ops::value::{Spanned, Value};
use serde_json::{Value as Json, json};
use std::fmt::Write as _;

/// The declaration of a key.
pub struct Key {
    pub name: &'static str,
    pub doc: &'static str,
    /// The bounds of a number.
    pub range: Option<[f64; 2]>,
    /// The default that the schema states.
    pub stated: Option<f64>,
    /// The number for which the key is left out.
    pub omitted: Option<f64>,
}

impl Key {
    /// A key without any of the facts that it may have.
    pub const fn new(name: &'static str, doc: &'static str) -> Key {
        Key { name, doc, range: None, stated: None, omitted: None }
    }
}

/// A type of what a key has.
pub trait OfKey: Sized {
    /// The schema, without a description.
    fn schema(key: &Key) -> Json;
    /// Reads the value of the key; `None` after a diagnostic.
    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Self>;
    /// The value in recipes; `None` if the key is left out.
    fn write(&self, key: &Key) -> Option<Value>;
}

/// A part of a table that makes a `T`.
pub trait Part<T>: Sync {
    /// The keys.
    fn keys(&self) -> Vec<&'static str>;
    /// The schemas of the keys.
    fn schemas(&self) -> Vec<Json>;
    /// Reads the part from a table.
    fn read(&self, table: &Table, values: &mut ValueReader, out: &mut T);
    /// Appends the part to a recipe's text. The entry stays as it is.
    fn write(&self, entry: &mut T, text: &mut String);
}

/// A key whose value is a field of a `T`.
pub struct Field<T, V> {
    pub key: Key,
    pub of: fn(&mut T) -> &mut V,
}

impl<T, V: OfKey> Part<T> for Field<T, V> {
    fn keys(&self) -> Vec<&'static str> {
        vec![self.key.name]
    }

    fn schemas(&self) -> Vec<Json> {
        vec![described::<V>(&self.key)]
    }

    fn read(&self, table: &Table, values: &mut ValueReader, out: &mut T) {
        // A key that is repeated is reported; all of its values are checked.
        for (_, value) in table.entries.iter().filter(|(key, _)| key.value == self.key.name) {
            if let Some(value) = V::read(&self.key, value, values) {
                *(self.of)(out) = value;
            }
        }
    }

    fn write(&self, entry: &mut T, text: &mut String) {
        write((self.of)(entry), &self.key, text);
    }
}

/// Appends a key to a recipe's text.
pub fn write(value: &impl OfKey, key: &Key, text: &mut String) {
    if let Some(value) = value.write(key) {
        let _ = writeln!(text, "{} = {}", key.name, value.to_toml());
    }
}

/// The schema of a key.
pub fn described<V: OfKey>(key: &Key) -> Json {
    let mut schema = V::schema(key);
    schema["description"] = json!(short(key.doc));
    schema
}
