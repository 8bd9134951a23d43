//! An expression as a list of terms.

use super::function::{Argument, Function, MAX_ARGUMENTS};

/// Maximum length of an expression, in bytes.
pub const MAX_LENGTH: usize = 65_536;

/// Maximum nesting of parentheses, signs and powers.
pub const MAX_DEPTH: usize = 64;

/// Maximum number of terms of an expression: numbers, names and functions, equal ones counted once.
pub const MAX_TERMS: usize = 4096;

/// Maximum number of names of an expression.
pub const MAX_NAMES: usize = 64;

/// A part of an expression, which reads only earlier terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Term {
    /// A number.
    Number(f64),
    /// The value of a name, by its index.
    Name(usize),
    /// A function of earlier terms, by their indices; indices beyond its arity are ignored.
    Apply(Function, [usize; MAX_ARGUMENTS]),
}

/// Evaluates terms over a block of samples, given the samples of its names; a name without samples is 0.
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
