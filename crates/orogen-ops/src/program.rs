//! Programs: fused fields as a flat list of instructions over block registers.

use crate::expression::function::Function;
use crate::ids::{CoordSetId, GridId, NodeId, RegisterId};
use crate::layer::LayerKind;
use crate::number;
use crate::op::Affine;
use orogen_grid::error::Result;
use serde::{Deserialize, Serialize};

/// Samples per row of a block: wide enough for the full speed of noise on a lattice.
pub const BLOCK_WIDTH: usize = 256;

/// Maximum number of rows of a block: 256 x 64 samples of 4 bytes are 64 KiB per register, and several of them fit in
/// cache.
pub const BLOCK_HEIGHT: usize = 64;

/// An operand of a function.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Operand {
    /// A constant.
    Number(#[serde(with = "number")] f32),
    /// A block of samples.
    Register(RegisterId),
}

impl Operand {
    fn register(&self) -> Option<RegisterId> {
        match self {
            Operand::Register(register) => Some(*register),
            Operand::Number(_) => None,
        }
    }
}

/// An instruction. It runs once per block, no matter how many others read its result. During planning it reads requests
/// instead of grids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Instruction<G = GridId> {
    /// A constant.
    Constant {
        /// The number.
        #[serde(with = "number")]
        value: f32,
        /// The result.
        out: RegisterId,
    },
    /// A field at a coordinate set.
    Field {
        /// The node.
        node: NodeId,
        /// Index of the layer.
        layer: usize,
        /// The coordinate set.
        coords: CoordSetId,
        /// Its inputs at that coordinate set.
        inputs: Vec<Option<RegisterId>>,
        /// The result.
        out: RegisterId,
    },
    /// A function of samples, from nodes and from expressions.
    Apply {
        /// The function.
        function: Function,
        /// Its arguments.
        arguments: Vec<Operand>,
        /// The result.
        out: RegisterId,
    },
    /// A layer of a solver's solution at a coordinate set.
    Solved {
        /// The node.
        node: NodeId,
        /// Index of the layer.
        layer: usize,
        /// The interpolation of the layer.
        kind: LayerKind,
        /// The coordinate set.
        coords: CoordSetId,
        /// Its inputs there, if it has any.
        inputs: Vec<Option<RegisterId>>,
        /// The result.
        out: RegisterId,
    },
    /// A grid made by an earlier step, at a coordinate set.
    Grid {
        /// The grid of the plan.
        grid: G,
        /// The interpolation.
        kind: LayerKind,
        /// The coordinate set.
        coords: CoordSetId,
        /// The result.
        out: RegisterId,
    },
    /// source + (result - source) * mask, with the mask clamped to 0 ..= 1; a missing source is 0.
    Mask {
        /// The value where the mask is 0.
        source: Option<RegisterId>,
        /// The value where the mask is 1.
        result: RegisterId,
        /// The mask.
        mask: RegisterId,
        /// The output register.
        out: RegisterId,
    },
    /// Displaces a coordinate set by two registers times a strength, each clamped to the reach.
    Displace {
        /// The source coordinate set.
        from: CoordSetId,
        /// Displacement east.
        east: RegisterId,
        /// Displacement south.
        south: RegisterId,
        /// Metres per unit of the registers.
        strength: f64,
        /// Maximum displacement along an axis, in metres.
        reach: f64,
        /// The new coordinate set.
        to: CoordSetId,
    },
    /// Maps a coordinate set.
    Map {
        /// The source coordinate set.
        from: CoordSetId,
        /// The map.
        map: Affine,
        /// The new coordinate set.
        to: CoordSetId,
    },
}

/// A program over registers and coordinate sets, which are reused as soon as they are free.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Program<G = GridId> {
    /// The instructions in the order of execution.
    pub instructions: Vec<Instruction<G>>,
    /// Number of instructions that do not depend on the altitude: they come first, and run once for all altitudes.
    pub once: usize,
    /// Number of registers.
    pub registers: usize,
    /// Number of coordinate sets.
    pub coord_sets: usize,
    /// The registers with the results.
    pub outputs: Vec<RegisterId>,
}

