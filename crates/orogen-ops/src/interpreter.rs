//! The interpreter of programs over a block of samples.

use crate::expression::function::{Argument, MAX_ARGUMENTS};
use crate::ids::{CoordSetId, GridId, IndexVec, NodeId, RegisterId};
use crate::layer::LayerKind;
use crate::op::{Evaluator, Field, Inputs, Reading, Solution, Solver, WorldParams};
use crate::program::{Instruction, Operand, Program};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample::{self, NOWHERE};
use orogen_noise::Points;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The data that a program's instructions refer to.
pub struct Bindings<'a> {
    pub world_params: &'a WorldParams,
    pub evaluators: &'a Evaluators,
    pub fields: &'a (dyn Fn(NodeId) -> Option<&'a dyn Field> + Sync),
    pub solvers: &'a (dyn Fn(NodeId) -> Option<(&'a dyn Solver, Arc<Solution>)> + Sync),
    pub grids: &'a (dyn Fn(GridId) -> Option<&'a Grid> + Sync),
}

/// The fields of a program, prepared for many blocks.
#[derive(Default)]
pub struct Evaluators(BTreeMap<NodeId, Evaluator>);

impl Evaluators {
    /// Prepares the fields of a program.
    pub fn new<'a>(
        program: &Program,
        world_params: &WorldParams,
        field: impl Fn(NodeId) -> Option<&'a dyn Field>,
    ) -> Evaluators {
        let nodes = program.instructions.iter().filter_map(|instruction| match instruction {
            Instruction::Field { node, .. } => Some(*node),
            _ => None,
        });
        let nodes: BTreeSet<NodeId> = nodes.collect();
        Evaluators(nodes.into_iter().filter_map(|node| Some((node, field(node)?.prepare(world_params)?))).collect())
    }
}

/// The representation of a coordinate set.
#[derive(Clone, Copy, Default, PartialEq)]
enum Shape {
    #[default]
    Lattice,
    Displaced,
    Scattered,
}

#[derive(Default)]
struct CoordSet {
    shape: Shape,
    x: Vec<f64>,
    y: Vec<f64>,
    dx: Vec<f32>,
    dy: Vec<f32>,
    /// The altitude in metres; `None` for the altitude of the samples.
    altitude: Option<f64>,
}

impl CoordSet {
    fn points(&self) -> Points<'_> {
        match self.shape {
            Shape::Lattice => Points::Lattice { xs: &self.x, ys: &self.y },
            Shape::Displaced => Points::Displaced { xs: &self.x, ys: &self.y, dx: &self.dx, dy: &self.dy },
            Shape::Scattered => Points::Scattered { x: &self.x, y: &self.y },
        }
    }
}

/// Registers and coordinate sets that can be passed to the next interpreter to avoid allocation.
#[derive(Default)]
pub struct Buffers {
    registers: IndexVec<RegisterId, Vec<f32>>,
    coord_sets: IndexVec<CoordSetId, CoordSet>,
}

/// An interpreter, which reuses registers and coordinate sets from block to block.
pub struct Interpreter<'p> {
    program: &'p Program,
    registers: IndexVec<RegisterId, Vec<f32>>,
    coord_sets: IndexVec<CoordSetId, CoordSet>,
    /// The altitude of the samples, in metres.
    altitude: f64,
}

