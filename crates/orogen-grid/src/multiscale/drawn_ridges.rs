//! Ridges and summits drawn on the map.
//!
//! Which cells of a level a ridge crosses, and how far a node is from it, depend on the drawing alone, so they have the
//! same bits in every window.

use super::drawn_rivers::{DrawnRivers, River, cleaned};
use super::hash::JITTER;
use super::level::invalid;
use super::refinement::Refinement;
use crate::error::Result;
use crate::grid::Window;

/// Minimum and maximum height of a ridge above the sea, in metres.
const HEIGHTS: [f64; 2] = [1.0, 1e5];

/// Cells of ridges, and cells beside them, in planes of marks.
pub(super) const RIDGE: u8 = 2;
pub(super) const BESIDE: u8 = 1;

/// The ridges and summits of a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawnRidges {
    lines: DrawnRivers,
    /// Points: east, south, height, in metres.
    summits: Vec<[f64; 3]>,
    /// The number of the first line without heights, from 1.
    flat: Option<usize>,
}

/// The node of a cell that a ridge crosses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crest {
    /// The index of the cell in the window.
    pub q: usize,
    /// Position of the node in its cell: at the highest place of the ridge in the cell, as far as nodes get there.
    pub east: f32,
    pub south: f32,
    /// Height of the ridge there, in metres.
    pub height: f32,
}

/// The nearest place of a ridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Near {
    /// Distance in metres; infinite if no ridge is near.
    pub distance: f32,
    /// Height of the ridge there, in metres.
    pub height: f32,
}

impl Near {
    pub const NOTHING: Near = Near { distance: f32::INFINITY, height: 0.0 };
}

impl DrawnRidges {
    /// Ridges along lines, whose points are metres east, metres south, and the height. A line of one point is a summit.
    #[must_use]
    pub fn new(lines: &[Vec<[f64; 3]>]) -> DrawnRidges {
        let mut made = DrawnRidges::default();
        for (number, line) in (1..).zip(lines) {
            if made.flat.is_none() && line.iter().all(|point| point[2] <= 0.0) {
                made.flat = Some(number);
            }
            let [least, most] = HEIGHTS;
            let line = cleaned(line).into_iter().map(|[x, y, height]| [x, y, height.clamp(least, most)]);
            let line: Vec<[f64; 3]> = line.collect();
            match line.as_slice() {
                [] => {}
                [summit] => made.summits.push(*summit),
                line => made.lines.rivers.push(River::along(line)),
            }
        }
        // Where ridges meet in a cell, the cell belongs to the highest one.
        let top = |line: &River| line.height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        made.lines.rivers.sort_by(|one, other| top(other).total_cmp(&top(one)));
        made.summits.sort_by(|one, other| one[2].total_cmp(&other[2]));
        made
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.summits.is_empty()
    }

    /// Checks that every ridge is above the sea.
    pub(super) fn check(&self) -> Result<()> {
        self.flat.map_or(Ok(()), |number| {
            Err(invalid(format!(
                "ridge {number} has no height above 0; give its points a third number, the height in metres"
            )))
        })
    }

