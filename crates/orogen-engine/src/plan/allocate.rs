//! The allocation of registers: values that are never needed at the same time share one.

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_ops::ids::{CoordSetId, Id, IndexVec, RegisterId};
use orogen_ops::program::{Instruction, Program};

/// Ids that are reused as soon as they are free.
struct Pool<I> {
    /// The id assigned to each value while it is needed.
    assigned: IndexVec<I, Option<I>>,
    free: Vec<I>,
    count: usize,
}

impl<I: Id> Pool<I> {
    fn new(values: usize) -> Pool<I> {
        Pool { assigned: vec![None; values].into(), free: Vec::new(), count: 0 }
    }

    fn take(&mut self, value: I) -> I {
        let id = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            I::new(self.count - 1)
        });
        self.assigned[value] = Some(id);
        id
    }

    fn get(&self, value: I) -> Result<I> {
        self.assigned[value].ok_or_else(|| Error::new(ErrorKind::Internal, "a program reads a value that is not made"))
    }

    fn release(&mut self, value: I) {
        self.free.extend(self.assigned[value].take());
    }
}

/// Assigns registers and coordinate sets. In the input, each is written once (the block itself never); the output
/// reuses them. The instructions from number `once` on can be run repeatedly: they do not overwrite values that they
/// read from earlier ones.
///
/// # Errors
/// If an instruction reads a value before it is written, which is a bug.
pub fn allocate<G>(
    mut instructions: Vec<Instruction<G>>,
    once: usize,
    values: usize,
    coord_sets: usize,
    outputs: Vec<RegisterId>,
) -> Result<Program<G>> {
    let end = instructions.len();
    let mut last_value: IndexVec<RegisterId, usize> = vec![0; values].into();
    let mut last_coords: IndexVec<CoordSetId, usize> = vec![0; coord_sets].into();
    let mut early_values: IndexVec<RegisterId, bool> = vec![false; values].into();
    let mut early_coords: IndexVec<CoordSetId, bool> = vec![false; coord_sets].into();
    for (i, instruction) in instructions.iter_mut().enumerate() {
        let (reads, coords) = instruction.reads();
        let last = |early: bool| if early && i >= once { end } else { i };
        reads.iter().for_each(|value| last_value[*value] = last(early_values[*value]));
        coords.iter().for_each(|coords| last_coords[*coords] = last(early_coords[*coords]));
        if i < once {
            instruction.out().into_iter().for_each(|out| early_values[*out] = true);
            instruction.new_coords().into_iter().for_each(|to| early_coords[*to] = true);
        }
    }
    outputs.iter().for_each(|value| last_value[*value] = end);
    let (mut registers, mut sets) = (Pool::new(values), Pool::new(coord_sets));
    sets.take(CoordSetId::BLOCK);
    last_coords[CoordSetId::BLOCK] = end;
    for (i, instruction) in instructions.iter_mut().enumerate() {
        let (reads, coords) = instruction.reads();
        instruction.rename(|value| registers.get(value), |coords| sets.get(coords))?;
        // The result is assigned before the inputs are freed: an instruction never overwrites its inputs.
        let fresh = instruction.out().map(|out| {
            let value = *out;
            *out = registers.take(value);
            value
        });
        let moved = instruction.new_coords().map(|to| {
            let value = *to;
            *to = sets.take(value);
            value
        });
        // A value that is never read is freed at once.
        for value in reads.into_iter().chain(fresh).filter(|value| last_value[*value] <= i) {
            registers.release(value);
        }
        for coords in coords.into_iter().chain(moved).filter(|coords| last_coords[*coords] <= i) {
            sets.release(coords);
        }
    }
    let outputs = outputs.into_iter().map(|value| registers.get(value)).collect::<Result<_>>()?;
    Ok(Program { instructions, once, registers: registers.count, coord_sets: sets.count, outputs })
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_ops::expression::function::Function;
    use orogen_ops::ids::GridId;
    use orogen_ops::program::Operand;

    fn sum(terms: [usize; 2], out: usize) -> Instruction<GridId> {
        let arguments = terms.map(|term| Operand::Register(RegisterId::new(term))).into();
        Instruction::Apply { function: Function::Add, arguments, out: RegisterId::new(out) }
    }

    #[test]
    fn values_share_registers_and_unknown_values_are_errors() {
        let constant = |out: usize| Instruction::Constant { value: 1.0, out: RegisterId::new(out) };
        let chain = vec![constant(0), sum([0, 0], 1), sum([1, 1], 2), sum([2, 2], 3)];
        let program = allocate(chain, 4, 4, 1, vec![RegisterId::new(3)]).unwrap();
        assert_eq!((program.registers, program.coord_sets), (2, 1));
        let early = vec![sum([1, 1], 0), constant(1)];
        assert_eq!(allocate(early, 2, 2, 1, vec![RegisterId::new(0)]).unwrap_err().kind(), ErrorKind::Internal);
        let never = vec![constant(0)];
        assert_eq!(allocate(never, 1, 2, 1, vec![RegisterId::new(1)]).unwrap_err().kind(), ErrorKind::Internal);
    }
    #[test]
    fn values_that_are_made_once_and_read_repeatedly_keep_their_registers() {
        let constant = |out: usize| Instruction::Constant { value: 1.0, out: RegisterId::new(out) };
        // 0 is read by the repeated sums 2 and 3 only, 1 by nothing.
        let sums = || vec![constant(0), constant(1), sum([0, 0], 2), sum([2, 2], 3), sum([3, 3], 4)];
        let registers = |once| allocate(sums(), once, 5, 1, vec![RegisterId::new(4)]).unwrap().registers;
        assert_eq!((registers(5), registers(2)), (2, 3));
    }
}
