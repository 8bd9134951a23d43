//! The parameters of all levels, independent of how the coarsest one is made.

use super::level::invalid;
use crate::error::Result;
use crate::grid::Window;
use crate::words::number;

/// Levels of land, each computed from the next coarser one: rivers keep their course, and branches and slopes grow
/// between them.
///
/// The node (i, j) of the finest level of valleys is exactly at (i cell, j cell). On a coarser level with cell c, the
/// node of sample (i, j) is at ((i + east) c - cell / 2, (j + south) c - cell / 2), where `cell` is the cell of the
/// finest level of valleys. On a detail level it is at ((i + east) c, (j + south) c). The samples (i, j) of given land
/// are in the middles of the coarsest cells, at ((i + 0.5) c, (j + 0.5) c).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Refinement {
    /// Seed of all random choices.
    pub seed: u64,
    /// Cell of the finest level of valleys, in metres.
    pub cell: f64,
    /// Number of halvings from the coarsest level to the finest level of valleys.
    pub levels: usize,
    /// Factor of the uplift.
    pub relief: f64,
    /// Distance over which creep smooths the finest level of valleys, in its cells: the standard deviation of the
    /// average.
    pub creep: f64,
    /// Factor of the variation of the rock that each level adds.
    pub variation: f64,
    /// Distance of the coarsest nodes of given land from its valleys, 0 to 1: 0 is in the valley of the sample's cell,
    /// 1 at a random position in the cell.
    pub jitter: f64,
    /// Number of further halvings, below `cell`. They give detail levels, which have the slopes of the finest level of
    /// valleys, gullies, and beds and banks of rivers.
    pub details: usize,
    /// Frequency of lakes with an outlet along rivers, 0 to 1.
    pub lakes: f64,
    /// Whether given land has a [sea](super::level::Level::drown), whose depth determines the distance to the shore.
    /// Near steep coasts that distance changes by more than a kilometre per kilometre.
    pub sea: bool,
    /// Whether levels lead [drawn rivers](super::given::Given::rivers), which need more of the coarser level.
    pub drawn: bool,
    /// Whether levels keep drawn ridges at their heights, which need more of the coarser level.
    pub ridges: bool,
    /// Number of detail levels, from the coarsest, that read the given shore. Finer ones
    /// take it over and add irregularities.
    pub shore_details: usize,
}

impl Default for Refinement {
    fn default() -> Refinement {
        Refinement {
            seed: 0,
            cell: 60.0,
            levels: 11,
            relief: 1.0,
            creep: 1.0,
            variation: 1.0,
            jitter: 1.0,
            details: 0,
            lakes: 0.0,
            sea: false,
            drawn: false,
            ridges: false,
            shore_details: 0,
        }
    }
}

orogen_noise::builder!(Refinement: with_seed(seed: u64), with_cell(cell: f64), with_levels(levels: usize), with_relief(relief: f64),
    with_creep(creep: f64), with_variation(variation: f64), with_jitter(jitter: f64), with_details(details: usize),
    with_lakes(lakes: f64), with_sea(sea: bool), with_drawn(drawn: bool), with_ridges(ridges: bool),
    with_shore_details(shore_details: usize));

/// Minimum rise over one cell, in metres, so that heights strictly fall. On detail levels it shrinks with the cell, so
/// that floors stay flat, down to the precision of heights of a few kilometres.
const LEAST_RISE: f32 = 0.012;
const LEAST_DETAIL_RISE: f32 = 0.001;

/// Maximum number of halvings to the finest level of valleys.
pub const MAX_LEVELS: usize = 24;

/// Maximum number of halvings from there to the finest detail level.
pub const MAX_DETAILS: usize = 10;

/// Maximum distance of creep, in cells.
pub const MAX_CREEP: f64 = 5.0;

/// Maximum absolute coordinate of a sample, such that no sum overflows.
const FURTHEST: i64 = 1 << 50;

/// Maximum number of samples along a side.
const MAX_SIDE: usize = 1 << 24;

impl Refinement {
    /// Levels with this seed and the defaults of the other parameters.
    #[must_use]
    pub fn new(seed: u64) -> Refinement {
        Refinement { seed, ..Refinement::default() }
    }

    /// The cell of a level, in metres.
    #[must_use]
    pub fn cell_of(&self, depth: usize) -> f64 {
        let doublings = self.levels.min(MAX_LEVELS).saturating_sub(depth);
        let halvings = depth.saturating_sub(self.levels).min(MAX_DETAILS);
        self.cell * (1u64 << doublings) as f64 / (1u64 << halvings) as f64
    }

    /// The cell of a level, in kilometres.
    pub(super) fn kilometres(&self, depth: usize) -> f64 {
        self.cell_of(depth) / 1000.0
    }