    /// Memory in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.lines.memory() + size_of_val(self.summits.as_slice()) as u64
    }

    /// The cells of a window of level `depth` with ridges and summits, row by row.
    pub(super) fn crests(&self, land: &Refinement, depth: usize, window: &Window) -> Vec<Crest> {
        let (cell, half) = (land.cell_of(depth), 0.5 * land.cell);
        let at = |[x, y]: [f64; 2]| [(x + half) / cell, (y + half) / cell];
        let crest = |q: usize, place: [f64; 2], height: f64| {
            let corner = [window.x + (q % window.width) as i64, window.y + (q / window.width) as i64];
            let within = |k: usize| {
                let share = (at(place)[k] - corner[k] as f64) as f32;
                share.clamp(0.5 - 0.5 * JITTER, 0.5 + 0.5 * JITTER)
            };
            Crest { q, east: within(0), south: within(1), height: height as f32 }
        };
        let crossed = self.lines.crossed(land, depth, window);
        let mut crests: Vec<Crest> =
            crossed
                .all()
                .map(|(q, passage)| {
                    let line = &self.lines.rivers[passage.river as usize];
                    let within = |chainage: &f64| (passage.entry..=passage.chainage).contains(chainage);
                    let ends = [passage.entry, passage.chainage];
                    let best = ends.into_iter().chain(line.chainage.iter().copied().filter(within));
                    let middle = 0.5 * (ends[0] + ends[1]);
                    let best = best.fold(middle, |best, chainage| {
                        if line.height_at(chainage) > line.height_at(best) { chainage } else { best }
                    });
                    crest(q, line.place(best), line.height_at(best))
                })
                .collect();
        for &[x, y, height] in &self.summits {
            let [i, j] = at([x, y]).map(f64::floor);
            let (i, j) = (i - window.x as f64, j - window.y as f64);
            if i < 0.0 || j < 0.0 || i >= window.width as f64 || j >= window.height as f64 {
                continue;
            }
            let q = j as usize * window.width + i as usize;
            let own = crest(q, [x, y], height);
            match crests.binary_search_by_key(&q, |crest| crest.q) {
                Ok(k) if crests[k].height <= own.height => crests[k] = own,
                Ok(_) => {}
                Err(k) => crests.insert(k, own),
            }
        }
        crests
    }

    /// The nearest place of a ridge to a position in each cell of a window of level `depth`, within `reach` cells.
    /// `inside` are the positions in cells: of the samples of the window from the corners of their cells.
    pub(super) fn near(
        &self,
        land: &Refinement,
        depth: usize,
        window: &Window,
        reach: f64,
        inside: impl Fn(usize) -> [f32; 2],
    ) -> Vec<Near> {
        let (cell, half) = (land.cell_of(depth), 0.5 * land.cell);
        let at = |[x, y]: [f64; 2]| [(x + half) / cell, (y + half) / cell];
        let mut near = vec![Near::NOTHING; window.len()];
        let (first, size) = ([window.x as f64, window.y as f64], [window.width as f64, window.height as f64]);
        let mut offer = |from: [f64; 2], to: [f64; 2], heights: [f64; 2]| {
            let (from, to) = (at(from), at(to));
            let range = |k: usize| {
                // The position of a sample can be a cell beyond its own.
                let low = (from[k].min(to[k]) - reach - 2.0 - first[k]).floor().clamp(0.0, size[k]);
                let high = (from[k].max(to[k]) + reach + 2.0 - first[k]).ceil().clamp(0.0, size[k]);
                low as usize..high as usize
            };
            let step = [to[0] - from[0], to[1] - from[1]];
            let square = step[0] * step[0] + step[1] * step[1];
            for j in range(1) {
                for i in range(0) {
                    let q = j * window.width + i;
                    let [east, south] = inside(q);
                    let x = (window.x + i as i64) as f64 + f64::from(east) - from[0];
                    let y = (window.y + j as i64) as f64 + f64::from(south) - from[1];
                    let share = if square > 0.0 { ((x * step[0] + y * step[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
                    let (x, y) = (x - share * step[0], y - share * step[1]);
                    let distance = (x * x + y * y).sqrt();
                    let metres = (distance * cell) as f32;
                    if distance <= reach && metres < near[q].distance {
                        let height = heights[0] + share * (heights[1] - heights[0]);
                        near[q] = Near { distance: metres, height: height as f32 };
                    }
                }
            }
        };
        for line in &self.lines.rivers {
            let [low, high] = [at(line.low), at(line.high)];
            let is_near =
                (0..2).all(|k| low[k] - reach - 2.0 <= first[k] + size[k] && high[k] + reach + 2.0 >= first[k]);
            if is_near {
                for (ends, heights) in line.points.windows(2).zip(line.height.windows(2)) {
                    offer(ends[0], ends[1], [heights[0], heights[1]]);
                }
            }
        }
        for &[x, y, height] in &self.summits {
            offer([x, y], [x, y], [height, height]);
        }
        near
    }
}
