//! What every op implements by its declaration.

use super::input::{Input, InputName};
use super::spec::Spec;
use crate::value::Value;
use orogen_io::dem::file_ref::FileRef;

/// What an `op!` block implements: reaching a node's inputs and parameters by their index in the [`Spec`].
pub trait Declared {
    /// What was declared.
    fn spec(&self) -> &'static Spec;
    /// The inputs it has: those declared, or those that its expression names.
    fn inputs(&self) -> Vec<InputName<'_>> {
        self.spec().inputs.iter().map(|input| InputName { name: input.name, required: input.required }).collect()
    }
    /// Input `i`.
    fn input(&self, i: usize) -> &Input;
    /// Sets input `i`.
    fn set_input(&mut self, i: usize, input: Input);
    /// Parameter `i`.
    fn param(&self, i: usize) -> Value;
    /// Sets parameter `i`, or says what was expected.
    fn set_param(&mut self, i: usize, value: &Value) -> Result<(), String>;
    /// What of parameter `i` decides about results.
    fn param_key(&self, i: usize) -> Value;
    /// The files that parameters name.
    fn files(&mut self) -> Vec<&mut FileRef>;
    /// What a single parameter cannot see: a message if parameters contradict each other, with the key it is about.
    fn consistent(&self) -> Result<(), (&'static str, String)>;
}
