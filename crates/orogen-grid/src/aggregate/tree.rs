//! An aggregate on a grid, as a tree of cells: each cell except the first is attached to a neighbor.

use crate::checks::{never, now_and_then};
use crate::error::Result;
use crate::progress::Progress;
use crate::random::Random;

/// Columns to the east and rows to the south of the eight neighbors, those that share a side first.
const AROUND: [(i64, i64); 8] = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)];

const FREE: u32 = u32::MAX;

/// Members between two reports of progress.
const REPORTED: usize = 1 << 10;

/// Steps of walkers between two checks for cancellation.
const UNCHECKED: u32 = 1 << 16;

/// An aggregate on a grid of `width` x `height` cells.
#[derive(Debug, Clone)]
pub struct Tree {
    width: usize,
    height: usize,
    /// The member in each cell, [`FREE`] if there is none.
    members: Vec<u32>,
    /// The cell of each member.
    cells: Vec<u32>,
    /// The older member to which each member is attached; `None` for the first ones.
    parents: Vec<Option<u32>>,
    /// Limit of growth: an ellipse around the center whose axes are this share of the grid's sides.
    reach: f64,
}

impl Tree {
    /// An empty tree that grows within an ellipse around the center, whose axes are `reach` times the sides of the
    /// grid.
    #[must_use]
    pub fn new(width: usize, height: usize, reach: f64) -> Tree {
        Tree { width, height, members: vec![FREE; width * height], cells: Vec::new(), parents: Vec::new(), reach }
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The cells of the members, oldest first.
    #[must_use]
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// Number of cells within the limit of growth.
    #[must_use]
    pub fn room(&self) -> usize {
        let rows = (0..self.height).map(|j| (0..self.width).filter(|i| self.holds(*i as i64, j as i64)).count());
        rows.sum()
    }

    /// Whether a cell is within the limit of growth.
    fn holds(&self, i: i64, j: i64) -> bool {
        if i < 0 || j < 0 || i >= self.width as i64 || j >= self.height as i64 {
            return false;
        }
        let across = (2.0 * i as f64 + 1.0) / self.width as f64 - 1.0;
        let down = (2.0 * j as f64 + 1.0) / self.height as f64 - 1.0;
        across * across + down * down <= self.reach * self.reach
    }

    fn index(&self, i: i64, j: i64) -> usize {
        j as usize * self.width + i as usize
    }

    /// Adds a member in a cell. If the cell already has one, returns that one.
    pub fn put(&mut self, i: i64, j: i64, parent: Option<u32>) -> u32 {
        let cell = self.index(i, j);
        if self.members[cell] == FREE {
            self.members[cell] = self.cells.len() as u32;
            self.cells.push(cell as u32);
            self.parents.push(parent);
        }
        self.members[cell]
    }

    /// A member in one of the eight neighboring cells; a random one if there are several.
    fn beside(&self, i: i64, j: i64, random: &mut Random) -> Option<u32> {
        let mut found = [0; 8];
        let mut count = 0;
        for (east, south) in AROUND {
            let (i, j) = (i + east, j + south);
            if i >= 0 && j >= 0 && i < self.width as i64 && j < self.height as i64 {
                let member = self.members[self.index(i, j)];
                if member != FREE {
                    found[count] = member;
                    count += 1;
                }
            }
        }
        match count {
            0 => None,
            1 => Some(found[0]),
            _ => Some(found[random.below(count)]),
        }
    }

    /// Grows the aggregate to `members` members. Random walkers start at any free cell and stick where they touch the
    /// aggregate (Witten and Sander, "Diffusion-limited aggregation, a kinetic critical phenomenon", 1981; in the paper
    /// each walker starts far away).
    ///
    /// Since walkers start everywhere, the gaps between branches are filled evenly. The number of steps of a walk is
    /// about the square of the gap's width.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn grow(&mut self, members: usize, random: &mut Random, progress: &Progress) -> Result<()> {
        let most = members.min(self.room());
        progress.expect(most.saturating_sub(self.cells.len()) as f64);
        let mut steps = 0u32;
        while self.cells.len() < most {
            let (mut i, mut j) = (random.below(self.width) as i64, random.below(self.height) as i64);
            if !self.holds(i, j) || self.members[self.index(i, j)] != FREE {
                continue;
            }
            loop {
                if let Some(parent) = self.beside(i, j, random) {
                    self.put(i, j, Some(parent));
                    if self.cells.len().is_multiple_of(REPORTED) {
                        progress.advance(REPORTED as f64);
                    }
                    break;
                }
                steps = steps.wrapping_add(1);
                if steps.is_multiple_of(UNCHECKED) {
                    progress.check()?;
                }
                let (east, south) = AROUND[random.below(8)];
                if !self.holds(i + east, j + south) {
                    continue;
                }
                (i, j) = (i + east, j + south);
            }
        }
        progress.finish();
        progress.check()
    }

    /// The same aggregate on a grid of `width` x `height` cells, about twice as many along each side. Every cell moves
    /// to a random one of its four subcells, and the connections between cells bend. The first member must be the
    /// central one and stays at the center.
    pub fn refined(&self, width: usize, height: usize, random: &mut Random) -> Tree {
        let Ok(fine) = self.refined_checked(width, height, random, &never);
        fine
    }

