//! The compiler from nodes to a program: it flattens the part of the graph that can be evaluated point by point.
//!
//! A node is evaluated *at a coordinate set*: the block itself, or the positions to which warps and transforms lead
//! from there. Each (layer, coordinate set) pair becomes one instruction, however many nodes read it. The traversal
//! uses an explicit stack, so chains of any length need no recursion.

use super::program::{CoordSet, Instruction, Operand, Program, Register};
use crate::expression::function::{Function, MAX_ARGUMENTS};
use crate::expression::term::Term;
use crate::layer::LayerKind;
use crate::op::{CoordMap, Op, Stencil};
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, LayerRef, Link};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use std::collections::{HashMap, HashSet};

/// Maximum number of instructions of a program. Only nested warps multiply them.
const MAX_INSTRUCTIONS: usize = 1 << 20;

/// A request for a grid that an earlier step must make: a node's layer over a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridRequest {
    /// The layer.
    pub target: LayerRef,
    /// Whether the filter's own result is requested, before its mask; otherwise the node's result.
    pub raw: bool,
    /// The window.
    pub window: Window,
}

/// A program whose `Instruction::Grid` refers to requests instead of grids.
pub struct Draft {
    pub program: Program,
    pub requests: Vec<GridRequest>,
    /// Fields and solvers that are evaluated at the block itself.
    pub evaluated: Vec<usize>,
}

enum Work {
    Visit(LayerRef, CoordSet),
    Enter(LayerRef, CoordSet),
    Surround(LayerRef, CoordSet),
    Emit(LayerRef, CoordSet),
}

pub struct Compiler<'a> {
    recipe: &'a Recipe,
    graph: &'a Graph,
    /// Nodes whose result is read from a grid at the block itself.
    kept: &'a HashSet<usize>,
    /// The node that this program computes, which must not be read from the grid that it fills.
    own: Option<usize>,
    instructions: Vec<Instruction>,
    values: usize,
    made: HashMap<(LayerRef, CoordSet), Register>,
    constants: HashMap<u32, Register>,
    /// The samples around each coordinate set, on the lattice of filters.
    windows: Vec<Window>,
    entered: HashMap<(usize, CoordSet), CoordSet>,
    /// The first of the four coordinate sets around a coordinate set, by the bits of their distance.
    surrounded: HashMap<(u64, CoordSet), CoordSet>,
    requests: Vec<GridRequest>,
    evaluated: Vec<usize>,
}

impl<'a> Compiler<'a> {
    /// Compiles `targets` for blocks of `window`.
    pub fn compile(
        recipe: &'a Recipe,
        graph: &'a Graph,
        kept: &'a HashSet<usize>,
        own: Option<usize>,
        targets: &[Link],
        window: Window,
    ) -> Result<Draft> {
        let mut compiler = Compiler {
            recipe,
            graph,
            kept,
            own,
            instructions: Vec::new(),
            values: 0,
            made: HashMap::new(),
            constants: HashMap::new(),
            windows: vec![window],
            entered: HashMap::new(),
            surrounded: HashMap::new(),
            requests: Vec::new(),
            evaluated: Vec::new(),
        };
        let mut outputs = Vec::with_capacity(targets.len());
        for link in targets {
            if let Link::Node(target) = link {
                compiler.run(*target)?;
            }
            outputs.push(compiler.value(link, 0)?);
        }
        let coord_sets = compiler.windows.len();
        let program = Program::allocate(compiler.instructions, compiler.values, coord_sets, outputs);
        Ok(Draft { program, requests: compiler.requests, evaluated: compiler.evaluated })
    }

