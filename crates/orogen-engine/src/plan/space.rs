//! The order of a program that is run at several altitudes: first what does not depend on the altitude.

use orogen_ops::ids::{CoordSetId, IndexVec, NodeId, RegisterId};
use orogen_ops::program::Instruction;

/// Moves the instructions that depend on the altitude behind all others, and returns the number of the others. The
/// order within both parts is kept. Each value and coordinate set is written once.
pub fn in_two_parts<G>(
    instructions: Vec<Instruction<G>>,
    values: usize,
    coord_sets: usize,
    reads_altitude: impl Fn(NodeId) -> bool,
) -> (Vec<Instruction<G>>, usize) {
    let mut value_varies: IndexVec<RegisterId, bool> = vec![false; values].into();
    let mut coords_vary: IndexVec<CoordSetId, bool> = vec![false; coord_sets].into();
    let mut at_one_altitude: IndexVec<CoordSetId, bool> = vec![false; coord_sets].into();
    let (mut once, mut varying) = (Vec::with_capacity(instructions.len()), Vec::new());
    for mut instruction in instructions {
        let (reads, coords) = instruction.reads();
        if let (Some(from), Some(to)) = (coords, instruction.new_coords().copied()) {
            at_one_altitude[to] = at_one_altitude[from] || instruction.has_altitude();
        }
        let reads_own = |node: NodeId, coords: CoordSetId| reads_altitude(node) && !at_one_altitude[coords];
        let varies = matches!(&instruction, Instruction::Field { node, coords, .. } if reads_own(*node, *coords))
            || reads.iter().any(|value| value_varies[*value])
            || coords.is_some_and(|coords| coords_vary[coords]);
        if !varies {
            once.push(instruction);
            continue;
        }
        if let Some(out) = instruction.out() {
            value_varies[*out] = true;
        }
        if let Some(to) = instruction.new_coords() {
            coords_vary[*to] = true;
        }
        varying.push(instruction);
    }
    let count = once.len();
    once.extend(varying);
    (once, count)
}
