//! Types of parameters, with conversion from and to values.

use super::spec::{ParamSpec, Shape};
use crate::expression::text::Expression;
use crate::value::{Spanned, Value};
use orogen_grid::hex;
use orogen_io::dem::file_ref::{AreaFile, FileRef, LineFile, NetworkFile, Picture, RidgeFile};

/// A type that parameters can have.
pub trait Param: Sized {
    /// The kind of its value.
    const SHAPE: Shape;
    /// The parameter from a value; `None` if the value has another kind.
    fn read(value: &Value) -> Option<Self>;
    /// The parameter as a value.
    fn write(&self) -> Value;
    /// Whether every number in it is finite and within the range.
    fn within(&self, range: [f64; 2]) -> bool {
        let _ = range;
        true
    }
    /// The part of it that affects results: the parameter itself or, for a file, its content.
    fn key(&self) -> Value {
        self.write()
    }
    /// The file, if the parameter is a file.
    fn file(&mut self) -> Option<&mut FileRef> {
        None
    }
}

/// A parameter of any type.
#[doc(hidden)]
pub trait AnyParam {
    /// [`Param::write`].
    fn value(&self) -> Value;
    /// [`Param::key`].
    fn key_value(&self) -> Value;
    /// [`Param::file`].
    fn file_ref(&mut self) -> Option<&mut FileRef>;
    /// Sets it from a value; the error describes the valid kind and range.
    fn set(&mut self, spec: &ParamSpec, value: &Value) -> Result<(), String>;
}

impl<T: Param> AnyParam for T {
    fn value(&self) -> Value {
        self.write()
    }
    fn key_value(&self) -> Value {
        self.key()
    }
    fn file_ref(&mut self) -> Option<&mut FileRef> {
        self.file()
    }
    fn set(&mut self, spec: &ParamSpec, value: &Value) -> Result<(), String> {
        *self = read_param(spec, value)?;
        Ok(())
    }
}

impl Param for Expression {
    const SHAPE: Shape = Shape::Expression;
    fn read(value: &Value) -> Option<Expression> {
        match value {
            Value::Text(text) => Some(Expression::from(text.as_str())),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Text(self.text().to_string())
    }
    fn key(&self) -> Value {
        Value::Text(Expression::key(self))
    }
}

impl Param for FileRef {
    const SHAPE: Shape = Shape::File;
    fn read(value: &Value) -> Option<FileRef> {
        match value {
            Value::Text(path) => Some(FileRef::from(path.as_str())),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Text(self.text())
    }
    fn key(&self) -> Value {
        match self.content_hash() {
            Some(hash) => Value::Text(hex::encode(hash)),
            None => self.write(),
        }
    }
    fn file(&mut self) -> Option<&mut FileRef> {
        Some(self)
    }
}

/// Files that are not read as heights.
macro_rules! file_param {
    ($($name:ident),*) => { $(
        impl Param for $name {
            const SHAPE: Shape = Shape::File;
            fn read(value: &Value) -> Option<$name> {
                match value {
                    Value::Text(path) => Some($name::from(path.as_str())),
                    _ => None,
                }
            }
            fn write(&self) -> Value {
                self.0.write()
            }
            fn key(&self) -> Value {
                self.0.key()
            }
            fn file(&mut self) -> Option<&mut FileRef> {
                Some(&mut self.0)
            }
        }
    )* };
}

file_param!(Picture, LineFile, AreaFile, NetworkFile, RidgeFile);

impl Param for f64 {
    const SHAPE: Shape = Shape::Number;
    fn read(value: &Value) -> Option<f64> {
        value.number()
    }
    fn write(&self) -> Value {
        Value::Number(*self)
    }
    fn within(&self, range: [f64; 2]) -> bool {
        self.is_finite() && (range[0]..=range[1]).contains(self)
    }
}

impl Param for u32 {
    const SHAPE: Shape = Shape::Integer;
    fn read(value: &Value) -> Option<u32> {
        match value {
            // Values that do not fit are out of every declared range. They saturate, so that the message states the
            // range.
            Value::Integer(integer) => Some(u32::try_from(*integer).unwrap_or(u32::MAX)),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Integer(i64::from(*self))
    }
    fn within(&self, range: [f64; 2]) -> bool {
        (range[0]..=range[1]).contains(&f64::from(*self))
    }
}

impl Param for u64 {
    const SHAPE: Shape = Shape::Seed;
    fn read(value: &Value) -> Option<u64> {
        match value {
            Value::Integer(integer) => u64::try_from(*integer).ok(),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Integer((*self).min(i64::MAX as u64) as i64)
    }
}

impl Param for bool {
    const SHAPE: Shape = Shape::Flag;
    fn read(value: &Value) -> Option<bool> {
        match value {
            Value::Flag(flag) => Some(*flag),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::Flag(*self)
    }
}

impl Param for [f64; 2] {
    const SHAPE: Shape = Shape::Pair;
    fn read(value: &Value) -> Option<[f64; 2]> {
        match value {
            Value::List(items) => match items.as_slice() {
                [a, b] => Some([a.value.number()?, b.value.number()?]),
                _ => None,
            },
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::List(self.iter().map(|number| Spanned::unplaced(Value::Number(*number))).collect())
    }
    fn within(&self, range: [f64; 2]) -> bool {
        self.iter().all(|number| number.within(range))
    }
}

impl Param for Vec<[f64; 2]> {
    const SHAPE: Shape = Shape::Curve;
    fn read(value: &Value) -> Option<Vec<[f64; 2]>> {
        match value {
            Value::List(items) => items.iter().map(|item| <[f64; 2]>::read(&item.value)).collect(),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        Value::List(self.iter().map(|point| Spanned::unplaced(point.write())).collect())
    }
    fn within(&self, range: [f64; 2]) -> bool {
        self.len() >= 2
            && self.iter().all(|point| point.within(range))
            && self.windows(2).all(|pair| pair[0][0] < pair[1][0])
    }
}

/// Reads a parameter; the error describes the valid kind and range.
pub fn read_param<T: Param>(spec: &ParamSpec, value: &Value) -> Result<T, String> {
    T::read(value).filter(|param| param.within(spec.range)).ok_or_else(|| refusal(spec, value))
}

/// The message for an invalid value. It is separate from [`read_param`], which is compiled for each type.
#[cold]
fn refusal(spec: &ParamSpec, value: &Value) -> String {
    if let Some((_, message)) = spec.problem(value) {
        return message;
    }
    let given = match spec.shape {
        Shape::Integer | Shape::Seed => value.describe_as_integer(),
        _ => value.describe(),
    };
    let mut message = format!("`{}` must be {}, not {given}", spec.name, spec.expected());
    if let (Shape::Choice(choices), Value::Text(text)) = (spec.shape, value) {
        let names: Vec<&str> = choices().iter().map(|(name, _)| *name).collect();
        if let Some(near) = orogen_grid::words::nearest(text, names) {
            message.push_str(&format!("; did you mean \"{near}\"?"));
        }
    }
    message
}
