//! The split of a program between a device and the processor. The processor first computes the values that the device
//! cannot, with everything that they depend on, and passes them to the device as grids.

use super::allocate::allocate;
use crate::device::{Lowered, LoweredCoords, LoweredOperand, LoweredProgram};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_noise::shader::function::Shader;
use orogen_ops::ids::{CoordSetId, GridId, Id, IndexVec, RegisterId};
use orogen_ops::layer::LayerKind;
use orogen_ops::program::{Instruction, Operand, Program};
use std::collections::BTreeMap;

/// A program in two parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// The program that the processor runs first. The device reads its outputs as grids, which follow [`Split::grids`].
    pub processor: Option<Program>,
    /// The grids of the plan that the device reads.
    pub grids: Vec<GridId>,
    /// The program that the device runs on these grids.
    pub device: LoweredProgram,
}

/// Splits a program. `lower` returns the function that computes a field, or reads a solution, on the device, if there
/// is one. `is_away` returns whether a grid is only on the device. Returns `None` if the device would compute no field
/// and read no such grid, because it would then only copy grids.
///
/// # Errors
/// If an instruction reads a value before it is written, which is a bug.
pub fn split(
    program: &Program,
    lower: impl Fn(&Instruction) -> Option<Shader>,
    is_away: impl Fn(GridId) -> bool,
) -> Result<Option<Split>> {
    let written_once = WrittenOnce::of(program)?;
    let at_altitudes = written_once.at_altitudes();
    let shaders: Vec<Option<Shader>> = written_once
        .instructions
        .iter()
        .map(|instruction| match instruction {
            // Shaders are functions of the plane.
            Instruction::Field { coords, .. } if at_altitudes[*coords] => None,
            Instruction::Field { .. } | Instruction::Solved { .. } => lower(instruction),
            _ => None,
        })
        .collect();
    let is_for_processor = |i: usize| match &written_once.instructions[i] {
        Instruction::Field { .. } | Instruction::Solved { .. } => shaders[i].is_none(),
        _ => false,
    };
    let needed = written_once.needed(&written_once.outputs, is_for_processor);
    let is_there = |i: usize| match &written_once.instructions[i] {
        Instruction::Grid { grid, .. } => is_away(*grid),
        _ => shaders[i].is_some(),
    };
    if !needed.iter().enumerate().any(|(i, needed)| *needed && is_there(i)) {
        return Ok(None);
    }
    let handed: Vec<RegisterId> = (0..needed.len())
        .filter(|i| needed[*i] && is_for_processor(*i))
        .filter_map(|i| written_once.instructions[i].clone().out().copied())
        .collect();
    let processor = (!handed.is_empty()).then(|| written_once.part(&handed)).transpose()?;
    let mut lowering = Lowering {
        grids: Vec::new(),
        values: BTreeMap::new(),
        coords: BTreeMap::new(),
        program: LoweredProgram::default(),
    };
    lowering.program.coord_sets.push(LoweredCoords::Block);
    lowering.coords.insert(CoordSetId::BLOCK, 0);
    // The grids of the plan come first.
    for (instruction, _) in written_once.instructions.iter().zip(&needed).filter(|(_, needed)| **needed) {
        if let Instruction::Grid { grid, .. } = instruction
            && !lowering.grids.contains(grid)
        {
            lowering.grids.push(*grid);
        }
    }
    for (k, value) in handed.iter().enumerate() {
        let grid = lowering.grids.len() + k;
        lowering.make(*value, Lowered::Grid { grid, kind: LayerKind::Height, coords: 0 });
    }
    for (i, instruction) in written_once.instructions.iter().enumerate() {
        if needed[i] && !is_for_processor(i) {
            lowering.lower(instruction, shaders[i].clone())?;
        }
    }
    lowering.program.outputs =
        written_once.outputs.iter().map(|value| lowering.value(*value)).collect::<Result<_>>()?;
    Ok(Some(Split { processor, grids: lowering.grids, device: lowering.program }))
}

/// The instructions of a program with registers and coordinate sets that are written once.
struct WrittenOnce {
    instructions: Vec<Instruction>,
    values: usize,
    coord_sets: usize,
    outputs: Vec<RegisterId>,
}

