//! Expressions: a text and its terms.

use super::error::ExpressionError;
use super::function::Function;
use super::parse::parse;
use super::term::Term;
use std::fmt;

/// An expression: its text, and the terms parsed from it.
///
/// ```
/// use orogen_ops::expression::text::Expression;
///
/// let hills = Expression::from("300 * smoothstep(0, 1, noise) + base");
/// assert_eq!(hills.names(), ["noise", "base"]);
/// assert!(hills.error().is_none());
/// let error = Expression::from("300 * (noise");
/// assert!(error.error().is_some_and(|error| error.message.contains("`)`")));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    text: String,
    names: Vec<String>,
    terms: Vec<Term>,
    error: Option<Box<ExpressionError>>,
}

impl Default for Expression {
    /// An empty expression, which has an error.
    fn default() -> Expression {
        Expression::from("")
    }
}

impl From<&str> for Expression {
    fn from(text: &str) -> Expression {
        match parse(text) {
            Ok((names, terms)) => Expression { text: text.to_string(), names, terms, error: None },
            Err(error) => Expression {
                text: text.to_string(),
                names: Vec::new(),
                terms: Vec::new(),
                error: Some(Box::new(error)),
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
    /// The functions that are written with a name: name, syntax with named arguments, and description.
    pub fn functions() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
        Function::functions().map(|function| (function.name(), function.usage(), function.doc().trim()))
    }

    /// The text of the expression.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names in it, in the order of the text, without duplicates, functions and constants.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Its terms; the last one is its value. Empty if it has an error.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The error, if there is one.
    #[must_use]
    pub fn error(&self) -> Option<&ExpressionError> {
        self.error.as_deref()
    }

    /// A description of the computation, independent of names, for content keys.
    #[must_use]
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

    /// The value in f64 for these values of its names.
    #[must_use]
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
