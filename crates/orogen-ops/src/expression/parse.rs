//! The parser: precedence climbing (Clarke 1986) with bounded depth.
//!
//! From lowest to highest precedence: comparisons, `+ -`, `* / %`, unary `- +`, `^` (right associative). Equal terms
//! are shared.

use super::error::ExpressionError;
use super::function::{Function, MAX_ARGUMENTS};
use super::term::{MAX_DEPTH, MAX_LENGTH, MAX_NAMES, MAX_TERMS, Term};
use super::token::{Token, tokens};
use crate::value::Span;
use orogen_grid::words::{count, suggestion};
use std::collections::HashMap;

/// Named constants.
const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU)];

/// Parses an expression: its names and its terms.
pub fn parse(text: &str) -> Result<(Vec<String>, Vec<Term>), ExpressionError> {
    if text.len() > MAX_LENGTH {
        let message = format!("the expression has {} bytes, the most it may have is {MAX_LENGTH}", text.len());
        return Err(ExpressionError::new(0..1, message));
    }
    let tokens = tokens(text)?;
    if tokens.is_empty() {
        return Err(ExpressionError::new(0..text.len(), "the expression is empty; an example is \"a * 2 + b\""));
    }
    let mut parser = Parser {
        tokens: &tokens,
        at: 0,
        end: text.len(),
        depth: 0,
        names: Vec::new(),
        terms: Vec::new(),
        known: HashMap::new(),
    };
    let value = parser.comparison()?;
    match parser.tokens.get(parser.at) {
        None => {
            // An earlier term may be the value; terms after it were only needed during parsing.
            parser.terms.truncate(value + 1);
            Ok((parser.names, parser.terms))
        }
        Some((Token::Sign(")"), span)) => Err(ExpressionError::new(span.clone(), "there is no `(` for this `)`")),
        Some((Token::Sign(","), span)) => {
            Err(ExpressionError::new(span.clone(), "a comma only separates arguments of a function"))
        }
        Some((_, span)) => {
            Err(ExpressionError::new(span.clone(), "an operator such as `+` or `*` is missing before this"))
        }
    }
}

/// The key of equal terms.
#[derive(PartialEq, Eq, Hash)]
enum Same {
    Number(u64),
    Name(usize),
    Apply(Function, [usize; MAX_ARGUMENTS]),
}

struct Parser<'t> {
    tokens: &'t [(Token<'t>, Span)],
    at: usize,
    end: usize,
    depth: usize,
    names: Vec<String>,
    terms: Vec<Term>,
    known: HashMap<Same, usize>,
}

