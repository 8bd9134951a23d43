//! From nodes to a program: the part of the graph that can be evaluated point by point, flattened.
//!
//! A node is evaluated *at a place*: the block itself, or where warps and transforms lead from there. Each (layer, place) pair
//! becomes one instruction, however often it is read. Work is kept on an explicit stack, so a chain of any length is
//! flattened without recursion.

use super::program::{Instruction, Place, Program, Register};
use crate::error::{Error, ErrorKind, Result};
use crate::grid::Window;
use crate::layer::LayerKind;
use crate::op::{Moves, Op, Slopes};
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, Link, Target};
use std::collections::{HashMap, HashSet};

/// Most instructions a program may have. Only warps within warps multiply them.
const MOST_INSTRUCTIONS: usize = 1 << 20;

/// A grid that an earlier step must make: a node's layer over a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// The layer.
    pub target: Target,
    /// What the filter itself made, before its mask; otherwise the node's result.
    pub raw: bool,
    /// The samples needed.
    pub window: Window,
}

/// A program before grids have numbers: `Instruction::Grid` counts the demands.
pub struct Draft {
    pub program: Program,
    pub demands: Vec<Demand>,
    /// Fields and solvers evaluated at the block itself.
    pub evaluated: Vec<usize>,
}

enum Work {
    Visit(Target, Place),
    Enter(Target, Place),
    Surround(Target, Place),
    Emit(Target, Place),
}

