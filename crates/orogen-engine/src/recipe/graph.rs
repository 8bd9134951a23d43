//! The graph of a recipe's nodes: resolved names, order, keys.

use super::document::{MAX_NODES, Recipe};
use orogen_grid::error::{Diagnostic, Error, ErrorKind};
use orogen_grid::words::suggestion;
use orogen_ops::declare::{Input, MARGIN, Spec};
use orogen_ops::ids::{Id, IndexVec, NodeId};
use orogen_ops::layer::{Interpolation, LayerKind};
use orogen_ops::node::Node;
use orogen_ops::op::Op;
use orogen_ops::registered::check_name;
use std::collections::{BTreeSet, HashMap, HashSet};

/// Maximum nesting of recipes in recipes.
pub const MAX_USE_DEPTH: usize = 16;

/// Maximum number of samples along a side of a world's lattice.
pub const MAX_SAMPLES: f64 = (1u64 << 31) as f64;

/// Maximum number of diagnostics reported at once; finding suggestions for a million of them would take very long.
pub const MAX_FAULTS: usize = 20;

/// The target of an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Link {
    /// No input.
    None,
    /// A constant.
    Value(f32),
    /// A node's layer.
    Node(LayerRef),
}

/// A layer of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LayerRef {
    /// The node, by its index in the recipe.
    pub node: NodeId,
    /// Index of the layer among the node's layers.
    pub layer: usize,
}

/// The resolved graph.
#[derive(Debug, Clone)]
pub struct Graph {
    /// The inputs of each node, in the order of the declaration.
    pub links: IndexVec<NodeId, Vec<Link>>,
    /// The mask of each node.
    pub masks: IndexVec<NodeId, Link>,
    /// The nodes in an order where every node comes after the nodes that it reads.
    pub order: Vec<NodeId>,
    /// The targets of the outputs, in the recipe's order.
    pub outputs: Vec<Link>,
    /// Whether each node's result depends on the altitude at which it is sampled.
    pub in_space: IndexVec<NodeId, bool>,
}

/// The position of a problem in a recipe.
#[derive(Debug, Clone, PartialEq)]
pub enum At {
    /// A key of a node; the empty key is the node itself.
    Node(usize, String),
    /// An output.
    Output(usize),
    /// The world.
    World,
}

/// A problem in a recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct GraphDiagnostic {
    /// Its position.
    pub at: At,
    /// The message, with the problem and advice.
    pub message: String,
}

/// Whether a name is valid for a node or a layer.
pub(super) fn is_name(name: &str) -> bool {
    (1..=64).contains(&name.len())
        && name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-')
}

/// Whether a name is valid for a node, including the names of recipes that it comes from.
fn is_path(name: &str) -> bool {
    name.split('/').count() <= MAX_USE_DEPTH + 1 && name.split('/').all(is_name)
}

const NAME_RULE: &str = "a name must have 1 to 64 letters, digits, `_` and `-`, and must not start with a digit";

impl Graph {
    /// Resolves names, checks all values and finds an order, or returns all problems, up to [`MAX_FAULTS`].
    pub fn resolve(recipe: &Recipe) -> Result<Graph, Vec<GraphDiagnostic>> {
        let nodes = recipe.nodes();
        if nodes.len() > MAX_NODES {
            let message = format!("the recipe has {} nodes; at most {MAX_NODES} are allowed", nodes.len());
            return Err(vec![GraphDiagnostic { at: At::Node(MAX_NODES, String::new()), message }]);
        }
        let names = HashMap::with_capacity(nodes.len());
        let mut resolver = Resolver { recipe, names, registered: HashMap::new(), diagnostics: Vec::new() };
        resolver.check_world();
        (0..nodes.len()).try_for_each(|index| resolver.check_node(index))?;
        let linked: Vec<(Vec<Link>, Link)> =
            (0..nodes.len()).map(|index| resolver.link_node(index)).collect::<Result<_, _>>()?;
        let outputs = resolver.link_outputs()?;
        if !resolver.diagnostics.is_empty() {
            return Err(resolver.diagnostics);
        }
        let (links, masks): (Vec<Vec<Link>>, Vec<Link>) = linked.into_iter().unzip();
        let in_space = vec![false; nodes.len()].into();
        let mut graph = Graph { links: links.into(), masks: masks.into(), order: Vec::new(), outputs, in_space };
        graph.order = graph.sort().map_err(|cycle| vec![graph.cycle_fault(&cycle, recipe)])?;
        graph.find_altitude(recipe)?;
        Ok(graph)
    }