impl<'t> Parser<'t> {
    fn sign(&self) -> Option<&'static str> {
        match self.tokens.get(self.at) {
            Some((Token::Sign(sign), _)) => Some(sign),
            _ => None,
        }
    }

    /// The position of the next token, or the end of the text.
    fn here(&self) -> Span {
        match (self.tokens.get(self.at), self.tokens.last()) {
            (Some((_, span)), _) => span.clone(),
            (None, Some((_, last))) => last.end..(last.end + 1).min(self.end.max(last.end)),
            (None, None) => 0..self.end,
        }
    }

    fn push(&mut self, term: Term) -> Result<usize, ExpressionError> {
        let same = match term {
            Term::Number(number) => Same::Number(number.to_bits()),
            Term::Name(name) => Same::Name(name),
            Term::Apply(function, arguments) => Same::Apply(function, arguments),
        };
        if let Some(known) = self.known.get(&same) {
            return Ok(*known);
        }
        if self.terms.len() >= MAX_TERMS {
            return Err(ExpressionError::new(
                self.here(),
                format!("the expression has more than {MAX_TERMS} terms; make several nodes of it"),
            ));
        }
        self.terms.push(term);
        self.known.insert(same, self.terms.len() - 1);
        Ok(self.terms.len() - 1)
    }

    fn apply(&mut self, function: Function, arguments: &[usize]) -> Result<usize, ExpressionError> {
        let mut all = [0; MAX_ARGUMENTS];
        all.iter_mut().zip(arguments).for_each(|(to, from)| *to = *from);
        self.push(Term::Apply(function, all))
    }

    /// Parses a part one level deeper.
    fn deeper(
        &mut self,
        part: impl FnOnce(&mut Self) -> Result<usize, ExpressionError>,
    ) -> Result<usize, ExpressionError> {
        if self.depth >= MAX_DEPTH {
            return Err(ExpressionError::new(
                self.here(),
                format!("this is nested more than {MAX_DEPTH} levels deep; make several nodes of it"),
            ));
        }
        self.depth += 1;
        let term = part(self)?;
        self.depth -= 1;
        Ok(term)
    }

    fn comparison(&mut self) -> Result<usize, ExpressionError> {
        let left = self.sum()?;
        let Some(function) = self.sign().and_then(comparison) else { return Ok(left) };
        self.at += 1;
        let right = self.sum()?;
        if self.sign().and_then(comparison).is_some() {
            return Err(ExpressionError::new(self.here(), "comparisons do not chain: write `(a < b) * (b < c)`"));
        }
        self.apply(function, &[left, right])
    }

    fn sum(&mut self) -> Result<usize, ExpressionError> {
        let mut left = self.product()?;
        while let Some(function) = match self.sign() {
            Some("+") => Some(Function::Add),
            Some("-") => Some(Function::Subtract),
            _ => None,
        } {
            self.at += 1;
            let right = self.product()?;
            left = self.apply(function, &[left, right])?;
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<usize, ExpressionError> {
        let mut left = self.signed()?;
        while let Some(function) = match self.sign() {
            Some("*") => Some(Function::Multiply),
            Some("/") => Some(Function::Divide),
            Some("%") => Some(Function::Modulo),
            _ => None,
        } {
            self.at += 1;
            let right = self.signed()?;
            left = self.apply(function, &[left, right])?;
        }
        Ok(left)
    }

    fn signed(&mut self) -> Result<usize, ExpressionError> {
        match self.sign() {
            Some("-") => {
                self.at += 1;
                let term = self.deeper(Self::signed)?;
                match self.terms.get(term) {
                    Some(Term::Number(number)) => {
                        let number = -number;
                        self.push(Term::Number(number))
                    }
                    _ => self.apply(Function::Negate, &[term]),
                }
            }
            Some("+") => {
                self.at += 1;
                self.deeper(Self::signed)
            }
            _ => self.power(),
        }
    }

    fn power(&mut self) -> Result<usize, ExpressionError> {
        let base = self.primary()?;
        if self.sign() != Some("^") {
            return Ok(base);
        }
        self.at += 1;
        let exponent = self.deeper(Self::signed)?;
        self.raised(base, exponent)
    }

    /// A power. Powers whose exponent allows multiplication or a root are computed that way, which is exact and much
    /// faster.
    fn raised(&mut self, base: usize, exponent: usize) -> Result<usize, ExpressionError> {
        match self.terms.get(exponent) {
            Some(Term::Number(1.0)) => Ok(base),
            Some(Term::Number(2.0)) => self.apply(Function::Multiply, &[base, base]),
            Some(Term::Number(3.0)) => {
                let square = self.apply(Function::Multiply, &[base, base])?;
                self.apply(Function::Multiply, &[square, base])
            }
            Some(Term::Number(4.0)) => {
                let square = self.apply(Function::Multiply, &[base, base])?;
                self.apply(Function::Multiply, &[square, square])
            }
            Some(Term::Number(0.5)) => self.apply(Function::Sqrt, &[base]),
            Some(Term::Number(-1.0)) => {
                let one = self.push(Term::Number(1.0))?;
                self.apply(Function::Divide, &[one, base])
            }
            _ => self.apply(Function::Power, &[base, exponent]),
        }
    }

    fn primary(&mut self) -> Result<usize, ExpressionError> {
        let Some((token, span)) = self.tokens.get(self.at) else {
            return Err(ExpressionError::new(
                self.here(),
                "the expression ends too early: a number, a name or a `(` is missing",
            ));
        };
        match token {
            Token::Number(number) => {
                self.at += 1;
                self.push(Term::Number(*number))
            }
            Token::Sign("(") => {
                self.at += 1;
                let term = self.deeper(Self::comparison)?;
                self.close(span)?;
                Ok(term)
            }
            Token::Sign(sign) => Err(ExpressionError::new(
                span.clone(),
                format!("a number, a name or a `(` is missing before this `{sign}`"),
            )),
            Token::Name(name) => {
                self.at += 1;
                match self.sign() {
                    Some("(") => self.call(name, span),
                    _ => self.name(name, span),
                }
            }
        }
    }

    fn close(&mut self, opened: &Span) -> Result<(), ExpressionError> {
        match self.tokens.get(self.at) {
            Some((Token::Sign(")"), _)) => {
                self.at += 1;
                Ok(())
            }
            Some((Token::Sign(","), span)) => {
                Err(ExpressionError::new(span.clone(), "a comma only separates arguments of a function"))
            }
            Some((_, span)) => Err(ExpressionError::new(span.clone(), "an operator or a `)` is missing before this")),
            None => Err(ExpressionError::new(opened.clone(), "the `)` that closes this is missing")),
        }
    }

    fn name(&mut self, name: &'t str, span: &Span) -> Result<usize, ExpressionError> {
        if let Some((_, number)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            return self.push(Term::Number(*number));
        }
        if let Some(function) = Function::named(name) {
            return Err(ExpressionError::new(
                span.clone(),
                format!("`{name}` is a function: write `{}`", function.usage()),
            ));
        }
        let index = match self.names.iter().position(|known| known == name) {
            Some(index) => index,
            None if self.names.len() >= MAX_NAMES => {
                let message = format!("the expression has more than {MAX_NAMES} names; make several nodes of it");
                return Err(ExpressionError::new(span.clone(), message));
            }
            None => {
                self.names.push(name.to_string());
                self.names.len() - 1
            }
        };
        self.push(Term::Name(index))
    }

    /// A function's arguments, starting with its `(`.
    fn call(&mut self, name: &str, span: &Span) -> Result<usize, ExpressionError> {
        let Some(function) = Function::named(name) else {
            let hint = suggestion(name, Function::functions().map(Function::name));
            return Err(ExpressionError::new(span.clone(), format!("there is no function `{name}`; {hint}")));
        };
        let opened = self.here();
        self.at += 1;
        let mut arguments = Vec::new();
        if self.sign() != Some(")") {
            arguments.push(self.deeper(Self::comparison)?);
            while self.sign() == Some(",") {
                self.at += 1;
                arguments.push(self.deeper(Self::comparison)?);
            }
        }
        self.close(&opened)?;
        let any_number = matches!(function, Function::Min | Function::Max) && arguments.len() >= 2;
        if arguments.len() != function.arity() && !any_number {
            let message = format!(
                "`{name}` takes {}, {}, not {}",
                count(function.arity(), "argument"),
                function.usage(),
                arguments.len()
            );
            return Err(ExpressionError::new(span.clone(), message));
        }
        match (function, arguments.as_slice()) {
            (Function::Power, [base, exponent]) => self.raised(*base, *exponent),
            (_, [first, second, more @ ..]) if any_number => {
                let mut term = self.apply(function, &[*first, *second])?;
                for next in more {
                    term = self.apply(function, &[term, *next])?;
                }
                Ok(term)
            }
            (_, arguments) => self.apply(function, arguments),
        }
    }
}

fn comparison(sign: &str) -> Option<Function> {
    Some(match sign {
        "<" => Function::Less,
        "<=" => Function::LessOrEqual,
        ">" => Function::Greater,
        ">=" => Function::GreaterOrEqual,
        "==" => Function::Equal,
        "!=" => Function::NotEqual,
        _ => return None,
    })
}

/// Whether a name has a fixed meaning: a function or a constant.
pub fn is_taken(name: &str) -> bool {
    Function::named(name).is_some() || CONSTANTS.iter().any(|(constant, _)| *constant == name)
}
