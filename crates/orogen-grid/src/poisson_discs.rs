//! Points with a minimum distance (Poisson discs). The points of any window are computed independently of other
//! windows.
//!
//! The plane is a lattice with four cells per spacing. Each cell has one candidate with a hashed position and a hashed
//! rank. A candidate takes part if its rank is below a limit that follows from the density. The candidates are decided
//! in rounds: a candidate becomes a point if no undecided candidate of lower rank is within the spacing, and the
//! undecided candidates within the spacing of a point are removed. These are the rounds of Luby's parallel algorithm
//! for maximal independent sets ("A simple parallel algorithm for the maximal independent set problem", 1986) with
//! ranks that are drawn only once. Without a limit of rounds the result would be that of random sequential adsorption,
//! candidate by candidate in the order of ranks, but it would depend on points at any distance. After [`ROUNDS`] rounds
//! less than one candidate in 10 000 is undecided; these do not become points. So a point depends only on the
//! surroundings within [`PoissonDiscs::reach`] metres.
//!
//! Ranks decide both which candidates take part and which are decided first, so the points at a lower density are a
//! subset of those at a higher density.

use std::ops::Range;

use crate::error::{Error, ErrorKind, Result};
use crate::parallel;
use crate::progress::Progress;
use crate::random::{Random, STEP, mix64};
use crate::words::number;

/// Number of cells of the lattice per spacing. A power of two, so that the cell size is exact.
const CELLS: i64 = 4;

/// Number of rounds.
pub const ROUNDS: i64 = 5;

/// Number of cells around a region that its points depend on. Each round reads the candidates within the spacing, and
/// those within the spacing of these. The last round removes none and therefore reads only the former.
const HALO: i64 = (2 * ROUNDS - 1) * CELLS + 1;

/// Side of a block that is computed at once, in cells, without its halo.
const BLOCK: i64 = 384;

/// Number of blocks in one list of work.
const BLOCKS: usize = 4096;

/// Maximum number of cells of a window, which take some hours.
const MAX_CELLS: f64 = (1u64 << 40) as f64;

/// Maximum column and row of a cell. Beyond it positions would not be exact enough to keep the spacing.
const MAX_CELL: f64 = (1u64 << 31) as f64;

/// The share of a cell at each side that has no candidates, so that rounding moves none into the next cell.
const MARGIN: f64 = 1.0 / (1 << 20) as f64;

/// Measured number of points in a square whose side is the spacing, at a density of 1. A maximal set of random points
/// has 0.6966: its discs cover a share of 0.547, the jamming limit of random sequential adsorption (Feder, "Random
/// sequential adsorption", 1980).
pub const POINTS: f64 = 0.623;

/// Limits of ranks for densities in steps of 1/16, such that the number of points is proportional to the density.
/// Measured on 10^7 candidates.
const LIMITS: [f64; 17] = [
    0.0, 0.0026, 0.00553, 0.00893, 0.01286, 0.01754, 0.02315, 0.02996, 0.03851, 0.04954, 0.06442, 0.08529, 0.11614,
    0.16633, 0.25839, 0.45469, 1.0,
];

/// A set of points with a minimum distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoissonDiscs {
    spacing: f64,
    seed: u64,
}

/// A point of a set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiscPoint {
    /// Metres east and south of the origin.
    pub position: [f64; 2],
    /// Random bits, for properties of the point.
    pub bits: u64,
}

impl PoissonDiscs {
    /// The set of points that are at least `spacing` metres apart, which must be more than 0.
    #[must_use]
    pub fn new(spacing: f64, seed: u64) -> PoissonDiscs {
        PoissonDiscs { spacing, seed }
    }

    /// Maximum distance in metres from a region at which the density still affects the points of the region.
    #[must_use]
    pub fn reach(&self) -> f64 {
        // One cell beyond the halo, and two for rounding.
        (HALO + 3) as f64 * self.cell()
    }

    /// Memory in bytes of the computation on `threads` threads, without the resulting points.
    #[must_use]
    pub fn memory(threads: usize) -> u64 {
        let cells = (BLOCK + 2 * (HALO + CELLS)) as usize;
        let each = size_of::<[f64; 2]>() + size_of::<u64>() + size_of::<State>() + 2 * size_of::<usize>();
        (threads * cells * cells * each) as u64
    }

    fn cell(&self) -> f64 {
        self.spacing / CELLS as f64
    }