    /// Like [`Tree::refined`]; calls `check` regularly and ends with its error.
    pub(super) fn refined_checked<E>(
        &self,
        width: usize,
        height: usize,
        random: &mut Random,
        check: &impl Fn() -> std::result::Result<(), E>,
    ) -> std::result::Result<Tree, E> {
        let mut fine = Tree::new(width, height, self.reach);
        let mut places: Vec<(i64, i64)> = Vec::with_capacity(self.cells.len());
        let mut became: Vec<u32> = Vec::with_capacity(self.cells.len());
        for (cell, parent) in self.cells.iter().zip(&self.parents) {
            let (i, j) = ((*cell as usize % self.width) as i64, (*cell as usize / self.width) as i64);
            now_and_then(places.len(), check)?;
            let chance = random.draw();
            let end = (2 * i + (chance & 1) as i64, 2 * j + (chance >> 1 & 1) as i64);
            let end = (end.0.min(width as i64 - 1), end.1.min(height as i64 - 1));
            let member = match parent {
                // The center is within the limit of growth even if that is small, so walkers can find the aggregate.
                None => fine.put(width as i64 / 2, height as i64 / 2, None),
                Some(parent) => {
                    let start = places[*parent as usize];
                    // In the middle the connection bends by up to one cell to either side.
                    let bend = ((chance >> 2) % 3) as i64 - 1;
                    let across = if (end.0 - start.0).abs() > (end.1 - start.1).abs() { (0, bend) } else { (bend, 0) };
                    let middle = ((start.0 + end.0) / 2 + across.0, (start.1 + end.1) / 2 + across.1);
                    let middle = (middle.0.clamp(0, width as i64 - 1), middle.1.clamp(0, height as i64 - 1));
                    let half = fine.line(became[*parent as usize], middle);
                    fine.line(half, end)
                }
            };
            became.push(member);
            let cell = fine.cells[member as usize] as usize;
            places.push(((cell % width) as i64, (cell / width) as i64));
        }
        Ok(fine)
    }

    /// Adds members along a line from a member to a cell. If it meets another member, the line continues from there.
    fn line(&mut self, from: u32, (to_i, to_j): (i64, i64)) -> u32 {
        let cell = self.cells[from as usize] as usize;
        let (mut i, mut j) = ((cell % self.width) as i64, (cell / self.width) as i64);
        let mut at = from;
        while (i, j) != (to_i, to_j) {
            (i, j) = (i + (to_i - i).signum(), j + (to_j - j).signum());
            at = self.put(i, j, Some(at));
        }
        at
    }

    /// The distance of each member to the farthest tip that grew on it, in members.
    #[must_use]
    pub fn to_tips(&self) -> Vec<u32> {
        let mut steps = vec![0u32; self.cells.len()];
        for (member, parent) in self.parents.iter().enumerate().rev() {
            if let Some(parent) = parent {
                steps[*parent as usize] = steps[*parent as usize].max(steps[member] + 1);
            }
        }
        steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_sound(tree: &Tree) {
        for (member, (cell, parent)) in tree.cells.iter().zip(&tree.parents).enumerate() {
            assert_eq!(tree.members[*cell as usize], member as u32);
            if let Some(parent) = parent {
                assert!((*parent as usize) < member, "no circles");
                let other = tree.cells[*parent as usize] as usize;
                let apart = |a: usize, b: usize| a.abs_diff(b);
                let cell = *cell as usize;
                assert!(
                    apart(cell % tree.width, other % tree.width) <= 1
                        && apart(cell / tree.width, other / tree.width) <= 1
                );
            }
        }
        assert_eq!(tree.members.iter().filter(|member| **member != FREE).count(), tree.cells.len());
    }

    #[test]
    fn it_grows_in_one_piece_and_stays_within_its_reach() {
        let mut random = Random::new(5, 1);
        let mut tree = Tree::new(40, 30, 0.8);
        tree.put(20, 15, None);
        tree.grow(200, &mut random, &Progress::none()).unwrap();
        is_sound(&tree);
        assert_eq!(tree.cells.len(), 200);
        assert!(tree.cells.iter().all(|cell| tree.holds(i64::from(*cell) % 40, i64::from(*cell) / 40)));
        let room = tree.room();
        tree.grow(1 << 20, &mut random, &Progress::none()).unwrap();
        assert_eq!(tree.cells.len(), room, "it can fill all there is");
    }

    #[test]
    fn however_small_its_reach_walkers_find_it() {
        for (reach, down) in [(0.05, 12), (0.1, 7), (0.25, 3), (0.3, 12)] {
            for seed in 0..20 {
                let mut random = Random::new(seed, 1);
                let mut tree = Tree::new(12, down, reach);
                tree.put(6, down as i64 / 2, None);
                for _ in 0..5 {
                    tree = tree.refined(tree.width() * 2, tree.height() * 2, &mut random);
                    tree.grow(tree.room() / 2, &mut random, &Progress::none()).unwrap();
                    is_sound(&tree);
                }
                assert!(tree.cells.len() >= tree.room() / 2);
            }
        }
    }

    #[test]
    fn a_refined_tree_is_a_tree_of_the_same_shape() {
        for seed in 0..20 {
            let mut random = Random::new(seed, 1);
            let mut tree = Tree::new(16, 16, 1.0);
            tree.put(8, 8, None);
            tree.grow(50, &mut random, &Progress::none()).unwrap();
            let fine = tree.refined(32, 31, &mut random);
            is_sound(&fine);
            let (was, is) = (tree.to_tips()[0], fine.to_tips()[0]);
            assert!(fine.cells.len() >= 60 && fine.cells.len() < 200, "{}", fine.cells.len());
            assert!(is >= was && is <= 4 * was + 4, "{was} {is}");
        }
    }
}
