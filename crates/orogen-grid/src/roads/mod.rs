//! Roads: routes of least cost with a maximum grade, smoothed, with their cuts, embankments, bridges and tunnels.
//!
//! After Galin, Peytavie, Maréchal and Guérin, "Procedural generation of roads" (2010). A route is a shortest path on a
//! lattice whose moves reach several nodes far; longer moves are bridges and tunnels. The route becomes a smooth curve
//! with a profile that keeps the grade, and the ground is cut and filled to it. All searches break ties by index and
//! all sums are in a fixed order, so the result does not depend on threads.

mod costs;
mod earthworks;
mod heap;
mod jumps;
mod lattice;
mod lines;
mod moves;
mod network;
mod profile;
mod route;
mod smooth;
mod ways;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use lattice::Lattice;
pub use lines::{RoadKind, RoadLine};

/// Roads to be built.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Roads {
    /// Width of the road, in metres.
    pub width: f64,
    /// Maximum grade: rise over run.
    pub grade: f64,
    /// Radius below which curves are expensive, in metres.
    pub radius: f64,
    /// Distance between the nodes of the lattice, in metres.
    pub spacing: f64,
    /// Cost of a bridge over that of a level road of the same length.
    pub bridge_cost: f64,
    /// Cost of a tunnel over that of a level road of the same length.
    pub tunnel_cost: f64,
    /// Length of the longest bridge, in metres.
    pub longest_bridge: f64,
    /// Length of the longest tunnel, in metres.
    pub longest_tunnel: f64,
    /// Cost of an existing road over that of a new one.
    pub reuse: f64,
    /// Slope of cuts.
    pub cut_slope: f64,
    /// Slope of embankments.
    pub embankment_slope: f64,
    /// Maximum width of a cut or an embankment beside the road, in metres.
    pub slope_width: f64,
}

impl Default for Roads {
    /// The defaults of the op `roads`.
    fn default() -> Roads {
        Roads {
            width: 7.0,
            grade: 0.08,
            radius: 30.0,
            spacing: 20.0,
            bridge_cost: 8.0,
            tunnel_cost: 12.0,
            longest_bridge: 300.0,
            longest_tunnel: 1000.0,
            reuse: 0.2,
            cut_slope: 1.0 / 1.5,
            embankment_slope: 1.0 / 1.5,
            slope_width: 15.0,
        }
    }
}

orogen_noise::builder!(
    Roads:
    with_width(width: f64),
    with_grade(grade: f64),
    with_radius(radius: f64),
    with_spacing(spacing: f64),
    with_bridge_cost(bridge_cost: f64),
    with_tunnel_cost(tunnel_cost: f64),
    with_longest_bridge(longest_bridge: f64),
    with_longest_tunnel(longest_tunnel: f64),
    with_reuse(reuse: f64),
    with_cut_slope(cut_slope: f64),
    with_embankment_slope(embankment_slope: f64),
    with_slope_width(slope_width: f64)
);

/// The land through which roads are built.
pub struct Land<'a> {
    /// The heights, in metres. Roads avoid samples without a height.
    pub ground: &'a Grid,
    /// Water is where this is more than 0.
    pub water: Option<&'a Grid>,
    /// Factor on the cost at each sample.
    pub cost: Option<&'a Grid>,
    /// Height of the sea, in metres; the ground up to it is water.
    pub sea_level: Option<f32>,
    /// The samples within which places may be.
    pub domain: Window,
}

/// Land with roads.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadLayers {
    /// Heights with cuts and embankments, in metres.
    pub height: Grid,
    /// 1 on roads, 0 elsewhere and on bridges and in tunnels.
    pub road: Grid,
    /// The number of the [`RoadKind`]; 0 outside roads.
    pub kind: Grid,
    /// What was cut (negative) and filled, in metres.
    pub change: Grid,
    /// The roads. Where a road uses an earlier one, only the earlier one has a line.
    pub lines: Vec<RoadLine>,
}

/// Memory of a sample of the grids, in bytes: three sources, four layers, masks and earthworks.
const BYTES: u64 = 60;
/// Memory of a node of the lattice, in bytes: costs of moves, jumps, and the search.
const NODE_BYTES: u64 = 160 + 16 + 16 + 150 + 8 * 33;

impl Roads {
    /// Memory in bytes of [`Roads::run`] over a window, with its grids.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        let nodes = lattice::nodes_of(window, self.spacing) as u64;
        (window.len() as u64).saturating_mul(BYTES).saturating_add(nodes.saturating_mul(NODE_BYTES))
    }

    /// Builds roads that connect the places of each list one after the other: metres east and south.
    ///
    /// # Errors
    /// If a place is outside the domain or in water, two places cannot be connected, the grids have different windows,
    /// or the work was cancelled.
    pub fn run(&self, land: &Land, places: &[Vec<[f64; 3]>], progress: &Progress) -> Result<RoadLayers> {
        let window = *land.ground.window();
        let others = [land.water, land.cost].into_iter().flatten();
        if others.into_iter().any(|grid| *grid.window() != window) {
            return Err(Error::new(ErrorKind::Request, "the ground, its water and its cost must have the same window"));
        }
        let legs: usize = places.iter().map(|line| line.len().saturating_sub(1)).sum();
        // The lattice; what its ways cost; each leg; their lines; the ground, in two steps.
        progress.expect(6.0 + legs as f64);
        let lattice = Lattice::new(self, land);
        progress.step(1.0)?;
        let lines = network::build(self, land, &lattice, places, progress)?;
        drop(lattice);
        let layers = earthworks::build(self, land, lines, progress)?;
        progress.step(1.0)?;
        Ok(layers)
    }
}

#[cfg(test)]
mod tests;
