//! Layers: the things a node makes, and how each may be read between its samples.

use serde::{Deserialize, Serialize};

/// How a layer is read between its samples. On its own lattice a sample is always itself, bit for bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LayerKind {
    /// Smooth, such as a height: the interpolating cubic.
    Height,
    /// Names in numbers, such as a watershed: the nearest sample.
    Label,
    /// Amounts over many orders of magnitude, such as a drainage area: linear in their logarithms, so that it neither falls
    /// below nor rises above the samples around; the nearest sample where one of those is not above zero.
    Flow,
}

impl LayerKind {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            LayerKind::Height => "height",
            LayerKind::Label => "label",
            LayerKind::Flow => "flow",
        }
    }

    /// What it means, for a reader of the reference.
    pub fn about(self) -> &'static str {
        match self {
            LayerKind::Height => "cubic interpolation",
            LayerKind::Label => "nearest sample",
            LayerKind::Flow => "interpolation of logarithms",
        }
    }
}

/// How a declaration says its layer is read between samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// As this kind.
    As(LayerKind),
    /// As what the op's first input shows.
    AsSource,
}

/// One of the things a node makes.
#[derive(Debug)]
pub struct Layer {
    /// Its name: read as `node.layer`; the first may be read as `node`.
    pub name: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its unit, or empty.
    pub unit: &'static str,
    /// How it is read between samples.
    pub interpolation: Interpolation,
}

/// What an op makes that declares no layers.
pub const ONE_LAYER: &[Layer] = &[Layer {
    name: "height",
    doc: "What the node makes.",
    unit: "",
    interpolation: Interpolation::As(LayerKind::Height),
}];
