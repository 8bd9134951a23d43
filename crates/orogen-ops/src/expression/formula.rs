//! Formulas: expressions of parameters, evaluated once in f64.

use super::error::ExpressionError;
use super::parse::is_taken;
use super::text::Expression;
use super::token::{Token, tokens};
use crate::value::Span;

/// The first character of a formula in place of a number.
pub const MARK: char = '=';

/// The expression of a formula: the text after the [`MARK`]; `None` if the text is not a formula.
#[must_use]
pub fn formula(text: &str) -> Option<&str> {
    text.trim_start().strip_prefix(MARK)
}

/// The value of a formula.
///
/// # Errors
/// If it is not an expression, a name in it has no value (`unknown` returns the reason), or its value is not finite.
pub fn value(
    text: &str,
    value_of: impl Fn(&str) -> Option<f64>,
    unknown: impl Fn(&str) -> String,
) -> Result<f64, ExpressionError> {
    let expression = Expression::from(text);
    if let Some(fault) = expression.error() {
        return Err(fault.clone());
    }
    let mut values = Vec::with_capacity(expression.names().len());
    for name in expression.names() {
        match value_of(name) {
            Some(value) => values.push(value),
            None => return Err(ExpressionError::new(place_of(text, name), unknown(name))),
        }
    }
    match expression.value(&values) {
        Some(value) if value.is_finite() => Ok(value),
        value => {
            let value = value.unwrap_or(f64::NAN);
            Err(ExpressionError::new(
                0..text.len(),
                format!("the value of this formula is {value}, which is not finite"),
            ))
        }
    }
}

/// The first position of a name in an expression; the whole text if there is none.
#[must_use]
pub fn place_of(text: &str, name: &str) -> Span {
    let tokens = tokens(text).unwrap_or_default();
    tokens.into_iter().find(|(token, _)| *token == Token::Name(name)).map_or(0..text.len(), |(_, span)| span)
}

/// The expression with its names replaced; names for which `of` returns `None` do not change.
pub fn renamed(text: &str, of: impl Fn(&str) -> Option<String>) -> String {
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for (token, span) in tokens(text).unwrap_or_default() {
        if let Token::Name(name) = token
            && !is_taken(name)
            && let Some(other) = of(name)
        {
            out.push_str(&text[at..span.start]);
            out.push_str(&other);
            at = span.end;
        }
    }
    out.push_str(&text[at..]);
    out
}

/// Whether a name is valid for a parameter: an expression must parse it as a name.
#[must_use]
pub fn is_parameter_name(name: &str) -> bool {
    let tokens = tokens(name).unwrap_or_default();
    name.len() <= 64
        && !name.contains('.')
        && !is_taken(name)
        && matches!(tokens.as_slice(), [(Token::Name(whole), _)] if *whole == name)
}
