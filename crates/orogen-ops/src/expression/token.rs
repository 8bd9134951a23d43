//! The tokenizer: tokens with their positions.

use super::error::ExpressionError;
use crate::value::Span;

/// A token.
#[derive(Debug, Clone, PartialEq)]
pub enum Token<'t> {
    /// A number.
    Number(f64),
    /// A name: of a function, a constant, an input or a parameter; `node.layer` is one name.
    Name(&'t str),
    /// An operator, a comma or a parenthesis.
    Sign(&'static str),
}

/// Longer symbols first.
const SIGNS: [&str; 15] = ["<=", ">=", "==", "!=", "+", "-", "*", "/", "^", "%", "<", ">", "(", ")", ","];

/// Symbols of other languages, each with the symbol to use instead.
const FOREIGN: [(&str, &str); 7] = [
    ("**", "powers are written `a ^ b`"),
    ("&&", "write `a * b`: comparisons are 1 or 0"),
    ("||", "write `max(a, b)`: comparisons are 1 or 0"),
    ("?", "write `mix(a, b, condition)`: comparisons are 1 or 0"),
    ("=", "an expression has a value and assigns none; equality is `==`"),
    ("!", "write `1 - a`: comparisons are 1 or 0"),
    ("[", "parentheses are round"),
];

/// The tokens of a text.
pub fn tokens(text: &str) -> Result<Vec<(Token<'_>, Span)>, ExpressionError> {
    let bytes = text.as_bytes();
    let (mut tokens, mut at) = (Vec::new(), 0);
    while let Some(&byte) = bytes.get(at) {
        let end = match byte {
            b' ' | b'\t' | b'\n' | b'\r' => {
                at += 1;
                continue;
            }
            b'0'..=b'9' | b'.' => number_end(bytes, at),
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => name_end(bytes, at),
            _ => at,
        };
        let token = if end == at {
            let rest = &text[at..];
            if let Some((sign, why)) = FOREIGN
                .iter()
                .find(|(sign, _)| rest.starts_with(sign) && !rest.starts_with("==") && !rest.starts_with("!="))
            {
                return Err(ExpressionError::new(at..at + sign.len(), format!("unknown symbol `{sign}`: {why}")));
            }
            let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) else {
                let found = rest.chars().next().unwrap_or(' ');
                return Err(ExpressionError::new(
                    at..at + found.len_utf8(),
                    format!("unknown symbol `{}`", found.escape_debug()),
                ));
            };
            (Token::Sign(sign), at..at + sign.len())
        } else if byte.is_ascii_digit() || byte == b'.' {
            let written = &text[at..end];
            match written.parse::<f64>() {
                Ok(number) if number.is_finite() => (Token::Number(number), at..end),
                Ok(_) => return Err(ExpressionError::new(at..end, format!("{written} is more than a number can be"))),
                Err(_) => return Err(ExpressionError::new(at..end, format!("`{written}` is not a number"))),
            }
        } else {
            (Token::Name(&text[at..end]), at..end)
        };
        at = token.1.end;
        tokens.push(token);
    }
    Ok(tokens)
}

/// The end of a number: digits with a point and an exponent.
fn number_end(bytes: &[u8], start: usize) -> usize {
    let mut at = start;
    while bytes.get(at).is_some_and(|byte| byte.is_ascii_digit() || *byte == b'.') {
        at += 1;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if bytes.get(at + 1 + sign).is_some_and(u8::is_ascii_digit) {
            at += 1 + sign;
            while bytes.get(at).is_some_and(u8::is_ascii_digit) {
                at += 1;
            }
        }
    }
    at
}

/// The end of a name: letters, digits and `_`; one point separates a layer.
fn name_end(bytes: &[u8], start: usize) -> usize {
    let letters = |mut at: usize| {
        while bytes.get(at).is_some_and(|byte| byte.is_ascii_alphanumeric() || *byte == b'_') {
            at += 1;
        }
        at
    };
    let end = letters(start);
    match bytes.get(end) {
        Some(b'.') if letters(end + 1) > end + 1 => letters(end + 1),
        _ => end,
    }
}
