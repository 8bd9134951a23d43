//! Watersheds of chosen outlets (pour points), which are first moved to the nearest stream.

use super::water::{Cover, Water};
use super::watersheds::label_way;
use super::zones::ZoneStats;
use crate::error::Result;
use crate::progress::Progress;

/// The index that stands for no outlet.
pub const NONE: u32 = u32::MAX;

/// The stream node near a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Snapped {
    /// The index of the node.
    pub node: usize,
    /// The distance of the node from the position, in samples.
    pub moved: f64,
}

/// The stream node that is nearest to a position, within `radius` samples (Jenson 1991). Stream nodes are nodes on land
/// or in a lake through which at least `least` samples drain. Of equally near nodes, the one with the largest drainage
/// area is returned. `at` is a column and a row of the grid. Only nodes of samples that `inside` accepts are
/// considered. The time is O(distance^2).
///
/// # Errors
/// If the work was cancelled.
pub fn nearest_stream(
    water: &Water,
    at: [f64; 2],
    least: f64,
    radius: f64,
    inside: impl Fn([usize; 2]) -> bool,
    progress: &Progress,
) -> Result<Option<Snapped>> {
    let (width, height) = (water.heights.width() as i64, water.heights.height() as i64);
    let column = (at[0].round() as i64).clamp(0, width.max(1) - 1);
    let row = (at[1].round() as i64).clamp(0, height.max(1) - 1);
    let farthest = radius.min((width + height) as f64).ceil() as i64 + 2;
    let mut best: Option<Snapped> = None;
    for ring in 0..=farthest {
        // A node is at most one sample from its own sample, and the position half a sample from the center of the
        // rings.
        if best.is_some_and(|best| best.moved < ring as f64 - 2.0) {
            break;
        }
        progress.check()?;
        for j in (row - ring).max(0)..=(row + ring).min(height - 1) {
            let whole = (j - row).abs() == ring;
            let step = if whole || ring == 0 { 1 } else { 2 * ring };
            for i in (column - ring..=column + ring).step_by(step as usize).filter(|i| (0..width).contains(i)) {
                let node = (j * width + i) as usize;
                let is_stream = water.drained(node) >= least
                    && matches!(water.node_cover(node), Cover::Land | Cover::Lake(_))
                    && water.heights.data()[node].is_finite();
                if !is_stream || !inside([i as usize, j as usize]) {
                    continue;
                }
                let [x, y] = water.node_place(node);
                let moved = libm::hypot(x - at[0], y - at[1]);
                let is_better = best.is_none_or(|best| {
                    moved < best.moved || moved == best.moved && water.drained(node) > water.drained(best.node)
                });
                if moved <= radius && is_better {
                    best = Some(Snapped { node, moved });
                }
            }
        }
    }
    Ok(best)
}

/// The land that drains to each of several chosen nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct PourPoints {
    /// For each node, the index of the first outlet that its water passes; [`NONE`] if it passes none.
    pub labels: Vec<u32>,
    /// For each outlet, the index of the next outlet downstream.
    pub downstream: Vec<Option<u32>>,
}

impl PourPoints {
    /// The land that drains to each of these nodes. If two outlets are at the same node, the water passes the later one
    /// first. The time is O(nodes).
    ///
    /// # Errors
    /// If the work was cancelled.
    pub fn of(water: &Water, outlets: &[usize], progress: &Progress) -> Result<PourPoints> {
        const UNKNOWN: u32 = NONE - 1;
        let mut labels = vec![UNKNOWN; water.heights.data().len()];
        // The next outlet at the same node.
        let mut same = vec![None; outlets.len()];
        for (k, node) in outlets.iter().enumerate() {
            if labels[*node] != UNKNOWN {
                same[k] = Some(labels[*node]);
            }
            labels[*node] = k as u32;
        }
        let mut way = Vec::new();
        for start in 0..labels.len() {
            if start.is_multiple_of(1 << 20) {
                progress.check()?;
            }
            label_way(&water.receivers, start, &mut labels, [UNKNOWN, NONE], &mut way);
        }
        let next = |node: usize| match water.receivers.of(node) {
            next if next == node => None,
            next => Some(labels[next]).filter(|label| *label != NONE),
        };
        let downstream = outlets.iter().zip(same).map(|(node, same)| same.or_else(|| next(*node))).collect();
        Ok(PourPoints { labels, downstream })
    }

    /// For each outlet, its own index and those of the outlets upstream.
    #[must_use]
    pub fn upstream(&self) -> Vec<Vec<u32>> {
        let mut all: Vec<Vec<u32>> = vec![Vec::new(); self.downstream.len()];
        for k in 0..self.downstream.len() {
            let mut at = Some(k as u32);
            while let Some(outlet) = at {
                all[outlet as usize].push(k as u32);
                at = self.downstream[outlet as usize];
            }
        }
        all
    }
}

/// Statistics of the samples of a label.
#[derive(Debug, Clone, Copy)]
pub struct LabelStats {
    /// The heights of the samples.
    pub ground: ZoneStats,
    /// The first and the last column.
    pub columns: [usize; 2],
    /// The first and the last row.
    pub rows: [usize; 2],
    /// Whether a sample is at the border of the grid, or next to a sample without a height.
    pub at_border: bool,
}

impl LabelStats {
    /// No samples.
    pub const EMPTY: LabelStats =
        LabelStats { ground: ZoneStats::EMPTY, columns: [usize::MAX, 0], rows: [usize::MAX, 0], at_border: false };

