//! The river network of a recipe with levels.

use super::document::Recipe;
use super::graph::{Graph, LayerRef};
use orogen_ops::declare::Input;
use orogen_ops::ids::Id;
use orogen_ops::op::{Levels, Op};

/// The network of a levelled node, which every window of the world shares: drainage areas and receivers are functions
/// of the position, not of the window.
///
/// A recipe has one if its output `flow` is the layer `flow` of a levelled node, and its output `receiver` reads the
/// layer `receiver` of the same node, directly or through other nodes (which may, for example, remove the receivers
/// below sea level). The heights of the recipe must fall along the receivers.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnNetwork {
    node: String,
    levels: Levels,
    /// The level whose nodes are at the samples.
    at_samples: usize,
    has_nodes: bool,
    is_height: bool,
}

/// The layers of nodes.
const NODES: [&str; 5] = ["node_height", "node_flow", "node_receiver", "node_east", "node_south"];

impl OwnNetwork {
    /// The network of a recipe, if it has one.
    #[must_use]
    pub fn of(recipe: &Recipe) -> Option<OwnNetwork> {
        let output = |name: &str| match recipe.output_inputs().iter().find(|(output, _)| output == name) {
            Some((_, Input::Node(text))) => Graph::find(recipe, text).ok(),
            _ => None,
        };
        let node_of = |link: LayerRef| &recipe.nodes()[link.node.index()];
        let name_of = |link: LayerRef| node_of(link).node.layers().get(link.layer).map_or("", |layer| layer.name);
        let (flow, receiver) = (output("flow")?, output("receiver")?);
        let Op::Levelled(op) = node_of(flow).node.op() else { return None };
        let has = |name: &str| node_of(flow).node.layers().iter().any(|layer| layer.name == name);
        if name_of(flow) != "flow" || !["height", "lake", "surface", "receiver"].into_iter().all(has) {
            return None;
        }
        let reads = |link: LayerRef| link.node == flow.node && name_of(link) == "receiver";
        if !reads(receiver) && !is_read_by(recipe, receiver.node.index(), &reads) {
            return None;
        }
        let height = output("height");
        Some(OwnNetwork {
            node: node_of(flow).name.clone(),
            levels: op.levels(),
            at_samples: op.level_at_samples(),
            has_nodes: NODES.into_iter().all(has),
            is_height: height.is_some_and(|height| height.node == flow.node && name_of(height) == "height"),
        })
    }

    /// The name by which worlds know a layer of the node.
    #[must_use]
    pub fn layer(&self, name: &str) -> String {
        format!("{}.{name}", self.node)
    }

    /// The name of the layer with drainage areas. If the levels have layers of nodes, it is one of them, so that areas
    /// and receivers agree at every level.
    #[must_use]
    pub fn flow(&self) -> &'static str {
        if self.has_nodes { "node_flow" } else { "flow" }
    }

    /// The name of the layer of receivers.
    #[must_use]
    pub fn receiver(&self) -> &'static str {
        if self.has_nodes { "node_receiver" } else { "receiver" }
    }

    /// Whether the nodes of a level are at the samples of its lattice, as at the finest level of valleys.
    #[must_use]
    pub fn is_at_samples(&self, cell: f64) -> bool {
        cell == self.levels.cell(self.at_samples)
    }

    /// Whether the recipe's heights are the heights of the node.
    #[must_use]
    pub fn is_height(&self) -> bool {
        self.is_height
    }

    /// The cell of the level whose rivers a window with this cell shows; `None` if the node has only the rivers of
    /// another level.
    #[must_use]
    pub fn cell_for(&self, cell: f64) -> Option<f64> {
        let serving = self.levels.cell(self.levels.serving(cell));
        (self.has_nodes || self.is_at_samples(serving)).then_some(serving)
    }
}

/// Whether a node, or one that it reads, has an input or a mask that `reads` accepts.
fn is_read_by(recipe: &Recipe, start: usize, reads: &dyn Fn(LayerRef) -> bool) -> bool {
    let mut seen = vec![false; recipe.nodes().len()];
    let mut waiting = vec![start];
    while let Some(index) = waiting.pop() {
        if std::mem::replace(&mut seen[index], true) {
            continue;
        }
        let named = &recipe.nodes()[index];
        let inputs = (0..named.node.inputs().len()).map(|i| named.node.input(i)).chain([&named.mask]);
        for input in inputs {
            let Input::Node(text) = input else { continue };
            let Ok(link) = Graph::find(recipe, text) else { continue };
            if reads(link) {
                return true;
            }
            waiting.push(link.node.index());
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::presets;

    fn of(preset: &str) -> Option<OwnNetwork> {
        OwnNetwork::of(&presets::find(preset).unwrap().recipe().unwrap())
    }

    #[test]
    fn presets_of_levels_have_one() {
        for (name, cell, finest, is_height) in [
            ("endless", 60.0, 0.9375, true),
            ("continent", 60.0, 0.9375, true),
            ("island", 20.0, 1.25, false),
            ("archipelago", 40.0, 1.25, false),
        ] {
            let network = of(name).unwrap();
            assert!(network.is_at_samples(cell) && network.is_height() == is_height, "{name}");
            assert!(!network.is_at_samples(cell * 2.0) && !network.is_at_samples(cell / 2.0), "{name}");
            let rivers = [cell * 5.0, cell * 0.7, 1e-3].map(|requested| network.cell_for(requested));
            assert_eq!(rivers, [Some(cell * 4.0), Some(cell * 0.5), Some(finest)], "{name}");
            assert_eq!(network.layer("flow"), "land.flow");
        }
        for name in presets::all().iter().map(|preset| preset.name) {
            let known = ["archipelago", "biomes", "continent", "endless", "island", "tile-continent"].contains(&name);
            assert_eq!(of(name).is_some(), known, "{name}");
        }
    }

    #[test]
    fn both_outputs_must_be_of_one_node() {
        let text = |outputs: &str| {
            format!(
                "orogen = 1\n[world]\ncell = 60\n[nodes.a]\nop = \"continents\"\n[nodes.b]\nop = \"continents\"\nseed = 1\n[outputs]\n\
                 height = \"a\"\n{outputs}\n"
            )
        };
        let has = |outputs: &str| OwnNetwork::of(&Recipe::parse(&text(outputs), "test").unwrap()).is_some();
        assert!(has("flow = \"a.flow\"\nreceiver = \"a.receiver\""));
        assert!(!has("flow = \"a.flow\"\nreceiver = \"b.receiver\""));
        assert!(!has("flow = \"a.flow\""));
        assert!(!has("receiver = \"a.receiver\""));
        assert!(!has("flow = \"a.lake\"\nreceiver = \"a.receiver\""));
    }
}
