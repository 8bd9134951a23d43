//! Types of what keys of several tables have.

use super::key::{Key, OfKey};
use super::reader::ValueReader;
use orogen_io::palette::color::{Rgb, hex};
use orogen_io::palette::names;
use orogen_ops::declare::Input;
use orogen_ops::value::{Spanned, Value};
use serde_json::{Value as Json, json};

impl<V: OfKey> OfKey for Option<V> {
    fn schema(key: &Key) -> Json {
        V::schema(key)
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Option<V>> {
        V::read(key, value, values).map(Some)
    }

    fn write(&self, key: &Key) -> Option<Value> {
        self.as_ref().and_then(|value| value.write(key))
    }
}

impl OfKey for f64 {
    fn schema(key: &Key) -> Json {
        // 0 and 1 are written without a point.
        let plain = |number: f64| if number == 0.0 || number == 1.0 { json!(number as u8) } else { json!(number) };
        let mut schema = json!({ "type": "number" });
        let bounds = key.range.into_iter().flat_map(|[low, high]| [("minimum", low), ("maximum", high)]);
        for (name, number) in bounds.chain(key.stated.map(|default| ("default", default))) {
            schema[name] = plain(number);
        }
        schema
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<f64> {
        values.number(key.name, value, key.range.unwrap_or([f64::MIN, f64::MAX]))
    }

    fn write(&self, key: &Key) -> Option<Value> {
        (Some(*self) != key.omitted).then_some(Value::Number(*self))
    }
}

/// A seed.
impl OfKey for u64 {
    fn schema(_: &Key) -> Json {
        json!({ "type": "integer", "minimum": 0 })
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<u64> {
        Some(values.whole(key.name, value, i64::MAX) as u64)
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Value::Integer(*self as i64))
    }
}

/// A name.
impl OfKey for String {
    fn schema(_: &Key) -> Json {
        json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" })
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<String> {
        let is_part = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b == b'-';
        match &value.value {
            Value::Text(text) if (1..=64).contains(&text.len()) && text.bytes().all(is_part) => Some(text.clone()),
            other => {
                let (key, found) = (key.name, other.describe());
                let message = format!("`{key}` must be 1 to 64 letters, digits, `_` and `-`, not {found}");
                values.diagnostic(&value.span, message);
                None
            }
        }
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Value::Text(self.clone()))
    }
}

/// A node, a layer or a number.
impl OfKey for Input {
    fn schema(_: &Key) -> Json {
        json!({ "allOf": [{ "$ref": "#/definitions/input" }] })
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Input> {
        match (&value.value, value.value.number(), key.range) {
            (Value::Text(name), ..) => {
                values.names.push((name.clone(), value.span.clone()));
                Some(Input::Node(name.clone()))
            }
            (_, Some(_), Some(range)) => values.number(key.name, value, range).map(Input::Value),
            (_, Some(number), None) if number.is_finite() => Some(Input::Value(number)),
            (other, ..) => {
                let (key, found) = (key.name, other.describe());
                let message = format!("`{key}` must name a node or a layer, or be a number, not {found}");
                values.diagnostic(&value.span, message);
                None
            }
        }
    }

    fn write(&self, _: &Key) -> Option<Value> {
        match self {
            Input::None => None,
            Input::Node(name) => Some(Value::Text(name.clone())),
            Input::Value(number) => Some(Value::Number(*number)),
        }
    }
}

/// A color: `#rrggbb`, `#rgb` or a name.
impl OfKey for Rgb {
    fn schema(_: &Key) -> Json {
        json!({ "type": "string" })
    }

    fn read(_: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Rgb> {
        let color = match &value.value {
            Value::Text(text) => names::hexadecimal(text).or_else(|| names::named(text)),
            _ => None,
        };
        if color.is_none() {
            let found = value.value.describe();
            let message = format!("a color must be \"#rrggbb\" or a name such as \"khaki\", not {found}");
            values.diagnostic(&value.span, message);
        }
        color
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Value::Text(hex(*self).to_string()))
    }
}
