//! A heap of states by their cost, in which costs can be lowered.

/// Children of an entry.
const WIDTH: usize = 4;
/// The position of a state that is not in the heap.
const NOWHERE: u32 = u32::MAX;

/// The states to be expanded, the cheapest first; of equal ones the lowest index.
pub(super) struct Heap {
    /// States in heap order.
    order: Vec<u32>,
    /// Position of each state in the order.
    positions: Vec<u32>,
    /// Estimated total cost of each state.
    keys: Vec<f64>,
}

impl Heap {
    pub(super) fn new(states: usize) -> Heap {
        Heap { order: Vec::new(), positions: vec![NOWHERE; states], keys: vec![f64::INFINITY; states] }
    }

    fn is_before(&self, one: u32, other: u32) -> bool {
        let [a, b] = [one, other].map(|state| self.keys[state as usize]);
        a < b || (a == b && one < other)
    }

    fn put(&mut self, at: usize, state: u32) {
        self.order[at] = state;
        self.positions[state as usize] = at as u32;
    }

    /// Adds a state, or lowers its key.
    pub(super) fn push(&mut self, state: u32, key: f64) {
        self.keys[state as usize] = key;
        let mut at = match self.positions[state as usize] {
            NOWHERE => {
                self.order.push(state);
                self.order.len() - 1
            }
            at => at as usize,
        };
        while at > 0 {
            let above = (at - 1) / WIDTH;
            let other = self.order[above];
            if !self.is_before(state, other) {
                break;
            }
            self.put(at, other);
            at = above;
        }
        self.put(at, state);
    }

    /// Removes the first state.
    pub(super) fn pop(&mut self) -> Option<u32> {
        let first = *self.order.first()?;
        self.positions[first as usize] = NOWHERE;
        let last = self.order.pop()?;
        if last != first {
            let mut at = 0;
            loop {
                let children = WIDTH * at + 1..(WIDTH * at + 1 + WIDTH).min(self.order.len());
                let mut next: Option<(usize, u32)> = None;
                for child in children {
                    let state = self.order[child];
                    if next.is_none_or(|(_, least)| self.is_before(state, least)) {
                        next = Some((child, state));
                    }
                }
                match next {
                    Some((child, state)) if self.is_before(state, last) => {
                        self.put(at, state);
                        at = child;
                    }
                    _ => break,
                }
            }
            self.put(at, last);
        }
        Some(first)
    }
}
