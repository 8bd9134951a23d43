//! Arithmetic expressions, for formulas of parameters and for the op `expr`.
//!
//! - `function`: the functions of expressions
//! - `token`: the tokenizer
//! - `parse`: the parser, with bounded recursion
//! - `term`: an expression as a list of terms, each after those that it reads
//! - [`text`]: an expression with its text
//! - `formula`: an expression of parameters, evaluated once in f64

#[doc(hidden)]
pub mod error;
#[doc(hidden)]
pub mod formula;
#[doc(hidden)]
pub mod function;
mod parse;
#[doc(hidden)]
pub mod term;
pub mod text;
mod token;

#[cfg(test)]
mod tests;
