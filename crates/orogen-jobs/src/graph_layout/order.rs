//! Columns and the order within them: the first two steps of Sugiyama, Tagawa and Toda (1981), "Methods for visual
//! understanding of hierarchical system structures".

/// An element of a column: a box, or a wire that passes through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slot {
    /// The box with this index.
    Block(usize),
    /// The wire with this index.
    Pass(usize),
}

/// Slots in columns, and their connections to the next column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Columns {
    /// All slots.
    pub slots: Vec<Slot>,
    /// The slots of each column. Columns are listed from the left, slots from the top.
    pub columns: Vec<Vec<usize>>,
    /// For each wire its slots from the left: its first box, the slots it passes, its last box.
    pub ways: Vec<Vec<usize>>,
}

/// Rounds of sorting slots by their neighbors.
const ROUNDS: usize = 24;

impl Columns {
    /// Arranges boxes in columns, each box to the left of all boxes that read it and as close to them as possible, in
    /// an order with few crossings. `wires` are pairs of boxes; the second box reads the first. There must be no
    /// cycles, and a box must come after the boxes that it reads.
    #[must_use]
    pub fn new(blocks: usize, wires: &[(usize, usize)]) -> Columns {
        let mut rank = vec![0usize; blocks];
        let mut sorted: Vec<&(usize, usize)> = wires.iter().collect();
        sorted.sort_by_key(|(_, to)| std::cmp::Reverse(*to));
        for (from, to) in sorted {
            rank[*from] = rank[*from].max(rank[*to] + 1);
        }
        let last = rank.iter().copied().max().unwrap_or(0);
        let mut columns = Columns { columns: vec![Vec::new(); last + 1], ..Columns::default() };
        for (block, rank) in rank.iter().enumerate() {
            columns.add(Slot::Block(block), last - rank);
        }
        for (wire, (from, to)) in wires.iter().enumerate() {
            let passes = (last - rank[*from] + 1..last - rank[*to]).map(|column| columns.add(Slot::Pass(wire), column));
            let way = std::iter::once(*from).chain(passes.collect::<Vec<usize>>()).chain([*to]);
            columns.ways.push(way.collect());
        }
        columns.sort();
        columns
    }

    fn add(&mut self, slot: Slot, column: usize) -> usize {
        self.slots.push(slot);
        self.columns[column].push(self.slots.len() - 1);
        self.slots.len() - 1
    }

    /// Reduces crossings: sorts slots by the mean position of their neighbors, left and right in turns, and keeps the
    /// best order.
    fn sort(&mut self) {
        let mut left: Vec<Vec<usize>> = vec![Vec::new(); self.slots.len()];
        let mut right = left.clone();
        for pair in self.ways.iter().flat_map(|way| way.windows(2)) {
            right[pair[0]].push(pair[1]);
            left[pair[1]].push(pair[0]);
        }
        let mut best = (self.crossings(&right), self.columns.clone());
        for round in 0..ROUNDS {
            let rightwards = round % 2 == 0;
            let neighbors = if rightwards { &left } else { &right };
            let count = self.columns.len();
            for k in 0..count {
                let column = if rightwards { k } else { count - 1 - k };
                let place = self.places();
                let mean = |slot: usize| {
                    let around = &neighbors[slot];
                    match around.is_empty() {
                        true => place[slot] as f64,
                        false => around.iter().map(|slot| place[*slot] as f64).sum::<f64>() / around.len() as f64,
                    }
                };
                // A stable sort keeps the order of ties, so the same recipe always gives the same drawing.
                self.columns[column].sort_by(|a, b| mean(*a).total_cmp(&mean(*b)));
            }
            let crossings = self.crossings(&right);
            if crossings < best.0 {
                best = (crossings, self.columns.clone());
            }
        }
        self.columns = best.1;
    }

    /// The position of each slot in its column.
    fn places(&self) -> Vec<usize> {
        let mut places = vec![0; self.slots.len()];
        for column in &self.columns {
            column.iter().enumerate().for_each(|(place, slot)| places[*slot] = place);
        }
        places
    }

    /// Number of crossings of wires, between all adjacent columns.
    fn crossings(&self, right: &[Vec<usize>]) -> usize {
        let place = self.places();
        self.columns
            .iter()
            .map(|column| {
                let mut seen: Vec<usize> = Vec::new();
                let mut crossings = 0;
                for slot in column {
                    let mut ends: Vec<usize> = right[*slot].iter().map(|slot| place[*slot]).collect();
                    ends.sort_unstable();
                    // Wires that end further down are crossed.
                    crossings +=
                        ends.iter().map(|end| seen.len() - seen.partition_point(|other| other <= end)).sum::<usize>();
                    for end in ends {
                        let at = seen.partition_point(|other| *other <= end);
                        seen.insert(at, end);
                    }
                }
                crossings
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_stand_left_of_their_readers_and_wires_pass() {
        // 0 -> 1 -> 2, 0 -> 2, and 3 -> 2 close to its reader.
        let columns = Columns::new(4, &[(0, 1), (1, 2), (0, 2), (3, 2)]);
        let column = |block: usize| {
            columns
                .columns
                .iter()
                .position(|column| column.iter().any(|slot| columns.slots[*slot] == Slot::Block(block)))
                .unwrap()
        };
        assert_eq!([0, 1, 2, 3].map(column), [0, 1, 2, 1]);
        assert_eq!(columns.ways[2].len(), 3);
        assert_eq!(columns.slots[columns.ways[2][1]], Slot::Pass(2));
    }

    #[test]
    fn crossings_that_need_not_be_are_not() {
        // Two chains whose ends are given in reverse order, and a pair that reads both.
        let wires = [(0, 3), (1, 2), (2, 5), (3, 4)];
        let columns = Columns::new(6, &wires);
        let mut right = vec![Vec::new(); columns.slots.len()];
        columns.ways.iter().flat_map(|way| way.windows(2)).for_each(|pair| right[pair[0]].push(pair[1]));
        assert_eq!(columns.crossings(&right), 0);
        assert_eq!(Columns::new(6, &wires), columns);
    }
}
