//! Hydraulic erosion with virtual pipes.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams};
use orogen_grid::erosion::pipe_rows::{BED, DEPTH, SEDIMENT};
use orogen_grid::erosion::pipes::{Pipes as Law, RADIUS, Wet};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Hydraulic erosion by rain on a grid of virtual pipes: water runs off, erodes gullies, collects, and deposits
    /// sediment.
    ///
    /// After Mei, Decaudin and Hu (2007) and Stava et al. (2008). Water flows between neighboring cells according to
    /// the difference of the water surfaces. It can carry sin(slope) times its discharge times `capacity`; it erodes
    /// where it carries less and deposits where it carries more. Sediment moves with the water that crosses each side
    /// of a cell (not along the velocity as in Mei), so mass is conserved up to rounding. Erosion and deposition are
    /// spread over 3 x 3 cells. Erosion stops half way to the lowest neighbor; deposition stops at the neighbors' mean
    /// height plus a quarter of the water depth. This avoids grooves along the grid, pits and spikes.
    ///
    /// The simulated storm is short, with far more rain and erosion than in nature: the product of rain and iterations
    /// matters. Water moves at most one cell per iteration. The halo is three cells per iteration; put a `bake` after a
    /// filter with many iterations. The result depends on the cell size. About 4 ns per sample and iteration.
    pub struct Pipes = "pipes", filter, revision 1;
    inputs {
        /// The initial heights, without water.
        source: required,
    }
    params {
        /// Number of iterations.
        iterations: u32 = 100, range 0.0 to 10000.0;
        /// Rainfall rate.
        rain: f64 = 2.0, unit "mm/s", range 0.0 to 1000.0;
        /// Share of the water that evaporates per second.
        evaporation: f64 = 0.01, unit "1/s", range 0.0 to 1.0;
        /// Sediment, in metres of ground, that 1 m^2/s of water carries down a vertical slope.
        capacity: f64 = 2.0, unit "s/m", range 0.0 to 1000.0;
        /// Share of the free capacity that is eroded per second.
        erosion: f64 = 0.3, unit "1/s", range 0.0 to 10.0;
        /// Share of the excess sediment that is deposited per second.
        deposition: f64 = 0.3, unit "1/s", range 0.0 to 10.0;
        /// Cross-section of a pipe per metre of the cell's side. It equals the water depth at which real waves have the
        /// model's wave speed.
        pipe: f64 = 1.0, unit "m", range 1e-3 to 1000.0;
        /// Share of a pipe's flow that is lost per second.
        friction: f64 = 0.05, unit "1/s", range 0.0 to 10.0;
        /// Gravitational acceleration.
        gravity: f64 = 9.81, unit "m/s^2", range 1e-3 to 1000.0;
        /// Duration of an iteration. It is limited to the stable value, cell / (2 sqrt(gravity pipe)).
        time_step: f64 = 1.0, unit "s", range 1e-6 to 1e6;
    }
    layers {
        /// The final ground.
        height: height, unit "m";
        /// Water depth.
        water: height, unit "m";
        /// Suspended sediment, in metres of ground.
        sediment: height, unit "m";
        /// Flow velocity.
        velocity: height, unit "m/s";
    }
}

const CODE: &str = include_str!("pipes.wgsl");

impl Filter for Pipes {
    fn halo(&self, _: f64) -> usize {
        // One more cell for the velocity, which is computed from the flows over a cell's sides.
        RADIUS * self.iterations as usize + 1
    }

    fn scratch(&self, window: &Window) -> u64 {
        // Five planes before and after, and the bands.
        memory(&window.grown(self.halo(window.cell) + 1), 60)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        if window.is_empty() {
            return Ok(());
        }
        let law = self.law();
        let wet = law.open(Wet::new(source), self.iterations as usize, context.progress)?;
        let planes: [&dyn Fn() -> Grid; 4] =
            [&|| wet.plane(BED), &|| wet.plane(DEPTH), &|| carried(&wet), &|| wet.speed(&law)];
        for (layer, plane) in out.iter_mut().zip(planes) {
            context.progress.check()?;
            if let Some(layer) = layer {
                layer.paste(&plane());
            }
        }
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let passes =
            Passes::new(CODE, &[]).with_numbers(self.law().numbers(cell)).with_scratch(6).then("start", 0, [0; 2]);
        let passes = (0..self.iterations as usize).map(|k| RADIUS * k).fold(passes, |passes, inset| {
            let passes = passes.then("flow", 0, [inset + 1; 2]).then("pass_on", 0, [inset + 2; 2]);
            passes.then("lay", 0, [inset + 3; 2])
        });
        Lowering::Shader(passes.then("finish", 0, [self.halo(cell); 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        4.0 * f64::from(self.iterations)
    }
}

/// The sediment, at least 0: rounding of the bed's height may make it slightly negative.
fn carried(wet: &Wet) -> Grid {
    let mut carried = wet.plane(SEDIMENT);
    carried.data_mut().iter_mut().for_each(|metres| *metres = metres.max(0.0));
    carried
}

impl Pipes {
    fn law(&self) -> Law {
        Law::default()
            .with_rain(self.rain / 1000.0)
            .with_evaporation(self.evaporation)
            .with_capacity(self.capacity)
            .with_erosion(self.erosion)
            .with_deposition(self.deposition)
            .with_pipe(self.pipe)
            .with_friction(self.friction)
            .with_gravity(self.gravity)
            .with_time_step(self.time_step)
    }
}
