//! Formulas: expressions of parameters, computed once in f64.

use super::error::ExpressionError;
use super::parse::is_taken;
use super::text::Expression;
use super::token::{Token, tokens};
use crate::value::Span;

/// What a formula begins with where a number could stand.
pub const MARK: char = '=';

/// The text of a formula, if this is one: what follows the [`MARK`].
pub fn formula(text: &str) -> Option<&str> {
    text.trim_start().strip_prefix(MARK)
}

/// The value of a formula.
///
/// # Errors
/// If it is no expression, a name in it has no value (`unknown` says why), or its value is not finite.
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
                format!("the value of this formula is {value}, which is no finite number"),
            ))
        }
    }
}

/// Where a name stands first in an expression; all of it, if it stands nowhere.
pub fn place_of(text: &str, name: &str) -> Span {
    let tokens = tokens(text).unwrap_or_default();
    tokens.into_iter().find(|(token, _)| *token == Token::Name(name)).map_or(0..text.len(), |(_, span)| span)
}

/// The same expression with other texts in place of its names; names that `of` knows nothing of stay.
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

/// Whether a name can be that of a parameter: one that an expression reads as a name of its own.
pub fn is_parameter_name(name: &str) -> bool {
    let tokens = tokens(name).unwrap_or_default();
    name.len() <= 64
        && !name.contains('.')
        && !is_taken(name)
        && matches!(tokens.as_slice(), [(Token::Name(whole), _)] if *whole == name)
}
