//! Definition of derived layers.

use super::appended::Appended;
use crate::options::OptionSpec;
use orogen_engine::declare::Input;
use orogen_engine::recipe::document::Recipe;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// The meaning of a layer's channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nature {
    /// Plain numbers.
    Numbers,
    /// A unit vector: east, north and up, each -1 to 1.
    Normal,
    /// Weights: each 0 to 1, with the sum 1.
    Weights,
    /// A color in linear light: red, green and blue, 0 to 1.
    Color,
}

/// A layer derived from the heights.
pub struct Derived {
    /// The name for `--layer`.
    pub name: &'static str,
    /// A one-line description.
    pub about: &'static str,
    /// The palette for maps of the layer; empty if it cannot be mapped.
    pub palette: &'static str,
    /// The options of the layer.
    pub options: fn() -> &'static [OptionSpec],
    /// How the layer is computed.
    pub made: Made,
}

impl Derived {
    /// The channels, if the layer is not simply a layer of a node.
    #[must_use]
    pub fn channels(&self) -> Option<&Channels> {
        match &self.made {
            Made::Channels(channels) => Some(channels),
            Made::Nodes(_) => None,
        }
    }

    /// The meaning of the channels.
    #[must_use]
    pub fn nature(&self) -> Nature {
        self.channels().map_or(Nature::Numbers, |channels| channels.nature)
    }
}

/// How a derived layer is computed.
pub enum Made {
    /// By nodes that are appended to the recipe before its world is opened; the layer is a layer of one of them.
    Nodes(NodeLayer),
    /// Sample by sample from layers of appended nodes, for layers with several channels or with surfaces.
    Channels(Channels),
}

/// A layer computed by nodes.
pub struct NodeLayer {
    /// Whether one of the nodes is a solver, which needs a bounded world.
    pub bounded: bool,
    /// Whether the nodes need no solver in a world with [its own network](orogen_engine::recipe::network::OwnNetwork).
    pub network: bool,
    /// Whether the layer may be finite where there is no height, or missing where there is one. If so, finite samples
    /// of the heights are counted instead.
    pub counts_heights: bool,
    /// Appends the nodes, and returns the input that the layer reads.
    ///
    /// Fails if an option is missing or invalid.
    pub append: fn(&mut Appended) -> Result<Input>,
}

impl NodeLayer {
    /// A layer for any world.
    #[must_use]
    pub const fn new(append: fn(&mut Appended) -> Result<Input>) -> NodeLayer {
        NodeLayer { bounded: false, network: false, counts_heights: false, append }
    }

    /// Restricts the layer to bounded worlds.
    #[must_use]
    pub const fn bounded(self) -> NodeLayer {
        NodeLayer { bounded: true, ..self }
    }

    /// Restricts the layer to bounded worlds and worlds with their own network.
    #[must_use]
    pub const fn bounded_or_network(self) -> NodeLayer {
        NodeLayer { bounded: true, network: true, ..self }
    }

    /// Counts the finite samples of the heights instead of those of the layer.
    #[must_use]
    pub const fn counting_heights(self) -> NodeLayer {
        NodeLayer { counts_heights: true, ..self }
    }
}

/// A layer computed sample by sample from other layers.
pub struct Channels {
    /// The meaning of the channels.
    pub nature: Nature,
    /// The names of the channels, for a [prepared](super::list::prepare) recipe.
    pub names: fn(&Recipe) -> Vec<String>,
    /// Appends the nodes that compute the input layers.
    pub prepare: fn(&mut Appended),
    /// The layers of a prepared recipe that are read, at least one. The result has no samples where the first layer has
    /// none.
    pub layers: fn(&Recipe) -> Vec<String>,
    /// Computes the channels; `None` if the input layers are the channels.
    pub make: Option<MakeChannels>,
}

/// Computes the channels over a window from layers over rows that contain the window: one grid per channel.
pub type MakeChannels = fn(&Recipe, &[Grid], &Window) -> Vec<Grid>;
