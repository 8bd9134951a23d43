//! The tree a recipe's text is read into: values that remember where they stood.

use std::ops::Range;

/// Bytes of the text, from its start.
pub type Span = Range<usize>;

/// A value and where it stood in the text. What was made by a program has an empty span.
#[derive(Debug, Clone, PartialEq)]
pub struct Spanned<T> {
    /// What was read.
    pub value: T,
    /// Where.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value that stands in no text.
    pub fn unplaced(value: T) -> Spanned<T> {
        Spanned { value, span: 0..0 }
    }
}

/// What TOML and JSON have in common.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// true or false.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// Any other number.
    Number(f64),
    /// A string.
    Text(String),
    /// Values in order.
    List(Vec<Spanned<Value>>),
    /// Keys with their values, in the order of the text.
    Table(Vec<(Spanned<String>, Spanned<Value>)>),
    /// What recipes have no use for (a date, a null), by its name.
    Other(&'static str),
}

impl Value {
    /// The value as a message names it: "the string `abc`", "a table".
    pub fn describe(&self) -> String {
        match self {
            Value::Flag(flag) => format!("{flag}"),
            Value::Integer(integer) => format!("{integer}"),
            Value::Number(number) if number.is_nan() => "nan".to_string(),
            Value::Number(number) => format!("{number}"),
            Value::Text(text) if text.chars().count() > 40 => {
                format!("the string \"{}...\"", text.chars().take(37).collect::<String>())
            }
            Value::Text(text) => format!("the string {text:?}"),
            Value::List(items) if items.len() <= 4 && items.iter().all(|item| item.value.number().is_some()) => {
                self.to_toml()
            }
            Value::List(items) => format!("a list of {}", items.len()),
            Value::Table(_) => "a table".to_string(),
            Value::Other(name) => (*name).to_string(),
        }
    }

    /// The value as a number, whole numbers included.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Integer(integer) => Some(*integer as f64),
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The value in TOML, on one line.
    pub fn to_toml(&self) -> String {
        match self {
            Value::Flag(flag) => flag.to_string(),
            Value::Integer(integer) => integer.to_string(),
            Value::Number(number) => toml_number(*number),
            Value::Text(text) => toml_string(text),
            Value::List(items) => {
                let items: Vec<String> = items.iter().map(|item| item.value.to_toml()).collect();
                format!("[{}]", items.join(", "))
            }
            Value::Table(entries) => {
                let entries: Vec<String> = entries
                    .iter()
                    .map(|(key, item)| format!("{} = {}", toml_key(&key.value), item.value.to_toml()))
                    .collect();
                format!("{{ {} }}", entries.join(", "))
            }
            Value::Other(name) => toml_string(name),
        }
    }
}

/// The shortest TOML number that reads back as the same f64.
fn toml_number(number: f64) -> String {
    if number.is_nan() {
        "nan".to_string()
    } else if number.is_infinite() {
        if number > 0.0 { "inf".to_string() } else { "-inf".to_string() }
    } else {
        // Debug prints the shortest form that reads back, with a point or an exponent, as TOML asks.
        format!("{number:?}")
    }
}

/// A TOML basic string.
pub fn toml_string(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", c as u32)),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// A TOML key, quoted only where it must be.
pub fn toml_key(key: &str) -> String {
    let bare = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare { key.to_string() } else { toml_string(key) }
}
