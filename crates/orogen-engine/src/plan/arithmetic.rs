//! Compiling the arithmetic of fields that are terms of their inputs.

use super::compile::{Compiler, internal};
use crate::recipe::graph::Link;
use orogen_grid::error::Result;
use orogen_ops::expression::function::{Function, MAX_ARGUMENTS};
use orogen_ops::expression::term::Term;
use orogen_ops::ids::{CoordSetId, RegisterId};
use orogen_ops::program::{Instruction, Operand};

impl Compiler<'_> {
    /// Emits the arithmetic of a field. Constant terms are folded.
    pub(super) fn evaluate(&mut self, terms: &[Term], links: &[Link], coords: CoordSetId) -> Result<RegisterId> {
        let mut used = vec![false; terms.len()];
        if let Some(last) = used.last_mut() {
            *last = true;
        }
        for (at, term) in terms.iter().enumerate().rev() {
            if let (true, Term::Apply(function, arguments)) = (used[at], term) {
                arguments[..function.arity()].iter().for_each(|argument| used[*argument] = true);
            }
        }
        let mut made: Vec<Option<Operand>> = Vec::with_capacity(terms.len());
        for (term, used) in terms.iter().zip(used) {
            let operand = match term {
                _ if !used => None,
                Term::Number(number) => Some(Operand::Number(*number as f32)),
                Term::Name(name) => Some(match links.get(*name) {
                    Some(Link::Value(value)) => Operand::Number(*value),
                    Some(link @ Link::Node(_)) => Operand::Register(self.value(link, coords)?),
                    // An optional input that is not given is 0 in terms.
                    Some(Link::None) => Operand::Number(0.0),
                    None => return Err(internal("a term names an input that its field does not declare")),
                }),
                Term::Apply(function, arguments) => {
                    let arguments = arguments[..function.arity()].iter().map(|argument| made.get(*argument).copied());
                    let arguments = arguments.map(Option::flatten).collect::<Option<Vec<Operand>>>();
                    let arguments = arguments.ok_or_else(|| internal("a term reads a term that comes after it"))?;
                    Some(self.apply(*function, arguments))
                }
            };
            made.push(operand);
        }
        match made.last() {
            Some(Some(Operand::Register(register))) => Ok(*register),
            Some(Some(Operand::Number(number))) => Ok(self.constant(*number)),
            Some(None) | None => Err(internal("a field that is terms of its inputs has none")),
        }
    }

    /// A function of operands; of constants only, a constant.
    fn apply(&mut self, function: Function, arguments: Vec<Operand>) -> Operand {
        let mut numbers = [0.0; MAX_ARGUMENTS];
        for (number, argument) in numbers.iter_mut().zip(&arguments) {
            let Operand::Number(value) = argument else {
                let out = self.fresh();
                self.instructions.push(Instruction::Apply { function, arguments, out });
                return Operand::Register(out);
            };
            *number = *value;
        }
        Operand::Number(function.of_f32(numbers))
    }
}