    /// The points whose easting and southing lie within `bounds`, in metres, row by row of their lattice. `density` is
    /// the number of points at a position as a share of the greatest possible one, 0 to 1; NaN means no points. It is
    /// evaluated up to [`reach`](PoissonDiscs::reach) metres outside the bounds. A point does not depend on the bounds
    /// as long as `density` is the same function.
    ///
    /// # Errors
    /// If the bounds are more than 2^29 spacings from the origin or have more than 2^40 cells, or if the work was
    /// cancelled.
    pub fn within(
        &self,
        bounds: &[Range<f64>; 2],
        density: impl Fn([f64; 2]) -> f64 + Sync,
        progress: &Progress,
    ) -> Result<Vec<DiscPoint>> {
        let cells = |range: &Range<f64>| {
            let ends = [range.start, range.end].map(|metres| (metres / self.cell()).floor());
            let far = MAX_CELL - (HALO + BLOCK) as f64;
            match ends.iter().all(|end| end.abs() < far) {
                true => Ok(ends[0] as i64 - 1..ends[1] as i64 + 2),
                false => Err(Error::new(
                    ErrorKind::Request,
                    format!(
                        "points with a spacing of {} m can be placed up to {} m from the origin; use a window nearer to it, or a larger spacing",
                        self.spacing,
                        far * self.cell()
                    ),
                )),
            }
        };
        if bounds.iter().any(|range| range.is_empty()) {
            return Ok(Vec::new());
        }
        let [columns, rows] = [cells(&bounds[0])?, cells(&bounds[1])?];
        let pieces = |range: &Range<i64>| {
            let range = range.clone();
            (range.start.div_euclid(BLOCK)..=(range.end - 1).div_euclid(BLOCK))
                .map(move |k| (k * BLOCK).max(range.start)..((k + 1) * BLOCK).min(range.end))
        };
        let cells = (columns.end - columns.start) as f64 * (rows.end - rows.start) as f64;
        if cells > MAX_CELLS {
            let sides = [0, 1].map(|k| number(bounds[k].end - bounds[k].start));
            return Err(Error::new(
                ErrorKind::Request,
                format!(
                    "points with a spacing of {} m over {} x {} m would have {cells:.0} candidates; at most {MAX_CELLS:.0} are allowed. Use a larger spacing, a smaller \
                     window or a smaller clearance",
                    number(self.spacing),
                    sides[0],
                    sides[1]
                ),
            ));
        }
        progress.expect(pieces(&rows).count() as f64 * pieces(&columns).count() as f64);
        let mut blocks =
            pieces(&rows).flat_map(|rows| pieces(&columns).map(move |columns| [columns, rows.clone()])).peekable();
        let mut points: Vec<([i64; 2], DiscPoint)> = Vec::new();
        // In pieces: a list of all blocks of a large window with few points would need more memory than the points.
        while blocks.peek().is_some() {
            let piece: Vec<[Range<i64>; 2]> = blocks.by_ref().take(BLOCKS).collect();
            let made = parallel::try_map(&piece, |[columns, rows]| -> Result<Vec<([i64; 2], DiscPoint)>> {
                progress.check()?;
                let mut block = Block::new(self, columns, rows, &density);
                block.decide();
                let points = block.points(self, columns, rows, bounds);
                progress.step(1.0)?;
                Ok(points)
            })?;
            points.extend(made.into_iter().flatten());
        }
        parallel::sort_by(&mut points, |(a, _), (b, _)| a.cmp(b));
        Ok(points.into_iter().map(|(_, point)| point).collect())
    }

    /// The candidate of a cell, and its rank.
    fn candidate(&self, column: i64, row: i64) -> (DiscPoint, u64) {
        let state = mix64(mix64(self.seed.wrapping_add(STEP)).wrapping_add((column as u64).wrapping_mul(STEP)));
        let mut random = Random::of_state(mix64(state.wrapping_add((row as u64).wrapping_mul(STEP))));
        let mut along = |cell: i64| (cell as f64 + (MARGIN + random.share() * (1.0 - 2.0 * MARGIN))) * self.cell();
        let position = [along(column), along(row)];
        let rank = random.draw();
        (DiscPoint { position, bits: random.draw() }, rank)
    }
}

/// The rank below which candidates take part at a density of 0 to 1.
fn limit(density: f64) -> f64 {
    let steps = (LIMITS.len() - 1) as f64;
    // NaN is treated like 0.
    let at = if density > 0.0 { density.min(1.0) * steps } else { 0.0 };
    let k = (at as usize).min(LIMITS.len() - 2);
    LIMITS[k] + (LIMITS[k + 1] - LIMITS[k]) * (at - k as f64)
}

/// A rank as a number from 0 (included) to 1 (excluded).
fn share(rank: u64) -> f64 {
    (rank >> 11) as f64 / (1u64 << 53) as f64
}

