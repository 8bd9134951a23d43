//! Programs: fused fields as a flat list of instructions over block registers.

use crate::expression::function::Function;
use crate::layer::LayerKind;
use crate::op::Affine;
use serde::{Deserialize, Serialize};

/// Samples per row of a block: wide enough for the full speed of noise on a lattice.
pub const BLOCK_WIDTH: usize = 256;

/// Maximum number of rows of a block: 256 x 64 samples of 4 bytes are 64 KiB per register, and several of them fit in
/// cache.
pub const BLOCK_HEIGHT: usize = 64;

/// Index of a register: one block of samples.
pub type Register = usize;

/// Index of a coordinate set: the points at which samples are evaluated. Set 0 is the block itself.
pub type CoordSet = usize;

/// An operand of a function.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Operand {
    /// A constant.
    Number(f32),
    /// A block of samples.
    Register(Register),
}

impl Operand {
    fn register(&self) -> Option<Register> {
        match self {
            Operand::Register(register) => Some(*register),
            Operand::Number(_) => None,
        }
    }
}

/// An instruction. It runs once per block, however many others read its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Instruction {
    /// A constant.
    Constant {
        /// The number.
        value: f32,
        /// The result.
        out: Register,
    },
    /// A field at a coordinate set.
    Field {
        /// The node.
        node: usize,
        /// The coordinate set.
        coords: CoordSet,
        /// Its inputs at that coordinate set.
        inputs: Vec<Option<Register>>,
        /// The result.
        out: Register,
    },
    /// A function of samples, from nodes and from expressions.
    Apply {
        /// The function.
        function: Function,
        /// Its arguments.
        arguments: Vec<Operand>,
        /// The result.
        out: Register,
    },
    /// A layer of a solver's solution at a coordinate set.
    Solved {
        /// The node.
        node: usize,
        /// Index of the layer.
        layer: usize,
        /// The interpolation of the layer.
        kind: LayerKind,
        /// The coordinate set.
        coords: CoordSet,
        /// Its inputs there, if it has any.
        inputs: Vec<Option<Register>>,
        /// The result.
        out: Register,
    },
    /// A grid made by an earlier step, at a coordinate set.
    Grid {
        /// Index of the grid in the plan.
        grid: usize,
        /// The interpolation.
        kind: LayerKind,
        /// The coordinate set.
        coords: CoordSet,
        /// The result.
        out: Register,
    },
    /// source + (result - source) * mask, with the mask clamped to 0 ..= 1; a missing source is 0.
    Mask {
        /// The value where the mask is 0.
        source: Option<Register>,
        /// The value where the mask is 1.
        result: Register,
        /// The mask.
        mask: Register,
        /// The output register.
        out: Register,
    },
    /// Displaces a coordinate set by two registers times a strength, each clamped to the reach.
    Displace {
        /// The source coordinate set.
        from: CoordSet,
        /// Displacement east.
        east: Register,
        /// Displacement south.
        south: Register,
        /// Metres per unit of the registers.
        strength: f64,
        /// Maximum displacement along an axis, in metres.
        reach: f64,
        /// The new coordinate set.
        to: CoordSet,
    },
    /// Maps a coordinate set.
    Map {
        /// The source coordinate set.
        from: CoordSet,
        /// The map.
        map: Affine,
        /// The new coordinate set.
        to: CoordSet,
    },
}

/// A program over registers and coordinate sets, which are reused as soon as they are free.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Program {
    /// The instructions in the order of execution.
    pub instructions: Vec<Instruction>,
    /// Number of registers.
    pub registers: usize,
    /// Number of coordinate sets.
    pub coord_sets: usize,
    /// The registers with the results.
    pub outputs: Vec<Register>,
}

impl Instruction {
    fn reads(&self) -> (Vec<Register>, Option<CoordSet>) {
        match self {
            Instruction::Constant { .. } => (Vec::new(), None),
            Instruction::Apply { arguments, .. } => (arguments.iter().filter_map(Operand::register).collect(), None),
            Instruction::Field { coords, inputs, .. } | Instruction::Solved { coords, inputs, .. } => {
                (inputs.iter().flatten().copied().collect(), Some(*coords))
            }
            Instruction::Grid { coords, .. } => (Vec::new(), Some(*coords)),
            Instruction::Mask { source, result, mask, .. } => {
                (source.iter().copied().chain([*result, *mask]).collect(), None)
            }
            Instruction::Displace { from, east, south, .. } => (vec![*east, *south], Some(*from)),
            Instruction::Map { from, .. } => (Vec::new(), Some(*from)),
        }
    }

