//! Hydraulic erosion by droplets.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::erosion::droplets::Droplets as Law;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Hydraulic erosion by droplets. Each droplet runs downhill, erodes where it is fast and deposits where it slows
    /// down. It makes gullies on slopes and deposits in hollows.
    ///
    /// After Beyer, "Implementation of a method for hydraulic erosion" (2015), with lengths in metres. A droplet moves
    /// one cell per step and can carry capacity * max(slope, least_slope) * speed * water; its speed changes by v^2 =
    /// v^2 + gravity * drop. It erodes no deeper than the height difference ahead of it, and at the end it deposits all
    /// that it carries: mass is conserved up to rounding.
    ///
    /// If droplets ran one after another, the result would depend on their order. Here they start at hashed positions,
    /// in batches: all droplets of a batch see the same ground and their changes are summed in fixed point, so the
    /// result does not depend on tiles or threads. After each batch the deposits slide apart in 16 passes, so that
    /// droplets that end in one hollow do not pile up. The halo is lifetime + radius + 18 cells per batch. More batches
    /// make longer and deeper gullies. The result depends on the cell size. About a microsecond per droplet of 30
    /// cells.
    pub struct Droplets = "droplets", filter, revision 1;
    inputs {
        /// The initial heights.
        source: required,
    }
    params {
        /// Number of droplets per area, over all batches.
        density: f64 = 5000.0, unit "1/km^2", range 0.0 to 1e9;
        /// Number of batches.
        batches: u32 = 4, range 1.0 to 1000.0;
        /// Maximum path length of a droplet.
        lifetime: f64 = 300.0, unit "m", range 0.0 to 1e6;
        /// Radius within which a droplet erodes.
        radius: f64 = 30.0, unit "m", range 0.0 to 1e5;
        /// Share of its direction that a droplet keeps at each cell: 0 follows the slope, values near 1 run straight
        /// on.
        inertia: f64 = 0.05, range 0.0 to 0.99;
        /// Capacity on a vertical slope for each m/s of speed, as a depth over the area that the droplet stands for.
        capacity: f64 = 0.4, unit "s", range 0.0 to 1000.0;
        /// Minimum slope (rise over run) in the capacity.
        least_slope: f64 = 0.01, range 0.0 to 10.0;
        /// Share of the free capacity that is eroded at each cell.
        erosion: f64 = 0.3, range 0.0 to 1.0;
        /// Share of the excess sediment that is deposited at each cell.
        deposition: f64 = 0.3, range 0.0 to 1.0;
        /// Share of its water that a droplet loses per metre.
        evaporation: f64 = 0.001, unit "1/m", range 0.0 to 1.0;
        /// Acceleration of droplets by the height difference.
        gravity: f64 = 4.0, unit "m/s^2", range 0.0 to 1000.0;
        /// Seed of the droplets' start positions.
        seed: u64 = 0;
    }
}

impl Filter for Droplets {
    fn halo(&self, cell: f64) -> usize {
        self.law(0).halo(cell)
    }

    fn scratch(&self, window: &Window) -> u64 {
        // The heights twice, two sums of eight bytes, and four planes while the deposits slide.
        memory(&window.grown(self.halo(window.cell)), 40)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        if window.is_empty() {
            return Ok(());
        }
        *out = self.law(context.world_params.seed_of(self.seed)).run(source, context.progress)?;
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        // Sums of fractions in arbitrary order would make the result depend on the card and differ from run to run.
        Lowering::Processor(
            "its droplets add up their changes in whole numbers of 64 bits, for which WGSL has no atomic sum",
        )
    }

    fn cost(&self, cell: f64) -> f64 {
        let steps = (self.lifetime / cell).ceil();
        100.0 + self.density * cell * cell / 1e6 * (100.0 + 30.0 * steps)
    }
}

impl Droplets {
    fn law(&self, seed: u64) -> Law {
        Law::default()
            .with_density(self.density)
            .with_batches(self.batches as usize)
            .with_lifetime(self.lifetime)
            .with_radius(self.radius)
            .with_inertia(self.inertia)
            .with_capacity(self.capacity)
            .with_least_slope(self.least_slope)
            .with_erosion(self.erosion)
            .with_deposition(self.deposition)
            .with_evaporation(self.evaporation)
            .with_gravity(self.gravity)
            .with_seed(seed)
    }
}
