//! Slopes slide to the talus angle.

use crate::erosion::thermal::Thermal as Law;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};

op! {
    /// Thermal weathering: what is steeper than the talus angle slides down and piles up below, in straight scree slopes.
    ///
    /// After Musgrave, Kolb and Mace (1989). In each pass the material that crosses the side between two cells is a share of
    /// (1 - T / |g|) g, with g the slope there and T the talus angle's: the same in all directions, where comparing a cell with its
    /// eight neighbours makes octagonal cones. Mass is kept. Material moves one cell a pass, so cliffs of n cells need some n^2
    /// passes to become scree to their foot, and the window is made with one sample more on each side for every pass; where that grows
    /// too large, `bake` it. What comes out depends on the cell.
    pub struct Thermal = "thermal", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// The steepest slope that stands: 30 to 40 for loose rock, 25 for soil.
        talus_angle: f64 = 35.0, unit "deg", range 0.0 to 89.0;
        /// How many passes.
        iterations: u32 = 50, range 0.0 to 10000.0;
        /// The share of the fastest stable rate.
        rate: f64 = 1.0, range 0.0 to 1.0;
    }
}

impl Filter for Thermal {
    fn halo(&self, _: f64) -> usize {
        self.iterations as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        // All rows before and after some passes, and bands of them.
        12 * window.grown(self.iterations as usize).len() as u64
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let ([Some(source)], [Some(out)]) = (inputs, out) else { return Ok(()) };
        if window.is_empty() {
            return Ok(());
        }
        let law = Law { talus: libm::tan(self.talus_angle.to_radians()), rate: self.rate };
        *out = law.run(source, self.iterations as usize, context.progress)?;
        Ok(())
    }

    fn cost(&self, _: f64) -> f64 {
        0.7 * f64::from(self.iterations)
    }
}
