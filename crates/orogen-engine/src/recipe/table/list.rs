//! Lists of tables.

use super::keys::Keys;
use super::reader::{Table, ValueReader};
use orogen_ops::value::{Span, Spanned, Value};
use serde_json::{Value as Json, json};

/// The declaration of a list of tables.
pub struct List<T: 'static> {
    /// The key of the list.
    pub key: &'static str,
    pub doc: &'static str,
    /// The names in messages of one table and of several.
    pub names: [&'static str; 2],
    /// Minimum and maximum number of tables.
    pub count: [usize; 2],
    /// The keys of a table.
    pub keys: Keys<'static, T>,
    /// Reads a table, with [`List::keys`], after the entries before it.
    pub entry: fn(&Table, &mut ValueReader, &[(T, Span)]) -> T,
}

impl<T: Clone> List<T> {
    /// Reads the list: its entries with the positions of their tables.
    pub fn read(&self, value: &Spanned<Value>, values: &mut ValueReader) -> Vec<(T, Span)> {
        let (key, [least, most]) = (self.key, self.count);
        let problem = match &value.value {
            Value::List(items) if items.len() < least => {
                format!("`{key}` needs at least one entry; add a table `[[{key}]]` with a `name`")
            }
            Value::List(items) if items.len() > most => {
                format!("there are {} {}; a recipe has at most {most}", items.len(), self.names[1])
            }
            Value::List(items) => {
                let mut out: Vec<(T, Span)> = Vec::new();
                for item in items {
                    let Some(entries) = values.table(self.names[0], item) else { continue };
                    let table = Table { name: self.names[0], span: &item.span, entries };
                    let entry = (self.entry)(&table, values, &out);
                    out.push((entry, item.span.clone()));
                }
                return out;
            }
            other => format!("`{key}` must be a list of tables, `[[{key}]]`, not {}", other.describe()),
        };
        values.diagnostic(&value.span, problem);
        Vec::new()
    }

    /// Appends an entry to a recipe's text.
    pub fn write(&self, entry: &T, text: &mut String) {
        self.keys.write(&format!("[[{}]]", self.key), entry, text);
    }

    /// The schema of the list.
    pub fn schema(&self) -> Json {
        let [least, most] = self.count;
        let mut schema =
            json!({ "type": "array", "maxItems": most, "description": self.doc, "items": self.keys.schema() });
        if least > 0 {
            schema["minItems"] = json!(least);
        }
        schema
    }
}
