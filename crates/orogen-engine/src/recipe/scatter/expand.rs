//! Expansion of scatter to nodes: the density of each kind is computed by ordinary ops.

use super::document::ExpandedScatter;
use crate::recipe::condition::expand::ShareNodes;
use crate::recipe::document::Recipe;
use crate::recipe::outputs::HEIGHT;
use orogen_ops::declare::Input;

/// Adds the nodes that compute the densities of a recipe's scatter, unless they exist. A recipe without a layer
/// `height` has no objects. Opening a world does this.
pub fn expand(recipe: &mut Recipe) {
    let Some((_, height)) = recipe.output_inputs().iter().find(|(name, _)| name == HEIGHT) else { return };
    if recipe.scatter().is_empty() || !recipe.expanded_scatter().is_empty() {
        return;
    }
    let height = height.clone();
    let entries = recipe.scatter().to_vec();
    let mut nodes = ShareNodes::new(recipe, height);
    let expanded = (1..).zip(&entries).map(|(k, entry)| {
        let first = nodes.recipe.nodes().len();
        let more = [entry.mask.clone(), entry.density.clone()];
        let density = match nodes.share(&format!("scatter-{k}"), &entry.all, &entry.any, more) {
            Input::Node(name) => name,
            _ => String::new(),
        };
        ExpandedScatter { density, nodes: first..nodes.recipe.nodes().len() }
    });
    let expanded = expanded.collect();
    recipe.set_expanded_scatter(expanded);
}
