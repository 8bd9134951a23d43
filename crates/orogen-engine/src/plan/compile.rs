//! The compiler from nodes to a program: it flattens the part of the graph that can be evaluated point by point.
//!
//! A node is evaluated *at a coordinate set*: the block itself, or the positions to which warps and transforms lead
//! from there. Each (layer, coordinate set) pair becomes one instruction, however many nodes read it. The traversal
//! uses an explicit stack, so chains of any length need no recursion.

use super::allocate::allocate;
use super::around::samples_around;
use super::coord_sets::CoordSets;
use super::request::{GridRequest, Requests};
use super::resolved::ResolvedRecipe;
use super::space::in_two_parts;
use crate::recipe::graph::{LayerRef, Link};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_ops::ids::{CoordSetId, Id, NodeId, RegisterId, RequestId};
use orogen_ops::layer::LayerKind;
use orogen_ops::op::{CoordMap, Field, Op, Stencil};
use orogen_ops::program::{Instruction, Program};
use std::collections::{HashMap, HashSet};

/// Maximum number of instructions of a program. Only nested warps multiply them.
const MAX_INSTRUCTIONS: usize = 1 << 20;

/// The input of a compilation.
#[derive(Clone, Copy)]
pub struct Scope<'a> {
    pub resolved: &'a ResolvedRecipe,
    /// Nodes whose result is read from a grid at the block itself.
    pub kept: &'a HashSet<NodeId>,
    /// The node that this program computes, which must not be read from the grid that it fills.
    pub own: Option<NodeId>,
}

/// A program whose grids are requests.
pub struct Draft {
    pub program: Program<RequestId>,
    /// Fields and solvers that are evaluated at the block itself.
    pub evaluated: Vec<NodeId>,
}

/// Compiles `targets` for blocks of `window`, and adds the requests for the grids that the program reads.
///
/// # Errors
/// If nested warps lead to more instructions than are allowed.
pub fn compile(scope: Scope, targets: &[Link], window: Window, requests: &mut Requests) -> Result<Draft> {
    let mut compiler = Compiler {
        scope,
        instructions: Vec::new(),
        values: 0,
        made: HashMap::new(),
        constants: HashMap::new(),
        coord_sets: CoordSets::new(window),
        requests,
        evaluated: Vec::new(),
    };
    let mut outputs = Vec::with_capacity(targets.len());
    for link in targets {
        if let Link::Node(target) = link {
            compiler.run(*target)?;
        }
        outputs.push(compiler.value(link, CoordSetId::BLOCK)?);
    }
    let Compiler { instructions, values, coord_sets, evaluated, .. } = compiler;
    let reads_altitude = |node: NodeId| scope.resolved.recipe.nodes()[node.index()].node.reads_altitude();
    let (instructions, once) = in_two_parts(instructions, values, coord_sets.count(), reads_altitude);
    let program = allocate(instructions, once, values, coord_sets.count(), outputs)?;
    Ok(Draft { program, evaluated })
}

enum Work {
    Visit(LayerRef, CoordSetId),
    Enter(LayerRef, CoordSetId),
    Surround(LayerRef, CoordSetId),
    Emit(LayerRef, CoordSetId),
}

pub(super) struct Compiler<'a> {
    scope: Scope<'a>,
    pub(super) instructions: Vec<Instruction<RequestId>>,
    values: usize,
    made: HashMap<(LayerRef, CoordSetId), RegisterId>,
    constants: HashMap<u32, RegisterId>,
    coord_sets: CoordSets,
    requests: &'a mut Requests,
    evaluated: Vec<NodeId>,
}

impl<'a> Compiler<'a> {
    fn run(&mut self, target: LayerRef) -> Result<()> {
        let mut stack = vec![Work::Visit(target, CoordSetId::BLOCK)];
        while let Some(work) = stack.pop() {
            if self.instructions.len() > MAX_INSTRUCTIONS {
                let message = format!(
                    "this recipe would need more than {MAX_INSTRUCTIONS} evaluations per sample. A warp evaluates its source at displaced positions, and gullies at five positions, so nested warps multiply; put a `bake` between them"
                );
                return Err(Error::new(ErrorKind::Recipe, message));
            }
            match work {
                Work::Visit(target, coords) => self.visit(target, coords, &mut stack)?,
                Work::Enter(target, coords) => self.enter(target, coords, &mut stack)?,
                Work::Surround(target, coords) => self.surround(target, coords, &mut stack)?,
                Work::Emit(target, coords) => self.emit(target, coords)?,
            }
        }
        Ok(())
    }