impl Program {
    /// The grids that it reads.
    #[must_use]
    pub fn reads(&self) -> Vec<GridId> {
        let grid = |instruction: &Instruction| match instruction {
            Instruction::Grid { grid, .. } => Some(*grid),
            _ => None,
        };
        self.instructions.iter().filter_map(grid).collect()
    }
}

impl<G> Program<G> {
    /// The program with its grids replaced.
    pub fn resolve<H>(self, grid: impl Fn(G) -> Result<H>) -> Result<Program<H>> {
        let Program { instructions, once, registers, coord_sets, outputs } = self;
        let instructions =
            instructions.into_iter().map(|instruction| instruction.resolve(&grid)).collect::<Result<_>>()?;
        Ok(Program { instructions, once, registers, coord_sets, outputs })
    }
}

impl<G> Instruction<G> {
    fn resolve<H>(self, resolved: impl Fn(G) -> Result<H>) -> Result<Instruction<H>> {
        Ok(match self {
            Instruction::Grid { grid, kind, coords, out } => {
                Instruction::Grid { grid: resolved(grid)?, kind, coords, out }
            }
            Instruction::Constant { value, out } => Instruction::Constant { value, out },
            Instruction::Field { node, layer, coords, inputs, out } => {
                Instruction::Field { node, layer, coords, inputs, out }
            }
            Instruction::Apply { function, arguments, out } => Instruction::Apply { function, arguments, out },
            Instruction::Solved { node, layer, kind, coords, inputs, out } => {
                Instruction::Solved { node, layer, kind, coords, inputs, out }
            }
            Instruction::Mask { source, result, mask, out } => Instruction::Mask { source, result, mask, out },
            Instruction::Displace { from, east, south, strength, reach, to } => {
                Instruction::Displace { from, east, south, strength, reach, to }
            }
            Instruction::Map { from, map, to } => Instruction::Map { from, map, to },
        })
    }

    /// The registers and the coordinate set that it reads.
    pub fn reads(&self) -> (Vec<RegisterId>, Option<CoordSetId>) {
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

    /// Renames the registers and the coordinate set that it reads.
    pub fn rename(
        &mut self,
        register: impl Fn(RegisterId) -> Result<RegisterId>,
        coords: impl Fn(CoordSetId) -> Result<CoordSetId>,
    ) -> Result<()> {
        match self {
            Instruction::Constant { .. } => {}
            Instruction::Apply { arguments, .. } => {
                for argument in arguments {
                    if let Operand::Register(read) = argument {
                        *read = register(*read)?;
                    }
                }
            }
            Instruction::Field { coords: at, inputs, .. } | Instruction::Solved { coords: at, inputs, .. } => {
                *at = coords(*at)?;
                for input in inputs.iter_mut().flatten() {
                    *input = register(*input)?;
                }
            }
            Instruction::Grid { coords: at, .. } => *at = coords(*at)?,
            Instruction::Mask { source, result, mask, .. } => {
                for read in source.iter_mut().chain([result, mask]) {
                    *read = register(*read)?;
                }
            }
            Instruction::Displace { from, east, south, .. } => {
                (*from, *east, *south) = (coords(*from)?, register(*east)?, register(*south)?);
            }
            Instruction::Map { from, .. } => *from = coords(*from)?,
        }
        Ok(())
    }

    /// The register that it writes.
    pub fn out(&mut self) -> Option<&mut RegisterId> {
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

    /// Whether it makes a coordinate set with its own altitude.
    pub fn has_altitude(&self) -> bool {
        matches!(self, Instruction::Map { map, .. } if map.altitude.is_some())
    }

    /// The coordinate set that it makes.
    pub fn new_coords(&mut self) -> Option<&mut CoordSetId> {
        match self {
            Instruction::Displace { to, .. } | Instruction::Map { to, .. } => Some(to),
            _ => None,
        }
    }
}