/// The state of a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    Undecided,
    Point,
    NoPoint,
}

/// The candidates of a rectangle of cells and of its halo. A border of [`CELLS`] cells without candidates surrounds
/// them, so that every candidate has neighbors on all sides.
struct Block {
    /// Column and row of the first cell of the border.
    first: [i64; 2],
    width: usize,
    positions: Vec<[f64; 2]>,
    ranks: Vec<u64>,
    states: Vec<State>,
    spacing: f64,
}

impl Block {
    fn new(discs: &PoissonDiscs, columns: &Range<i64>, rows: &Range<i64>, density: &impl Fn([f64; 2]) -> f64) -> Block {
        let grown = |range: &Range<i64>, by: i64| range.start - by..range.end + by;
        let [inner_columns, inner_rows] = [grown(columns, HALO), grown(rows, HALO)];
        let [columns, rows] = [grown(&inner_columns, CELLS), grown(&inner_rows, CELLS)];
        let width = (columns.end - columns.start) as usize;
        let cells = width * (rows.end - rows.start) as usize;
        let mut block = Block {
            first: [columns.start, rows.start],
            width,
            positions: vec![[0.0; 2]; cells],
            ranks: vec![0; cells],
            states: vec![State::NoPoint; cells],
            spacing: discs.spacing,
        };
        for row in inner_rows {
            for column in inner_columns.clone() {
                let (point, rank) = discs.candidate(column, row);
                if share(rank) < limit(density(point.position)) {
                    let k = block.index(column, row);
                    block.positions[k] = point.position;
                    block.ranks[k] = rank;
                    block.states[k] = State::Undecided;
                }
            }
        }
        block
    }

    fn index(&self, column: i64, row: i64) -> usize {
        (row - self.first[1]) as usize * self.width + (column - self.first[0]) as usize
    }

    /// Decides the candidates, round by round.
    fn decide(&mut self) {
        let offsets: Vec<isize> =
            offsets().into_iter().map(|[east, south]| south as isize * self.width as isize + east as isize).collect();
        let mut undecided: Vec<usize> =
            (0..self.states.len()).filter(|&k| self.states[k] == State::Undecided).collect();
        for _ in 0..ROUNDS {
            let first: Vec<usize> = undecided.iter().copied().filter(|&k| self.is_first(k, &offsets)).collect();
            first.iter().for_each(|&k| self.states[k] = State::Point);
            for k in first {
                for offset in &offsets {
                    let other = k.wrapping_add_signed(*offset);
                    if self.states[other] == State::Undecided && self.is_near(k, other) {
                        self.states[other] = State::NoPoint;
                    }
                }
            }
            undecided.retain(|&k| self.states[k] == State::Undecided);
        }
    }

    /// Whether candidate `k` has the lowest rank of the undecided candidates within the spacing. Equal ranks are
    /// ordered by their cells, row by row, which is the same order in every block.
    fn is_first(&self, k: usize, offsets: &[isize]) -> bool {
        let rank = self.ranks[k];
        !offsets.iter().any(|offset| {
            let other = k.wrapping_add_signed(*offset);
            self.states[other] == State::Undecided && (self.ranks[other], other) < (rank, k) && self.is_near(k, other)
        })
    }

    /// Whether two candidates are closer to each other than the spacing.
    fn is_near(&self, a: usize, b: usize) -> bool {
        square(self.positions[a], self.positions[b]) < self.spacing * self.spacing
    }

    /// The points in the block's cells that lie within the bounds, with their rows and columns.
    fn points(
        &self,
        discs: &PoissonDiscs,
        columns: &Range<i64>,
        rows: &Range<i64>,
        bounds: &[Range<f64>; 2],
    ) -> Vec<([i64; 2], DiscPoint)> {
        let mut points = Vec::new();
        for row in rows.clone() {
            for column in columns.clone() {
                let k = self.index(column, row);
                let is_within = (bounds.iter().zip(self.positions[k])).all(|(range, at)| range.contains(&at));
                if self.states[k] == State::Point && is_within {
                    points.push(([row, column], discs.candidate(column, row).0));
                }
            }
        }
        points
    }
}

/// The square of the distance between two positions, in m^2.
#[must_use]
pub fn square(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [east, south] = [a[0] - b[0], a[1] - b[1]];
    east * east + south * south
}