    /// The coordinate, in metres, of a node in column or row `index` at the position `share` in its cell.
    pub(super) fn metres(&self, depth: usize, index: i64, share: f32) -> f64 {
        (index as f64 + f64::from(share)) * self.cell_of(depth) - 0.5 * self.cell
    }

    /// Half a cell of the finest level of valleys, in cells of a level. Nodes and points are offset by it within their
    /// cells, because the nodes of the finest level are in the middles of its cells.
    pub(super) fn half_finest(&self, depth: usize) -> f32 {
        (0.5 * self.cell / self.cell_of(depth)) as f32
    }

    /// Whether a level is the finest level of valleys, whose nodes are on the lattice.
    pub(super) fn is_finest(&self, depth: usize) -> bool {
        depth == self.levels
    }

    /// Whether a level is finer than the finest level of valleys.
    pub(super) fn is_detail(&self, depth: usize) -> bool {
        depth > self.levels
    }

    /// Whether a level reads the given shore.
    #[must_use]
    pub fn reads_shore(&self, depth: usize) -> bool {
        depth <= self.levels.saturating_add(self.shore_details)
    }

    /// Whether the given shore is binding on all levels that read it.
    #[must_use]
    pub fn is_shore_binding(&self) -> bool {
        self.shore_details > 0
    }

    /// The minimum rise over one cell of a level, in metres.
    pub(super) fn least_rise(&self, depth: usize) -> f32 {
        if self.is_detail(depth) {
            (LEAST_RISE * (self.cell_of(depth) / self.cell) as f32).max(LEAST_DETAIL_RISE)
        } else {
            LEAST_RISE
        }
    }

    /// Number of cells by which the nodes of a level are ahead of its samples: the node of the cell to the south-east
    /// of sample (i, j) is (i + ahead, j + ahead).
    pub(super) fn ahead(&self, depth: usize) -> i64 {
        if self.is_detail(depth) { 1i64 << (depth - self.levels - 1).min(MAX_DETAILS) } else { 0 }
    }

    /// The cells of a level whose nodes are to the south-east of the samples of a window.
    #[must_use]
    pub fn nodes_at(&self, depth: usize, window: &Window) -> Window {
        let ahead = self.ahead(depth);
        window.at(window.x + ahead, window.y + ahead)
    }

    /// The inverse of [`Refinement::nodes_at`].
    #[must_use]
    pub fn samples_at(&self, depth: usize, nodes: &Window) -> Window {
        let ahead = self.ahead(depth);
        nodes.at(nodes.x - ahead, nodes.y - ahead)
    }

    /// Checks the parameters, and that `window` belongs to level `depth`.
    pub(super) fn check(&self, depth: usize, window: &Window) -> Result<()> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !(positive(self.cell) && positive(self.relief)) {
            return Err(invalid("the cell and the relief of levels must be above 0"));
        }
        if !(0.0..=MAX_CREEP).contains(&self.creep) || !(0.0..=10.0).contains(&self.variation) {
            return Err(invalid(format!(
                "the creep of levels must be 0 to {MAX_CREEP} cells, their variation 0 to 10"
            )));
        }
        if !(0.0..=1.0).contains(&self.jitter) || !(0.0..=1.0).contains(&self.lakes) {
            return Err(invalid("the jitter of levels and the frequency of their lakes must be 0 to 1"));
        }
        if self.levels > MAX_LEVELS || self.details > MAX_DETAILS {
            return Err(invalid(format!("levels are at most {MAX_LEVELS}, and {MAX_DETAILS} of details")));
        }
        if depth > self.levels + self.details {
            return Err(invalid(format!("level {depth} does not exist: the finest is {}", self.levels + self.details)));
        }
        if window.cell != self.cell_of(depth) {
            return Err(invalid(format!("level {depth} has a cell of {} m, not {}", self.cell_of(depth), window.cell)));
        }
        let Window { x, y, width, height, cell } = *window;
        if window.is_empty() {
            return Err(invalid(format!("a window of {width} x {height} samples is empty")));
        }
        if width.max(height) > MAX_SIDE {
            return Err(invalid(format!(
                "the level with a cell of {} m is needed over {width} x {height} samples; a level is made over at most {MAX_SIDE} samples a side",
                number(cell)
            )));
        }
        if let Some(far) = [x, y].into_iter().find(|at| !(-FURTHEST..=FURTHEST).contains(at)) {
            return Err(invalid(format!(
                "the level with a cell of {} m is needed {} m from the origin; levels end {} m from it, after 2^50 samples",
                number(cell),
                number(far.unsigned_abs() as f64 * cell),
                number(FURTHEST as f64 * cell)
            )));
        }
        Ok(())
    }
}
