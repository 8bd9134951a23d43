//! Thermal weathering: slopes slide to the talus angle.

use crate::budget::memory;
use crate::lower::{Lowering, Passes, alternating};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::erosion::thermal::Thermal as Law;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Thermal weathering: ground steeper than the talus angle slides down and accumulates below as straight scree
    /// slopes.
    ///
    /// After Musgrave, Kolb and Mace (1989). In each pass the material that crosses the side between two cells is a
    /// share of (1 - T / |g|) g, where g is the slope there and T the tangent of the talus angle. This is the same in
    /// all directions; comparing a cell with its eight neighbors would make octagonal cones. Mass is conserved.
    /// Material moves one cell per pass, so a cliff of n cells needs about n^2 passes to become scree down to its foot.
    /// The halo is one sample per pass; where it grows too large, use `bake`. The result depends on the cell size.
    ///
    /// With `strata` each has its own talus angle: material moves where the slope is above that of the stratum of the
    /// higher sample.
    pub struct Thermal = "thermal", filter, revision 1;
    strata;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Maximum stable slope: 30 to 40 for loose rock, 25 for soil.
        talus_angle: f64 = 35.0, unit "deg", range 0.0 to 89.0;
        /// Number of passes.
        iterations: u32 = 50, range 0.0 to 10000.0;
        /// Rate of movement, as a share of the fastest stable rate.
        rate: f64 = 1.0, range 0.0 to 1.0;
    }
}

const CODE: &str = include_str!("thermal.wgsl");

impl Filter for Thermal {
    fn halo(&self, _: f64) -> usize {
        self.iterations as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        // All rows before and after a group of passes, and the bands.
        memory(&window.grown(self.iterations as usize), if self.strata.is_empty() { 12 } else { 28 })
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        if window.is_empty() {
            return Ok(());
        }
        let (law, passes) = (self.law(), self.iterations as usize);
        *out = match self.prepared_strata(law.talus) {
            None => law.run(source, passes, context.progress)?,
            Some(strata) => {
                let mut bottoms = match inputs.get("bedding") {
                    Some(tops) => tops.clone(),
                    None => Grid::filled(*source.window(), 0.0),
                };
                let thickness = strata.thickness();
                bottoms.data_mut().iter_mut().for_each(|top| *top = (f64::from(*top) - thickness) as f32);
                law.run_in_strata(&strata, source, &bottoms, passes, context.progress)?
            }
        };
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        if !self.strata.is_empty() {
            return Lowering::Processor("strata are integrated in f64");
        }
        // The layer and another plane, which the passes write in turn.
        const TURNS: [u32; 2] = [2, 3];
        let [stands, share] = self.law().numbers(cell);
        if self.iterations == 0 {
            // A pass that moves nothing.
            let passes = Passes::new(CODE, &[]).with_numbers([("stands", stands), ("share", 0.0)]).with_scratch(1);
            return Lowering::Shader(passes.then("slide", TURNS[0] << 8, [0; 2]));
        }
        let passes = Passes::new(CODE, &[]).with_numbers([("stands", stands), ("share", share)]).with_scratch(1);
        let steps = alternating(self.iterations, 0, TURNS);
        let slide = |passes: Passes, (k, step)| passes.then("slide", step, [k + 1; 2]);
        Lowering::Shader(steps.into_iter().enumerate().fold(passes, slide))
    }

    fn cost(&self, _: f64) -> f64 {
        (if self.strata.is_empty() { 0.7 } else { 15.0 }) * f64::from(self.iterations)
    }
}

impl Thermal {
    fn law(&self) -> Law {
        Law::new(libm::tan(self.talus_angle.to_radians())).with_rate(self.rate)
    }
}
