//! An order of boxes in which wires run from earlier to later boxes.

/// Boxes in an order for [`Layout::new`](super::layout::Layout::new).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Forward {
    /// The boxes; each comes after the boxes that it reads, except within cycles.
    pub order: Vec<usize>,
    /// For each box its position in the order.
    pub place: Vec<usize>,
}

impl Forward {
    /// Finds an order. `wires` are pairs of boxes; the second box reads the first. Boxes of cycles are ordered such
    /// that few wires run backwards.
    #[must_use]
    pub fn new(blocks: usize, wires: &[(usize, usize)]) -> Forward {
        let mut waits = vec![0_usize; blocks];
        let mut readers: Vec<Vec<usize>> = vec![Vec::new(); blocks];
        for (from, to) in wires.iter().filter(|(from, to)| from != to && *from < blocks && *to < blocks) {
            waits[*to] += 1;
            readers[*from].push(*to);
        }
        let mut is_placed = vec![false; blocks];
        let mut ready: std::collections::BTreeSet<usize> = (0..blocks).filter(|block| waits[*block] == 0).collect();
        let mut order = Vec::with_capacity(blocks);
        while order.len() < blocks {
            // Within cycles, the box that waits for the fewest other boxes is next.
            let circle = || (0..blocks).filter(|block| !is_placed[*block]).min_by_key(|block| waits[*block]);
            let Some(next) = ready.pop_first().or_else(circle) else { break };
            is_placed[next] = true;
            order.push(next);
            for reader in &readers[next] {
                waits[*reader] = waits[*reader].saturating_sub(1);
                if waits[*reader] == 0 && !is_placed[*reader] {
                    ready.insert(*reader);
                }
            }
        }
        let mut place = vec![0; blocks];
        order.iter().enumerate().for_each(|(at, block)| place[*block] = at);
        Forward { order, place }
    }

    /// Whether a wire runs to a later box.
    #[must_use]
    pub fn is_forward(&self, (from, to): (usize, usize)) -> bool {
        self.place.get(from) < self.place.get(to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_come_first_and_the_order_is_kept_where_possible() {
        let forward = Forward::new(5, &[(4, 0), (0, 2), (4, 2), (2, 3)]);
        assert_eq!(forward.order, [1, 4, 0, 2, 3]);
        assert_eq!(forward.place, [2, 0, 3, 4, 1]);
    }

    #[test]
    fn circles_leave_one_wire_backwards() {
        let wires = [(0, 1), (1, 2), (2, 0), (2, 3)];
        let forward = Forward::new(4, &wires);
        assert_eq!(wires.iter().filter(|wire| !forward.is_forward(**wire)).count(), 1);
        assert_eq!(forward.order.len(), 4);
    }
}
