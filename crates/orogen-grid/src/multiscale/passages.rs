//! The cells of a level that drawn rivers cross.
//!
//! Every level leads a drawn river through exactly the cells that its line crosses, at the height of the line. Which
//! cells these are depends on the line alone, so they have the same bits in every window.

use super::drawn_rivers::DrawnRivers;
use super::hash::JITTER;
use super::level::{Level, cropped};
use super::refinement::Refinement;
use crate::grid::Window;
use crate::hydrology::direction::{NONE, STEPS};

/// How a drawn river leaves a cell for the last time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// The number of the river. In a cell that several rivers cross it is the first of them.
    pub river: u32,
    /// Distance along the line at which it leaves the cell, in metres.
    pub chainage: f64,
    /// Code of the direction of the next cell; [`NONE`] where the river ends in the cell.
    pub code: u8,
    /// Position of the node in its cell: near the point where the river leaves, in the same quarter of the cell.
    pub east: f32,
    pub south: f32,
    /// Distance along the line at which it enters the cell for the first time, in metres.
    pub entry: f64,
    /// Height of the bed, in metres: where the river enters, so that whatever joins it in the cell is above the bed. It
    /// falls from each cell to the next one.
    pub height: f32,
    /// Drainage area where it leaves, in km^2.
    pub area: f64,
}

impl Passage {
    /// The length of the line between entering and leaving the cell.
    #[cfg(test)]
    pub fn length(&self) -> f64 {
        self.chainage - self.entry
    }
}

/// Number of cells downstream in which the bed is below that of a cell, even where a tributary reaches the coarse cell
/// of its main river above their confluence.
const BELOW: usize = 16;

/// The cells of a window that drawn rivers cross.
#[derive(Debug, Clone, Default)]
pub struct Passages {
    list: Vec<Passage>,
    /// The number in the list plus 1, or 0, of each cell; empty if no river crosses the window.
    of_cell: Vec<u32>,
}

impl Passages {
    /// Whether no river crosses the window.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The passage of a cell.
    #[inline(always)]
    pub fn at(&self, q: usize) -> Option<&Passage> {
        let number = *self.of_cell.get(q)?;
        self.list.get((number as usize).wrapping_sub(1))
    }

    /// The cells that rivers cross and leave, row by row.
    pub fn left(&self) -> impl Iterator<Item = (usize, &Passage)> {
        (0..self.of_cell.len()).filter_map(|q| Some((q, self.at(q)?))).filter(|(_, passage)| passage.code < NONE)
    }

    /// The cells in which rivers end, row by row.
    pub fn ended(&self) -> impl Iterator<Item = (usize, &Passage)> {
        (0..self.of_cell.len()).filter_map(|q| Some((q, self.at(q)?))).filter(|(_, passage)| passage.code == NONE)
    }

    /// The cells that lines cross, row by row.
    pub fn all(&self) -> impl Iterator<Item = (usize, &Passage)> {
        (0..self.of_cell.len()).filter_map(|q| Some((q, self.at(q)?)))
    }

    /// Moves the nodes of the cells that rivers cross.
    pub fn place(&self, east: &mut [f32], south: &mut [f32]) {
        for (q, passage) in self.left().chain(self.ended()) {
            (east[q], south[q]) = (passage.east, passage.south);
        }
    }

    /// Whether the river of a node follows the line, so that its area is that of the drawn river.
    pub fn is_led(&self, level: &Level, q: usize) -> bool {
        let Some(own) = self.at(q) else { return false };
        level.downstream(q).is_some_and(|to| match self.at(to) {
            Some(next) => next.river != own.river || next.chainage > own.chainage,
            None => level.receiver[to] >= NONE,
        })
    }

    /// A river enters a cell.
    fn enter(&mut self, cells: usize, q: usize, entry: f64, river: u32) {
        self.of_cell.resize(cells, 0);
        match (self.of_cell[q] as usize).checked_sub(1) {
            Some(number) if self.list[number].river == river => {
                let present = &mut self.list[number];
                present.entry = present.entry.min(entry);
            }
            Some(_) => {}
            None => {
                let ends = Passage {
                    river,
                    chainage: entry,
                    code: NONE,
                    east: 0.5,
                    south: 0.5,
                    entry,
                    height: 0.0,
                    area: 0.0,
                };
                self.list.push(ends);
                self.of_cell[q] = self.list.len() as u32;
            }
        }
    }

    /// The passages of a part of the window.
    fn cropped(self, window: &Window, part: &Window) -> Passages {
        if self.list.is_empty() {
            return self;
        }
        let of_cell = cropped(&self.of_cell, window, part);
        match of_cell.iter().any(|number| *number > 0) {
            true => Passages { list: self.list, of_cell },
            false => Passages::default(),
        }
    }

    /// The cell after one, if it is in the window.
    fn next(&self, q: usize, width: usize) -> Option<usize> {
        let (east, south) = *STEPS.get(usize::from(self.at(q)?.code))?;
        let (i, j) = ((q % width).checked_add_signed(east)?, (q / width).checked_add_signed(south)?);
        (i < width && j < self.of_cell.len() / width).then_some(j * width + i)
    }