    /// Finds the nodes that depend on the altitude. Only fields may read them, because a grid has one result for all
    /// altitudes.
    fn find_altitude(&mut self, recipe: &Recipe) -> Result<(), Vec<GraphDiagnostic>> {
        let mut diagnostics = Vec::new();
        for &id in &self.order {
            let named = &recipe.nodes()[id.index()];
            let on_grids = match named.node.op() {
                Op::Field(field) => field.source_cell(recipe.world.cell, recipe.world.cell).is_some(),
                Op::Filter(_) | Op::Levelled(_) | Op::Solver(_) => true,
            };
            let in_space = |link: &Link| matches!(link, Link::Node(target) if self.in_space[target.node]);
            for (link, input) in self.links[id].iter().zip(named.node.inputs()) {
                if let (true, true, Link::Node(source)) = (on_grids, in_space(link), link) {
                    diagnostics.push(altitude_fault(recipe, id, input.name, source.node));
                    if diagnostics.len() >= MAX_FAULTS {
                        return Err(diagnostics);
                    }
                }
            }
            let is_slice = match named.node.op() {
                Op::Field(field) => field.coord_map().and_then(|map| map.altitude()).is_some(),
                _ => false,
            };
            let from_inputs = !on_grids && !is_slice && self.links[id].iter().any(in_space);
            self.in_space[id] = named.node.reads_altitude() || from_inputs || in_space(&self.masks[id]);
        }
        if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
    }

    /// The nodes that a node reads, including its mask.
    pub fn sources(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        self.links[node].iter().chain([&self.masks[node]]).filter_map(|link| match link {
            Link::Node(target) => Some(target.node),
            _ => None,
        })
    }

    /// Kahn's algorithm; nodes keep the order of the text where possible. On failure, the nodes of a cycle.
    fn sort(&self) -> Result<Vec<NodeId>, Vec<NodeId>> {
        let count = self.links.len();
        let nodes = || (0..count).map(NodeId::new);
        let mut waiting: IndexVec<NodeId, usize> = nodes().map(|node| self.sources(node).count()).collect();
        let mut readers: IndexVec<NodeId, Vec<NodeId>> = vec![Vec::new(); count].into();
        for node in nodes() {
            for source in self.sources(node) {
                readers[source].push(node);
            }
        }
        let mut ready: BTreeSet<NodeId> = nodes().filter(|&node| waiting[node] == 0).collect();
        let mut order = Vec::with_capacity(count);
        while let Some(node) = ready.pop_first() {
            order.push(node);
            for &reader in &readers[node] {
                waiting[reader] -= 1;
                if waiting[reader] == 0 {
                    ready.insert(reader);
                }
            }
        }
        if order.len() == count {
            return Ok(order);
        }
        // Every remaining node reads another one that remains: going upstream must repeat.
        let left = |node: &NodeId| waiting[*node] > 0;
        let mut path: Vec<NodeId> = Vec::new();
        let mut step: HashMap<NodeId, usize> = HashMap::new();
        let mut at = nodes().find(|node| left(node));
        while let Some(node) = at {
            if let Some(&first) = step.get(&node) {
                let mut cycle = path.split_off(first);
                cycle.reverse();
                return Err(cycle);
            }
            step.insert(node, path.len());
            path.push(node);
            at = self.sources(node).find(left);
        }
        Err(path)
    }

    fn cycle_fault(&self, cycle: &[NodeId], recipe: &Recipe) -> GraphDiagnostic {
        let name = |node: NodeId| recipe.nodes()[node.index()].name.as_str();
        let reader = cycle.first().copied().unwrap_or(NodeId::new(0));
        let source = cycle.last().copied().unwrap_or(reader);
        let inputs = recipe.nodes()[reader.index()].node.inputs();
        let key = self.links[reader]
            .iter()
            .position(|link| matches!(link, Link::Node(target) if target.node == source))
            .map_or("mask", |i| inputs[i].name);
        let message = if cycle.len() == 1 {
            format!("node `{}`, `{key}`: the node reads itself; it must read another node", name(reader))
        } else {
            const SHOWN: usize = 8;
            let mut names: Vec<&str> = cycle.iter().take(SHOWN).map(|&node| name(node)).collect();
            if cycle.len() > SHOWN {
                names.push("...");
            }
            names.push(name(reader));
            format!("these nodes form a cycle: {}; one of them must read something else", names.join(" -> "))
        };
        GraphDiagnostic { at: At::Node(reader.index(), key.to_string()), message }
    }

    /// The error for diagnostics of a recipe without a text.
    #[must_use]
    pub fn error(diagnostics: Vec<GraphDiagnostic>) -> Error {
        let diagnostics = diagnostics.into_iter().map(|diagnostic| Diagnostic::new(diagnostic.message)).collect();
        Error::from_diagnostics(ErrorKind::Recipe, diagnostics)
    }

