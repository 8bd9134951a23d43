//! Layers: the things a node makes, and how each may be read between its samples.

pub use orogen_grid::resample::LayerKind;

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
