//! What a node reads.

use serde::{Deserialize, Serialize};

/// An input of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputName<'a> {
    /// Its key.
    pub name: &'a str,
    /// Whether the node cannot do without.
    pub required: bool,
}

/// What an op reads: another node's output, or a constant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub enum Input {
    /// Nothing: an optional input left out, or a required one still missing.
    #[default]
    None,
    /// A node by name, or one of its layers as `node.layer`.
    Node(String),
    /// The same number everywhere.
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

/// Sets what a name in an expression stands for, and keeps the names in the expression's order.
pub fn set_named(inputs: &mut Vec<(String, Input)>, names: &[String], name: String, input: Input) {
    inputs.retain(|(other, _)| *other != name);
    inputs.push((name, input));
    inputs.sort_by_key(|(name, _)| names.iter().position(|other| other == name));
}
