//! Arithmetic expressions, for formulas of parameters and for the op `expr`.
//!
//! - [`function`]: the functions of expressions
//! - `token`: the tokenizer
//! - `parse`: the parser, with bounded recursion
//! - [`term`]: an expression as a list of terms, each after those that it reads
//! - [`text`]: an expression with its text
//! - [`formula`]: an expression of parameters, evaluated once in f64

pub mod error;
pub mod formula;
pub mod function;
mod parse;
pub mod term;
pub mod text;
mod token;

#[cfg(test)]
mod tests;