    fn op(&self, node: NodeId) -> Result<Op<'a>> {
        let named = self.scope.resolved.recipe.nodes().get(node.index());
        named.map(|named| named.node.op()).ok_or_else(|| internal("a link leads to no node"))
    }

    fn field(&self, node: NodeId) -> Result<&'a dyn Field> {
        match self.op(node)? {
            Op::Field(field) => Ok(field),
            _ => Err(internal("a node with a coordinate map or a stencil is not a field")),
        }
    }

    /// Whether the node's result is available as a grid here.
    fn is_kept(&self, node: NodeId, coords: CoordSetId) -> bool {
        coords == CoordSetId::BLOCK && self.scope.own != Some(node) && self.scope.kept.contains(&node)
    }

    fn visit(&mut self, target: LayerRef, coords: CoordSetId, stack: &mut Vec<Work>) -> Result<()> {
        if self.made.contains_key(&(target, coords)) {
            return Ok(());
        }
        stack.push(Work::Emit(target, coords));
        if self.is_kept(target.node, coords) {
            return Ok(());
        }
        let node = target.node;
        let graph = &self.scope.resolved.graph;
        let links = &graph.links[node];
        let mut here: Vec<Link> = Vec::new();
        match self.op(node)? {
            Op::Field(field) if self.source_cell(field, coords).is_some() => {}
            Op::Field(field) => match field.coord_map() {
                Some(CoordMap::Displaced { east, south, .. }) => {
                    stack.push(Work::Enter(target, coords));
                    here.extend([input(links, east)?, input(links, south)?]);
                }
                Some(CoordMap::Mapped { .. }) => stack.push(Work::Enter(target, coords)),
                None => {
                    if field.stencil().is_some() {
                        stack.push(Work::Surround(target, coords));
                    }
                    here.extend(links);
                }
            },
            Op::Solver(solver) if solver.reads_inputs() => here.extend(links),
            Op::Solver(_) | Op::Filter(_) | Op::Levelled(_) => {}
        }
        if graph.masks[node] != Link::None {
            here.extend(self.masked_source(target));
            here.push(graph.masks[node]);
        }
        // The last one pushed is visited first: inputs are in the order of their declaration.
        for link in here.iter().rev() {
            if let Link::Node(source) = link {
                stack.push(Work::Visit(*source, coords));
            }
        }
        Ok(())
    }

    /// The layer that replaces a node's result where its mask is 0: its first input. Layers other than the first have
    /// none.
    fn masked_source(&self, target: LayerRef) -> Option<Link> {
        let first = self.scope.resolved.graph.links[target.node].first().copied();
        first.filter(|link| target.layer == 0 && *link != Link::None)
    }

    /// Makes the coordinate set at which a field with a coordinate map reads its source.
    fn enter(&mut self, target: LayerRef, coords: CoordSetId, stack: &mut Vec<Work>) -> Result<()> {
        let map = self.field(target.node)?.coord_map().ok_or_else(|| internal("a field has no coordinate map"))?;
        let links = &self.scope.resolved.graph.links[target.node];
        let source = match map {
            CoordMap::Displaced { source, .. } | CoordMap::Mapped { source, .. } => input(links, source)?,
        };
        let to = match self.coord_sets.entered(target.node, coords) {
            Some(to) => to,
            None => match map {
                CoordMap::Displaced { east, south, strength, reach, .. } => {
                    let east = self.value(&input(links, east)?, coords)?;
                    let south = self.value(&input(links, south)?, coords)?;
                    let to = self.coord_sets.enter(target.node, coords, &map);
                    self.instructions.push(Instruction::Displace { from: coords, east, south, strength, reach, to });
                    to
                }
                CoordMap::Mapped { map: affine, .. } => {
                    let to = self.coord_sets.enter(target.node, coords, &map);
                    self.instructions.push(Instruction::Map { from: coords, map: affine, to });
                    to
                }
            },
        };
        if let Link::Node(source) = source {
            stack.push(Work::Visit(source, to));
        }
        Ok(())
    }

    /// Makes the four coordinate sets at which a field with a stencil reads its source.
    fn surround(&mut self, target: LayerRef, coords: CoordSetId, stack: &mut Vec<Work>) -> Result<()> {
        let stencil = self.field(target.node)?.stencil().ok_or_else(|| internal("a field has no stencil"))?;
        let around = self.around(&stencil, coords);
        if let Link::Node(source) = input(&self.scope.resolved.graph.links[target.node], stencil.source)? {
            stack.extend(around.map(|to| Work::Visit(source, to)));
        }
        Ok(())
    }

    fn around(&mut self, stencil: &Stencil, coords: CoordSetId) -> [CoordSetId; 4] {
        self.coord_sets.around(stencil, coords, |instruction| self.instructions.push(instruction))
    }

    fn emit(&mut self, target: LayerRef, coords: CoordSetId) -> Result<()> {
        if self.made.contains_key(&(target, coords)) {
            return Ok(());
        }
        let ResolvedRecipe { recipe, graph, .. } = self.scope.resolved;
        let node = target.node;
        let kind = graph.layer_kind(recipe, target);
        if self.is_kept(node, coords) {
            let out =
                self.request(GridRequest { target, raw: false, window: self.coord_sets.window(coords) }, coords, kind);
            self.made.insert((target, coords), out);
            return Ok(());
        }
        let links = &graph.links[node];
        let result = match self.op(node)? {
            Op::Field(field) => match self.source_cell(field, coords) {
                Some(cell) => self.interpolate(&input(links, 0)?, cell, coords, kind)?,
                None => self.emit_field(field, target, links, coords)?,
            },
            Op::Solver(solver) => {
                self.note(node, coords);
                let inputs = if solver.reads_inputs() { self.values(links, coords)? } else { Vec::new() };
                let out = self.fresh();
                self.instructions.push(Instruction::Solved { node, layer: target.layer, kind, coords, inputs, out });
                out
            }
            Op::Filter(_) | Op::Levelled(_) => {
                self.request(GridRequest { target, raw: true, window: self.coord_sets.window(coords) }, coords, kind)
            }
        };
        let mask = graph.masks[node];
        let value = if mask == Link::None {
            result
        } else {
            let source = self.masked_source(target).map(|link| self.value(&link, coords)).transpose()?;
            let mask = self.value(&mask, coords)?;
            let out = self.fresh();
            self.instructions.push(Instruction::Mask { source, result, mask, out });
            out
        };
        self.made.insert((target, coords), value);
        Ok(())
    }

    fn emit_field(
        &mut self,
        field: &dyn Field,
        target: LayerRef,
        links: &[Link],
        coords: CoordSetId,
    ) -> Result<RegisterId> {
        let LayerRef { node, layer } = target;
        if let Some(CoordMap::Displaced { source, .. } | CoordMap::Mapped { source, .. }) = field.coord_map() {
            let to = self.coord_sets.entered(node, coords);
            return self.value(&input(links, source)?, to.ok_or_else(|| internal("a coordinate map was not planned"))?);
        }
        self.note(node, coords);
        if let Some(terms) = field.terms() {
            return self.evaluate(&terms, links, coords);
        }
        let mut inputs = self.values(links, coords)?;
        if let Some(stencil) = field.stencil() {
            let source = input(links, stencil.source)?;
            for to in self.around(&stencil, coords) {
                inputs.push(Some(self.value(&source, to)?));
            }
        }
        let out = self.fresh();
        self.instructions.push(Instruction::Field { node, layer, coords, inputs, out });
        Ok(out)
    }

    /// The cell at which the source of an interpolating field is computed, for a coordinate set.
    fn source_cell(&self, field: &dyn Field, coords: CoordSetId) -> Option<f64> {
        field.source_cell(self.coord_sets.window(coords).cell, self.scope.resolved.recipe.world.cell)
    }

    /// Interpolates a source between its samples with this cell.
    fn interpolate(&mut self, source: &Link, cell: f64, coords: CoordSetId, kind: LayerKind) -> Result<RegisterId> {
        let Link::Node(target) = source else { return self.value(source, coords) };
        let window = samples_around(&self.coord_sets.window(coords), cell);
        Ok(self.request(GridRequest::of(self.scope.resolved, *target, window), coords, kind))
    }

    fn request(&mut self, request: GridRequest, coords: CoordSetId, kind: LayerKind) -> RegisterId {
        let grid = self.requests.add(request);
        let out = self.fresh();
        self.instructions.push(Instruction::Grid { grid, kind, coords, out });
        out
    }

    /// Records a node that is evaluated at the block itself: if several programs evaluate it, keeping its grid may be
    /// better.
    fn note(&mut self, node: NodeId, coords: CoordSetId) {
        if coords == CoordSetId::BLOCK {
            self.evaluated.push(node);
        }
    }

    pub(super) fn fresh(&mut self) -> RegisterId {
        self.values += 1;
        RegisterId::new(self.values - 1)
    }

    fn values(&mut self, links: &[Link], coords: CoordSetId) -> Result<Vec<Option<RegisterId>>> {
        links.iter().map(|link| (*link != Link::None).then(|| self.value(link, coords)).transpose()).collect()
    }

    /// The register with the value of a link at a coordinate set that has been visited.
    pub(super) fn value(&mut self, link: &Link, coords: CoordSetId) -> Result<RegisterId> {
        match link {
            Link::Node(target) => self
                .made
                .get(&(*target, coords))
                .copied()
                .ok_or_else(|| internal("a node was read before it was planned")),
            Link::Value(value) => Ok(self.constant(*value)),
            Link::None => Err(internal("an input that is not given was read")),
        }
    }

    /// The register with a constant.
    pub(super) fn constant(&mut self, value: f32) -> RegisterId {
        if let Some(register) = self.constants.get(&value.to_bits()) {
            return *register;
        }
        let out = self.fresh();
        self.instructions.push(Instruction::Constant { value, out });
        self.constants.insert(value.to_bits(), out);
        out
    }
}

/// Input `i` of a node.
fn input(links: &[Link], i: usize) -> Result<Link> {
    links.get(i).copied().ok_or_else(|| internal("a field reads an input that it does not declare"))
}

pub(super) fn internal(message: &str) -> Error {
    Error::new(ErrorKind::Internal, message)
}
