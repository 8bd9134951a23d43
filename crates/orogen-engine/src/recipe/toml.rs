//! Parsing of TOML to a tree of values.

use super::text::Text;
use orogen_grid::error::Result;
use orogen_ops::value::{Spanned, Value};
use toml::de::{DeTable, DeValue};

/// Parses the whole text; the error is the first syntax error.
pub fn read(text: &Text) -> Result<Spanned<Value>> {
    match DeTable::parse(text.text) {
        Ok(table) => {
            let span = table.span();
            Ok(Spanned { value: convert_table(table.into_inner()), span })
        }
        Err(diagnostic) => {
            let span = diagnostic.span().unwrap_or(0..0);
            Err(text.error(&span, format!("this is not TOML: {}", diagnostic.message().replace('\n', ", "))))
        }
    }
}

fn convert_table(table: DeTable) -> Value {
    let mut entries: Vec<(Spanned<String>, Spanned<Value>)> = table
        .into_iter()
        .map(|(key, value)| {
            let (key_span, span) = (key.span(), value.span());
            let key = Spanned { value: key.into_inner().into_owned(), span: key_span };
            (key, Spanned { value: convert(value.into_inner()), span })
        })
        .collect();
    // The parser returns tables sorted by name; this restores the order of the text.
    entries.sort_by_key(|(key, _)| key.span.start);
    Value::Table(entries)
}

/// Recursion is bounded by the parser, which rejects deep nesting.
fn convert(value: DeValue) -> Value {
    match value {
        DeValue::Boolean(flag) => Value::Flag(flag),
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(value) => Value::Integer(value),
            Err(_) => Value::Other("a whole number beyond 64 bits"),
        },
        DeValue::Float(float) => float.as_str().parse().map_or(Value::Other("an invalid number"), Value::Number),
        DeValue::Datetime(_) => Value::Other("a date"),
        DeValue::Array(items) => Value::List(
            items
                .into_iter()
                .map(|item| {
                    let span = item.span();
                    Spanned { value: convert(item.into_inner()), span }
                })
                .collect(),
        ),
        DeValue::Table(table) => convert_table(table),
    }
}