    /// The statistics of the samples of both.
    #[must_use]
    pub fn join(mut self, other: &LabelStats) -> LabelStats {
        let span = |a: [usize; 2], b: [usize; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        self.ground.join(&other.ground);
        LabelStats {
            columns: span(self.columns, other.columns),
            rows: span(self.rows, other.rows),
            at_border: self.at_border || other.at_border,
            ..self
        }
    }
}

impl PourPoints {
    /// The label of each land sample in some columns and rows of the water's grid, and the statistics of each of
    /// `count` labels.
    #[must_use]
    pub fn sampled(
        &self,
        water: &Water,
        count: usize,
        columns: &[usize],
        rows: &[usize],
    ) -> (Vec<u32>, Vec<LabelStats>) {
        let (width, height) = (columns.len(), rows.len());
        let at = |i: usize, j: usize| rows[j] * water.heights.width() + columns[i];
        let is_missing = |i: usize, j: usize| water.cover(at(i, j)) == Cover::Missing;
        let mut labels = vec![NONE; width * height];
        let mut parts = vec![LabelStats::EMPTY; count];
        for j in 0..height {
            for i in 0..width {
                let at = at(i, j);
                let label = self.labels[water.nearest_node(at)];
                if label == NONE || !matches!(water.cover(at), Cover::Land | Cover::Lake(_)) {
                    continue;
                }
                labels[j * width + i] = label;
                let known = &mut parts[label as usize];
                known.ground.add(water.heights.data()[at]);
                *known = known.join(&LabelStats {
                    ground: ZoneStats::EMPTY,
                    columns: [i; 2],
                    rows: [j; 2],
                    at_border: known.at_border
                        || i == 0
                        || j == 0
                        || i + 1 == width
                        || j + 1 == height
                        || (j - 1..=j + 1).any(|y| (i - 1..=i + 1).any(|x| is_missing(x, y))),
                });
            }
        }
        (labels, parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Grid, Window};
    use crate::hydrography::water::Least;
    use crate::hydrology::samples;

    fn water(seed: i64, sea: Option<f32>) -> Water {
        Water::of(samples::hills(60, 50, seed), sea, Least::new(12, 4), &Progress::none()).unwrap()
    }

    #[test]
    fn a_watershed_is_all_that_flows_through_its_outlet() {
        for seed in 0..5 {
            let water = water(seed, Some(250.0));
            let drains_much = (0..water.area.data().len()).filter(|node| water.area.data()[*node] >= 40);
            let mut outlets: Vec<usize> = drains_much.step_by(7).collect();
            // Two outlets at one node.
            outlets.push(outlets[0]);
            let found = PourPoints::of(&water, &outlets, &Progress::none()).unwrap();
            let passes = |start: usize, outlet: usize| {
                let mut at = start;
                loop {
                    let next = water.receivers.of(at);
                    if at == outlet || next == at {
                        return at == outlet;
                    }
                    at = next;
                }
            };
            assert!(found.downstream.iter().any(Option::is_some));
            assert_eq!(found.downstream[outlets.len() - 1], Some(0));
            for (k, upstream) in found.upstream().iter().enumerate() {
                let mut count = 0;
                for node in 0..found.labels.len() {
                    let is_inside = upstream.contains(&found.labels[node]);
                    assert_eq!(is_inside, passes(node, outlets[k]));
                    count += u32::from(is_inside);
                }
                assert_eq!(count, water.area.data()[outlets[k]], "{seed}: {k}");
            }
        }
    }

    #[test]
    fn the_nearest_stream_is_that_of_a_search_through_all_nodes() {
        let mut moved = 0;
        for seed in 0..4 {
            let water = water(seed, Some(250.0));
            let is_stream = |node: usize| {
                water.area.data()[node] >= 20 && matches!(water.cover(node), Cover::Land | Cover::Lake(_))
            };
            for k in 0..60 {
                let at = [f64::from(k * 37 % 590) / 10.0, f64::from(k * 53 % 490) / 10.0];
                let inside = |[i, j]: [usize; 2]| i > 3 && j < 45;
                let far = |node: usize| libm::hypot((node % 60) as f64 - at[0], (node / 60) as f64 - at[1]);
                let expect = (0..3000)
                    .filter(|node| is_stream(*node) && inside([node % 60, node / 60]) && far(*node) <= 6.5)
                    .min_by(|a, b| far(*a).total_cmp(&far(*b)).then(water.area.data()[*b].cmp(&water.area.data()[*a])));
                let found = nearest_stream(&water, at, 20.0, 6.5, inside, &Progress::none()).unwrap();
                assert_eq!(found.map(|found| found.moved), expect.map(far), "{seed}: {at:?}");
                moved += u32::from(found.is_some_and(|found| found.moved > 2.0));
            }
        }
        assert!(moved > 20, "{moved}");
    }

    #[test]
    fn land_that_passes_no_outlet_has_no_label() {
        let mut slope = Grid::filled(Window::new(9, 5, 1.0), 0.0);
        for j in 0..5 {
            for i in 0..9 {
                slope.row_mut(j)[i] = 9.0 - i as f32 + (j as f32 - 2.0).abs() * 0.1;
            }
        }
        let water = Water::of(slope, None, Least::new(1, 1), &Progress::none()).unwrap();
        let found = PourPoints::of(&water, &[2 * 9 + 4], &Progress::none()).unwrap();
        assert_eq!((found.labels[2 * 9 + 3], found.labels[2 * 9 + 5]), (0, NONE));
        assert_eq!((found.downstream, found.labels[0]), (vec![None], NONE));
    }
}
