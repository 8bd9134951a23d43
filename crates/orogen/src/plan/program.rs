//! A program: fused fields as a flat list of instructions over block registers.

use crate::layer::LayerKind;
use crate::op::Affine;
use serde::{Deserialize, Serialize};

/// Samples a row of a block: wide enough that noise on a lattice runs at full speed.
pub const BLOCK_WIDTH: usize = 256;

/// Most rows of a block: 256 x 64 samples of 4 bytes are 64 KiB a register, a few of which stay in cache.
pub const BLOCK_HEIGHT: usize = 64;

/// Index of a register: one block of samples.
pub type Register = usize;

/// Index of a place: where samples are asked. Place 0 is the block itself.
pub type Place = usize;

/// One instruction. It runs once a block, whatever reads its result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Instruction {
    /// The same number everywhere.
    Constant {
        /// The number.
        value: f32,
        /// Where it goes.
        out: Register,
    },
    /// A field at a place.
    Field {
        /// The node.
        node: usize,
        /// Where it is asked.
        place: Place,
        /// Its inputs there.
        inputs: Vec<Option<Register>>,
        /// Where it goes.
        out: Register,
    },
    /// A layer of a solved solver at a place.
    Solved {
        /// The node.
        node: usize,
        /// Which of its layers.
        layer: usize,
        /// How the layer is read between its samples.
        kind: LayerKind,
        /// Where it is asked.
        place: Place,
        /// Its inputs there, if it reads them.
        inputs: Vec<Option<Register>>,
        /// Where it goes.
        out: Register,
    },
    /// A grid made by an earlier step, at a place.
    Grid {
        /// Index of the grid in the plan.
        grid: usize,
        /// How it is read between its samples.
        kind: LayerKind,
        /// Where it is asked.
        place: Place,
        /// Where it goes.
        out: Register,
    },
    /// source + (result - source) * mask, the mask cut to 0 ..= 1; without a source it is 0.
    Mask {
        /// What shows where the mask is 0.
        source: Option<Register>,
        /// What shows where it is 1.
        result: Register,
        /// The mask.
        mask: Register,
        /// Where it goes.
        out: Register,
    },
    /// A place moved by two registers times a strength, each cut to the reach.
    Displace {
        /// The place moved.
        from: Place,
        /// Moves it east.
        east: Register,
        /// Moves it south.
        south: Register,
        /// Metres for an input of 1.
        strength: f64,
        /// Most metres along an axis.
        reach: f64,
        /// The new place.
        to: Place,
    },
    /// A place mapped.
    Map {
        /// The place mapped.
        from: Place,
        /// The map.
        map: Affine,
        /// The new place.
        to: Place,
    },
}

/// A program over registers and places, each used again as soon as it is free.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Program {
    /// In the order they run.
    pub instructions: Vec<Instruction>,
    /// How many registers there are.
    pub registers: usize,
    /// How many places there are.
    pub places: usize,
    /// The registers that hold the results at the end.
    pub outputs: Vec<Register>,
}

impl Instruction {
    fn reads(&self) -> (Vec<Register>, Option<Place>) {
        match self {
            Instruction::Constant { .. } => (Vec::new(), None),
            Instruction::Field { place, inputs, .. } | Instruction::Solved { place, inputs, .. } => {
                (inputs.iter().flatten().copied().collect(), Some(*place))
            }
            Instruction::Grid { place, .. } => (Vec::new(), Some(*place)),
            Instruction::Mask { source, result, mask, .. } => {
                (source.iter().copied().chain([*result, *mask]).collect(), None)
            }
            Instruction::Displace { from, east, south, .. } => (vec![*east, *south], Some(*from)),
            Instruction::Map { from, .. } => (Vec::new(), Some(*from)),
        }
    }

    fn rename(&mut self, register: impl Fn(Register) -> Register, place: impl Fn(Place) -> Place) {
        match self {
            Instruction::Constant { .. } => {}
            Instruction::Field { place: at, inputs, .. } | Instruction::Solved { place: at, inputs, .. } => {
                *at = place(*at);
                for input in inputs.iter_mut().flatten() {
                    *input = register(*input);
                }
            }
            Instruction::Grid { place: at, .. } => *at = place(*at),
            Instruction::Mask { source, result, mask, .. } => {
                for read in source.iter_mut().chain([result, mask]) {
                    *read = register(*read);
                }
            }
            Instruction::Displace { from, east, south, .. } => {
                (*from, *east, *south) = (place(*from), register(*east), register(*south));
            }
            Instruction::Map { from, .. } => *from = place(*from),
        }
    }

    fn out(&mut self) -> Option<&mut Register> {
        match self {
            Instruction::Constant { out, .. }
            | Instruction::Field { out, .. }
            | Instruction::Solved { out, .. }
            | Instruction::Grid { out, .. }
            | Instruction::Mask { out, .. } => Some(out),
            Instruction::Displace { .. } | Instruction::Map { .. } => None,
        }
    }

    fn new_place(&mut self) -> Option<&mut Place> {
        match self {
            Instruction::Displace { to, .. } | Instruction::Map { to, .. } => Some(to),
            _ => None,
        }
    }
}

/// Numbers handed out anew as soon as they are free.
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
    /// From instructions in which every register and place is written once (place 0 by nobody) to as few of both as it takes.
    pub(super) fn allocate(
        mut instructions: Vec<Instruction>,
        values: usize,
        places: usize,
        outputs: Vec<Register>,
    ) -> Program {
        let end = instructions.len();
        let (mut last_value, mut last_place) = (vec![0usize; values], vec![0usize; places]);
        for (i, instruction) in instructions.iter().enumerate() {
            let (reads, place) = instruction.reads();
            reads.iter().for_each(|value| last_value[*value] = i);
            place.iter().for_each(|place| last_place[*place] = i);
        }
        outputs.iter().for_each(|value| last_value[*value] = end);
        let (mut registers, mut spots) = (Pool::new(values), Pool::new(places));
        spots.take(0);
        last_place[0] = end;
        for (i, instruction) in instructions.iter_mut().enumerate() {
            let (reads, place) = instruction.reads();
            instruction.rename(|value| registers.slot[value], |place| spots.slot[place]);
            // The result is placed before its inputs are freed: an instruction never writes over what it reads.
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
            // A value nobody reads is free at once.
            for value in reads.into_iter().chain(fresh) {
                if last_value[value] <= i && registers.slot[value] != usize::MAX {
                    registers.free.push(std::mem::replace(&mut registers.slot[value], usize::MAX));
                }
            }
            for place in place.into_iter().chain(moved) {
                if last_place[place] <= i && spots.slot[place] != usize::MAX {
                    spots.free.push(std::mem::replace(&mut spots.slot[place], usize::MAX));
                }
            }
        }
        let outputs = outputs.into_iter().map(|value| registers.slot[value]).collect();
        Program { instructions, registers: registers.count, places: spots.count, outputs }
    }
}
