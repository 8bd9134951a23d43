//! Content keys: hashes of everything that a node's result depends on.

use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, Link};
use orogen_ops::declare::{MARGIN, Shape, Spec, VERTICAL};
use orogen_ops::ids::{Id, IndexVec, NodeId};
use orogen_ops::node::Node;
use orogen_ops::op::{Op, WorldParams};
use orogen_ops::value::Value;
use sha2::{Digest, Sha256};

/// A hash of everything that a node's result depends on: the op, its revision, its parameters, the keys of its sources,
/// and the properties of the world that it reads. Names are not included.
pub type Key = [u8; 32];

/// The key of every node, by index.
pub fn keys(recipe: &Recipe, graph: &Graph) -> IndexVec<NodeId, Key> {
    let world_params = recipe.world.world_params();
    let mut keys: IndexVec<NodeId, Key> = vec![[0; 32]; recipe.nodes().len()].into();
    for &index in &graph.order {
        let node = &recipe.nodes()[index.index()].node;
        let spec: &Spec = node.spec();
        let mut hash = Sha256::new();
        hash.update(spec.op.as_bytes());
        hash.update([0]);
        hash.update(spec.revision.to_le_bytes());
        put_world(&mut hash, node, &world_params);
        for (i, param) in spec.params.iter().enumerate() {
            // Solutions that were stored before ops had these parameters stay valid.
            if [MARGIN, VERTICAL].contains(&param.name) && node.param(i) == Value::Number(0.0) {
                continue;
            }
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

/// The key of a link's target, given the keys of all nodes.
pub fn link_key(link: &Link, keys: &IndexVec<NodeId, Key>) -> Key {
    let mut hash = Sha256::new();
    put_link(&mut hash, link, keys);
    hash.finalize().into()
}

fn put_link(hash: &mut Sha256, link: &Link, keys: &IndexVec<NodeId, Key>) {
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

/// Adds the properties of the world that a node reads: the seed, if the node has a seed; the extent and the solvers'
/// lattice, if the node depends on the whole world or on its edges; the cell at which a field's source is computed; the
/// sea level, if the op declares it.
fn put_world(hash: &mut Sha256, node: &Node, world: &WorldParams) {
    let mut put = |number: Option<u64>| {
        hash.update([u8::from(number.is_some())]);
        hash.update(number.unwrap_or(0).to_le_bytes());
    };
    let is_seeded = node.spec().params.iter().any(|param| matches!(param.shape, Shape::Seed));
    let (size, cell, sea) = match node.op() {
        Op::Field(field) => (field.needs_bounds(), field.source_cell(world.cell, world.cell), field.reads_sea_level()),
        Op::Filter(filter) => (filter.reads_size(), None, filter.reads_sea_level()),
        Op::Levelled(levelled) => (false, None, levelled.reads_sea_level()),
        Op::Solver(solver) => (true, Some(solver.cell(world.cell)), solver.reads_sea_level()),
    };
    put(is_seeded.then_some(world.seed));
    let size = size.then_some(world.size).flatten();
    put(size.map(|[width, _]| width.to_bits()));
    put(size.map(|[_, height]| height.to_bits()));
    put(cell.map(f64::to_bits));
    put(sea.then_some(world.sea_level.to_bits()));
}

/// The identity of a recipe for plans: the keys of all nodes, in the order of the recipe. Plans refer to nodes by
/// index.
pub fn identity(keys: &IndexVec<NodeId, Key>) -> Key {
    let mut hash = Sha256::new();
    keys.iter().for_each(|key| hash.update(key));
    hash.finalize().into()
}
