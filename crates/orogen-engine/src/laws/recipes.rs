//! Worlds and recipes in which an op is tested.

use crate::recipe::document::{Recipe, WorldSpec};
use orogen_grid::grid::Window;
use orogen_ops::declare::Input;
use orogen_ops::field::{Fbm, Perlin};
use orogen_ops::filter::Blur;
use orogen_ops::layer::Layer;
use orogen_ops::node::Node;

/// The name of the node under test in the recipes of [`recipe_of`] and [`Laws::in_recipes`](super::Laws::in_recipes).
pub const NODE: &str = "node";

/// Samples along the sides of the worlds of [`world_of`], their far edges included.
pub(super) const SIDES: [usize; 2] = [97, 81];

/// The whole of [`world_of`], its far edges included.
pub(super) fn full(cell: f64) -> Window {
    Window::new(SIDES[0], SIDES[1], cell)
}

/// The nodes of a recipe.
pub(super) fn without_outputs(from: &Recipe) -> Recipe {
    let mut recipe = Recipe::new(from.world);
    for named in from.nodes() {
        recipe.add_masked(&named.name, named.node.clone(), named.mask.clone());
    }
    recipe
}

/// The node and its inputs without the blur below them, because the result of a filter depends on the cell.
pub(super) fn unsoftened(from: &Recipe) -> Recipe {
    let mut recipe = Recipe::new(from.world);
    for named in from.nodes().iter().filter(|named| named.name != SOFT) {
        let mut node = named.node.clone();
        for i in 0..node.inputs().len() {
            if *node.input(i) == Input::from(SOFT) {
                node.set_input(i, Input::Node(format!("in{i}")));
            }
        }
        recipe.add_masked(&named.name, node, named.mask.clone());
    }
    recipe.output("height", NODE);
    recipe
}

/// The node that a `source` is read through.
const SOFT: &str = "soft";

/// The name of the output of a layer other than the first one, whose output is `height`.
pub(super) fn output_of(layer: &Layer) -> &'static str {
    if layer.name == "height" { "layer_height" } else { layer.name }
}

/// A bounded world of 97 x 81 samples at a cell.
#[must_use]
pub fn world_of(cell: f64) -> WorldSpec {
    let size = SIDES.map(|side| (side - 1) as f64 * cell);
    WorldSpec { seed: 42, size: Some(size), cell, ..WorldSpec::default() }
}

/// A recipe with the node as [`NODE`]. Each input is a separate noise, about -1 to 1 with a wavelength of nine cells.
/// An input called `source` reads it through a blur, so that halos add up. The outputs are the node's layers. The first
/// one is named `height`; if another layer has that name, its output is `layer_height`.
#[must_use]
pub fn recipe_of(node: &Node, world: WorldSpec, masked: bool) -> Recipe {
    let mut node = node.clone();
    let mut recipe = Recipe::new(world);
    let inputs: Vec<String> = node.inputs().iter().map(|input| input.name.to_string()).collect();
    for (i, input) in inputs.iter().enumerate() {
        let name = format!("in{i}");
        recipe.add(&name, Fbm { seed: i as u64, wavelength: 9.0 * world.cell, octaves: 3, ..Default::default() });
        if input == "source" {
            recipe.add(SOFT, Blur { source: Input::from(&name), radius: 1.2 * world.cell });
            node.set_input(i, Input::from(SOFT));
        } else {
            node.set_input(i, Input::Node(name));
        }
    }
    let layers = node.layers();
    if masked {
        recipe.add("mask", Perlin { seed: 99, wavelength: 7.0 * world.cell, ..Default::default() });
        recipe.add_masked(NODE, node, "mask");
    } else {
        recipe.add(NODE, node);
    }
    recipe.output("height", NODE);
    for layer in layers.iter().skip(1) {
        recipe.output(output_of(layer), Input::Node(format!("{NODE}.{}", layer.name)));
    }
    recipe
}