    /// The interpolation of a target. A layer that is interpolated like its source takes the kind of that source, and
    /// so on.
    #[must_use]
    pub fn layer_kind(&self, recipe: &Recipe, target: LayerRef) -> LayerKind {
        let mut at = target;
        loop {
            match recipe.nodes()[at.node.index()].node.layers().get(at.layer).map(|layer| layer.interpolation) {
                Some(Interpolation::As(kind)) => return kind,
                Some(Interpolation::AsSource) => match self.links[at.node].first() {
                    Some(Link::Node(source)) => at = *source,
                    _ => return LayerKind::Height,
                },
                None => return LayerKind::Height,
            }
        }
    }

    /// The target of `node` or `node.layer`.
    ///
    /// # Errors
    /// A message with the closest name, if there is no such node or layer.
    pub fn find(recipe: &Recipe, text: &str) -> Result<LayerRef, String> {
        named(recipe, text, |name| recipe.nodes().iter().position(|node| node.name == name))
    }
}

/// The problem of an op that is computed on grids and reads a node that depends on the altitude.
fn altitude_fault(recipe: &Recipe, reader: NodeId, key: &str, source: NodeId) -> GraphDiagnostic {
    let (reading, source) = (&recipe.nodes()[reader.index()], &recipe.nodes()[source.index()]);
    let message = format!(
        "node `{}`, `{key}`: `{}` depends on the altitude, and the op `{}` is computed in the plane, for all altitudes at once. Let it read a node without \
         `altitude` and without noise with `vertical`, and add what depends on the altitude after it, with fields",
        reading.name,
        source.name,
        reading.node.spec().op
    );
    GraphDiagnostic { at: At::Node(reader.index(), key.to_string()), message }
}

/// The target of `node` or `node.layer`, with the node's index from `find`.
fn named(recipe: &Recipe, text: &str, find: impl Fn(&str) -> Option<usize>) -> Result<LayerRef, String> {
    const SHOWN: usize = 64;
    let (node, layer) = text.split_once('.').map_or((text, None), |(node, layer)| (node, Some(layer)));
    let Some(index) = find(node) else {
        let shown: String = node.chars().take(SHOWN).collect();
        let names = recipe.nodes().iter().map(|node| node.name.as_str());
        return Err(format!("unknown node `{shown}`; {}", suggestion(node, names)));
    };
    let Some(layer) = layer else { return Ok(LayerRef { node: NodeId::new(index), layer: 0 }) };
    let layers = recipe.nodes()[index].node.layers();
    match layers.iter().position(|known| known.name == layer) {
        Some(layer) => Ok(LayerRef { node: NodeId::new(index), layer }),
        None => {
            let shown: String = layer.chars().take(SHOWN).collect();
            let names = layers.iter().map(|layer| layer.name);
            Err(format!("the node `{node}` has no layer `{shown}`; {}", suggestion(layer, names)))
        }
    }
}

/// Checks a recipe and collects problems.
struct Resolver<'a> {
    recipe: &'a Recipe,
    names: HashMap<&'a str, usize>,
    /// The declarations of ops that are not built in, by their names.
    registered: HashMap<&'static str, &'static Spec>,
    diagnostics: Vec<GraphDiagnostic>,
}

impl<'a> Resolver<'a> {
    fn diagnostic(&mut self, at: At, message: String) {
        self.diagnostics.push(GraphDiagnostic { at, message });
    }

    /// Ends the check if there are too many diagnostics.
    fn enough(&mut self) -> Result<(), Vec<GraphDiagnostic>> {
        match self.diagnostics.len() >= MAX_FAULTS {
            true => Err(std::mem::take(&mut self.diagnostics)),
            false => Ok(()),
        }
    }

    fn check_world(&mut self) {
        let world = self.recipe.world;
        for message in super::world_spec::KEYS.problems("`world`", &world) {
            self.diagnostic(At::World, message);
        }
        let Some([width, height]) = world.size else { return };
        let most = width.max(height) / world.cell;
        if most > MAX_SAMPLES {
            let message = format!(
                "the world would have {most:.0} samples along a side; at most {MAX_SAMPLES:.0} are allowed. Raise `cell`"
            );
            self.diagnostic(At::World, message);
        }
        if width.min(height) < world.cell {
            let message = format!(
                "the world is {width} x {height} m, less than one `cell` of {} m; raise `size` or lower `cell`",
                world.cell
            );
            self.diagnostic(At::World, message);
        }
    }

