//! What is wrong with an expression.

use crate::value::Span;

/// What is wrong with an expression, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpressionError {
    /// Bytes of the text.
    pub span: Span,
    /// What, and what to do.
    pub message: String,
}

impl ExpressionError {
    /// Something wrong at a part of the text.
    pub fn new(span: Span, message: impl Into<String>) -> ExpressionError {
        ExpressionError { span, message: message.into() }
    }
}
