//! Landforms by geomorphons.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::geomorphons::{CODES, Level, Look, geomorphons_with};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

choice! {
    /// The test for a level direction.
    pub enum Comparison {
        /// A direction is level if neither its highest nor its lowest line of sight is steeper than `flat`; otherwise
        /// the steeper one counts, as in r.geomorphon of GRASS.
        Steepest = "steepest",
        /// A direction is level if its zenith and nadir angles differ by no more than `flat`, as in the paper.
        Difference = "difference",
    }
}

op! {
    /// Landforms by geomorphons (Jasiewicz and Stepinski 2013): the ground is classified by which of the eight
    /// directions lead up and which lead down.
    ///
    /// Along each direction the highest and the lowest line of sight within `reach` are compared. For different cell
    /// sizes the landforms agree best at the same `reach`. The time grows with the reach.
    pub struct Geomorphons = "geomorphons", filter, revision 2;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Search radius; at least 1 sample, at most 1024 samples.
        reach: f64 = 500.0, unit "m", range 0.0 to 1e6;
        /// Flatness threshold: smaller angles count as level.
        flat: f64 = 1.0, unit "degrees", range 0.0 to 45.0;
        /// The test for a level direction.
        comparison: Comparison = Comparison::Steepest;
    }
    layers {
        /// The landform: 1 flat, 2 peak, 3 ridge, 4 shoulder, 5 spur, 6 slope, 7 hollow, 8 footslope, 9 valley, 10 pit.
        form: label;
    }
}

/// Maximum search radius in samples.
const FARTHEST: f64 = 1024.0;

const CODE: &str = include_str!("geomorphons.wgsl");

impl Filter for Geomorphons {
    fn halo(&self, cell: f64) -> usize {
        (self.reach / cell).floor().clamp(1.0, FARTHEST) as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        memory(window, 1)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let forms = geomorphons_with(source, &self.look(window.cell), context.progress)?;
        out.data_mut().iter_mut().zip(forms.data()).for_each(|(out, form)| *out = f32::from(*form));
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let look = self.look(cell);
        let by_difference = f32::from(u8::from(look.level == Level::ByDifference));
        let limit = libm::tan(look.flat.to_radians()) as f32;
        let passes = Passes::new(CODE, &[])
            .with_numbers([
                ("straight", look.straight as f32),
                ("diagonal", look.diagonal as f32),
                ("limit", limit),
                ("is_by_difference", by_difference),
                ("cell", cell as f32),
            ])
            .with_table("form", CODES.iter().flatten().map(|code| u32::from(*code)));
        let reach = self.halo(cell);
        Lowering::Shader(passes.then("forms", 0, [reach; 2]).reading(8 * reach))
    }

    fn cost(&self, cell: f64) -> f64 {
        10.0 * self.halo(cell) as f64
    }
}

impl Geomorphons {
    fn look(&self, cell: f64) -> Look {
        let level = match self.comparison {
            Comparison::Steepest => Level::BySteepest,
            Comparison::Difference => Level::ByDifference,
        };
        Look::round((self.reach / cell).min(FARTHEST), self.flat, level)
    }
}
