//! Viewshed of an observer.

use super::terrain;
use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::analysis::viewshed::{BEYOND, Observer, sinking, viewshed};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

op! {
    /// Viewshed: which ground an observer sees, and how far a target must rise to be seen where the ground is hidden.
    ///
    /// Exact lines of sight from the eye to every sample (R3; Franklin and Ray 1994). The ground is linear between
    /// samples along the columns or rows that a line crosses, whichever are more. Time grows slightly faster than the
    /// world; blocks of hidden ground are skipped. Memory is 24 bytes per cell.
    pub struct Viewshed = "viewshed", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Position of the observer: metres east and south of the world's origin.
        observer: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Height of the eye above the ground.
        observer_height: f64 = 1.75, unit "m", range 0.0 to 1e6;
        /// Height of the target above the ground.
        target_height: f64 = 0.0, unit "m", range 0.0 to 1e6;
        /// Maximum distance.
        radius: f64 = 1e9, unit "m", range 0.0 to 1e9;
        /// Whether the earth's curvature is taken into account (mean radius 6371 km).
        curvature: bool = false;
        /// With `curvature`: refraction coefficient, the share of the curvature that refraction compensates.
        refraction: f64 = 0.13, range 0.0 to 1.0;
    }
    layers {
        /// 1 where the target is visible, else 0.
        visible: label;
        /// Height above the ground at which a target becomes visible: 0 where the ground is visible, -1 beyond the
        /// radius.
        hidden: height, unit "m";
    }
}

impl Solver for Viewshed {
    fn scratch(&self, padded: &Window) -> u64 {
        memory(padded, 24)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let heights = terrain::heights(sources, context)?;
        let window = *heights.window();
        let [east, south] = self.observer;
        let observer = Observer::new(
            [east / window.cell - window.x as f64, south / window.cell - window.y as f64],
            self.observer_height,
        )
        .with_radius(self.radius)
        .with_sinking(if self.curvature { sinking(self.refraction) } else { 0.0 });
        let hidden = viewshed(&heights, &observer, &|| context.progress.check())?;
        let mut visible = heights;
        for (visible, hidden) in visible.data_mut().iter_mut().zip(hidden.data()) {
            *visible = f32::from(u8::from(*hidden != BEYOND && f64::from(*hidden) <= self.target_height));
        }
        Ok(Solution { layers: vec![sources.keep(visible)?, sources.keep(hidden)?], scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("lines of sight are compared in f64")
    }

    fn cost(&self) -> f64 {
        400.0
    }
}
