//! Errors in expressions.

use crate::value::Span;

/// An error in an expression, with its position.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionError {
    /// Position in the text, in bytes.
    pub span: Span,
    /// The message, with the problem and advice.
    pub message: String,
}

impl ExpressionError {
    /// An error at a position.
    pub fn new(span: Span, message: impl Into<String>) -> ExpressionError {
        ExpressionError { span, message: message.into() }
    }
}