    fn rename(&mut self, register: impl Fn(Register) -> Register, coords: impl Fn(CoordSet) -> CoordSet) {
        match self {
            Instruction::Constant { .. } => {}
            Instruction::Apply { arguments, .. } => {
                for argument in arguments {
                    if let Operand::Register(read) = argument {
                        *read = register(*read);
                    }
                }
            }
            Instruction::Field { coords: at, inputs, .. } | Instruction::Solved { coords: at, inputs, .. } => {
                *at = coords(*at);
                for input in inputs.iter_mut().flatten() {
                    *input = register(*input);
                }
            }
            Instruction::Grid { coords: at, .. } => *at = coords(*at),
            Instruction::Mask { source, result, mask, .. } => {
                for read in source.iter_mut().chain([result, mask]) {
                    *read = register(*read);
                }
            }
            Instruction::Displace { from, east, south, .. } => {
                (*from, *east, *south) = (coords(*from), register(*east), register(*south));
            }
            Instruction::Map { from, .. } => *from = coords(*from),
        }
    }

    fn out(&mut self) -> Option<&mut Register> {
        match self {
            Instruction::Constant { out, .. }
            | Instruction::Apply { out, .. }
            | Instruction::Field { out, .. }
            | Instruction::Solved { out, .. }
            | Instruction::Grid { out, .. }
            | Instruction::Mask { out, .. } => Some(out),
            Instruction::Displace { .. } | Instruction::Map { .. } => None,
        }
    }

    fn new_place(&mut self) -> Option<&mut CoordSet> {
        match self {
            Instruction::Displace { to, .. } | Instruction::Map { to, .. } => Some(to),
            _ => None,
        }
    }
}

/// Indices that are reused as soon as they are free.
struct Pool {
    slot: Vec<usize>,
    free: Vec<usize>,
    count: usize,
}

impl Pool {
    fn new(values: usize) -> Pool {
        Pool { slot: vec![usize::MAX; values], free: Vec::new(), count: 0 }
    }

    fn take(&mut self, value: usize) -> usize {
        let slot = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        self.slot[value] = slot;
        slot
    }
}

impl Program {
    /// Assigns registers and coordinate sets. In the input, each is written once (coordinate set 0 never); the output
    /// reuses them.
    pub(super) fn allocate(
        mut instructions: Vec<Instruction>,
        values: usize,
        coord_sets: usize,
        outputs: Vec<Register>,
    ) -> Program {
        let end = instructions.len();
        let (mut last_value, mut last_coords) = (vec![0usize; values], vec![0usize; coord_sets]);
        for (i, instruction) in instructions.iter().enumerate() {
            let (reads, coords) = instruction.reads();
            reads.iter().for_each(|value| last_value[*value] = i);
            coords.iter().for_each(|coords| last_coords[*coords] = i);
        }
        outputs.iter().for_each(|value| last_value[*value] = end);
        let (mut registers, mut spots) = (Pool::new(values), Pool::new(coord_sets));
        spots.take(0);
        last_coords[0] = end;
        for (i, instruction) in instructions.iter_mut().enumerate() {
            let (reads, coords) = instruction.reads();
            instruction.rename(|value| registers.slot[value], |coords| spots.slot[coords]);
            // The result is assigned before the inputs are freed: an instruction never overwrites its inputs.
            let fresh = instruction.out().map(|out| {
                let value = *out;
                *out = registers.take(value);
                value
            });
            let moved = instruction.new_place().map(|to| {
                let value = *to;
                *to = spots.take(value);
                value
            });
            // A value that is never read is freed at once.
            for value in reads.into_iter().chain(fresh) {
                if last_value[value] <= i && registers.slot[value] != usize::MAX {
                    registers.free.push(std::mem::replace(&mut registers.slot[value], usize::MAX));
                }
            }
            for coords in coords.into_iter().chain(moved) {
                if last_coords[coords] <= i && spots.slot[coords] != usize::MAX {
                    spots.free.push(std::mem::replace(&mut spots.slot[coords], usize::MAX));
                }
            }
        }
        let outputs = outputs.into_iter().map(|value| registers.slot[value]).collect();
        Program { instructions, registers: registers.count, coord_sets: spots.count, outputs }
    }
}
