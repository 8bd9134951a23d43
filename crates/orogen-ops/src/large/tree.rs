//! The minimum spanning tree of a tile's passes, and its contribution to the map's tree.
//!
//! The pass that each basin drains over follows from the minimum spanning tree of all basins (see
//! [`hydrology::basins`](crate::hydrology::basins)). A pass that is not in a tile's tree is not in the map's tree
//! either. A pass in a tile's tree is also in the map's tree, except for the highest pass on each path between two
//! basins that extend beyond the tile, because a lower pass elsewhere may replace it. The map therefore needs only
//! these passes of each tile, and the basins where such paths branch.

use orogen_grid::hydrology::basins::{Pass, ordered};

/// Disjoint sets (union-find).
#[derive(Debug, Clone)]
pub struct Sets {
    parents: Vec<u32>,
}

impl Sets {
    /// `count` sets of one member each.
    pub fn new(count: usize) -> Sets {
        Sets { parents: (0..count as u32).collect() }
    }

    /// The representative of the set of `member`.
    pub fn find(&mut self, member: u32) -> u32 {
        let mut at = member;
        while self.parents[at as usize] != at {
            let next = self.parents[at as usize];
            self.parents[at as usize] = self.parents[next as usize];
            at = next;
        }
        at
    }

    /// Joins two sets; the representative of the first set represents both. Returns false if they were the same set.
    pub fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parents[b as usize] = a;
        a != b
    }
}

/// A pass of a tile's tree.
#[derive(Debug, Clone, Copy)]
pub struct Branch {
    /// The pass, between basins of the tile.
    pub pass: Pass,
    /// The names of the two basins between which it is the highest pass, if it may be replaced.
    pub joins: Option<[u32; 2]>,
}

/// The minimum spanning tree, or forest, of a tile's basins. `names` are the names of basins known beyond the tile,
/// numbered from 0; basins where paths between them branch get the next numbers.
pub fn least(mut passes: Vec<Pass>, names: &mut [Option<u32>]) -> Vec<Branch> {
    passes.sort_unstable_by_key(|pass| (ordered(pass.height), pass.from, pass.code));
    let mut sets = Sets::new(names.len());
    passes.retain(|pass| sets.join(pass.basins[0], pass.basins[1]));
    let beside = Beside::new(names.len(), passes.iter().map(|pass| pass.basins));
    let other = |k: u32, basin: u32| {
        let [a, b] = passes[k as usize].basins;
        if a == basin { b } else { a }
    };
    // Removes dead ends, from the tips inward.
    let mut degrees: Vec<u32> = (0..names.len() as u32).map(|basin| beside.of(basin).len() as u32).collect();
    let mut alive = vec![true; passes.len()];
    for tip in 0..names.len() as u32 {
        let mut at = tip;
        while names[at as usize].is_none() && degrees[at as usize] == 1 {
            let Some(k) = beside.of(at).iter().copied().find(|k| alive[*k as usize]) else { break };
            alive[k as usize] = false;
            degrees[at as usize] = 0;
            at = other(k, at);
            degrees[at as usize] -= 1;
        }
    }
    let mut next = names.iter().flatten().count() as u32;
    for (name, degree) in names.iter_mut().zip(&degrees) {
        if name.is_none() && *degree > 2 {
            *name = Some(next);
            next += 1;
        }
    }
    let mut branches: Vec<Branch> = passes.iter().map(|pass| Branch { pass: *pass, joins: None }).collect();
    for start in (0..names.len() as u32).filter(|basin| names[*basin as usize].is_some()) {
        for first in beside.of(start) {
            // Follows the path to the next named basin. Passes are sorted, so the highest one has the largest index.
            let (mut at, mut k, mut highest) = (start, *first, *first);
            while std::mem::replace(&mut alive[k as usize], false) {
                highest = highest.max(k);
                at = other(k, at);
                if names[at as usize].is_some() {
                    let ends = names[start as usize].zip(names[at as usize]);
                    branches[highest as usize].joins = ends.map(<[u32; 2]>::from);
                    break;
                }
                let Some(on) = beside.of(at).iter().copied().find(|k| alive[*k as usize]) else { break };
                k = on;
            }
        }
    }
    branches
}

/// The branches at each node of a tree.
#[derive(Debug, Clone)]
pub struct Beside {
    starts: Vec<u32>,
    branches: Vec<u32>,
}

impl Beside {
    /// A tree of `count` nodes with the two ends of each branch.
    pub fn new(count: usize, ends: impl Iterator<Item = [u32; 2]> + Clone) -> Beside {
        let mut starts = vec![0u32; count + 1];
        for node in ends.clone().flatten() {
            starts[node as usize + 1] += 1;
        }
        for node in 0..count {
            starts[node + 1] += starts[node];
        }
        let mut places = starts.clone();
        let mut branches = vec![0u32; starts[count] as usize];
        for (k, [a, b]) in ends.enumerate() {
            for node in [a, b] {
                branches[places[node as usize] as usize] = k as u32;
                places[node as usize] += 1;
            }
        }
        Beside { starts, branches }
    }

    /// The branches at a node.
    pub fn of(&self, node: u32) -> &[u32] {
        &self.branches[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize]
    }
}
