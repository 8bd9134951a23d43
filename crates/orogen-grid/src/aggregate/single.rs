//! A single aggregate, grown with the method of Witten and Sander.

use crate::random::Random;

/// Grows an aggregate of `members` cells from the center of a square of `side` cells, with walkers that start far away.
/// Returns whether each cell belongs to it. Growth ends early if it comes near the edge.
///
/// Walkers step to one of the four neighbors and stick when they are next to a cell of the aggregate (Witten and Sander
/// 1981). A walker farther away than twice the aggregate's radius is dropped. The number of cells grows as the radius
/// to the power of 1.71.
#[must_use]
pub fn aggregate(side: usize, members: usize, seed: u64) -> Vec<bool> {
    let mut cells = vec![false; side * side];
    let middle = side as i64 / 2;
    let at = |i: i64, j: i64| (j * side as i64 + i) as usize;
    if side == 0 {
        return cells;
    }
    cells[at(middle, middle)] = true;
    let mut random = Random::new(seed, 0);
    let (mut reach, mut count) = (1i64, 1);
    while count < members && reach + 3 < middle {
        // Walkers start on a square around the aggregate: a walker from far away reaches any point of it with about the
        // same probability.
        let launch = reach + 2;
        let along = random.below(2 * launch as usize + 1) as i64 - launch;
        let (mut i, mut j) = [(along, launch), (along, -launch), (launch, along), (-launch, along)][random.below(4)];
        let bound = (2 * launch).min(middle - 1);
        while i.abs() <= bound && j.abs() <= bound {
            let beside = [(1, 0), (-1, 0), (0, 1), (0, -1)];
            if i.abs() <= launch
                && j.abs() <= launch
                && beside.iter().any(|(x, y)| cells[at(middle + i + x, middle + j + y)])
            {
                cells[at(middle + i, middle + j)] = true;
                reach = reach.max(i.abs()).max(j.abs());
                count += 1;
                break;
            }
            let (x, y) = beside[random.below(4)];
            (i, j) = (i + x, j + y);
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_connected_and_its_dimension_is_below_two() {
        let side = 301;
        let cells = aggregate(side, 4000, 3);
        let within = |radius: i64| {
            let inside = |k: &usize| {
                let (i, j) = ((k % side) as i64 - 150, (k / side) as i64 - 150);
                i * i + j * j <= radius * radius
            };
            (0..side * side).filter(|k| cells[*k] && inside(k)).count() as f64
        };
        let dimension = libm::log(within(60) / within(15)) / libm::log(4.0);
        assert!((1.5..1.9).contains(&dimension), "{dimension}");
        let mut found = vec![150 * side + 150];
        let mut seen = vec![false; side * side];
        seen[found[0]] = true;
        let mut next = 0;
        while let Some(k) = found.get(next).copied() {
            next += 1;
            for n in [k - 1, k + 1, k - side, k + side] {
                if cells[n] && !std::mem::replace(&mut seen[n], true) {
                    found.push(n);
                }
            }
        }
        assert_eq!(found.len(), cells.iter().filter(|cell| **cell).count());
    }
}
