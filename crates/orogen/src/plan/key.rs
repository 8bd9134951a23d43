//! Content keys: what a node's result depends on, and nothing else.

use crate::declare::Spec;
use crate::op::WorldParams;
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, Link};
use sha2::{Digest, Sha256};

/// A hash of the op, its revision, its parameters, its sources' keys and the world. Names do not enter it.
pub type Key = [u8; 32];

/// The key of every node, by index.
pub fn keys(recipe: &Recipe, graph: &Graph) -> Vec<Key> {
    let world = world_key(&recipe.world.world_params());
    let mut keys: Vec<Key> = vec![[0; 32]; recipe.nodes().len()];
    for &index in &graph.order {
        let node = &recipe.nodes()[index].node;
        let spec: &Spec = node.spec();
        let mut hash = Sha256::new();
        hash.update(world);
        hash.update(spec.op.as_bytes());
        hash.update([0]);
        hash.update(spec.revision.to_le_bytes());
        for (i, param) in spec.params.iter().enumerate() {
            hash.update(param.name.as_bytes());
            hash.update([0]);
            hash.update(node.param_key(i).to_toml().as_bytes());
            hash.update([0]);
        }
        for link in graph.links[index].iter().chain([&graph.masks[index]]) {
            put_link(&mut hash, link, &keys);
        }
        keys[index] = hash.finalize().into();
    }
    keys
}

/// The key of what a link leads to, given those of all nodes.
pub fn link_key(link: &Link, keys: &[Key]) -> Key {
    let mut hash = Sha256::new();
    put_link(&mut hash, link, keys);
    hash.finalize().into()
}

fn put_link(hash: &mut Sha256, link: &Link, keys: &[Key]) {
    match link {
        Link::None => hash.update([0]),
        Link::Value(value) => {
            hash.update([1]);
            hash.update(value.to_bits().to_le_bytes());
        }
        Link::Node(target) => {
            hash.update([2]);
            hash.update(keys[target.node]);
            hash.update((target.layer as u32).to_le_bytes());
        }
    }
}

fn world_key(world_params: &WorldParams) -> Key {
    let mut hash = Sha256::new();
    hash.update(world_params.seed.to_le_bytes());
    for number in
        world_params.size.unwrap_or([f64::INFINITY; 2]).into_iter().chain([world_params.cell, world_params.sea_level])
    {
        hash.update(number.to_bits().to_le_bytes());
    }
    hash.finalize().into()
}
