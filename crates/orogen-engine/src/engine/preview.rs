//! Previews: what a device computes, kept apart from what the processor computes.

use super::run::Engine;
use crate::device::Device;
use crate::ids::{IndexVec, NodeId};
use crate::lower::Lowering;
use crate::op::Op;
use crate::plan::domain::Domain;
use crate::recipe::graph::Link;
use crate::store::grids::GridStore;
use crate::store::level_tiles::LevelTiles;
use crate::store::solutions::Store;
use std::path::Path;

/// What previews of a session keep in memory, for later ones. Nothing of it is stored for later runs, and nothing exact is made from it.
pub struct Previews {
    pub store: Store,
    pub grids: GridStore,
    pub level_tiles: LevelTiles,
}

impl Previews {
    /// Room for at most these bytes of grids and of tiles; `scratch` is the folder for solutions that do not fit in memory.
    pub fn new(scratch: &Path, grids: u64, level_tiles: u64) -> Previews {
        Previews {
            store: Store::holding(Vec::new(), scratch.to_path_buf()),
            grids: GridStore::new(grids),
            level_tiles: LevelTiles::new(level_tiles),
        }
    }

    /// Room for as much.
    pub fn emptied(&self) -> Previews {
        Previews::new(self.store.scratch(), self.grids.limit(), self.level_tiles.limit())
    }

    /// Bytes of all that is kept.
    pub fn memory(&self) -> u64 {
        self.store.memory().saturating_add(self.grids.memory()).saturating_add(self.level_tiles.memory())
    }

    /// Drops what was not used for longest, until all takes at most `allowed` bytes.
    pub fn make_room(&self, allowed: u64) {
        self.store.make_room(allowed, &[]);
        let left = allowed.saturating_sub(self.store.memory());
        self.grids.make_room(left);
        self.level_tiles.make_room(left.saturating_sub(self.grids.memory()));
    }
}

/// A device, and which nodes of a recipe are approximate with it.
pub struct Preview<'a> {
    pub device: &'a dyn Device,
    pub kept: &'a Previews,
    /// Solvers and levelled ops that the device computes, and all that reads them. Fields and filters that it computes are not among them: whether they
    /// must be exact depends on who reads them.
    approximate: IndexVec<NodeId, bool>,
    /// Whether a node reads such a node.
    reads: IndexVec<NodeId, bool>,
}

impl<'a> Preview<'a> {
    /// That of an engine's recipe.
    pub fn new(device: &'a dyn Device, kept: &'a Previews, engine: &Engine) -> Preview<'a> {
        let none = || -> IndexVec<NodeId, bool> { vec![false; engine.recipe.nodes().len()].into() };
        let mut preview = Preview { device, kept, approximate: none(), reads: none() };
        for &node in &engine.graph.order {
            let is_approximate = |link: &Link| matches!(link, Link::Node(read) if preview.approximate[read.node]);
            let mut links = engine.graph.links[node].iter().chain([&engine.graph.masks[node]]);
            preview.reads[node] = links.any(is_approximate);
            preview.approximate[node] = preview.reads[node] || is_lowered(engine, node);
        }
        preview
    }

    /// Whether a node is made on the device, or from what is made there.
    pub fn is_approximate(&self, node: NodeId) -> bool {
        self.approximate[node]
    }

    /// Whether a node is made from what is made on the device.
    pub fn is_read_by(&self, node: NodeId) -> bool {
        self.reads[node]
    }
}

/// Whether a device computes a solver, or a level of a levelled op.
fn is_lowered(engine: &Engine, node: NodeId) -> bool {
    let given = given(engine, node);
    match engine.op(node) {
        Some(Op::Solver(solver)) => {
            let padded = Domain::of(solver, engine.world_params).padded;
            matches!(solver.lower(&padded, &given, engine.world_params), Lowering::Shader(_))
        }
        Some(Op::Levelled(op)) => {
            let mut levels = 1..op.levels().count;
            levels.any(|level| matches!(op.lower(level, &given, engine.world_params), Lowering::Shader(_)))
        }
        _ => false,
    }
}

/// Whether each input of a node is given.
pub fn given(engine: &Engine, node: NodeId) -> Vec<bool> {
    engine.graph.links[node].iter().map(|link| *link != Link::None).collect()
}
