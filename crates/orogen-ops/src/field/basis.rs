//! Noise bases of fractals, as a choice in recipes.

use crate::declare::{Param, Shape};
use crate::value::Value;
use orogen_noise::Basis;

impl Param for Basis {
    const SHAPE: Shape = Shape::Choice(|| Basis::all().iter().map(|basis| (basis.name(), basis.about())).collect());

    fn read(value: &Value) -> Option<Basis> {
        match value {
            Value::Text(name) => Basis::from_name(name),
            _ => None,
        }
    }

    fn write(&self) -> Value {
        Value::Text(self.name().to_string())
    }
}
