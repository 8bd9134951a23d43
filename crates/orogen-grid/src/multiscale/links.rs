//! The paths of rivers through the children of a level: which links of the parents are kept, and which children they
//! pass.

use super::children::{Children, heir};
use super::drawn_ridges::{BESIDE, RIDGE};
use super::hash;
use super::lakes::drains;
use super::level::Level;
use super::passages::Drawn;
use super::refinement::Refinement;
use crate::error::Result;
use crate::hydrology::direction::{NONE, STEPS};
use crate::progress::Progress;

/// Randomness of the choice between paths, relative to their lengths, and the same for the last three levels.
const WANDER: f32 = 1.0;
const FINE_WANDER: f32 = 0.3;

/// Factor of the length of a detour around a corner. Without detours, rivers that follow diagonals would be straight.
const DETOUR: f32 = 0.9;

/// Randomness of the choice between paths to the nodes of a level.
pub fn wander(land: &Refinement, depth: usize) -> f32 {
    if depth + 2 >= land.levels { FINE_WANDER } else { WANDER }
}

/// Factors of the length of paths through cells of drawn ridges, and through cells beside them.
const ACROSS_RIDGE: f32 = 30.0;
const BESIDE_RIDGE: f32 = 3.0;

/// A child of a cell: its parent, and which of the four children it is. Bit 0 is set in the east, bit 1 in the south.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Child {
    pub parent: usize,
    pub corner: u8,
}

impl Child {
    /// The child at an index of planes of children. The inverse of [`Child::index`].
    pub fn at(index: usize, parents: usize) -> Child {
        let (i, j) = (index % (2 * parents), index / (2 * parents));
        Child { parent: j / 2 * parents + i / 2, corner: (i & 1) as u8 | ((j & 1) as u8) << 1 }
    }

    /// The index of the child in planes of children, where `parents` is the number of parents per row.
    #[inline(always)]
    pub fn index(self, parents: usize) -> usize {
        let (i, j) = (self.parent % parents, self.parent / parents);
        (2 * j + usize::from(self.corner >> 1)) * 2 * parents + 2 * i + usize::from(self.corner & 1)
    }
}

/// The third cell that a link across a corner passes through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Around {
    /// No third cell.
    Nothing,
    /// The cell to the east or west of the parent.
    Side,
    /// The cell to the north or south of the parent.
    End,
}

/// The path of a parent's link: from the parent's heir to the exit, then possibly around a corner, and from the entry
/// to the receiver's heir.
#[derive(Debug, Clone, Copy)]
pub struct Link {
    /// Whether the parent has a donor or is water. Other parents are dropped, and their nodes grow anew.
    pub kept: bool,
    /// Whether the parent has a donor.
    pub fed: bool,
    /// Child of the parent through which the river leaves.
    pub exit: u8,
    /// Child of the receiver through which the river arrives.
    pub entry: u8,
    /// The third cell that the river passes through between exit and entry.
    pub around: Around,
}

/// The links of all parents. Links of parents at least three cells from the edge are exact, and so are the children
/// that they pass.
pub struct Links {
    pub list: Vec<Link>,
    /// Number of parents per row.
    pub width: usize,
}

impl Links {
    pub fn new(
        land: &Refinement,
        parent: &Level,
        children: &Children,
        drawn: &Drawn,
        progress: &Progress,
    ) -> Result<Links> {
        let nothing = Link { kept: false, fed: false, exit: 0, entry: 0, around: Around::Nothing };
        let mut links = Links { list: vec![nothing; parent.window.len()], width: parent.window.width };
        links.keep(parent);
        progress.check()?;
        let wander = wander(land, children.depth);
        for q in links.kept(parent).filter(|&q| drains(parent.receiver[q])).collect::<Vec<_>>() {
            match drawn.above.at(q).filter(|passage| passage.code == parent.receiver[q]) {
                Some(passage) => links.follow(parent, q, passage.code),
                None => links.cross(land, parent, children, q, (wander, &drawn.ridges)),
            }
        }
        progress.check()?;
        if !land.is_finest(children.depth) {
            links.go_around(land, parent, children, drawn, wander);
        }
        Ok(links)
    }

    /// The parents that are kept and not at the edge, row by row.
    pub fn kept(&self, parent: &Level) -> impl Iterator<Item = usize> {
        parent.inner(1).filter(|&q| self.list[q].kept)
    }

    /// The receiver of a parent that is not at the edge.
    #[inline(always)]
    pub fn target(&self, parent: &Level, q: usize) -> usize {
        let (east, south) = step(parent.receiver[q]);
        q.wrapping_add_signed(south * self.width as isize + east)
    }

    /// The child of a third cell that the link of `q` passes through.
    #[inline(always)]
    pub fn via(&self, parent: &Level, q: usize) -> Option<Child> {
        self.passed(parent, q, self.list[q].around)
    }

    /// The child at the corner that the link of `q` crosses, in the third cell `around`.
    fn passed(&self, parent: &Level, q: usize, around: Around) -> Option<Child> {
        let (east, south) = step(parent.receiver[q]);
        let link = self.list[q];
        match around {
            Around::Nothing => None,
            Around::Side => Some(Child { parent: q.wrapping_add_signed(east), corner: link.entry & 1 | link.exit & 2 }),
            Around::End => {
                let parent = q.wrapping_add_signed(south * self.width as isize);
                Some(Child { parent, corner: link.exit & 1 | link.entry & 2 })
            }
        }
    }

