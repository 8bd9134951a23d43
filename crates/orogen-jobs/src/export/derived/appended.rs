//! Nodes that a derived layer appends to a recipe.

use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::declare::Input;
use orogen_engine::field::Expr;
use orogen_engine::node::Node;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::network::OwnNetwork;
use orogen_engine::solver::Drainage;

/// The option for the drainage area at which streams start.
pub const STREAM: OptionSpec = OptionSpec::new(
    "stream",
    "AREA",
    ValueKind::Number(0.0, 1e15),
    "Minimum drainage area of streams, in m^2 [default: 1e6]",
);

/// A recipe with known heights, and the given options.
pub struct Appended<'a> {
    recipe: &'a mut Recipe,
    heights: Input,
    options: &'a Options,
}

impl<'a> Appended<'a> {
    /// For a recipe whose heights are the input `heights`.
    pub fn new(recipe: &'a mut Recipe, heights: Input, options: &'a Options) -> Appended<'a> {
        Appended { recipe, heights, options }
    }

    /// The recipe.
    pub fn recipe(&self) -> &Recipe {
        self.recipe
    }

    /// The input for a node that reads the heights.
    pub fn heights(&self) -> Input {
        self.heights.clone()
    }

    /// The options of the layer.
    pub fn options(&self) -> &'a Options {
        self.options
    }

    /// Appends a node named after its op, unless a node with that name exists already.
    pub fn add(&mut self, node: impl Into<Node>) -> AppendedNode {
        let node = node.into();
        let name = format!("{}-below-height", node.spec().op);
        if !self.recipe.nodes().iter().any(|named| named.name == name) {
            self.recipe.add(&name, node);
        }
        AppendedNode(name)
    }

    /// Appends the drainage of the heights.
    pub fn drainage(&mut self) -> AppendedNode {
        let (source, stream) = (self.heights(), self.stream());
        self.add(Drainage { source, stream, ..Drainage::default() })
    }

    /// The drainage area: that of the recipe's own network, otherwise that of the heights.
    pub fn flow(&mut self) -> Input {
        match OwnNetwork::of(self.recipe) {
            Some(network) => Input::Node(network.layer(network.flow())),
            None => self.drainage().layer("flow"),
        }
    }

    /// The flow direction, like [`Appended::flow`]. There is none in the sea.
    pub fn receiver(&mut self) -> Input {
        let Some(network) = OwnNetwork::of(self.recipe) else { return self.drainage().layer("receiver") };
        let receiver = Input::Node(network.layer(network.receiver()));
        let (heights, sea) = (self.heights(), self.recipe.world.sea_level);
        let masked = Expr::new("mix(receiver, 8, height <= sea)");
        self.add(masked.with("receiver", receiver).with("height", heights).with("sea", sea)).layer("height")
    }

    /// The drainage area at which streams start, in m^2.
    pub fn stream(&self) -> f64 {
        self.options.number(STREAM.name).unwrap_or(Drainage::default().stream)
    }
}

/// An appended node.
pub struct AppendedNode(String);

impl AppendedNode {
    /// A layer of the node, as an input.
    pub fn layer(&self, layer: &str) -> Input {
        Input::Node(format!("{}.{layer}", self.0))
    }
}
