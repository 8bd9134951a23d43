//! Layers of nodes, and their interpolation.

pub use orogen_grid::resample::LayerKind;

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
