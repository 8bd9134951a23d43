//! The passes that compute a level from the next coarser one, on the CPU and on GPUs.

use super::refinement::Refinement;
use super::{creep, detail, lake_shores, lakes, ridges, straighten};
use crate::grid::Window;
use std::iter::repeat_n;

/// Number of cells at the edge of the children whose rivers and shores are not exact.
const CARVED: usize = 7;

/// Number of further cells that are not exact where there are drawn rivers: a tributary's area is added along them.
const DRAWN: usize = super::carve::JOINED;

/// Number of further cells that are not exact where the given shore is binding: the links on which drowned rivers
/// depend, of two cells each, and the cells by which the sea spreads.
const BOUND: usize = 2 * super::mouths::DROWNED_LINKS + super::shores::SPREAD;

/// Number of passes of heights before drainage areas change, and number of rounds of areas and heights afterwards.
const FIRST_PASSES: usize = 3;
const ROUNDS: usize = 5;

/// Number of passes of areas at the end of each level, and on the finest level, where nodes have just chosen their
/// receivers again.
const LAST_AREA_PASSES: usize = 3;
const FINEST_AREA_PASSES: usize = 6;

/// Number of passes that prevent areas from decreasing downstream: they are raised along the receivers, then limited
/// against them.
const RAISE_PASSES: usize = 6;
const LIMIT_PASSES: usize = 3;

/// Number of passes that raise banks on the finest level, and number of their rounds. After each round, nodes that
/// drained to a bank choose their receivers again.
const BANK_PASSES: usize = 3;
const BANK_ROUNDS: usize = 2;

/// A pass over nodes and their neighbors, after the rivers of the coarser level are carved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LevelPass {
    /// [`LevelPass::AddAreas`] for the first time. Nodes that are not rivers yet have drained nothing, because the
    /// areas of rivers already include them.
    FirstAreas,
    /// Areas become the sums of their donors' areas.
    AddAreas,
    /// Heights fall to the steady state of the law.
    Grow,
    /// Soil creeps.
    Creep,
    /// Banks of rivers rise.
    RaiseBanks,
    /// Free nodes choose their receivers by the steepest descent.
    Descend,
    /// Areas are raised along the receivers.
    RaiseAreas,
    /// Areas are limited against the receivers.
    LimitAreas,
}

impl LevelPass {
    /// Whether the pass writes heights.
    #[must_use]
    pub fn writes_heights(self) -> bool {
        matches!(self, LevelPass::Grow | LevelPass::Creep | LevelPass::RaiseBanks)
    }

    /// Whether the pass writes areas.
    #[must_use]
    pub fn writes_areas(self) -> bool {
        !self.writes_heights() && self != LevelPass::Descend
    }
}

/// The computation of a level from the next coarser one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Schedule {
    /// Whether the nodes are on the lattice and rivers are straightened.
    pub is_finest: bool,
    /// Whether the nodes of the coarser level are first turned into the nodes that detail levels begin with.
    pub begins_details: bool,
    /// Number of cells on which rivers that become lakes depend; 0 if there are no new lakes.
    pub lakes: usize,
    /// Number of cells at the edge of the children whose rivers are not exact.
    pub carved: usize,
    /// Number of further cells on which the straightened rivers of a cell depend.
    pub straightened: usize,
    /// Number of cells around a lake in which land has a minimum height; `None` without lakes.
    pub rims: Option<usize>,
    /// Number of the first passes after which drawn ridges get their heights.
    pub grown: usize,
    /// Number of further cells on which heights beside drawn ridges depend; 0 without them.
    pub ridges: usize,
    /// The passes that follow. Each makes one more cell at the edge inexact.
    pub passes: Vec<LevelPass>,
}

impl Schedule {
    /// Number of cells at the edge of the children that are not exact before the passes.
    #[must_use]
    pub fn edge(&self) -> usize {
        // The separation of waters depends on one more cell.
        self.lakes + self.carved + self.straightened + self.rims.map_or(0, |rim| rim + 1)
    }
}

impl Refinement {
    /// The schedule of level `depth`, at least 1.
    #[must_use]
    pub fn schedule(&self, depth: usize) -> Schedule {
        use LevelPass::{AddAreas, Creep, Descend, FirstAreas, Grow, LimitAreas, RaiseAreas, RaiseBanks};
        let (is_finest, above) = (self.is_finest(depth), depth.saturating_sub(1));
        let mut passes = vec![Grow; FIRST_PASSES];
        for round in 0..ROUNDS {
            passes.extend([if round == 0 { FirstAreas } else { AddAreas }, AddAreas, Grow]);
        }
        let grown = passes.len();
        if is_finest {
            passes.extend(repeat_n(Creep, creep::creep_passes(self.creep)));
            for _ in 0..BANK_ROUNDS {
                passes.extend(repeat_n(RaiseBanks, BANK_PASSES));
                passes.push(Descend);
            }
        } else if self.is_detail(depth) {
            passes.extend(repeat_n(Creep, detail::creep_passes(self)));
        }
        passes.extend(repeat_n(AddAreas, if is_finest { FINEST_AREA_PASSES } else { LAST_AREA_PASSES }));
        passes.extend(repeat_n(RaiseAreas, RAISE_PASSES));
        passes.extend(repeat_n(LimitAreas, LIMIT_PASSES));
        Schedule {
            is_finest,
            begins_details: self.is_finest(above),
            lakes: if lakes::begin_at(self, above) { 2 * lakes::REACH } else { 0 },
            carved: CARVED + if self.drawn { DRAWN } else { 0 } + if self.is_shore_binding() { BOUND } else { 0 },
            straightened: if is_finest { straighten::REACH } else { 0 },
            rims: (self.lakes > 0.0).then_some(lake_shores::RIM),
            grown,
            ridges: if self.ridges { ridges::EDGE } else { 0 },
            passes,
        }
    }

    /// Number of samples of level `depth - 1` that [`Refinement::refine`] to `depth` reads beyond each side of the
    /// halved window. The halved window extends from half the first sample, rounded down, to half the last, rounded up.
    #[must_use]
    pub fn reach(&self, depth: usize) -> usize {
        let schedule = self.schedule(depth);
        (schedule.edge() + schedule.ridges + schedule.passes.len()).div_ceil(2)
    }

    /// Number of samples of level `depth`, at least 1, beyond a window that [`Refinement::refine`] reads of the given
    /// land.
    #[must_use]
    pub fn given_reach(&self, depth: usize) -> usize {
        2 * self.reach(depth) + 1
    }

    /// The window of level `depth - 1` that [`Refinement::refine`] needs for `window` of level `depth`.
    #[must_use]
    pub fn parent_window(&self, depth: usize, window: &Window) -> Window {
        let (x, y) = (window.x >> 1, window.y >> 1);
        let last = |end: i64| (end - 1) - ((end - 1) >> 1);
        let (right, bottom) = (last(window.right()), last(window.bottom()));
        let (width, height) = ((right - x + 1) as usize, (bottom - y + 1) as usize);
        Window { x, y, width, height, cell: self.cell_of(depth.saturating_sub(1)) }.grown(self.reach(depth))
    }
}
