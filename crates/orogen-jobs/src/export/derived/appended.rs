//! Nodes that derived layers append to a recipe.

use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::declare::Input;
use orogen_engine::field::Expr;
use orogen_engine::filter::Extrapolate;
use orogen_engine::node::Node;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::network::OwnNetwork;
use orogen_engine::solver::Drainage;
use orogen_engine::world::HEIGHT;

/// The option for the drainage area at which streams start.
pub const STREAM: OptionSpec = OptionSpec::new("stream", "AREA", ValueKind::Number(0.0, 1e15))
    .with_about("Minimum drainage area of streams, in m^2 [default: 1e6]");

/// A recipe with heights and the given options, to which nodes are appended.
pub struct Appended<'a> {
    recipe: &'a mut Recipe,
    heights: Input,
    options: &'a Options,
}

impl<'a> Appended<'a> {
    /// Wraps a recipe; `None` if it has no heights.
    pub fn new(recipe: &'a mut Recipe, options: &'a Options) -> Option<Appended<'a>> {
        let heights =
            recipe.output_inputs().iter().find(|(name, _)| name == HEIGHT).map(|(_, heights)| heights.clone());
        heights.map(|heights| Appended { recipe, heights, options })
    }

    /// The recipe.
    pub fn recipe(&self) -> &Recipe {
        self.recipe
    }

    /// The recipe, mutably.
    pub fn recipe_mut(&mut self) -> &mut Recipe {
        self.recipe
    }

    /// The input for a node that reads the heights.
    pub fn heights(&self) -> Input {
        self.heights.clone()
    }

    /// The heights inside the world, for a node that reads the surroundings of its samples. Beyond the edges of a
    /// bounded world they are extrapolated by this number of samples, and missing further out.
    pub fn extrapolated(&mut self, samples: u32) -> Input {
        let source = self.heights();
        match self.recipe.world.size {
            Some(_) => self.add_as(&format!("extrapolate-{samples}"), Extrapolate { source, samples }).layer("value"),
            None => source,
        }
    }

    /// The options of the layer.
    pub fn options(&self) -> &'a Options {
        self.options
    }

    /// Appends a node named after its op, unless a node with that name already exists.
    pub fn add(&mut self, node: impl Into<Node>) -> AppendedNode {
        let node = node.into();
        self.add_as(node.spec().op, node)
    }

    /// Appends a node with this name instead of the name of its op.
    fn add_as(&mut self, name: &str, node: impl Into<Node>) -> AppendedNode {
        let node_name = AppendedNode::of(name);
        if !self.recipe.nodes().iter().any(|named| named.name == node_name.0) {
            self.recipe.add(&node_name.0, node.into());
        }
        node_name
    }

    /// Appends the drainage of the heights.
    pub fn drainage(&mut self) -> AppendedNode {
        let (source, stream) = (self.heights(), self.stream());
        self.add(Drainage { source, stream, ..Drainage::default() })
    }

    /// The drainage area: from the recipe's own network if it has one, otherwise computed from the heights.
    pub fn flow(&mut self) -> Input {
        match OwnNetwork::of(self.recipe) {
            Some(network) => Input::Node(network.layer(network.flow())),
            None => self.drainage().layer("flow"),
        }
    }

    /// The flow direction, from the same source as [`Appended::flow`]. There is none in the sea.
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
    /// The node that is named after an op.
    pub fn of(op: &str) -> AppendedNode {
        AppendedNode(format!("{op}-below-height"))
    }

    /// A layer of the node, as an input.
    pub fn layer(&self, layer: &str) -> Input {
        Input::Node(self.name_of(layer))
    }

    /// The name of a layer of the node.
    pub fn name_of(&self, layer: &str) -> String {
        format!("{}.{layer}", self.0)
    }
}