    fn run(&mut self, target: LayerRef) -> Result<()> {
        let mut stack = vec![Work::Visit(target, 0)];
        while let Some(work) = stack.pop() {
            if self.instructions.len() > MAX_INSTRUCTIONS {
                let message = format!(
                    "this recipe would need more than {MAX_INSTRUCTIONS} evaluations per sample. A warp evaluates its source at displaced positions, and gullies at five positions, so nested warps multiply; put a `bake` between them"
                );
                return Err(Error::new(ErrorKind::Recipe, message));
            }
            match work {
                Work::Visit(target, coords) => self.visit(target, coords, &mut stack),
                Work::Enter(target, coords) => self.enter(target, coords, &mut stack)?,
                Work::Surround(target, coords) => self.surround(target, coords, &mut stack),
                Work::Emit(target, coords) => self.emit(target, coords)?,
            }
        }
        Ok(())
    }

    /// Whether the node's result is available as a grid here.
    fn is_kept(&self, node: usize, coords: CoordSet) -> bool {
        coords == 0 && self.own != Some(node) && self.kept.contains(&node)
    }

    fn visit(&mut self, target: LayerRef, coords: CoordSet, stack: &mut Vec<Work>) {
        if self.made.contains_key(&(target, coords)) {
            return;
        }
        stack.push(Work::Emit(target, coords));
        if self.is_kept(target.node, coords) {
            return;
        }
        let node = target.node;
        let links = &self.graph.links[node];
        let mut here: Vec<Link> = Vec::new();
        match self.recipe.nodes()[node].node.op() {
            Op::Field(field) => match field.coord_map() {
                Some(CoordMap::Displaced { east, south, .. }) => {
                    stack.push(Work::Enter(target, coords));
                    here.extend([links[east], links[south]]);
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
            Op::Solver(_) | Op::Filter(_) => {}
        }
        if self.graph.masks[node] != Link::None {
            here.extend(self.masked_source(target));
            here.push(self.graph.masks[node]);
        }
        // The last one pushed is visited first: inputs are in the order of their declaration.
        for link in here.iter().rev() {
            if let Link::Node(source) = link {
                stack.push(Work::Visit(*source, coords));
            }
        }
    }

    /// The layer that replaces a node's result where its mask is 0: its first input. Layers other than the first have
    /// none.
    fn masked_source(&self, target: LayerRef) -> Option<Link> {
        self.graph.links[target.node].first().copied().filter(|link| target.layer == 0 && *link != Link::None)
    }

    /// Makes the coordinate set at which a field with a coordinate map reads its source.
    fn enter(&mut self, target: LayerRef, coords: CoordSet, stack: &mut Vec<Work>) -> Result<()> {
        let Op::Field(field) = self.recipe.nodes()[target.node].node.op() else { return Ok(()) };
        let Some(map) = field.coord_map() else { return Ok(()) };
        let links = &self.graph.links[target.node];
        let source = match map {
            CoordMap::Displaced { source, .. } | CoordMap::Mapped { source, .. } => source,
        };
        let to = match self.entered.get(&(target.node, coords)) {
            Some(to) => *to,
            None => {
                let to = self.windows.len();
                let around = self.windows[coords];
                match map {
                    CoordMap::Displaced { east, south, strength, reach, .. } => {
                        let (east, south) = (self.value(&links[east], coords)?, self.value(&links[south], coords)?);
                        self.windows.push(around.grown((reach / around.cell).ceil() as usize + MARGIN));
                        self.instructions.push(Instruction::Displace {
                            from: coords,
                            east,
                            south,
                            strength,
                            reach,
                            to,
                        });
                    }
                    CoordMap::Mapped { map, .. } => {
                        self.windows.push(mapped(&around, &map));
                        self.instructions.push(Instruction::Map { from: coords, map, to });
                    }
                }
                self.entered.insert((target.node, coords), to);
                to
            }
        };
        if let Link::Node(source) = links[source] {
            stack.push(Work::Visit(source, to));
        }
        Ok(())
    }

    /// Makes the four coordinate sets at which a field with a stencil reads its source.
    fn surround(&mut self, target: LayerRef, coords: CoordSet, stack: &mut Vec<Work>) {
        let Some((stencil, around)) = self.stencil(target.node, coords) else { return };
        if let Link::Node(source) = self.graph.links[target.node][stencil.source] {
            stack.extend(around.map(|to| Work::Visit(source, to)));
        }
    }

    /// The stencil of a field at a coordinate set, and the four coordinate sets around it.
    fn stencil(&mut self, node: usize, coords: CoordSet) -> Option<(Stencil, [CoordSet; 4])> {
        let Op::Field(field) = self.recipe.nodes()[node].node.op() else { return None };
        let stencil = field.stencil()?;
        let key = (stencil.step.to_bits(), coords);
        let first = match self.surrounded.get(&key) {
            Some(first) => *first,
            None => {
                let first = self.windows.len();
                for map in stencil.maps() {
                    self.instructions.push(Instruction::Map { from: coords, map, to: self.windows.len() });
                    self.windows.push(mapped(&self.windows[coords], &map));
                }
                self.surrounded.insert(key, first);
                first
            }
        };
        Some((stencil, [0, 1, 2, 3].map(|k| first + k)))
    }

    fn emit(&mut self, target: LayerRef, coords: CoordSet) -> Result<()> {
        if self.made.contains_key(&(target, coords)) {
            return Ok(());
        }
        let node = target.node;
        let kind = self.graph.layer_kind(self.recipe, target);
        if self.is_kept(node, coords) {
            let out = self.request(target, false, coords, kind);
            self.made.insert((target, coords), out);
            return Ok(());
        }
        let links = self.graph.links[node].clone();
        let result = match self.recipe.nodes()[node].node.op() {
            Op::Field(field) => match field.coord_map() {
                Some(CoordMap::Displaced { source, .. } | CoordMap::Mapped { source, .. }) => {
                    let to = self.entered.get(&(node, coords)).copied();
                    self.value(&links[source], to.ok_or_else(|| internal("a coordinate map was not planned"))?)?
                }
                None if let Some(terms) = field.terms() => {
                    self.note(node, coords);
                    self.evaluate(&terms, &links, coords)?
                }
                None => {
                    self.note(node, coords);
                    let mut inputs = self.values(&links, coords)?;
                    if let Some((stencil, around)) = self.stencil(node, coords) {
                        for to in around {
                            inputs.push(Some(self.value(&links[stencil.source], to)?));
                        }
                    }
                    let out = self.fresh();
                    self.instructions.push(Instruction::Field { node, coords, inputs, out });
                    out
                }
            },
            Op::Solver(solver) => {
                self.note(node, coords);
                let inputs = if solver.reads_inputs() { self.values(&links, coords)? } else { Vec::new() };
                let out = self.fresh();
                self.instructions.push(Instruction::Solved { node, layer: target.layer, kind, coords, inputs, out });
                out
            }
            Op::Filter(_) => self.request(target, true, coords, kind),
        };
        let mask = self.graph.masks[node];
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

    fn request(&mut self, target: LayerRef, raw: bool, coords: CoordSet, kind: LayerKind) -> Register {
        let grid = self.requests.len();
        self.requests.push(GridRequest { target, raw, window: self.windows[coords] });
        let out = self.fresh();
        self.instructions.push(Instruction::Grid { grid, kind, coords, out });
        out
    }

    /// Emits the arithmetic of a field. Constant terms are folded.
    fn evaluate(&mut self, terms: &[Term], links: &[Link], coords: CoordSet) -> Result<Register> {
        let mut used = vec![false; terms.len()];
        if let Some(last) = used.last_mut() {
            *last = true;
        }
        for (at, term) in terms.iter().enumerate().rev() {
            if let (true, Term::Apply(function, arguments)) = (used[at], term) {
                arguments[..function.arity()].iter().for_each(|argument| used[*argument] = true);
            }
        }
        let mut made: Vec<Operand> = Vec::with_capacity(terms.len());
        for (term, used) in terms.iter().zip(used) {
            let operand = match term {
                _ if !used => Operand::Number(0.0),
                Term::Number(number) => Operand::Number(*number as f32),
                Term::Name(name) => match links.get(*name) {
                    Some(Link::Value(value)) => Operand::Number(*value),
                    Some(link @ Link::Node(_)) => Operand::Register(self.value(link, coords)?),
                    Some(Link::None) | None => Operand::Number(0.0),
                },
                Term::Apply(function, arguments) => {
                    let arguments = arguments[..function.arity()].iter().map(|argument| made[*argument]).collect();
                    self.apply(*function, arguments)
                }
            };
            made.push(operand);
        }
        match made.last() {
            Some(Operand::Register(register)) => Ok(*register),
            Some(Operand::Number(number)) => self.value(&Link::Value(*number), coords),
            None => self.value(&Link::None, coords),
        }
    }

    /// A function of operands; of constants only, a constant.
    fn apply(&mut self, function: Function, arguments: Vec<Operand>) -> Operand {
        let mut numbers = [0.0; MAX_ARGUMENTS];
        for (number, argument) in numbers.iter_mut().zip(&arguments) {
            let Operand::Number(value) = argument else {
                let out = self.fresh();
                self.instructions.push(Instruction::Apply { function, arguments, out });
                return Operand::Register(out);
            };
            *number = *value;
        }
        Operand::Number(function.of_f32(numbers))
    }

    /// Records a node that is evaluated at the block itself: if several programs evaluate it, keeping its grid may be
    /// better.
    fn note(&mut self, node: usize, coords: CoordSet) {
        if coords == 0 {
            self.evaluated.push(node);
        }
    }

    fn fresh(&mut self) -> Register {
        self.values += 1;
        self.values - 1
    }

    fn values(&mut self, links: &[Link], coords: CoordSet) -> Result<Vec<Option<Register>>> {
        links.iter().map(|link| (*link != Link::None).then(|| self.value(link, coords)).transpose()).collect()
    }

    /// The register with the value of a link at a coordinate set that has been visited.
    fn value(&mut self, link: &Link, coords: CoordSet) -> Result<Register> {
        let constant = match link {
            Link::Node(target) => match self.made.get(&(*target, coords)) {
                Some(register) => return Ok(*register),
                None => return Err(internal("a node was read before it was planned")),
            },
            Link::Value(value) => *value,
            Link::None => 0.0,
        };
        Ok(match self.constants.get(&constant.to_bits()) {
            Some(register) => *register,
            None => {
                let out = self.fresh();
                self.instructions.push(Instruction::Constant { value: constant, out });
                self.constants.insert(constant.to_bits(), out);
                out
            }
        })
    }
}

fn internal(message: &str) -> Error {
    Error::new(ErrorKind::Internal, message)
}

/// Samples that the interpolating cubic reads around a position.
const MARGIN: usize = 2;

/// The samples around all positions that a map leads to from a window.
fn mapped(window: &Window, map: &crate::op::Affine) -> Window {
    let (right, bottom) = (window.east(window.width), window.south(window.height));
    let corners =
        [(window.east(0), window.south(0)), (right, window.south(0)), (window.east(0), bottom), (right, bottom)]
            .map(|(x, y)| map.apply(x, y));
    let span = |values: [f64; 4]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min) / window.cell;
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) / window.cell;
        // Positions beyond any lattice are rejected later for their memory; here they must only not overflow.
        const FAR: f64 = (1u64 << 60) as f64;
        let start = low.floor().clamp(-FAR, FAR) as i64 - MARGIN as i64;
        let end = high.ceil().clamp(-FAR, FAR) as i64 + MARGIN as i64 + 1;
        (start, (end - start).max(0) as usize)
    };
    let (x, width) = span(corners.map(|corner| corner.0));
    let (y, height) = span(corners.map(|corner| corner.1));
    Window { x, y, width, height, cell: window.cell }
}
