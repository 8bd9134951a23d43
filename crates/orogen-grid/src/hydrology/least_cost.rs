//! Least-cost breaching: draining depressions with the channels that need the least excavation.

use super::direction::{DISTANCES, NONE, neighbor, opposite, strides};
use super::outlets::Outlets;
use super::steepest::{self, Descent};
use super::{drainage, fill, flats, receivers::Receivers};
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Limits of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Limits {
    /// The maximum depth of a cut, in metres.
    pub deepest: f32,
    /// The maximum length of a channel, in cells.
    pub longest: u32,
}

impl Limits {
    /// Limits for cuts, in metres, and for lengths of channels, in cells.
    #[must_use]
    pub const fn new(deepest: f32, longest: u32) -> Limits {
        Limits { deepest, longest }
    }
}

orogen_noise::builder!(Limits: with_deepest(deepest: f32), with_longest(longest: u32));

/// The heights without depressions. From the bottom of each depression a channel is cut to lower ground or an outlet:
/// the one within the limits that has the least sum of depth times length. A depression without such a channel is
/// filled (Lindsay 2016, "Efficient hybrid breaching-filling sink removal methods for flow path enforcement in digital
/// elevation models"; Lindsay and Dhun 2015).
///
/// Depressions are processed in the order of their bottoms from the lowest up, equal ones in row order, each on the
/// ground that the previous ones left. Of paths with equal cost the first in row order is taken. The beds of channels
/// are level. Unlike with [`breach`](super::breach::breach), a channel may cross a rim anywhere: it cuts through a thin
/// dam instead of following a long way around it. The time is O(n log n) for the n cells that the searches visit: those
/// in and around the depression, up to the square of the longest channel.
///
/// # Errors
/// If the work is cancelled.
pub fn breach(heights: &Grid, outlets: &Outlets, limits: &Limits, progress: &Progress) -> Result<Grid> {
    let [searching, filling] = progress.parts([3.0, 1.0]);
    let mut out = heights.clone();
    let mut receivers = steepest::receivers(heights, outlets, Descent::Steepest);
    flats::resolve(heights, outlets, &mut receivers);
    let mut search = Search::new(&receivers);
    progress.check()?;
    let bottoms = bottoms(heights, outlets, &receivers);
    searching.expect(bottoms.len() as f64);
    for (n, pit) in bottoms.into_iter().enumerate() {
        search.drain(out.data_mut(), outlets, pit, limits, progress)?;
        if n % REPORTED == REPORTED - 1 {
            searching.advance(REPORTED as f64);
        }
    }
    searching.finish();
    let drained = drainage::route_carving_with(&out, outlets, Descent::Steepest, &filling)?;
    Ok(fill::filled(&out, &drained.basins))
}

/// Number of searches between two reports of progress.
const REPORTED: usize = 64;

/// Number of cells that a search visits between two checks for cancellation.
const UNCHECKED: usize = 1 << 14;

/// The lowest cell of each depression, the lowest depression first.
fn bottoms(heights: &Grid, outlets: &Outlets, receivers: &Receivers) -> Vec<usize> {
    let is_bottom = |c: &usize| receivers.code(*c) == NONE && !outlets.at(*c);
    let mut bottoms: Vec<usize> = (0..heights.data().len()).filter(is_bottom).collect();
    bottoms.sort_by(|a, b| heights.data()[*a].total_cmp(&heights.data()[*b]));
    bottoms
}

/// For each cell, the result of the last search that visited it.
#[derive(Debug, Clone, Copy)]
struct Found {
    search: u32,
    /// Number of cells from the bottom of the depression.
    length: u32,
    cost: f64,
    /// The direction back to the bottom.
    back: u8,
    settled: bool,
}

struct Search {
    strides: [isize; 8],
    found: Vec<Found>,
    searches: u32,
}

impl Search {
    fn new(receivers: &Receivers) -> Search {
        let nothing = Found { search: 0, length: 0, cost: f64::INFINITY, back: NONE, settled: false };
        Search {
            strides: strides(receivers.window().width),
            found: vec![nothing; receivers.codes().len()],
            searches: 0,
        }
    }

    /// Cuts the cheapest channel from `pit` within the limits, if there is one (Dijkstra's algorithm).
    fn drain(
        &mut self,
        h: &mut [f32],
        outlets: &Outlets,
        pit: usize,
        limits: &Limits,
        progress: &Progress,
    ) -> Result<()> {
        self.searches += 1;
        let (search, bed) = (self.searches, h[pit]);
        self.found[pit] = Found { search, length: 0, cost: 0.0, back: NONE, settled: false };
        // Costs are not negative, so their bits sort like their values.
        let mut waiting = BinaryHeap::from([Reverse((0u64, pit))]);
        let mut looked = 0usize;
        while let Some(Reverse((_, cell))) = waiting.pop() {
            if looked.is_multiple_of(UNCHECKED) {
                progress.check()?;
            }
            looked += 1;
            let here = self.found[cell];
            if std::mem::replace(&mut self.found[cell].settled, true) {
                continue;
            }
            if h[cell] < bed || outlets.at(cell) && h[cell] <= bed {
                self.cut(h, cell, bed);
                return Ok(());
            }
            // An outlet is not cut, so no path continues beyond a higher one.
            if outlets.at(cell) || here.length >= limits.longest {
                continue;
            }
            for (k, stride) in self.strides.into_iter().enumerate() {
                let n = neighbor(cell, stride);
                let depth = (h[n] - bed).max(0.0);
                if depth > limits.deepest || outlets.at(n) && h[n] > bed {
                    continue;
                }
                let cost = here.cost + f64::from(depth) * DISTANCES[k];
                let there = &mut self.found[n];
                if there.search != search || cost < there.cost {
                    *there = Found { search, length: here.length + 1, cost, back: opposite(k as u8), settled: false };
                    waiting.push(Reverse((cost.to_bits(), n)));
                }
            }
        }
        Ok(())
    }

