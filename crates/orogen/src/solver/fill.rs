//! Depressions filled to the brim.

use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::{fill, outlets::Outlets};
use crate::op::{Context, Solution, Solver, Sources};

op! {
    /// The source with every depression filled to the level at which it spills.
    ///
    /// The lowest surface from which water needs no way up to reach the sea or the world's border: what Priority-Flood makes
    /// (Barnes, Lehman and Mulla 2014, without an epsilon), bit for bit, found by flooding the graph of basins (Cordonnier,
    /// Bovy and Braun 2019). Filled ground is level. Time and memory grow with the world, 20 bytes a cell.
    pub struct Fill = "fill", solver, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Whether water also leaves where the ground is at or below sea level.
        sea: bool = true;
    }
    layers {
        /// The filled heights.
        filled: height, unit "m";
        /// How deep water or sediment stands on the source.
        depth: height, unit "m";
    }
}

impl Solver for Fill {
    fn scratch(&self, padded: &Window) -> u64 {
        padded.len() as u64 * 20
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let heights = sources.whole(0, sources.padded())?;
        context.progress.check()?;
        let outlets = Outlets::new(&heights, self.sea.then_some(context.setting.sea_level as f32));
        let filled = fill::fill(&heights, &outlets);
        let depth = difference(&filled, heights);
        Ok(Solution { layers: vec![sources.keep(filled)?, sources.keep(depth)?], scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        17.0
    }
}

/// `a` less `b`, in `b`'s memory.
fn difference(a: &Grid, mut b: Grid) -> Grid {
    b.data_mut().iter_mut().zip(a.data()).for_each(|(b, a)| *b = a - *b);
    b
}
