//! Arithmetic expressions, for formulas of parameters and for the op `expr`.
//!
//! - `function`: the functions of expressions
//! - `token`: the tokenizer
//! - `parse`: the parser, with bounded recursion
//! - `term`: an expression as a list of terms, each after the terms that it reads
//! - [`text`]: an expression with its text
//! - `formula`: an expression of parameters, evaluated once in f64

#[doc(hidden)]
#[doc(hidden)]
pub mod error;
#[doc(hidden)]
#[doc(hidden)]
pub mod formula;
#[doc(hidden)]
#[doc(hidden)]
pub mod function;
mod parse;
#[doc(hidden)]
#[doc(hidden)]
pub mod term;
#[doc(hidden)]
pub mod text;
mod token;

pub use error::ExpressionError;
pub use text::Expression;

#[cfg(test)]
mod tests;
