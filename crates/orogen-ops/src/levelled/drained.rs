//! Drained land with the parameters of an op.

use crate::op::WorldParams;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::rivers::Channel;
use orogen_grid::multiscale::continents::Continents;
use orogen_grid::multiscale::refinement::{MAX_LEVELS, Refinement};

/// The levels of an op, and the parameters of its layers.
pub struct Drained {
    /// The levels.
    pub refinement: Refinement,
    /// The geography from which the coarsest level is made, and which is used where inputs have no value. `None` if the
    /// coarsest level is given by inputs, with its samples in the middles of the cells.
    pub continents: Option<Continents>,
    /// Drainage area of rivers, in m^2.
    pub stream: f64,
    /// Runoff in metres per year.
    pub runoff: f64,
}

impl Drained {
    /// The same with its seed hashed with the world's seed. Cells, halos and the set of layers do not depend on the
    /// seed.
    pub fn seeded(self, world_params: &WorldParams) -> Drained {
        let refinement = self.refinement.with_seed(world_params.seed_of(self.refinement.seed));
        let continents = self.continents.map(|continents| continents.with_refinement(refinement));
        Drained { refinement, continents, ..self }
    }

    /// The nodes of a level at the samples of a window.
    pub fn nodes_at(&self, level: usize, window: &Window) -> Window {
        let ahead = self.ahead(level);
        self.refinement.nodes_at(level, &window.at(window.x + ahead, window.y + ahead))
    }

    /// The inverse of [`Drained::nodes_at`].
    pub fn samples_at(&self, level: usize, nodes: &Window) -> Window {
        let (window, ahead) = (self.refinement.samples_at(level, nodes), self.ahead(level));
        window.at(window.x - ahead, window.y - ahead)
    }

    /// Number of samples by which the lattice of a level is ahead of the samples of windows. A sample of given land is
    /// in the middle of its coarsest cell; the finer lattices start at the corner of cell 0, half a coarsest cell
    /// before.
    fn ahead(&self, level: usize) -> i64 {
        if self.continents.is_some() || level == 0 { 0 } else { 1i64 << (level - 1).min(MAX_LEVELS) }
    }

    /// Position of the samples of a level in its cells, as a share of the sides.
    pub fn share(&self, level: usize) -> f32 {
        if self.continents.is_none() && level == 0 { 0.5 } else { 0.0 }
    }

    /// Height of 0 in the levels, in metres: the sea level if they have a sea, otherwise 0.
    pub fn sea_level(&self, world_params: &WorldParams) -> f32 {
        if self.refinement.sea { world_params.sea_level as f32 } else { 0.0 }
    }

    /// Width and depth of rivers.
    pub fn channel(&self) -> Channel {
        Channel::default().with_runoff(self.runoff)
    }
}
