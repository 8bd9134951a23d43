//! What moves on the lattice cost, and its bridges and tunnels.

use super::costs;
use super::jumps::Jumps;
use super::lattice::Lattice;
use super::{Land, Roads};
use crate::error::Result;
use crate::progress::Progress;

/// The ways between the nodes of a lattice.
pub(super) struct Ways {
    /// The costs of the first half of the moves from each node.
    pub(super) costs: Vec<f32>,
    /// Bridges and tunnels.
    pub(super) jumps: Jumps,
    /// The least factor of the cost at a sample.
    pub(super) least: f64,
}

impl Ways {
    pub(super) fn new(roads: &Roads, land: &Land, lattice: &Lattice, progress: &Progress) -> Result<Ways> {
        let least = land.cost.map_or(1.0, |cost| {
            cost.data().iter().map(|factor| costs::factor(*factor)).fold(f64::INFINITY, f64::min).min(1e6)
        });
        let [moving, jumping] = progress.parts([1.0, 1.0]);
        let costs = costs::of_moves(roads, land, lattice, &moving)?;
        let jumps = Jumps::new(roads, land, lattice, &jumping)?;
        Ok(Ways { costs, jumps, least })
    }
}
