//! The trait that every op implements by its declaration.

use super::input::{Input, InputName};
use super::param::AnyParam;
use super::spec::Spec;
use crate::value::Value;
use orogen_io::dem::file_ref::FileRef;

/// The value of a parameter that an op does not have.
const NO_PARAM: Value = Value::Other("nothing");

/// Access to a node's inputs and parameters by their index in the [`Spec`]. An `op!` block implements it.
pub trait Declared {
    /// The declaration.
    fn spec(&self) -> &'static Spec;
    /// The inputs: those declared, or the names in the expression.
    fn inputs(&self) -> Vec<InputName<'_>> {
        self.spec().input_names()
    }
    /// Input `i`.
    fn input(&self, i: usize) -> &Input;
    /// Sets input `i`.
    fn set_input(&mut self, i: usize, input: Input);
    /// The parameters.
    #[doc(hidden)]
    fn params(&self) -> Vec<&dyn AnyParam>;
    /// The parameters, mutable.
    #[doc(hidden)]
    fn params_mut(&mut self) -> Vec<&mut dyn AnyParam>;
    /// Parameter `i`.
    fn param(&self, i: usize) -> Value {
        self.params().get(i).map_or(NO_PARAM, |param| param.value())
    }
    /// Sets parameter `i`; the error describes the valid values.
    fn set_param(&mut self, i: usize, value: &Value) -> Result<(), String> {
        let spec = self.spec().params.get(i);
        self.params_mut().get_mut(i).zip(spec).map_or(Ok(()), |(param, spec)| param.set(spec, value))
    }
    /// The part of parameter `i` that affects results.
    fn param_key(&self, i: usize) -> Value {
        self.params().get(i).map_or(NO_PARAM, |param| param.key_value())
    }
    /// The files that parameters name.
    fn files(&mut self) -> Vec<&mut FileRef> {
        self.params_mut().into_iter().filter_map(|param| param.file_ref()).collect()
    }
    /// The parameter [`MARGIN`](super::spec::MARGIN) of a solver whose domain may extend beyond the world, in metres;
    /// `None` if the op has no such parameter.
    fn margin(&self) -> Option<f64> {
        None
    }
    /// The parameter [`VERTICAL`](super::spec::VERTICAL) of a noise; 0 for a noise of the plane, and if the op has no
    /// such parameter.
    fn vertical(&self) -> f64 {
        0.0
    }
    /// The unit of a layer, or empty: the declared unit, unless it depends on parameters.
    fn unit(&self, layer: usize) -> &'static str {
        self.spec().layers.get(layer).map_or("", |layer| layer.unit)
    }
    /// Checks that parameters do not contradict each other; the error has a key and a message.
    fn consistent(&self) -> Result<(), (&'static str, String)>;
}