    /// Lowers the path back from `end` to the bed.
    fn cut(&self, h: &mut [f32], end: usize, bed: f32) {
        let mut cell = end;
        while self.found[cell].back != NONE {
            cell = neighbor(cell, self.strides[usize::from(self.found[cell].back)]);
            h[cell] = h[cell].min(bed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::{breach as along_valleys, samples};

    #[test]
    fn no_depression_is_left_and_the_limits_are_kept() {
        for heights in samples::grids() {
            for (deepest, longest) in [(0.0, 50), (20.0, 4), (150.0, 50), (1e9, 1000)] {
                let outlets = Outlets::new(&heights, None);
                let out = breach(&heights, &outlets, &Limits { deepest, longest }, &Progress::none()).unwrap();
                let full = fill(&out, &outlets);
                for (c, (new, old)) in out.data().iter().zip(heights.data()).enumerate() {
                    assert!(new.to_bits() == full.data()[c].to_bits() || new.is_nan(), "a depression at {c}");
                    assert!(old.is_nan() || old - new <= deepest, "{old} to {new}");
                    assert!(!outlets.at(c) || new.to_bits() == old.to_bits(), "outlets stay");
                }
            }
        }
    }

    #[test]
    fn a_thin_dam_is_cut_where_the_valley_would_go_around() {
        // A bowl with a rim of 3 at the end of a long path to the north, and a thin wall of 5 to the east.
        let mut heights = Grid::filled(Window::new(12, 9, 1.0), 20.0);
        heights.row_mut(5)[2..6].copy_from_slice(&[4.0, 2.0, 1.0, 1.5]);
        heights.row_mut(5)[6..].copy_from_slice(&[5.0, 0.8, 0.6, 0.4, 0.2, 0.0]);
        (1..5).for_each(|j| heights.row_mut(j)[3] = 3.0);
        heights.row_mut(0)[3] = 0.0;
        let outlets = Outlets::new(&heights, None);
        let out = breach(&heights, &outlets, &Limits { deepest: 10.0, longest: 20 }, &Progress::none()).unwrap();
        assert_eq!(out.row(5)[2..8], [4.0, 2.0, 1.0, 1.0, 1.0, 0.8]);
        assert_eq!(out[(3, 2)], 3.0, "the lip stays");
        // With a smaller depth limit neither can be cut, so the bowl is filled to its rim.
        let shallow = breach(&heights, &outlets, &Limits { deepest: 1.0, longest: 20 }, &Progress::none()).unwrap();
        assert_eq!(shallow.row(5)[2..7], [4.0, 3.0, 3.0, 3.0, 5.0]);
        let drainage = drainage::route_carving(&heights, &outlets, Descent::Steepest);
        let around = along_valleys::breach(&heights, &outlets, &drainage, 10.0);
        assert_eq!((around[(3, 2)], around[(6, 5)]), (1.0, 5.0));
    }

    #[test]
    fn less_is_moved_than_along_the_valleys() {
        let (mut by_cost, mut by_valleys) = (0.0, 0.0);
        for seed in 0..8 {
            let mut heights = samples::hills(60, 50, seed);
            // Low ground all around: neither method ends in an outlet above its bed.
            for (c, h) in heights.data_mut().iter_mut().enumerate() {
                if !(60..49 * 60).contains(&c) || c % 60 == 0 || c % 60 == 59 {
                    *h = -10.0;
                }
            }
            let outlets = Outlets::new(&heights, None);
            let moved = |out: &Grid| -> f64 {
                out.data().iter().zip(heights.data()).map(|(new, old)| f64::from((new - old).abs())).sum()
            };
            let least =
                moved(&breach(&heights, &outlets, &Limits { deepest: 1e9, longest: 1000 }, &Progress::none()).unwrap());
            let drainage = drainage::route_carving(&heights, &outlets, Descent::Steepest);
            let valleys = moved(&along_valleys::breach(&heights, &outlets, &drainage, 1e9));
            let full = moved(&fill(&heights, &outlets));
            assert!(least < full, "{least}, to fill {full}");
            by_cost += least;
            by_valleys += valleys;
        }
        assert!(by_cost < by_valleys, "{by_cost}, along valleys {by_valleys}");
    }
}
