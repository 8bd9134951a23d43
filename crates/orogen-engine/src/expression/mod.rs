//! Arithmetic in a line of text: what formulas of parameters and the op `expr` are written in.
//!
//! - `function`: what can be computed of samples, each function once
//! - `token`: a text as tokens
//! - `parse`: tokens as terms, without recursion deeper than a bound
//! - `term`: an expression as a list of terms, each after those that it reads
//! - [`text`]: an expression with its text
//! - `formula`: an expression of parameters, computed once in f64

pub(crate) mod error;
pub(crate) mod formula;
pub(crate) mod function;
mod parse;
pub(crate) mod term;
pub mod text;
mod token;

#[cfg(test)]
mod tests;