pub struct Compiler<'a> {
    recipe: &'a Recipe,
    graph: &'a Graph,
    /// Nodes whose result is read from a grid when asked for at the block itself.
    kept: &'a HashSet<usize>,
    /// The node this program is to make, which must not be read from the grid it makes.
    own: Option<usize>,
    instructions: Vec<Instruction>,
    values: usize,
    made: HashMap<(Target, Place), Register>,
    constants: HashMap<u32, Register>,
    /// The samples around each place, on the lattice that filters are made on.
    windows: Vec<Window>,
    entered: HashMap<(usize, Place), Place>,
    /// The first of the four places around a place, by the bits of how far they are from it.
    surrounded: HashMap<(u64, Place), Place>,
    demands: Vec<Demand>,
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
            demands: Vec::new(),
            evaluated: Vec::new(),
        };
        let mut outputs = Vec::with_capacity(targets.len());
        for link in targets {
            if let Link::Node(target) = link {
                compiler.run(*target)?;
            }
            outputs.push(compiler.value(link, 0));
        }
        let places = compiler.windows.len();
        let program = Program::allocate(compiler.instructions, compiler.values, places, outputs);
        Ok(Draft { program, demands: compiler.demands, evaluated: compiler.evaluated })
    }

    fn run(&mut self, target: Target) -> Result<()> {
        let mut stack = vec![Work::Visit(target, 0)];
        while let Some(work) = stack.pop() {
            if self.instructions.len() > MOST_INSTRUCTIONS {
                let sentence = format!(
                    "this recipe would take more than {MOST_INSTRUCTIONS} evaluations a sample: each warp makes its whole source \
                     anew at its own place, and gullies at five, so warps of warps multiply; bake some of them"
                );
                return Err(Error::new(ErrorKind::Recipe, sentence));
            }
            match work {
                Work::Visit(target, place) => self.visit(target, place, &mut stack),
                Work::Enter(target, place) => self.enter(target, place, &mut stack),
                Work::Surround(target, place) => self.surround(target, place, &mut stack),
                Work::Emit(target, place) => self.emit(target, place),
            }
        }
        Ok(())
    }

    /// Whether the node's result is a grid already when asked for here.
    fn is_kept(&self, node: usize, place: Place) -> bool {
        place == 0 && self.own != Some(node) && self.kept.contains(&node)
    }

    fn visit(&mut self, target: Target, place: Place, stack: &mut Vec<Work>) {
        if self.made.contains_key(&(target, place)) {
            return;
        }
        stack.push(Work::Emit(target, place));
        if self.is_kept(target.node, place) {
            return;
        }
        let node = target.node;
        let links = &self.graph.links[node];
        let mut here: Vec<Link> = Vec::new();
        match self.recipe.nodes()[node].node.op() {
            Op::Field(field) => match field.moves() {
                Some(Moves::Displaced { east, south, .. }) => {
                    stack.push(Work::Enter(target, place));
                    here.extend([links[east], links[south]]);
                }
                Some(Moves::Mapped { .. }) => stack.push(Work::Enter(target, place)),
                None => {
                    if field.slopes().is_some() {
                        stack.push(Work::Surround(target, place));
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
        // Last pushed is first visited: inputs in the order of their declaration.
        for link in here.iter().rev() {
            if let Link::Node(source) = link {
                stack.push(Work::Visit(*source, place));
            }
        }
    }

    /// What shows where a node's mask is 0: its first input. Layers but the first have no counterpart there.
    fn masked_source(&self, target: Target) -> Option<Link> {
        self.graph.links[target.node].first().copied().filter(|link| target.layer == 0 && *link != Link::None)
    }

    /// Makes the place that a moving field reads its source at.
    fn enter(&mut self, target: Target, place: Place, stack: &mut Vec<Work>) {
        let Op::Field(field) = self.recipe.nodes()[target.node].node.op() else { return };
        let Some(moves) = field.moves() else { return };
        let links = &self.graph.links[target.node];
        let source = match moves {
            Moves::Displaced { source, .. } | Moves::Mapped { source, .. } => source,
        };
        let to = match self.entered.get(&(target.node, place)) {
            Some(to) => *to,
            None => {
                let to = self.windows.len();
                let around = self.windows[place];
                match moves {
                    Moves::Displaced { east, south, strength, reach, .. } => {
                        let (east, south) = (self.value(&links[east], place), self.value(&links[south], place));
                        self.windows.push(around.grown((reach / around.cell).ceil() as usize + MARGIN));
                        self.instructions.push(Instruction::Displace { from: place, east, south, strength, reach, to });
                    }
                    Moves::Mapped { map, .. } => {
                        self.windows.push(mapped(&around, &map));
                        self.instructions.push(Instruction::Map { from: place, map, to });
                    }
                }
                self.entered.insert((target.node, place), to);
                to
            }
        };
        if let Link::Node(source) = links[source] {
            stack.push(Work::Visit(source, to));
        }
    }

    /// Makes the four places around one that a field with slopes reads its source at.
    fn surround(&mut self, target: Target, place: Place, stack: &mut Vec<Work>) {
        let Some((slopes, around)) = self.slopes(target.node, place) else { return };
        if let Link::Node(source) = self.graph.links[target.node][slopes.source] {
            stack.extend(around.map(|to| Work::Visit(source, to)));
        }
    }

    /// What a field with slopes reads around a place, and the four places there.
    fn slopes(&mut self, node: usize, place: Place) -> Option<(Slopes, [Place; 4])> {
        let Op::Field(field) = self.recipe.nodes()[node].node.op() else { return None };
        let slopes = field.slopes()?;
        let key = (slopes.step.to_bits(), place);
        let first = match self.surrounded.get(&key) {
            Some(first) => *first,
            None => {
                let first = self.windows.len();
                for map in slopes.maps() {
                    self.instructions.push(Instruction::Map { from: place, map, to: self.windows.len() });
                    self.windows.push(mapped(&self.windows[place], &map));
                }
                self.surrounded.insert(key, first);
                first
            }
        };
        Some((slopes, [0, 1, 2, 3].map(|k| first + k)))
    }

    fn emit(&mut self, target: Target, place: Place) {
        if self.made.contains_key(&(target, place)) {
            return;
        }
        let node = target.node;
        let kind = self.graph.layer_kind(self.recipe, target);
        if self.is_kept(node, place) {
            let out = self.demand(target, false, place, kind);
            self.made.insert((target, place), out);
            return;
        }
        let links = self.graph.links[node].clone();
        let result = match self.recipe.nodes()[node].node.op() {
            Op::Field(field) => match field.moves() {
                Some(Moves::Displaced { source, .. } | Moves::Mapped { source, .. }) => {
                    let to = self.entered.get(&(node, place)).copied().unwrap_or(place);
                    self.value(&links[source], to)
                }
                None => {
                    self.note(node, place);
                    let mut inputs = self.values(&links, place);
                    if let Some((slopes, around)) = self.slopes(node, place) {
                        inputs.extend(around.map(|to| Some(self.value(&links[slopes.source], to))));
                    }
                    let out = self.fresh();
                    self.instructions.push(Instruction::Field { node, place, inputs, out });
                    out
                }
            },
            Op::Solver(solver) => {
                self.note(node, place);
                let inputs = if solver.reads_inputs() { self.values(&links, place) } else { Vec::new() };
                let out = self.fresh();
                self.instructions.push(Instruction::Solved { node, layer: target.layer, kind, place, inputs, out });
                out
            }
            Op::Filter(_) => self.demand(target, true, place, kind),
        };
        let mask = self.graph.masks[node];
        let value = if mask == Link::None {
            result
        } else {
            let source = self.masked_source(target).map(|link| self.value(&link, place));
            let mask = self.value(&mask, place);
            let out = self.fresh();
            self.instructions.push(Instruction::Mask { source, result, mask, out });
            out
        };
        self.made.insert((target, place), value);
    }

    fn demand(&mut self, target: Target, raw: bool, place: Place, kind: LayerKind) -> Register {
        let grid = self.demands.len();
        self.demands.push(Demand { target, raw, window: self.windows[place] });
        let out = self.fresh();
        self.instructions.push(Instruction::Grid { grid, kind, place, out });
        out
    }

    /// Remembers what is evaluated at the block itself: what several programs do so may be better kept.
    fn note(&mut self, node: usize, place: Place) {
        if place == 0 {
            self.evaluated.push(node);
        }
    }

    fn fresh(&mut self) -> Register {
        self.values += 1;
        self.values - 1
    }

    fn values(&mut self, links: &[Link], place: Place) -> Vec<Option<Register>> {
        links.iter().map(|link| (*link != Link::None).then(|| self.value(link, place))).collect()
    }

    /// The register of what a link gives at a place where it has been visited.
    fn value(&mut self, link: &Link, place: Place) -> Register {
        let constant = match link {
            Link::Node(target) => match self.made.get(&(*target, place)) {
                Some(register) => return *register,
                None => 0.0,
            },
            Link::Value(value) => *value,
            Link::None => 0.0,
        };
        match self.constants.get(&constant.to_bits()) {
            Some(register) => *register,
            None => {
                let out = self.fresh();
                self.instructions.push(Instruction::Constant { value: constant, out });
                self.constants.insert(constant.to_bits(), out);
                out
            }
        }
    }
}

/// Samples beyond a position that the interpolating cubic reads.
const MARGIN: usize = 2;

/// The samples around everywhere that a map leads from a window.
fn mapped(window: &Window, map: &crate::op::Affine) -> Window {
    let (right, bottom) = (window.east(window.width), window.south(window.height));
    let corners =
        [(window.east(0), window.south(0)), (right, window.south(0)), (window.east(0), bottom), (right, bottom)]
            .map(|(x, y)| map.apply(x, y));
    let span = |values: [f64; 4]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min) / window.cell;
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) / window.cell;
        // What is farther than any lattice reaches is refused for its memory; here it only must not overflow.
        const FAR: f64 = (1u64 << 60) as f64;
        let start = low.floor().clamp(-FAR, FAR) as i64 - MARGIN as i64;
        let end = high.ceil().clamp(-FAR, FAR) as i64 + MARGIN as i64 + 1;
        (start, (end - start).max(0) as usize)
    };
    let (x, width) = span(corners.map(|corner| corner.0));
    let (y, height) = span(corners.map(|corner| corner.1));
    Window { x, y, width, height, cell: window.cell }
}
