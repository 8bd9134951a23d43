//! Layers of nodes, and their interpolation.

use serde::{Deserialize, Serialize};

/// The interpolation of a layer between its samples. At a sample's own position the value is always the sample, bit for
/// bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LayerKind {
    /// Smooth values, such as heights: interpolating cubic.
    Height,
    /// Numbers as names, such as watersheds: nearest sample.
    Label,
    /// Values over many orders of magnitude, such as drainage areas: linear in their logarithms, within the range of
    /// the surrounding samples; nearest sample if one of those is not positive.
    Flow,
}

impl LayerKind {
    /// The name in declarations.
    pub fn name(self) -> &'static str {
        match self {
            LayerKind::Height => "height",
            LayerKind::Label => "label",
            LayerKind::Flow => "flow",
        }
    }

    /// The description in the reference.
    pub fn about(self) -> &'static str {
        match self {
            LayerKind::Height => "cubic interpolation",
            LayerKind::Label => "nearest sample",
            LayerKind::Flow => "interpolation of logarithms",
        }
    }
}

/// The declared interpolation of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// This kind.
    As(LayerKind),
    /// The kind of the op's first input.
    AsSource,
}

/// A layer of a node.
#[derive(Debug)]
pub struct Layer {
    /// The name: read as `node.layer`; the first may also be read as `node`.
    pub name: &'static str,
    /// The description.
    pub doc: &'static str,
    /// The unit, or empty.
    pub unit: &'static str,
    /// The interpolation.
    pub interpolation: Interpolation,
}

/// The layers of an op that declares none.
pub const ONE_LAYER: &[Layer] = &[Layer {
    name: "height",
    doc: "What the node makes.",
    unit: "",
    interpolation: Interpolation::As(LayerKind::Height),
}];