impl WrittenOnce {
    fn of(program: &Program) -> Result<WrittenOnce> {
        let mut value_of: IndexVec<RegisterId, Option<RegisterId>> = vec![None; program.registers].into();
        let mut coords_of: IndexVec<CoordSetId, Option<CoordSetId>> = vec![None; program.coord_sets.max(1)].into();
        coords_of[CoordSetId::BLOCK] = Some(CoordSetId::BLOCK);
        let (mut values, mut coord_sets) = (0, 1);
        let mut instructions = program.instructions.clone();
        for instruction in &mut instructions {
            instruction.rename(
                |register| value_of[register].ok_or_else(unwritten),
                |coords| coords_of[coords].ok_or_else(unwritten),
            )?;
            if let Some(out) = instruction.out() {
                let value = RegisterId::new(values);
                value_of[*out] = Some(value);
                *out = value;
                values += 1;
            }
            if let Some(to) = instruction.new_coords() {
                let coords = CoordSetId::new(coord_sets);
                coords_of[*to] = Some(coords);
                *to = coords;
                coord_sets += 1;
            }
        }
        let outputs = program.outputs.iter().map(|out| value_of[*out].ok_or_else(unwritten)).collect::<Result<_>>()?;
        Ok(WrittenOnce { instructions, values, coord_sets, outputs })
    }

    /// Whether each coordinate set has its own altitude.
    fn at_altitudes(&self) -> IndexVec<CoordSetId, bool> {
        let mut at_altitudes: IndexVec<CoordSetId, bool> = vec![false; self.coord_sets].into();
        for instruction in &self.instructions {
            if let (_, Some(from)) = instruction.reads()
                && let Some(to) = instruction.clone().new_coords()
            {
                at_altitudes[*to] = at_altitudes[from] || instruction.has_altitude();
            }
        }
        at_altitudes
    }

    /// Which instructions are needed for `values`. Instructions for which `is_border` holds are needed, but not what
    /// they read.
    fn needed(&self, values: &[RegisterId], is_border: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut value_needed: IndexVec<RegisterId, bool> = vec![false; self.values].into();
        let mut coords_needed: IndexVec<CoordSetId, bool> = vec![false; self.coord_sets].into();
        values.iter().for_each(|value| value_needed[*value] = true);
        let mut needed = vec![false; self.instructions.len()];
        for (i, instruction) in self.instructions.iter().enumerate().rev() {
            let mut instruction = instruction.clone();
            let is_read = instruction.out().is_some_and(|out| value_needed[*out])
                || instruction.new_coords().is_some_and(|to| coords_needed[*to]);
            needed[i] = is_read;
            if is_read && !is_border(i) {
                let (reads, coords) = instruction.reads();
                reads.into_iter().for_each(|value| value_needed[value] = true);
                coords.into_iter().for_each(|coords| coords_needed[coords] = true);
            }
        }
        needed
    }

    /// A program for some of the values.
    fn part(&self, values: &[RegisterId]) -> Result<Program> {
        let needed = self.needed(values, |_| false);
        let kept = self.instructions.iter().zip(needed).filter(|(_, needed)| *needed);
        let instructions: Vec<Instruction> = kept.map(|(instruction, _)| instruction.clone()).collect();
        let once = instructions.len();
        allocate(instructions, once, self.values, self.coord_sets, values.to_vec())
    }
}

/// A device's program under construction.
struct Lowering {
    grids: Vec<GridId>,
    values: BTreeMap<RegisterId, usize>,
    coords: BTreeMap<CoordSetId, usize>,
    program: LoweredProgram,
}

impl Lowering {
    fn make(&mut self, value: RegisterId, lowered: Lowered) {
        self.values.insert(value, self.program.instructions.len());
        self.program.instructions.push(lowered);
    }

    fn value(&self, value: RegisterId) -> Result<usize> {
        self.values.get(&value).copied().ok_or_else(unwritten)
    }

    fn at(&self, coords: CoordSetId) -> Result<usize> {
        self.coords.get(&coords).copied().ok_or_else(unwritten)
    }

