//! Beds and banks of rivers on detail levels, where cells are smaller than the width of rivers.

use super::level::Level;
use super::refinement::Refinement;
use super::surface::Surface;
use crate::error::Result;
use crate::grid::Window;
use crate::hydrology::direction::{NONE, STEPS};
use crate::hydrology::rivers::Channel;
use crate::progress::Progress;

/// Half the width of the widest river, in cells. Wider rivers are narrowed to this width.
const WIDEST: f32 = 20.0;

/// Number of links up and down a river over which its course is averaged, per half width in cells, with a minimum and a
/// maximum. Without averaging, banks would be as angular as the links between cells.
const SMOOTHED: f32 = 3.0;
const MIN_SMOOTHED: f32 = 8.0;
const MAX_SMOOTHED: f32 = 24.0;

/// Widths in cells at which beds begin to be cut and have their full depth. A river narrower than a cell has no bed.
const NARROW: [f32; 2] = [1.0, 2.0];

/// A river at a node.
#[derive(Clone, Copy)]
struct Node {
    east: f32,
    south: f32,
    height: f32,
    /// Half the width, in cells.
    half: f32,
    /// Depth from bank to bed, in metres.
    depth: f32,
}

/// Parameters for cutting rivers.
struct Rivers<'a> {
    level: &'a Level,
    cell: f64,
    least_area: f64,
    channel: &'a Channel,
}

impl Refinement {
    /// Number of samples beyond a window from which the rivers affect the window in [`Refinement::cut_rivers`].
    pub const BEDS_REACH: usize = WIDEST as usize + 1;

    /// Number of samples of a level beyond a window that [`Refinement::cut_rivers`] reads.
    #[must_use]
    pub fn rivers_reach(&self, depth: usize) -> usize {
        if self.is_detail(depth) { (WIDEST + MAX_SMOOTHED) as usize + 2 } else { 0 }
    }

    /// On a detail level, lowers the ground to the beds of rivers with at least `least_area` of drainage area, in m^2.
    /// There are banks between flat beds and the ground next to them. Heights fall along the beds as they fall along
    /// the nodes. On other levels nothing is changed.
    ///
    /// # Errors
    /// If the level does not cover the surface's window grown by [`Refinement::rivers_reach`], or the work is
    /// cancelled.
    pub fn cut_rivers(
        &self,
        level: &Level,
        surface: &mut Surface,
        least_area: f64,
        channel: &Channel,
        progress: &Progress,
    ) -> Result<()> {
        if !self.is_detail(level.depth) {
            return Ok(());
        }
        let nodes = self.nodes_at(level.depth, surface.height.window());
        let read = nodes.grown(Refinement::BEDS_REACH);
        level.check_covers("a river bed", &nodes, self.rivers_reach(level.depth))?;
        let rivers = Rivers { level, cell: self.cell_of(level.depth), least_area, channel };
        for y in read.y..read.bottom() {
            progress.check()?;
            for x in read.x..read.right() {
                rivers.cut(x, y, &nodes, surface);
            }
        }
        Ok(())
    }
}

