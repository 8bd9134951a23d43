//! Parts of tables, and traits of the types of values.

use super::key::Key;
use super::reader::{Entry, Table, ValueReader};
use orogen_ops::declare::short;
use orogen_ops::value::{Spanned, Value};
use serde_json::{Value as Json, json};

/// The type of a key's value.
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
    /// Appends the part to the entries of a table. `of` is not changed.
    fn write(&self, of: &mut T, entries: &mut Vec<Entry>);
}

/// A key whose value is a field of a `T`.
pub struct Field<T, V> {
    pub key: Key<'static>,
    /// The field; `None` if this `T` does not have it.
    pub of: fn(&mut T) -> Option<&mut V>,
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
            if let Some((value, field)) = V::read(&self.key, value, values).zip((self.of)(out)) {
                *field = value;
            }
        }
    }

    fn write(&self, of: &mut T, entries: &mut Vec<Entry>) {
        let value = (self.of)(of).and_then(|value| value.write(&self.key));
        entries.extend(value.map(|value| entry(self.key.name, value)));
    }
}

/// An entry of a table that is written.
pub fn entry(key: &str, value: Value) -> Entry {
    (Spanned::unplaced(key.to_string()), Spanned::unplaced(value))
}

/// The schema of a key.
pub fn described<V: OfKey>(key: &Key) -> Json {
    let mut schema = V::schema(key);
    schema["description"] = json!(short(key.doc));
    schema
}