    /// Leaves the cells of bends that the river cuts off at this cell size, because it returns to a cell of its own,
    /// without area: it would be counted twice.
    fn cut_off(&mut self, width: usize) {
        let mut donors = vec![0u8; self.of_cell.len()];
        for q in 0..donors.len() {
            if let Some(to) = self.next(q, width)
                && self.at(to).map(|to| to.river) == self.at(q).map(|from| from.river)
            {
                donors[to] += 1;
            }
        }
        let at_edge = |q: usize| [0, width - 1].contains(&(q % width)) || q < width || q + width >= donors.len();
        let starts = |q: usize| self.at(q).is_some_and(|passage| passage.entry > 0.0) && !at_edge(q);
        let mut ends: Vec<usize> = (0..donors.len()).filter(|&q| donors[q] == 0 && starts(q)).collect();
        for _ in 0..BELOW - 2 {
            let mut next = Vec::new();
            for q in ends {
                let number = self.of_cell[q] as usize - 1;
                let river = self.list[number].river;
                self.list[number].area = 0.0;
                if let Some(to) = self.next(q, width).filter(|&to| self.at(to).is_some_and(|to| to.river == river)) {
                    donors[to] -= 1;
                    if donors[to] == 0 && self.at(to).is_some_and(|passage| passage.entry > 0.0) {
                        next.push(to);
                    }
                }
            }
            ends = next;
        }
    }

    /// Raises beds so that they fall by `rise` from each cell to the next one.
    fn raise(&mut self, width: usize, rise: f32) {
        let own: Vec<f32> = self.list.iter().map(|passage| passage.height).collect();
        for q in 0..self.of_cell.len() {
            let Some(number) = (self.of_cell[q] as usize).checked_sub(1) else { continue };
            let (mut at, mut height) = (q, own[number]);
            for step in 1..=BELOW {
                let Some(to) = self.next(at, width) else { break };
                at = to;
                let Some(next) = (self.of_cell[at] as usize).checked_sub(1) else { break };
                height = height.max(own[next] + step as f32 * rise);
            }
            self.list[number].height = height;
        }
    }

    /// Puts a passage where there is none, or where it comes before the present one: later on the same river, or of an
    /// earlier river. A river that ends in the cell comes after one that leaves it.
    fn put(&mut self, cells: usize, q: usize, passage: Passage) {
        self.of_cell.resize(cells, 0);
        match (self.of_cell[q] as usize).checked_sub(1) {
            Some(number) => {
                let present = &mut self.list[number];
                let comes_first = if passage.river == present.river {
                    passage.chainage >= present.chainage
                } else {
                    (passage.code == NONE, passage.river) < (present.code == NONE, present.river)
                };
                if comes_first {
                    let entry = if passage.river == present.river { present.entry } else { passage.entry };
                    *present = Passage { entry, ..passage };
                }
            }
            None => {
                self.list.push(passage);
                self.of_cell[q] = self.list.len() as u32;
            }
        }
    }
}

/// The cells of a level and of the next coarser one that drawn rivers cross.
pub struct Drawn {
    pub above: Passages,
    pub below: Passages,
    /// Cells of drawn ridges and beside them (see [`super::ridges::marks`]).
    pub ridges: Vec<u8>,
}

impl DrawnRivers {
    /// The cells of a window of level `depth` that rivers cross.
    pub(super) fn passages(&self, land: &Refinement, depth: usize, window: &Window) -> Passages {
        let wide = window.grown(BELOW);
        let mut found = self.crossed(land, depth, &wide);
        for passage in &mut found.list {
            let river = &self.rivers[passage.river as usize];
            (passage.height, passage.area) = (river.height_at(passage.entry) as f32, river.area_at(passage.chainage));
        }
        found.raise(wide.width, land.least_rise(depth));
        found.cut_off(wide.width);
        found.cropped(&wide, window)
    }