impl Rivers<'_> {
    /// Cuts the bed along the link from the node of a cell to its receiver.
    fn cut(&self, x: i64, y: i64, nodes: &Window, surface: &mut Surface) {
        let level = self.level;
        let q = (y - level.window.y) as usize * level.window.width + (x - level.window.x) as usize;
        let (area, receiver) = (f64::from(level.area[q]) * self.cell * self.cell, level.receiver[q]);
        if area < self.least_area || receiver >= NONE {
            return;
        }
        let (east, south) = STEPS[usize::from(receiver)];
        let to = q.wrapping_add_signed(south * level.window.width as isize + east);
        // Positions are relative to the cell, so that they do not depend on the window.
        let (from, to) = (self.node(q, 0.0, 0.0), self.node(to, east as f32, south as f32));
        let half = from.half.max(to.half);
        if 2.0 * half <= NARROW[0] {
            return;
        }
        let span = |a: f32, b: f32| ((a.min(b) - half).floor() as i64, (a.max(b) + half).ceil() as i64);
        let ((left, right), (top, bottom)) = (span(from.east, to.east), span(from.south, to.south));
        let rows = (y + top).max(nodes.y)..(y + bottom + 1).min(nodes.bottom());
        for row in rows {
            for column in (x + left).max(nodes.x)..(x + right + 1).min(nodes.right()) {
                let at = ((column - nodes.x) as usize, (row - nodes.y) as usize);
                if let Some(bed) = bed(&from, &to, (column - x) as f32, (row - y) as f32)
                    && bed < surface.height[at]
                    && surface.water_level[at].is_nan()
                {
                    surface.height[at] = bed;
                }
            }
        }
    }

    /// The river at node `q`, whose cell is `east` and `south` of another cell, averaged over links up and down the
    /// river.
    fn node(&self, q: usize, east: f32, south: f32) -> Node {
        let width = self.width(q);
        let reach = (SMOOTHED * 0.5 * width).clamp(MIN_SMOOTHED, MAX_SMOOTHED) as usize;
        let mut sums = Sums::default();
        sums.add(self.level, q, (east, south), (reach + 1) as f32);
        for towards in [Rivers::receiver, Rivers::main_donor] {
            let (mut at, mut offset) = (q, (east, south));
            for link in 0..reach {
                let Some(code) = towards(self, at) else { break };
                let (by_east, by_south) = STEPS[usize::from(code)];
                at = at.wrapping_add_signed(by_south * self.level.window.width as isize + by_east);
                offset = (offset.0 + by_east as f32, offset.1 + by_south as f32);
                sums.add(self.level, at, offset, (reach - link) as f32);
            }
        }
        let discharge = self.discharge(q);
        let share = ((width - NARROW[0]) / (NARROW[1] - NARROW[0])).clamp(0.0, 1.0);
        let depth = if self.level.receiver[q] < NONE { self.channel.depth_of(discharge) as f32 * share } else { 0.0 };
        let [east, south, height] = sums.of.map(|sum| sum / sums.weight);
        Node { east, south, height, half: (0.5 * width).min(WIDEST), depth }
    }

    fn discharge(&self, q: usize) -> f64 {
        self.channel.discharge(f64::from(self.level.area[q]) * self.cell * self.cell)
    }

    /// The width in cells.
    fn width(&self, q: usize) -> f32 {
        (self.channel.width_of(self.discharge(q)) / self.cell) as f32
    }

    /// The code of the direction downstream; `None` in water.
    fn receiver(&self, q: usize) -> Option<u8> {
        Some(self.level.receiver[q]).filter(|code| *code < NONE)
    }

    /// The code of the direction to the donor with the largest area, the first of equal ones; `None` at sources.
    fn main_donor(&self, q: usize) -> Option<u8> {
        let (mut best, mut most) = (None, 0.0);
        for (code, (east, south)) in (0u8..).zip(STEPS) {
            let donor = q.wrapping_add_signed(south * self.level.window.width as isize + east);
            if self.level.receiver[donor] == (code + 4) & 7 && self.level.area[donor] > most {
                (best, most) = (Some(code), self.level.area[donor]);
            }
        }
        best
    }
}

/// Weighted sums of positions and heights of nodes.
#[derive(Default)]
struct Sums {
    of: [f32; 3],
    weight: f32,
}

impl Sums {
    fn add(&mut self, level: &Level, q: usize, (east, south): (f32, f32), weight: f32) {
        let values = [level.east[q] + east, level.south[q] + south, level.height[q]];
        self.of.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        self.weight += weight;
    }
}

/// The height of the bed between two nodes at a position; `None` beyond the banks.
fn bed(from: &Node, to: &Node, east: f32, south: f32) -> Option<f32> {
    let (along_east, along_south) = (to.east - from.east, to.south - from.south);
    let (x, y) = (east - from.east, south - from.south);
    let square = (along_east * along_east + along_south * along_south).max(1e-6);
    let share = ((x * along_east + y * along_south) / square).clamp(0.0, 1.0);
    let between = |a: f32, b: f32| a + share * (b - a);
    let (x, y) = (x - share * along_east, y - share * along_south);
    let half = between(from.half, to.half);
    let across = (x * x + y * y) / (half * half);
    let profile = 1.0 - across * across;
    (across < 1.0).then(|| between(from.height, to.height) - between(from.depth, to.depth) * profile)
}