    fn lower(&mut self, instruction: &Instruction, shader: Option<Shader>) -> Result<()> {
        match instruction {
            Instruction::Constant { value, out } => self.make(*out, Lowered::Constant(*value)),
            Instruction::Field { coords, inputs, out, .. } | Instruction::Solved { coords, inputs, out, .. } => {
                let shader = shader.ok_or_else(unwritten)?;
                let inputs = inputs.iter().map(|input| input.map(|input| self.value(input)).transpose());
                let inputs = inputs.collect::<Result<_>>()?;
                self.make(*out, Lowered::Field { shader, coords: self.at(*coords)?, inputs });
            }
            Instruction::Apply { function, arguments, out } => {
                let argument = |argument: &Operand| match argument {
                    Operand::Number(number) => Ok(LoweredOperand::Number(*number)),
                    Operand::Register(register) => self.value(*register).map(LoweredOperand::Value),
                };
                let arguments = arguments.iter().map(argument).collect::<Result<_>>()?;
                self.make(*out, Lowered::Apply { function: *function, arguments });
            }
            Instruction::Grid { grid, kind, coords, out } => {
                let grid = self.grids.iter().position(|known| known == grid).ok_or_else(unwritten)?;
                self.make(*out, Lowered::Grid { grid, kind: *kind, coords: self.at(*coords)? });
            }
            Instruction::Mask { source, result, mask, out } => {
                let source = source.map(|source| self.value(source)).transpose()?;
                self.make(*out, Lowered::Mask { source, result: self.value(*result)?, mask: self.value(*mask)? });
            }
            Instruction::Displace { from, east, south, strength, reach, to } => {
                let (from, east, south) = (self.at(*from)?, self.value(*east)?, self.value(*south)?);
                let (strength, reach) = (*strength, *reach);
                self.add(*to, LoweredCoords::Displaced { from, east, south, strength, reach });
            }
            Instruction::Map { from, map, to } => {
                let from = self.at(*from)?;
                self.add(*to, LoweredCoords::Mapped { from, map: *map });
            }
        }
        Ok(())
    }

    fn add(&mut self, coords: CoordSetId, lowered: LoweredCoords) {
        self.coords.insert(coords, self.program.coord_sets.len());
        self.program.coord_sets.push(lowered);
    }
}

fn unwritten() -> Error {
    Error::new(ErrorKind::Internal, "a program for a device reads a value that is not made")
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_ops::expression::function::Function;
    use orogen_ops::ids::NodeId;

    fn field(node: usize, inputs: &[usize], out: usize) -> Instruction {
        let inputs = inputs.iter().map(|input| Some(RegisterId::new(*input))).collect();
        Instruction::Field {
            node: NodeId::new(node),
            layer: 0,
            coords: CoordSetId::BLOCK,
            inputs,
            out: RegisterId::new(out),
        }
    }

    fn shader(instruction: &Instruction) -> Option<Shader> {
        // Nodes from 10 on are for the processor.
        match instruction {
            Instruction::Field { node, .. } if node.index() < 10 => Some(Shader::new("f", "", &[])),
            _ => None,
        }
    }

    #[test]
    fn what_a_device_cannot_do_comes_first_with_what_it_reads() {
        // 10 reads 1 and is read by 2; registers are reused.
        let sum = |a, b, out| Instruction::Apply {
            function: Function::Add,
            arguments: vec![Operand::Register(RegisterId::new(a)), Operand::Register(RegisterId::new(b))],
            out: RegisterId::new(out),
        };
        let instructions =
            vec![field(1, &[], 0), field(10, &[0], 1), field(2, &[1], 0), sum(0, 1, 2), field(3, &[2], 0)];
        let program = Program { instructions, once: 5, registers: 3, coord_sets: 1, outputs: vec![RegisterId::new(0)] };
        let split = split(&program, shader, |_| false).unwrap().unwrap();
        let processor = split.processor.unwrap();
        assert_eq!((processor.instructions.len(), processor.outputs.len()), (2, 1));
        // The grid from the processor, 2, the sum and 3.
        let device = split.device;
        assert_eq!((device.instructions.len(), device.outputs.as_slice()), (4, &[3][..]));
        assert_eq!(device.reads(2), [1, 0]);
        assert!(split.grids.is_empty());
    }

    #[test]
    fn programs_without_fields_for_a_device_are_not_split() {
        let instructions = vec![field(11, &[], 0)];
        let program = Program { instructions, once: 1, registers: 1, coord_sets: 1, outputs: vec![RegisterId::new(0)] };
        assert_eq!(split(&program, shader, |_| false).unwrap(), None);
    }
}
