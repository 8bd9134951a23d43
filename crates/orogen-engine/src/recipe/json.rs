//! Parsing of JSON to a tree of values.

use super::text::Text;
use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use orogen_grid::error::Result;
use orogen_ops::value::{Span, Spanned, Value};

/// Maximum nesting. A recipe needs four levels; the limit protects recursive parsers.
const DEEPEST: usize = 64;

/// Parses the whole text; the error is the first syntax error.
pub fn read(text: &Text) -> Result<Spanned<Value>> {
    if let Some(at) = too_deep(text.text) {
        return Err(text.error(&(at..at + 1), format!("the JSON is nested more than {DEEPEST} levels deep")));
    }
    // Strict JSON: comments or loose strings would hide brackets from the check above.
    let options = ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    match parse_to_ast(text.text, &CollectOptions::default(), &options) {
        Ok(result) => match result.value {
            Some(value) => Ok(convert(&value)),
            None => Err(text.error(&(0..0), "the recipe is empty")),
        },
        Err(diagnostic) => {
            let range = diagnostic.range();
            Err(text.error(&(range.start..range.end), format!("this is not JSON: {}", diagnostic.kind())))
        }
    }
}

/// The position where nesting exceeds the limit, outside strings and comments.
fn too_deep(text: &str) -> Option<usize> {
    let (mut depth, mut in_string, mut escaped) = (0usize, false, false);
    for (at, byte) in text.bytes().enumerate() {
        if in_string {
            match byte {
                _ if escaped => escaped = false,
                b'\\' => escaped = true,
                b'"' => in_string = false,
                _ => {}
            }
            continue;
        }
        match byte {
            b'"' => in_string = true,
            b'{' | b'[' => {
                depth += 1;
                if depth > DEEPEST {
                    return Some(at);
                }
            }
            b'}' | b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    None
}

fn span(node: &impl Ranged) -> Span {
    let range = node.range();
    range.start..range.end
}

fn convert(value: &ast::Value) -> Spanned<Value> {
    let converted = match value {
        ast::Value::StringLit(text) => Value::Text(text.value.to_string()),
        ast::Value::NumberLit(number) => number_value(number.value),
        ast::Value::BooleanLit(flag) => Value::Flag(flag.value),
        ast::Value::NullKeyword(_) => Value::Other("null"),
        ast::Value::Array(items) => Value::List(items.elements.iter().map(convert).collect()),
        ast::Value::Object(object) => Value::Table(
            object
                .properties
                .iter()
                .map(|property| {
                    let (name, at) = match &property.name {
                        ast::ObjectPropName::String(text) => (text.value.to_string(), span(text)),
                        ast::ObjectPropName::Word(word) => (word.value.to_string(), span(word)),
                    };
                    (Spanned { value: name, span: at }, convert(&property.value))
                })
                .collect(),
        ),
    };
    Spanned { value: converted, span: span(value) }
}

/// A number without a fraction as an integer. Beyond 2^53 the text is not exact; zero may have a sign.
fn whole(number: f64) -> Option<i64> {
    let is_whole = number.fract() == 0.0 && number.abs() <= (1u64 << 53) as f64;
    (is_whole && !(number == 0.0 && number.is_sign_negative())).then_some(number as i64)
}

fn number_value(text: &str) -> Value {
    match (text.parse::<i64>(), text.parse::<f64>()) {
        (Ok(integer), _) => Value::Integer(integer),
        // JSON has one kind of number: `1.0` and `1e0` are the integer 1, and programs write them.
        (_, Ok(number)) => whole(number).map_or(Value::Number(number), Value::Integer),
        _ => Value::Other("an invalid number"),
    }
}