    /// The cells of a window that rivers cross, without heights and areas.
    pub(super) fn crossed(&self, land: &Refinement, depth: usize, window: &Window) -> Passages {
        let mut found = Passages::default();
        let (cell, half) = (land.cell_of(depth), 0.5 * land.cell);
        let at = |[x, y]: [f64; 2]| [(x + half) / cell, (y + half) / cell];
        let (low, high) = ([window.x, window.y], [window.right(), window.bottom()]);
        let meets = |from: [f64; 2], to: [f64; 2]| {
            (0..2).all(|k| from[k].max(to[k]) >= low[k] as f64 && from[k].min(to[k]) <= high[k] as f64)
        };
        for (number, river) in self.rivers.iter().enumerate() {
            if !meets(at(river.low), at(river.high)) {
                continue;
            }
            let last = river.points.len() - 2;
            for k in 0..=last {
                let (from, to) = (at(river.points[k]), at(river.points[k + 1]));
                if !meets(from, to) {
                    continue;
                }
                let segment = Segment { from, to };
                let (start, length) = (river.chainage[k], river.chainage[k + 1] - river.chainage[k]);
                let cells = window.len();
                let index = |[x, y]: [i64; 2]| {
                    let is_inside = (low[0]..high[0]).contains(&x) && (low[1]..high[1]).contains(&y);
                    is_inside.then(|| (y - low[1]) as usize * window.width + (x - low[0]) as usize)
                };
                let chainage = |share: f64| if share >= 1.0 { start + length } else { start + share * length };
                let passage = |share: f64, code: u8, [east, south]: [f32; 2]| {
                    let (river, chainage) = (number as u32, chainage(share));
                    Passage { river, chainage, code, east, south, entry: chainage, height: 0.0, area: 0.0 }
                };
                if let Some(q) = index(from.map(|at| at.floor() as i64)).filter(|_| k == 0) {
                    found.enter(cells, q, 0.0, number as u32);
                }
                for axis in 0..2 {
                    segment.crossings(axis, low[axis]..high[axis], |cell, share, code, place| {
                        if let Some(q) = index(cell) {
                            found.put(cells, q, passage(share, code, place));
                        }
                        let (east, south) = STEPS[usize::from(code)];
                        if let Some(q) = index([cell[0] + east as i64, cell[1] + south as i64]) {
                            found.enter(cells, q, chainage(share), number as u32);
                        }
                    });
                }
                if k == last {
                    let cell = to.map(|at| at.floor() as i64);
                    let place = [0, 1].map(|k| inside(to[k] - cell[k] as f64, (2.0 * to[k]).floor() as i64 & 1));
                    if let Some(q) = index(cell) {
                        found.put(cells, q, passage(1.0, NONE, place));
                    }
                }
            }
        }
        found
    }
}

/// A straight part of a line, in cells of a level.
struct Segment {
    from: [f64; 2],
    to: [f64; 2],
}

impl Segment {
    fn cell(&self, axis: usize, end: [f64; 2]) -> i64 {
        end[axis].floor() as i64
    }

    /// The share of the segment before the line between the cells `line - 1` and `line` of an axis.
    fn share(&self, axis: usize, line: i64) -> f64 {
        (line as f64 - self.from[axis]) / (self.to[axis] - self.from[axis])
    }

    /// The cell of an axis just before the segment crosses a line of the other axis at `share`. Of two lines at the
    /// same share, that of the first axis is crossed first.
    fn cell_at(&self, axis: usize, share: f64) -> i64 {
        let (first, last) = (self.cell(axis, self.from), self.cell(axis, self.to));
        let guess = (self.from[axis] + share * (self.to[axis] - self.from[axis])).floor() as i64;
        let is_crossed = |line: i64| {
            let own = self.share(axis, line);
            own < share || (own == share && axis == 0)
        };
        let mut cell = guess.clamp(first.min(last), first.max(last));
        if first <= last {
            while cell < last && is_crossed(cell + 1) {
                cell += 1;
            }
            while cell > first && !is_crossed(cell) {
                cell -= 1;
            }
        } else {
            while cell > last && is_crossed(cell) {
                cell -= 1;
            }
            while cell < first && !is_crossed(cell + 1) {
                cell += 1;
            }
        }
        cell
    }

    /// The same segment in cells of half the size.
    fn halved(&self) -> Segment {
        Segment { from: self.from.map(|at| 2.0 * at), to: self.to.map(|at| 2.0 * at) }
    }

    /// Where the segment leaves cells across lines of an axis: the cell, the share of the segment, the direction, and
    /// the place of the node in the cell. `cells` are those of this axis in the window.
    fn crossings(&self, axis: usize, cells: std::ops::Range<i64>, mut found: impl FnMut([i64; 2], f64, u8, [f32; 2])) {
        let (first, last) = (self.cell(axis, self.from), self.cell(axis, self.to));
        let is_rising = first < last;
        let lines = first.min(last) + 1..first.max(last) + 1;
        // The cell before a line is `line - 1` if the segment rises along the axis, otherwise `line`.
        let lines = lines.start.max(cells.start)..lines.end.min(cells.end.saturating_add(1));
        for line in lines {
            let share = self.share(axis, line);
            let across = self.cell_at(1 - axis, share);
            let half = self.halved().cell_at(1 - axis, share) & 1;
            let at = self.from[1 - axis] + share * (self.to[1 - axis] - self.from[1 - axis]) - across as f64;
            let along = (if is_rising { 1.0 } else { 0.0 }, i64::from(is_rising));
            let (mut cell, mut place) = ([0; 2], [0.0; 2]);
            (cell[axis], cell[1 - axis]) = (if is_rising { line - 1 } else { line }, across);
            (place[axis], place[1 - axis]) = (inside(along.0, along.1), inside(at, half));
            let code = match (axis, is_rising) {
                (0, true) => 0,
                (1, true) => 2,
                (0, false) => 4,
                _ => 6,
            };
            found(cell, share, code, place);
        }
    }
}

/// A position in a cell, moved into the given half of it and away from its border as nodes are.
fn inside(share: f64, half: i64) -> f32 {
    let (least, most) = (0.5 - 0.5 * JITTER, 0.5 + 0.5 * JITTER);
    let share = (share as f32).clamp(least, most);
    if half == 1 { share.max(0.5) } else { share.min(0.499) }
}
