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
    /// The palette for maps of it; empty if a map makes no sense.
    pub palette: &'static str,
    /// The options of the layer.
    pub options: fn() -> &'static [OptionSpec],
    /// How it is computed.
    pub made: Made,
}

impl Derived {
    /// The channels, if the layer is more than a layer of a node.
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
    /// By nodes that are appended to the recipe before its world is opened: it is a layer of one of them.
    Nodes(NodeLayer),
    /// Sample by sample from layers of appended nodes: it has several channels, or shows surfaces.
    Channels(Channels),
}

/// A layer computed by nodes.
pub struct NodeLayer {
    /// Whether one of them is a solver, which needs a bounded world.
    pub bounded: bool,
    /// Whether a world with [its own network](orogen_engine::recipe::network::OwnNetwork) needs no solver for it.
    pub network: bool,
    /// Whether it has finite samples where there is no height, or none where there is one: its finite samples are then
    /// those of the heights.
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

    /// The same for bounded worlds.
    #[must_use]
    pub const fn bounded(self) -> NodeLayer {
        NodeLayer { bounded: true, ..self }
    }

    /// The same for bounded worlds, and for worlds with their own network.
    #[must_use]
    pub const fn bounded_or_network(self) -> NodeLayer {
        NodeLayer { bounded: true, network: true, ..self }
    }

    /// The same with the finite samples of the heights.
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
    /// Appends the nodes that compute what it reads.
    pub prepare: fn(&mut Appended),
    /// The layers of a prepared recipe that it reads, at least one. It has no samples where the first one has none.
    pub layers: fn(&Recipe) -> Vec<String>,
    /// Computes them; `None` if the layers are the channels.
    pub make: Option<MakeChannels>,
}

/// Computes the channels over a window from layers over rows that contain it: one grid per channel.
pub type MakeChannels = fn(&Recipe, &[Grid], &Window) -> Vec<Grid>;
