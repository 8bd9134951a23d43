//! The biomes of a recipe.

use crate::recipe::document::Recipe;
use crate::recipe::graph::Graph;
use orogen_grid::climate::biomes::scheme::Scheme;
use orogen_ops::declare::Input;
use orogen_ops::ids::Id;
use orogen_ops::node::Node;

/// The output that reads the layer of a `biome` op, with its classes: the output `biome` if it does, otherwise the
/// first one.
#[must_use]
pub fn biomes(recipe: &Recipe) -> Option<(&str, Scheme)> {
    let scheme_of = |input: &Input| {
        let Input::Node(text) = input else { return None };
        let target = Graph::find(recipe, text).ok()?;
        match &recipe.nodes().get(target.node.index())?.node {
            Node::Biome(biome) => Some(Scheme::from(biome.scheme)),
            _ => None,
        }
    };
    let mut outputs: Vec<&(String, Input)> = recipe.output_inputs().iter().collect();
    outputs.sort_by_key(|(name, _)| name != "biome");
    outputs.into_iter().find_map(|(name, input)| Some((name.as_str(), scheme_of(input)?)))
}
