//! An expression as a list of terms.

use super::function::{Argument, Function, MAX_ARGUMENTS};
use super::parse;
use crate::value::Span;
use std::fmt;

/// Longest text of an expression, in bytes.
pub const MAX_LENGTH: usize = 65_536;

/// Deepest nesting of parentheses, signs and powers.
pub const MAX_DEPTH: usize = 64;

/// Most terms of an expression: numbers, names and what is computed of them, the same one counted once.
pub const MAX_TERMS: usize = 4096;

/// Most names of an expression.
pub const MAX_NAMES: usize = 64;

/// A part of an expression. It reads only terms that stand before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Term {
    /// A number.
    Number(f64),
    /// The value of a name, by its index.
    Name(usize),
    /// A function of earlier terms, by their indices; those beyond its arity mean nothing.
    Apply(Function, [usize; MAX_ARGUMENTS]),
}

/// Computes terms over a block of samples, given the samples of its names; a name without any is 0.
pub fn evaluate<'a>(terms: &[Term], names: impl Fn(usize) -> Option<&'a [f32]>, out: &mut [f32]) {
    let mut made: Vec<Vec<f32>> = Vec::with_capacity(terms.len());
    for term in terms {
        let mut samples = vec![0.0; out.len()];
        match term {
            Term::Number(number) => samples.fill(*number as f32),
            Term::Name(name) => samples.iter_mut().zip(names(*name).unwrap_or(&[])).for_each(|(to, from)| *to = *from),
            Term::Apply(function, arguments) => {
                let arguments: Vec<Argument> =
                    arguments[..function.arity()].iter().map(|argument| Argument::Samples(&made[*argument])).collect();
                function.apply(&arguments, &mut samples);
            }
        }
        made.push(samples);
    }
    match made.last() {
        Some(last) => out.copy_from_slice(last),
        None => out.fill(0.0),
    }
}

/// What is wrong with an expression, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Bytes of the text.
    pub span: Span,
    /// What, and what to do.
    pub message: String,
}

impl Fault {
    /// Something wrong at a part of the text.
    pub fn new(span: Span, message: impl Into<String>) -> Fault {
        Fault { span, message: message.into() }
    }
}

/// An expression: its text, and what it says.
///
/// ```
/// use orogen::expression::term::Expression;
///
/// let hills = Expression::from("300 * smoothstep(0, 1, noise) + base");
/// assert_eq!(hills.names(), ["noise", "base"]);
/// assert!(hills.fault().is_none());
/// let fault = Expression::from("300 * (noise");
/// assert!(fault.fault().is_some_and(|fault| fault.message.contains("`)`")));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    text: String,
    names: Vec<String>,
    terms: Vec<Term>,
    fault: Option<Box<Fault>>,
}

impl Default for Expression {
    /// No expression yet, which is a fault.
    fn default() -> Expression {
        Expression::from("")
    }
}

impl From<&str> for Expression {
    fn from(text: &str) -> Expression {
        match parse::parse(text) {
            Ok((names, terms)) => Expression { text: text.to_string(), names, terms, fault: None },
            Err(fault) => Expression {
                text: text.to_string(),
                names: Vec::new(),
                terms: Vec::new(),
                fault: Some(Box::new(fault)),
            },
        }
    }
}

impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Expression {
    /// The text that it was read from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names in it, in the order of the text, each once; functions and constants are none.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Its terms; the last is its value. None if it has a fault.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// What is wrong with it.
    pub fn fault(&self) -> Option<&Fault> {
        self.fault.as_deref()
    }

    /// What it computes, whatever its names are called: decides about results.
    pub fn key(&self) -> String {
        let mut key = String::new();
        for term in &self.terms {
            key.push_str(&match term {
                Term::Number(number) => format!("{:x};", number.to_bits()),
                Term::Name(name) => format!("n{name};"),
                Term::Apply(function, arguments) => format!("{function:?}{:?};", &arguments[..function.arity()]),
            });
        }
        key
    }

    /// Its value in f64 where its names have these values.
    pub fn value(&self, names: &[f64]) -> Option<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let value = match term {
                Term::Number(number) => *number,
                Term::Name(name) => *names.get(*name)?,
                Term::Apply(function, arguments) => {
                    function.of_f64(arguments.map(|argument| values.get(argument).copied().unwrap_or(0.0)))
                }
            };
            values.push(value);
        }
        values.last().copied()
    }
}