/// Offsets to the cells whose candidates may be within the spacing, the nearest first because they decide most often.
fn offsets() -> Vec<[i64; 2]> {
    let mut offsets: Vec<[i64; 2]> =
        (-CELLS..=CELLS).flat_map(|south| (-CELLS..=CELLS).map(move |east| [east, south])).collect();
    let gap = |offset: i64| (offset.abs() - 1).max(0);
    offsets.retain(|&[east, south]| {
        [east, south] != [0, 0] && gap(east) * gap(east) + gap(south) * gap(south) < CELLS * CELLS
    });
    offsets.sort_by_key(|&[east, south]| (east * east + south * south, south, east));
    offsets
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(discs: &PoissonDiscs, bounds: [Range<f64>; 2], density: f64) -> Vec<DiscPoint> {
        discs.within(&bounds, |_| density, &Progress::none()).unwrap()
    }

    /// The smallest distance between two points.
    fn smallest(points: &[DiscPoint]) -> f64 {
        let mut sorted: Vec<[f64; 2]> = points.iter().map(|point| point.position).collect();
        sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut smallest = f64::INFINITY;
        for (k, a) in sorted.iter().enumerate() {
            for b in &sorted[k + 1..] {
                if b[0] - a[0] >= smallest {
                    break;
                }
                smallest = smallest.min(square(*a, *b).sqrt());
            }
        }
        smallest
    }

    #[test]
    fn spacing_is_kept_and_space_is_filled() {
        let discs = PoissonDiscs::new(3.0, 5);
        let side = 1500.0;
        let all = points(&discs, [-200.0..side - 200.0, 1e7..1e7 + side], 1.0);
        assert!(smallest(&all) >= 3.0, "{}", smallest(&all));
        let filled = all.len() as f64 * 9.0 / (side * side);
        assert!((filled - POINTS).abs() < 0.005, "{filled}");
        assert!(filled > 0.89 * 0.6966, "{filled}");
    }

    #[test]
    fn the_number_of_points_is_proportional_to_the_density() {
        let discs = PoissonDiscs::new(1.0, 8);
        let bounds = || [0.0..220.0, 0.0..220.0];
        let all = points(&discs, bounds(), 1.0);
        for density in [0.01, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 0.97] {
            let some = points(&discs, bounds(), density);
            let share = some.len() as f64 / all.len() as f64;
            assert!((share - density).abs() < 0.012, "{density}: {share}");
            assert!(some.iter().all(|point| all.contains(point)), "a point moved at {density}");
        }
        assert!(points(&discs, bounds(), 0.0).is_empty() && points(&discs, bounds(), f64::NAN).is_empty());
    }

    #[test]
    fn windows_are_crops_of_the_whole() {
        let discs = PoissonDiscs::new(2.5, 77);
        // The density has steps, so that the number of rounds differs from place to place.
        let density = |[x, y]: [f64; 2]| if libm::sin(x * 0.05) + libm::sin(y * 0.03) > 0.4 { 1.0 } else { 0.15 };
        let within = |bounds: &[Range<f64>; 2]| discs.within(bounds, density, &Progress::none()).unwrap();
        let whole = within(&[-700.0..500.0, -300.0..600.0]);
        let mut random = Random::new(4, 4);
        for _ in 0..20 {
            let mut cut = |range: Range<f64>| {
                let length = range.end - range.start;
                let start = range.start + random.share() * length;
                start..(start + random.share() * 400.0).min(range.end)
            };
            let bounds = [cut(-700.0..500.0), cut(-300.0..600.0)];
            let is_within =
                |point: &&DiscPoint| (bounds.iter().zip(point.position)).all(|(range, at)| range.contains(&at));
            let crop: Vec<DiscPoint> = whole.iter().filter(is_within).copied().collect();
            assert_eq!(within(&bounds), crop);
        }
    }

    #[test]
    fn positions_too_far_away_are_an_error() {
        let error = PoissonDiscs::new(1e-3, 1).within(&[1e7..1e7 + 1.0, 0.0..1.0], |_| 1.0, &Progress::none());
        assert!(error.unwrap_err().to_string().contains("can be placed up to"));
    }

    #[test]
    fn too_many_points_are_an_error() {
        let error = PoissonDiscs::new(0.5, 1).within(&[0.0..2e5, 0.0..2e5], |_| 0.0, &Progress::none());
        let error = error.unwrap_err().to_string();
        assert!(
            error.contains("a spacing of 0.5 m over 200000 x 200000 m would have 2560009600009 candidates"),
            "{error}"
        );
    }

    #[test]
    fn a_cancelled_search_ends() {
        let progress = Progress::none();
        progress.cancel();
        let error = PoissonDiscs::new(1.0, 1).within(&[0.0..9.0, 0.0..9.0], |_| 1.0, &progress).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Cancelled);
    }
}
