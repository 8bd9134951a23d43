//! Marching squares over a band of rows: finds the crossings of levels with the edges between samples, and their order
//! along lines.
//!
//! A sample counts as high for every level that it reaches, including a level equal to it. Each edge is therefore
//! crossed by a contiguous range of levels, once by each, and the number of a crossing follows without a search.
//!
//! A cell whose four corners are high, low, high, low is ambiguous. It is resolved with the bilinear surface through
//! its corners: by the height of the saddle of that surface (Nielson and Hamann, "The asymptotic decider",
//! Visualization 1991). The saddle is the same for all levels, so lines of different levels never cross.

use std::ops::Range;

use crate::grid::Grid;

/// The class of a sample without a height.
const MISSING: u16 = u16::MAX;

/// The end of a line: no next crossing.
pub const NONE: u32 = u32::MAX;

/// The crossings of a band: on the edges along its rows, and on the edges down from its rows.
///
/// Crossings are numbered by rows: along a row, then down from it. The band's own crossings are followed by those along
/// the first row of the next band, which have the same order as in that band. Bands are therefore joined by adding
/// offsets.
#[derive(Debug, Default)]
pub struct Band {
    /// Column and row of each crossing.
    pub points: Vec<[f64; 2]>,
    /// The next crossing along the line, or [`NONE`].
    pub next: Vec<u32>,
    /// Whether a line leads from another crossing to this one.
    pub entered: Vec<bool>,
    /// The index of the level of each crossing.
    pub level: Vec<u16>,
    /// Number of the band's own crossings.
    pub own: usize,
}

/// Levels, prepared for comparison.
pub struct Levels {
    exact: Vec<f64>,
    /// The smallest f32 that reaches each level, between infinities. Class k is from `steps[k]` up to `steps[k + 1]`.
    steps: Vec<f32>,
}

impl Levels {
    /// Prepares levels in ascending order.
    #[must_use]
    pub fn new(levels: &[f64]) -> Levels {
        let reached = |level: &f64| {
            let near = *level as f32;
            if f64::from(near) >= *level { near } else { near.next_up() }
        };
        let ends = [f32::NEG_INFINITY, f32::INFINITY];
        let steps = ends[..1].iter().copied().chain(levels.iter().map(reached)).chain(ends[1..].iter().copied());
        Levels { exact: levels.to_vec(), steps: steps.collect() }
    }

    /// The number of levels that each sample reaches. Neighbors are similar, so each search starts at the previous
    /// result.
    fn classify(&self, row: &[f32], classes: &mut [u16]) {
        let mut class = 0;
        for (height, out) in row.iter().zip(classes) {
            if !height.is_finite() {
                *out = MISSING;
                continue;
            }
            while *height >= self.steps[class + 1] {
                class += 1;
            }
            while *height < self.steps[class] {
                class -= 1;
            }
            *out = class as u16;
        }
    }
}

/// A row of samples with its classes, and the number of the first crossing on each edge along it.
struct Row<'a> {
    heights: &'a [f32],
    classes: Vec<u16>,
    first: Vec<u32>,
}

impl<'a> Row<'a> {
    fn new(width: usize) -> Row<'a> {
        Row { heights: &[], classes: vec![0; width], first: vec![0; width] }
    }
}

impl Band {
    /// The band of these rows, which must not be only the last row of the grid. Its cells extend to the next row, if
    /// there is one.
    #[must_use]
    pub fn of(grid: &Grid, rows: Range<usize>, levels: &Levels) -> Band {
        let width = grid.width();
        let mut band = Band::default();
        let (mut above, mut below) = (Row::new(width), Row::new(width));
        let mut down = vec![0u32; width];
        band.along(&mut above, grid.row(rows.start), rows.start, levels);
        for j in rows.clone() {
            if j + 1 >= grid.height() {
                break;
            }
            below.heights = grid.row(j + 1);
            levels.classify(below.heights, &mut below.classes);
            band.down(&above, &below, j, levels, &mut down);
            band.own = band.points.len();
            band.cross(&mut below, j + 1, levels);
            band.cells(&above, &below, &down, levels);
            std::mem::swap(&mut above, &mut below);
        }
        if rows.end >= grid.height() {
            band.own = band.points.len();
        }
        band
    }