impl<'p> Interpreter<'p> {
    /// An interpreter for a program.
    #[must_use]
    pub fn new(program: &'p Program) -> Interpreter<'p> {
        Interpreter::with(program, Buffers::default())
    }

    /// An interpreter for a program that reuses the buffers of another one.
    pub fn with(program: &'p Program, buffers: Buffers) -> Interpreter<'p> {
        let Buffers { mut registers, mut coord_sets } = buffers;
        registers.resize_with(program.registers, Vec::new);
        coord_sets.resize_with(program.coord_sets.max(1), CoordSet::default);
        Interpreter { program, registers, coord_sets, altitude: 0.0 }
    }

    /// The buffers, for the next interpreter.
    #[must_use]
    pub fn into_buffers(self) -> Buffers {
        Buffers { registers: self.registers, coord_sets: self.coord_sets }
    }

    /// Runs the program over a block of the lattice, in the plane.
    pub fn run_block(&mut self, block: &Window, bindings: &Bindings) -> Result<()> {
        self.enter_block(block);
        self.run(Some(block), block.len(), bindings)
    }

    /// Runs the program over a block of the lattice at each altitude, and passes the first output to `visit` with the
    /// altitude's index. Instructions that do not depend on the altitude run once.
    pub fn run_block_at(
        &mut self,
        block: &Window,
        altitudes: &[f64],
        bindings: &Bindings,
        mut visit: impl FnMut(usize, &[f32]),
    ) -> Result<()> {
        self.enter_block(block);
        let (once, repeated) = self.program.instructions.split_at(self.program.once);
        self.prepare(block.len());
        self.steps(once, Some(block), block.len(), bindings)?;
        for (k, altitude) in altitudes.iter().enumerate() {
            self.altitude = *altitude;
            self.steps(repeated, Some(block), block.len(), bindings)?;
            visit(k, self.output(0));
        }
        Ok(())
    }

    /// Makes the block's coordinate set.
    fn enter_block(&mut self, block: &Window) {
        let coords = &mut self.coord_sets[CoordSetId::BLOCK];
        coords.shape = Shape::Lattice;
        coords.altitude = None;
        coords.x.clear();
        coords.x.extend((0..block.width).map(|i| block.east(i)));
        coords.y.clear();
        coords.y.extend((0..block.height).map(|j| block.south(j)));
    }

    /// Runs the program at arbitrary points, in the plane.
    pub fn run_points(&mut self, x: &[f64], y: &[f64], bindings: &Bindings) -> Result<()> {
        let coords = &mut self.coord_sets[CoordSetId::BLOCK];
        coords.shape = Shape::Scattered;
        coords.altitude = None;
        coords.x.clear();
        coords.x.extend_from_slice(x);
        coords.y.clear();
        coords.y.extend_from_slice(y);
        self.run(None, x.len().min(y.len()), bindings)
    }

    /// Output `i` of the last run.
    #[must_use]
    pub fn output(&self, i: usize) -> &[f32] {
        &self.registers[self.program.outputs[i]]
    }

    fn run(&mut self, block: Option<&Window>, count: usize, bindings: &Bindings) -> Result<()> {
        self.altitude = 0.0;
        self.prepare(count);
        self.steps(&self.program.instructions, block, count, bindings)
    }

    /// Gives the registers their length.
    fn prepare(&mut self, count: usize) {
        for register in self.registers.iter_mut() {
            register.resize(count, 0.0);
        }
    }

    fn steps(
        &mut self,
        instructions: &[Instruction],
        block: Option<&Window>,
        count: usize,
        bindings: &Bindings,
    ) -> Result<()> {
        instructions.iter().try_for_each(|instruction| self.step(instruction, block, count, bindings))
    }

    fn step(
        &mut self,
        instruction: &Instruction,
        block: Option<&Window>,
        count: usize,
        bindings: &Bindings,
    ) -> Result<()> {
        match instruction {
            Instruction::Constant { value, out } => self.registers[*out].fill(*value),
            Instruction::Field { node, layer, coords, inputs, out } => {
                let field = (bindings.fields)(*node).ok_or_else(|| internal("a node to evaluate is not a field"))?;
                let altitude = self.coord_sets[*coords].altitude.unwrap_or(self.altitude);
                self.with_inputs(*coords, inputs, *out, |points, slots, out| {
                    let inputs = Inputs::new(field.spec(), slots).with_altitude(altitude);
                    match bindings.evaluators.0.get(node) {
                        Some(evaluate) => evaluate(points, &inputs, out),
                        None => field.eval_layer(*layer, points, &inputs, bindings.world_params, out),
                    }
                })?;
            }
            Instruction::Apply { function, arguments, out } => {
                let mut samples = std::mem::take(&mut self.registers[*out]);
                let mut given = [Argument::Number(0.0); MAX_ARGUMENTS];
                for (given, argument) in given.iter_mut().zip(arguments) {
                    *given = match argument {
                        Operand::Number(number) => Argument::Number(*number),
                        Operand::Register(register) => Argument::Samples(&self.registers[*register]),
                    };
                }
                function.apply(&given[..arguments.len().min(MAX_ARGUMENTS)], &mut samples);
                self.registers[*out] = samples;
            }
            Instruction::Solved { node, layer, kind, coords, inputs, out } => {
                let solved = (bindings.solvers)(*node);
                let (solver, solution) = solved.ok_or_else(|| internal("a solver was read before it was solved"))?;
                self.with_inputs(*coords, inputs, *out, |at, slots, out| {
                    let inputs = Inputs::new(solver.spec(), slots);
                    solver.read(&solution, &Reading { layer: *layer, kind: *kind, at, inputs: &inputs }, out)
                })?;
            }
            Instruction::Grid { grid, kind, coords, out } => {
                let grid = (bindings.grids)(*grid);
                let grid = grid.ok_or_else(|| internal("a grid was read before it was made"))?;
                // Only the block itself is on the lattice of the grid.
                let block = block.filter(|_| *coords == CoordSetId::BLOCK);
                let mut samples = std::mem::take(&mut self.registers[*out]);
                copy_or_read(grid, *kind, block, &self.coord_sets[*coords].points(), &mut samples);
                self.registers[*out] = samples;
            }
            Instruction::Mask { source, result, mask, out } => {
                let mut samples = std::mem::take(&mut self.registers[*out]);
                let (result, mask) = (&self.registers[*result], &self.registers[*mask]);
                match source {
                    Some(source) => {
                        let source = &self.registers[*source];
                        for (((sample, s), r), m) in samples.iter_mut().zip(source).zip(result).zip(mask) {
                            *sample = s + (r - s) * m.clamp(0.0, 1.0);
                        }
                    }
                    None => {
                        for ((sample, r), m) in samples.iter_mut().zip(result).zip(mask) {
                            *sample = r * m.clamp(0.0, 1.0);
                        }
                    }
                }
                self.registers[*out] = samples;
            }
            Instruction::Displace { from, east, south, strength, reach, to } => {
                let mut moved = std::mem::take(&mut self.coord_sets[*to]);
                let metres = |input: f32| {
                    // A displacement that is NaN does not move the position; the source then decides the result.
                    let metres = (f64::from(input) * strength).clamp(-reach, *reach) as f32;
                    if metres.is_nan() { 0.0 } else { metres }
                };
                let (east, south) = (&self.registers[*east], &self.registers[*south]);
                displace(&self.coord_sets[*from], count, |k| (metres(east[k]), metres(south[k])), &mut moved);
                self.coord_sets[*to] = moved;
            }
            Instruction::Map { from, map, to } => {
                let mut mapped = std::mem::take(&mut self.coord_sets[*to]);
                let from = &self.coord_sets[*from];
                mapped.altitude = map.altitude.or(from.altitude);
                mapped.x.clear();
                mapped.y.clear();
                if from.shape == Shape::Lattice && map.is_separable() {
                    mapped.shape = Shape::Lattice;
                    mapped.x.extend(from.x.iter().map(|x| map.apply(*x, 0.0).0));
                    mapped.y.extend(from.y.iter().map(|y| map.apply(0.0, *y).1));
                } else {
                    mapped.shape = Shape::Scattered;
                    let points = from.points();
                    for k in 0..count {
                        let (x, y) = points.position(k).unwrap_or(NOWHERE);
                        let (x, y) = map.apply(x, y);
                        mapped.x.push(x);
                        mapped.y.push(y);
                    }
                }
                self.coord_sets[*to] = mapped;
            }
        }
        Ok(())
    }

    /// Lends the inputs and takes the output out during an op, so that both can be borrowed at once.
    fn with_inputs<T>(
        &mut self,
        coords: CoordSetId,
        inputs: &[Option<RegisterId>],
        out: RegisterId,
        work: impl FnOnce(&Points, &[Option<&[f32]>], &mut [f32]) -> T,
    ) -> T {
        let mut samples = std::mem::take(&mut self.registers[out]);
        const FEW: usize = 8;
        let mut few: [Option<&[f32]>; FEW] = [None; FEW];
        let many: Vec<Option<&[f32]>>;
        let slots = if inputs.len() <= FEW {
            for (slot, input) in few.iter_mut().zip(inputs) {
                *slot = input.map(|register| self.registers[register].as_slice());
            }
            &few[..inputs.len()]
        } else {
            many = inputs.iter().map(|input| input.map(|register| self.registers[register].as_slice())).collect();
            &many
        };
        let done = work(&self.coord_sets[coords].points(), slots, &mut samples);
        self.registers[out] = samples;
        done
    }
}

fn internal(message: &str) -> Error {
    Error::new(ErrorKind::Internal, message)
}

/// Copies a block from a grid on its own lattice, or interpolates.
fn copy_or_read(grid: &Grid, kind: LayerKind, block: Option<&Window>, points: &Points, out: &mut [f32]) {
    match block {
        Some(block) if grid.window().contains(block) => {
            let window = grid.window();
            let (left, top) = ((block.x - window.x) as usize, (block.y - window.y) as usize);
            for (j, row) in out.chunks_mut(block.width.max(1)).enumerate() {
                row.copy_from_slice(&grid.row(top + j)[left..left + block.width]);
            }
        }
        _ => resample::read(grid, kind, points, out),
    }
}

/// Displaces every point. For a lattice, its columns and rows are kept together with the displacements; for other sets
/// the new positions are plain points. In both cases a position is the f64 sum of its old value and the f32
/// displacement.
fn displace(from: &CoordSet, count: usize, by: impl Fn(usize) -> (f32, f32), to: &mut CoordSet) {
    to.x.clear();
    to.y.clear();
    to.dx.clear();
    to.dy.clear();
    to.altitude = from.altitude;
    if from.shape == Shape::Lattice {
        to.shape = Shape::Displaced;
        to.x.extend_from_slice(&from.x);
        to.y.extend_from_slice(&from.y);
        for k in 0..count {
            let (dx, dy) = by(k);
            to.dx.push(dx);
            to.dy.push(dy);
        }
        return;
    }
    to.shape = Shape::Scattered;
    let points = from.points();
    for k in 0..count {
        let ((x, y), (dx, dy)) = (points.position(k).unwrap_or(NOWHERE), by(k));
        to.x.push(x + f64::from(dx));
        to.y.push(y + f64::from(dy));
    }
}
