//! Types of values that several tables use.

use super::key::Key;
use super::part::{OfKey, entry};
use super::reader::ValueReader;
use orogen_io::palette::color::{Rgb, hex};
use orogen_io::palette::names;
use orogen_ops::declare::{Input, Param};
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
        let is_whole = |number: f64| number.fract() == 0.0 && number.abs() < 1e15;
        let plain = |number: f64| if is_whole(number) { json!(number as i64) } else { json!(number) };
        let mut schema = json!({ "type": "number" });
        let bounds = key.range.into_iter().flat_map(|[low, high]| [("minimum", low), ("maximum", high)]);
        let stated = key.stated.map(|default| ("default", default));
        for (name, number) in bounds.chain(stated).filter(|(_, number)| number.is_finite()) {
            schema[name] = plain(number);
        }
        schema
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<f64> {
        values.number(key, value)
    }

    fn write(&self, key: &Key) -> Option<Value> {
        (Some(*self) != key.omitted).then_some(Value::Number(*self))
    }
}

/// A seed.
impl OfKey for u64 {
    fn schema(key: &Key) -> Json {
        u32::schema(&Key { range: Some([0.0, f64::INFINITY]), ..*key })
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<u64> {
        values.whole(key, value, [0, i64::MAX]).map(|seed| seed as u64)
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Value::Integer(*self as i64))
    }
}

/// A whole number.
impl OfKey for u32 {
    fn schema(key: &Key) -> Json {
        let mut schema = f64::schema(key);
        schema["type"] = json!("integer");
        schema
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<u32> {
        let [least, most] = key.range.unwrap_or([0.0, f64::from(u32::MAX)]);
        values.whole(key, value, [least as i64, most as i64]).map(|number| number as u32)
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Value::Integer(i64::from(*self)))
    }
}

/// Two numbers, or one number for both.
impl OfKey for [f64; 2] {
    fn schema(key: &Key) -> Json {
        let one = f64::schema(key);
        let two = json!({ "type": "array", "minItems": 2, "maxItems": 2, "items": one });
        if key.single.is_some() { json!({ "anyOf": [one, two] }) } else { two }
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<[f64; 2]> {
        let (name, pair) = (key.name, key.pair.unwrap_or("[A, B]"));
        let (first, second) = match &value.value {
            Value::List(items) if items.len() == 2 => (&items[0], &items[1]),
            one if one.number().is_some() && key.single.is_some() => (value, value),
            other => {
                let one = if key.single.is_some() { "one number or " } else { "" };
                let found = other.describe();
                values.diagnostic(&value.span, format!("`{name}` must be {one}two numbers {pair}, not {found}"));
                return None;
            }
        };
        let [first, second] = [first, second].map(|value| values.number(key, value));
        let (first, second) = (first?, second?);
        if key.ascending.is_some() && first > second {
            values.diagnostic(&value.span, format!("the first number of `{name}` must not be greater than the second"));
            return None;
        }
        Some([first, second])
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Param::write(self))
    }
}

/// A name, or any text if the key allows it; an empty text is left out.
impl OfKey for String {
    fn schema(key: &Key) -> Json {
        match key.text {
            Some(_) => json!({ "type": "string" }),
            None => json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" }),
        }
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<String> {
        let is_part = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b == b'-';
        let expected = match (&value.value, key.text) {
            (Value::Text(text), Some(_)) => return Some(text.clone()),
            (Value::Text(text), None) if (1..=64).contains(&text.len()) && text.bytes().all(is_part) => {
                return Some(text.clone());
            }
            (_, Some(_)) => "a string",
            (_, None) => "1 to 64 letters, digits, `_` and `-`",
        };
        let message = format!("`{}` must be {expected}, not {}", key.name, value.value.describe());
        values.diagnostic(&value.span, message);
        None
    }

    fn write(&self, key: &Key) -> Option<Value> {
        (key.text.is_none() || !self.is_empty()).then(|| Value::Text(self.clone()))
    }
}

/// A table of values by arbitrary names.
impl<V: OfKey> OfKey for Vec<(Spanned<String>, V)> {
    fn schema(key: &Key) -> Json {
        json!({ "type": "object", "additionalProperties": V::schema(key) })
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Self> {
        let entries = values.table(&format!("`{}`", key.name), value)?;
        let of = |name: &Spanned<String>, value: &Spanned<Value>, values: &mut ValueReader| {
            V::read(&Key { name: &name.value, ..*key }, value, values)
        };
        Some(entries.iter().filter_map(|(name, value)| Some((name.clone(), of(name, value, values)?))).collect())
    }

    fn write(&self, key: &Key) -> Option<Value> {
        let entries = self.iter().filter_map(|(name, value)| Some(entry(&name.value, value.write(key)?)));
        Some(Value::Table(entries.collect()))
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
            (_, Some(_), Some(_)) => values.number(key, value).map(Input::Value),
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
