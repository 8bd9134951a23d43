//! Glaciers on land.

use super::glaciate::glaciated;
use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::glaciation::Glaciers as Law;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Thickness of the ice of glaciers on the land, and of firn on slopes above the equilibrium line.
    ///
    /// Ice is as thick as its weight makes it flow: H = `stress` / (rho g f S) for the slope S of the valley, with f =
    /// 0.8 for the drag of the walls (Nye 1965). Across a valley its surface is level. Add it to the source for the
    /// surface of the land.
    pub struct Glaciers = "glaciers", filter, revision 1;
    inputs {
        /// The heights of the ground.
        source: required,
        /// Flow direction, clockwise from east (0) to north-east (7), such as `drainage.receiver`.
        receiver: required,
        /// The ice that passes, in m^2: the sum of the balance along the drainage, as for `glaciate`. Glaciers are
        /// where it is at least 0.2 km^2.
        ice: required,
        /// Height of the equilibrium line in metres, above which more snow falls than melts.
        equilibrium_line: required,
    }
    params {
        /// Basal shear stress: 50 to 150 kPa.
        stress: f64 = 100.0, unit "kPa", range 0.0 to 1000.0;
        /// Thickness of firn on gentle slopes above the equilibrium line.
        firn: f64 = 12.0, unit "m", range 0.0 to 200.0;
    }
}

impl Filter for Glaciers {
    fn halo(&self, cell: f64) -> usize {
        self.law().halo(cell)
    }

    fn scratch(&self, window: &Window) -> u64 {
        memory(&window.grown(self.halo(window.cell)), 16)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let land = glaciated(inputs)?;
        let out = only_layer(out)?;
        if window.is_empty() {
            return Ok(());
        }
        *out = self.law().run(&land, context.progress)?;
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("it follows the valley from each sample down to a glacier")
    }

    fn cost(&self, cell: f64) -> f64 {
        60.0 + 4.0 * (1800.0 / cell).min(64.0)
    }
}

impl Glaciers {
    fn law(&self) -> Law {
        Law::default().with_stress(self.stress).with_firn(self.firn)
    }
}