    /// Marks the parents that are kept.
    fn keep(&mut self, parent: &Level) {
        for q in parent.inner(1) {
            if drains(parent.receiver[q]) {
                let target = self.target(parent, q);
                (self.list[target].kept, self.list[target].fed) = (true, true);
            }
            self.list[q].kept |= parent.receiver[q] >= NONE;
        }
    }

    /// Chooses the exit and the entry of a link. Across a side, one of four pairs is chosen by length and chance;
    /// across a corner there is only one pair.
    fn cross(
        &mut self,
        land: &Refinement,
        parent: &Level,
        children: &Children,
        q: usize,
        (wander, ridges): (f32, &[u8]),
    ) {
        let (east, south) = step(parent.receiver[q]);
        let target = self.target(parent, q);
        let (start, end) =
            (Child { parent: q, corner: heir(parent, q) }, Child { parent: target, corner: heir(parent, target) });
        // The bits for the sides of the cells, in the link's direction, at which the exit and the entry are.
        let sides = |step: isize| (u8::from(step > 0), u8::from(step < 0));
        let ((exit_east, entry_east), (exit_south, entry_south)) = (sides(east), sides(south));
        if east != 0 && south != 0 {
            let link = &mut self.list[q];
            (link.exit, link.entry) = (exit_east | exit_south << 1, entry_east | entry_south << 1);
            return;
        }
        let (width, (x, y)) = (self.width, parent.place(q));
        let bits = hash::node(land.seed, children.depth, x, y, 7);
        let mut shortest = f32::INFINITY;
        for choice in 0..4u8 {
            let (a, b) = (choice & 1, choice >> 1);
            let (exit, entry) = if east != 0 {
                (exit_east | a << 1, entry_east | b << 1)
            } else {
                (a | exit_south << 1, b | entry_south << 1)
            };
            let (out, into) = (Child { parent: q, corner: exit }, Child { parent: target, corner: entry });
            let length = children.distance(start, out, width)
                + children.distance(out, into, width)
                + children.distance(into, end, width);
            let length = length * (1.0 + wander * hash::unit16(bits, usize::from(choice)));
            let detour = |child: Child| match ridges.get(child.index(width)) {
                Some(&RIDGE) => ACROSS_RIDGE,
                Some(&BESIDE) => BESIDE_RIDGE,
                _ => 1.0,
            };
            let length = length * detour(out) * detour(into);
            if length < shortest {
                shortest = length;
                (self.list[q].exit, self.list[q].entry) = (exit, entry);
            }
        }
    }

    /// The exit and the entry of a drawn river's link: it leaves at the node, straight into the next cell.
    fn follow(&mut self, parent: &Level, q: usize, code: u8) {
        let exit = heir(parent, q);
        let across = if code & 2 == 0 { 1 } else { 2 };
        (self.list[q].exit, self.list[q].entry) = (exit, exit ^ across);
    }

    /// Leads some links around the corner that they cross, through a child of one of the two other cells that no link
    /// uses.
    fn go_around(&mut self, land: &Refinement, parent: &Level, children: &Children, drawn: &Drawn, wander: f32) {
        let width = self.width;
        let mut used = vec![0u8; self.list.len()];
        for q in parent.inner(1) {
            used[q] |= 1 << heir(parent, q);
            let link = self.list[q];
            if link.kept && drains(parent.receiver[q]) {
                used[q] |= 1 << link.exit;
                used[self.target(parent, q)] |= 1 << link.entry;
            }
        }
        for q in parent.inner(1) {
            let link = self.list[q];
            if !link.kept || !drains(parent.receiver[q]) || parent.receiver[q] & 1 == 0 {
                continue;
            }
            let target = self.target(parent, q);
            let (exit, entry) = (Child { parent: q, corner: link.exit }, Child { parent: target, corner: link.entry });
            let (x, y) = parent.place(q);
            let bits = hash::node(land.seed, children.depth, x, y, 9);
            let mut shortest = children.distance(exit, entry, width) * (1.0 + wander * hash::unit16(bits, 0));
            for (choice, around) in [(1, Around::Side), (2, Around::End)] {
                let Some(child) = self.passed(parent, q, around) else { continue };
                let index = child.index(width);
                let is_drawn = drawn.below.at(index).is_some() || drawn.ridges.get(index).is_some_and(|mark| *mark > 0);
                if used[child.parent] >> child.corner & 1 == 1 || is_drawn {
                    continue;
                }
                let length = children.distance(exit, child, width) + children.distance(child, entry, width);
                let length = length * DETOUR * (1.0 + wander * hash::unit16(bits, choice));
                if length < shortest {
                    shortest = length;
                    self.list[q].around = around;
                }
            }
        }
    }
}

/// The offset to the receiver, on land and in lakes.
#[inline(always)]
fn step(receiver: u8) -> (isize, isize) {
    STEPS[usize::from(receiver & 7)]
}

impl Children {
    /// The distance between two children, in cells.
    #[inline(always)]
    pub fn distance(&self, from: Child, to: Child, parents: usize) -> f32 {
        let (a, b) = (from.index(parents), to.index(parents));
        let width = 2 * parents;
        // Differences of integers are exact, wherever the window starts.
        let columns = (b % width) as isize - (a % width) as isize;
        let rows = (b / width) as isize - (a / width) as isize;
        let (mut x, mut y) = (columns as f32, rows as f32);
        if self.is_irregular() {
            (x, y) = (self.east[b] - self.east[a] + x, self.south[b] - self.south[a] + y);
        }
        (x * x + y * y).sqrt()
    }
}
