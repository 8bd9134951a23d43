//! A tree of values with their positions in a text.

use std::ops::Range;

/// A range of byte offsets in the text.
pub type Span = Range<usize>;

/// A value and its position in the text. Values made in code have an empty span.
#[derive(Debug, Clone, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its position.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value without a position.
    pub fn unplaced(value: T) -> Spanned<T> {
        Spanned { value, span: 0..0 }
    }
}

/// The common data model of TOML and JSON.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A boolean.
    Flag(bool),
    /// An integer.
    Integer(i64),
    /// A floating-point number.
    Number(f64),
    /// A string.
    Text(String),
    /// An array.
    List(Vec<Spanned<Value>>),
    /// Keys and values, in the order of the text.
    Table(Vec<(Spanned<String>, Spanned<Value>)>),
    /// A kind that recipes do not use (a date, a null), by its name.
    Other(&'static str),
}

impl Value {
    /// The description in messages: "the string `abc`", "a table".
    #[must_use]
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

    /// The description of a value where only an integer is valid: a float without a fraction keeps its point.
    #[must_use]
    pub fn describe_as_integer(&self) -> String {
        match self {
            Value::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => {
                format!("{number:.1}, which is not written as a whole number")
            }
            other => other.describe(),
        }
    }

    /// The value as a number; includes integers.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Integer(integer) => Some(*integer as f64),
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The value in TOML, on one line.
    #[must_use]
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

    /// The value in TOML, with a line for each table of a list of tables.
    #[must_use]
    pub fn to_toml_lines(&self) -> String {
        match self {
            Value::List(items)
                if !items.is_empty() && items.iter().all(|item| matches!(item.value, Value::Table(_))) =>
            {
                let lines: String = items.iter().map(|item| format!("  {},\n", item.value.to_toml())).collect();
                format!("[\n{lines}]")
            }
            _ => self.to_toml(),
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
        // Debug prints the shortest form that parses to the same number, with a point or an exponent, as TOML requires.
        format!("{number:?}")
    }
}

/// A TOML basic string.
#[must_use]
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

/// A TOML key, quoted only if necessary.
#[must_use]
pub fn toml_key(key: &str) -> String {
    let bare = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if bare { key.to_string() } else { toml_string(key) }
}
