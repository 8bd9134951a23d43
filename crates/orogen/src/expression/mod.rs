//! Arithmetic in a line of text: what formulas of parameters and the op `expr` are written in.
//!
//! - [`function`]: what can be computed of samples, each function once
//! - [`token`]: a text as tokens
//! - [`parse`]: tokens as terms, without recursion deeper than a bound
//! - [`term`]: an expression as a list of terms, each after those that it reads
//! - [`formula`]: an expression of parameters, computed once in f64

pub mod formula;
pub mod function;
mod parse;
pub mod term;
mod token;

#[cfg(test)]
mod tests;