    /// Checks a single node: its name, its parameters, and whether it is possible in this world.
    fn check_node(&mut self, index: usize) -> Result<(), Vec<GraphDiagnostic>> {
        let named = &self.recipe.nodes()[index];
        let name = named.name.as_str();
        if !is_path(name) {
            self.diagnostic(At::Node(index, String::new()), format!("`{name}` cannot be a node's name: {NAME_RULE}"));
        }
        if self.names.insert(name, index).is_some() {
            self.diagnostic(At::Node(index, String::new()), format!("there are two nodes named `{name}`: rename one"));
        }
        if let Node::Registered(_) = named.node {
            self.check_registered(index, named.node.spec());
        }
        self.check_params(index, &named.node);
        self.check_domain(index, &named.node);
        let needs_bounds = match named.node.op() {
            Op::Solver(_) => Some("looks at the whole world"),
            Op::Field(field) if field.needs_bounds() => Some("needs the edges of the world"),
            _ => None,
        };
        if let (Some(needs), None) = (needs_bounds, self.recipe.world.size) {
            let message = format!(
                "node `{name}`: the op `{}` {needs}, and this world is unbounded; set `size` in `world`, or remove the node",
                named.node.spec().op
            );
            self.diagnostic(At::Node(index, String::new()), message);
        }
        self.enough()
    }

    /// Checks the name of an op, which is part of content keys: no built-in op and no other op may have it.
    fn check_registered(&mut self, index: usize, spec: &'static Spec) {
        let message = match (check_name(spec.op), self.registered.insert(spec.op, spec)) {
            (Err(message), _) => message,
            (Ok(()), Some(other)) if !std::ptr::eq(other, spec) => {
                format!("two different ops are named `{}`; rename one", spec.op)
            }
            _ => return,
        };
        self.diagnostic(At::Node(index, String::new()), message);
    }

    /// Checks values that a program set in the same way as values read from a text.
    fn check_params(&mut self, index: usize, node: &Node) {
        let mut copy = node.clone();
        let mut sound = true;
        for (i, spec) in node.spec().params.iter().enumerate() {
            if let Err(message) = copy.set_param(i, &node.param(i)) {
                sound = false;
                self.diagnostic(At::Node(index, spec.name.to_string()), message);
            }
        }
        if sound && let Err((key, message)) = node.consistent() {
            self.diagnostic(At::Node(index, key.to_string()), message);
        }
    }

    /// Checks the size of a solver's domain, which with a margin may have more samples than the world.
    fn check_domain(&mut self, index: usize, node: &Node) {
        let (Op::Solver(solver), Some([width, height]), Some(margin)) =
            (node.op(), self.recipe.world.size, node.margin())
        else {
            return;
        };
        let cell = solver.cell(self.recipe.world.cell);
        let most = (width.max(height) + 2.0 * margin) / cell;
        if margin > 0.0 && most > MAX_SAMPLES {
            let message = format!(
                "node `{}`: the world and a `margin` of {margin} m would have {most:.0} samples along a side at a cell of {cell} m; at most {MAX_SAMPLES:.0} are allowed. Lower `margin` or raise `cell`",
                self.recipe.nodes()[index].name
            );
            self.diagnostic(At::Node(index, MARGIN.to_string()), message);
        }
    }

    /// The inputs of a node and its mask.
    fn link_node(&mut self, index: usize) -> Result<(Vec<Link>, Link), Vec<GraphDiagnostic>> {
        let named = &self.recipe.nodes()[index];
        let inputs = named.node.inputs();
        let inputs = inputs.iter().enumerate().map(|(i, input)| (input.name, named.node.input(i), input.required));
        let mut links: Vec<Link> = Vec::new();
        for (key, input, required) in inputs.chain([("mask", &named.mask, false)]) {
            links.push(self.link(input, required).unwrap_or_else(|message| {
                self.diagnostic(At::Node(index, key.to_string()), format!("node `{}`, `{key}`: {message}", named.name));
                Link::None
            }));
        }
        self.enough()?;
        let mask = links.pop().unwrap_or(Link::None);
        Ok((links, mask))
    }

    fn link_outputs(&mut self) -> Result<Vec<Link>, Vec<GraphDiagnostic>> {
        let (mut seen, mut links) = (HashSet::new(), Vec::new());
        for (index, (name, input)) in self.recipe.output_inputs().iter().enumerate() {
            if !is_name(name) {
                self.diagnostic(At::Output(index), format!("`{name}` cannot be an output's name: {NAME_RULE}"));
            }
            if !seen.insert(name) {
                self.diagnostic(At::Output(index), format!("two outputs are named `{name}`; rename one"));
            }
            links.push(self.link(input, true).unwrap_or_else(|message| {
                self.diagnostic(At::Output(index), format!("output `{name}`: {message}"));
                Link::None
            }));
            self.enough()?;
        }
        Ok(links)
    }

    /// The target of an input, or a message.
    fn link(&self, input: &Input, required: bool) -> Result<Link, String> {
        match input {
            Input::None if required => Err("it is missing; name the node to read, or set a number".to_string()),
            Input::None => Ok(Link::None),
            Input::Value(value) if value.is_finite() && (*value as f32).is_finite() => Ok(Link::Value(*value as f32)),
            Input::Value(value) => Err(format!("{value} is not a valid sample value")),
            Input::Node(name) => named(self.recipe, name, |node| self.names.get(node).copied()).map(Link::Node),
        }
    }
}
