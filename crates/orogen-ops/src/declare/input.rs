//! Inputs of nodes.

use serde::{Deserialize, Serialize};

/// An input of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputName<'a> {
    /// The key.
    pub name: &'a str,
    /// Whether the input is required.
    pub required: bool,
}

/// The value of an input: another node's output, or a constant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Input {
    /// An optional input that is omitted, or a required one that is missing.
    #[default]
    None,
    /// A node by name, or one of its layers as `node.layer`.
    Node(String),
    /// A constant.
    Value(f64),
}

impl From<&str> for Input {
    fn from(name: &str) -> Input {
        Input::Node(name.to_string())
    }
}

impl From<&String> for Input {
    fn from(name: &String) -> Input {
        Input::Node(name.clone())
    }
}

impl From<f64> for Input {
    fn from(value: f64) -> Input {
        Input::Value(value)
    }
}

/// The input for name `i` of an expression.
#[must_use]
pub fn named<'a>(inputs: &'a [(String, Input)], names: &[String], i: usize) -> &'a Input {
    let input = names.get(i).and_then(|name| inputs.iter().find(|(other, _)| other == name));
    input.map_or(&Input::None, |(_, input)| input)
}

/// Sets the input for a name in an expression, and keeps the order of names in the expression.
pub fn set_named(inputs: &mut Vec<(String, Input)>, names: &[String], name: &str, input: Input) {
    inputs.retain(|(other, _)| other != name);
    inputs.push((name.to_string(), input));
    inputs.sort_by_key(|(name, _)| names.iter().position(|other| other == name));
}