    fn along<'a>(&mut self, row: &mut Row<'a>, heights: &'a [f32], j: usize, levels: &Levels) {
        row.heights = heights;
        levels.classify(heights, &mut row.classes);
        self.cross(row, j, levels);
    }

    /// Adds the crossings on the edges along a row.
    fn cross(&mut self, row: &mut Row, j: usize, levels: &Levels) {
        let south = j as f64;
        for (i, pair) in row.classes.windows(2).enumerate() {
            if pair[0] != pair[1] && pair[0] != MISSING && pair[1] != MISSING {
                row.first[i] = self.points.len() as u32;
                let [a, b] = [row.heights[i], row.heights[i + 1]].map(f64::from);
                for level in pair[0].min(pair[1])..pair[0].max(pair[1]) {
                    let share = (levels.exact[usize::from(level)] - a) / (b - a);
                    self.push([i as f64 + share, south], level);
                }
            }
        }
    }

    /// Adds the crossings on the edges down from a row.
    fn down(&mut self, above: &Row, below: &Row, j: usize, levels: &Levels, first: &mut [u32]) {
        for (i, (&up, &low)) in above.classes.iter().zip(&below.classes).enumerate() {
            if up != low && up != MISSING && low != MISSING {
                first[i] = self.points.len() as u32;
                let [a, b] = [above.heights[i], below.heights[i]].map(f64::from);
                for level in up.min(low)..up.max(low) {
                    let share = (levels.exact[usize::from(level)] - a) / (b - a);
                    self.push([i as f64, j as f64 + share], level);
                }
            }
        }
    }

    fn push(&mut self, point: [f64; 2], level: u16) {
        self.points.push(point);
        self.next.push(NONE);
        self.entered.push(false);
        self.level.push(level);
    }

    /// Connects the crossings within the cells between two rows.
    fn cells(&mut self, above: &Row, below: &Row, down: &[u32], levels: &Levels) {
        let corners = above.classes.windows(2).zip(below.classes.windows(2));
        for (i, (north, south)) in corners.enumerate() {
            let [nw, ne, sw, se] = [north[0], north[1], south[0], south[1]];
            if nw == ne && nw == sw && nw == se {
                continue;
            }
            // The class of a missing sample is greater than all others.
            let high = nw.max(ne).max(sw.max(se));
            if high == MISSING {
                continue;
            }
            // The number that the crossing of level 0 on an edge would have. It wraps around if that is before the
            // first.
            let base = |first: u32, a: u16, b: u16| first.wrapping_sub(u32::from(a.min(b)));
            let top = base(above.first[i], nw, ne);
            let bottom = base(below.first[i], sw, se);
            let (left, right) = (base(down[i], nw, sw), base(down[i + 1], ne, se));
            for level in nw.min(ne).min(sw.min(se))..high {
                let is_high = |class: u16| u8::from(class > level);
                let [top, bottom, left, right] =
                    [top, bottom, left, right].map(|base| base.wrapping_add(u32::from(level)));
                // Higher ground to the left: if the west is high, a line runs north; if the north is high, it runs
                // east.
                match is_high(nw) << 3 | is_high(ne) << 2 | is_high(sw) << 1 | is_high(se) {
                    0b1000 => self.link(left, top),
                    0b0100 => self.link(top, right),
                    0b0010 => self.link(bottom, left),
                    0b0001 => self.link(right, bottom),
                    0b0111 => self.link(top, left),
                    0b1011 => self.link(right, top),
                    0b1101 => self.link(left, bottom),
                    0b1110 => self.link(bottom, right),
                    0b1100 => self.link(left, right),
                    0b0011 => self.link(right, left),
                    0b1010 => self.link(bottom, top),
                    0b0101 => self.link(top, bottom),
                    saddle @ (0b1001 | 0b0110) => {
                        let heights = [above.heights[i], above.heights[i + 1], below.heights[i], below.heights[i + 1]];
                        let joined = saddle_of(heights) >= levels.exact[usize::from(level)];
                        let pairs = match (saddle == 0b1001, joined) {
                            (true, true) => [(right, top), (left, bottom)],
                            (true, false) => [(left, top), (right, bottom)],
                            (false, true) => [(top, left), (bottom, right)],
                            (false, false) => [(top, right), (bottom, left)],
                        };
                        pairs.into_iter().for_each(|(from, to)| self.link(from, to));
                    }
                    _ => {}
                }
            }
        }
    }

    fn link(&mut self, from: u32, to: u32) {
        self.next[from as usize] = to;
        self.entered[to as usize] = true;
    }
}

/// The height of the saddle of the bilinear surface through the corners of a cell with two opposite corners higher than
/// the other two.
fn saddle_of(corners: [f32; 4]) -> f64 {
    let [nw, ne, sw, se] = corners.map(f64::from);
    (nw * se - ne * sw) / ((nw + se) - (ne + sw))
}
