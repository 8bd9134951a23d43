//! Stream power erosion with a finite halo.

use crate::budget::memory;
use crate::lower::{Lowering, Passes, alternating};
use crate::op::{Context, Filter, GridInputs, WorldParams};
use orogen_grid::erosion::local_stream_power::{AREA, HEIGHT, LocalStreamPower as Law, RADIUS, SEDIMENT};
use orogen_grid::erosion::planes::Planes;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// The stream power law as a filter: water erodes valleys and gullies and deposits sediment, with a finite halo. It
    /// also works in unbounded worlds.
    ///
    /// dh/dt = U - K A^m S^n + G Q / A, after Schott et al. (2023) and, for the sediment, Yuan et al. (2019). Each
    /// iteration reads the result of the one before: drainage areas A and sediment Q come from higher neighbors, shared
    /// in proportion to the fourth power of the slope. S is the upwind gradient, so there are no grooves along the
    /// grid. Steps of any length are stable; no cell is eroded below its lowest neighbor. Soil creep works as in
    /// `stream-power`.
    ///
    /// Water moves one cell per iteration, so rivers that start outside the window are unknown unless `flow` provides
    /// them (`drainage.flow` or `stream-power.flow` of a coarser solution). Use this filter for detail: the solver
    /// `stream-power` shapes the land, this filter adds gullies at any cell size. The mass of the sediment is conserved
    /// only approximately, because it arrives one iteration late. The halo is two cells per iteration. The result
    /// depends on the cell size. About 4 ns per sample and iteration.
    ///
    /// With `strata` the erodibility also depends on the rock at depth, as in `stream-power`; sediment counts as the
    /// rock at its height, and talus angles have no effect: use `thermal`.
    pub struct LocalStreamPower = "local-stream-power", filter, revision 1;
    strata;
    inputs {
        /// The initial heights.
        source: required,
        /// Initial drainage areas, in m^2. Default: the area of each cell.
        flow: optional,
    }
    params {
        /// Simulated time.
        years: f64 = 1e5, unit "yr", range 0.0 to 1e9;
        /// Number of iterations.
        iterations: u32 = 50, range 1.0 to 10000.0;
        /// K: erodibility; for m = 0.45 from 1e-6 (granite) to 5e-5 (mudstone).
        erodibility: f64 = 2e-5, unit "m^(1-2m)/yr", range 0.0 to 1.0;
        /// m: exponent of the drainage area.
        area_exponent: f64 = 0.45, range 0.0 to 2.0;
        /// n: exponent of the slope.
        slope_exponent: f64 = 1.0, range 0.2 to 5.0;
        /// U: uplift rate.
        uplift: f64 = 0.0, unit "mm/yr", range 0.0 to 100.0;
        /// G: deposition coefficient. 0 deposits nothing; values around 1 are common in nature.
        deposition: f64 = 0.5, range 0.0 to 100.0;
        /// Diffusivity of soil creep. It widens the gullies. It is limited to the stable value, a fifth of a cell's
        /// area per iteration.
        creep: f64 = 0.005, unit "m^2/yr", range 0.0 to 100.0;
        /// Whether ground at or below sea level keeps its height.
        sea: bool = true;
    }
    layers {
        /// The final heights.
        height: height, unit "m";
        /// The drainage areas.
        flow: flow, unit "m^2";
        /// The sediment that leaves each cell.
        sediment: flow, unit "m^3/yr";
    }
}

const CODE: &str = concat!(include_str!("../lower/power.wgsl"), include_str!("local_stream_power.wgsl"));

impl Filter for LocalStreamPower {
    fn halo(&self, _: f64) -> usize {
        RADIUS * self.iterations as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        // The planes before and after a group of iterations, and their bands.
        memory(&window.grown(self.halo(window.cell)), if self.strata.is_empty() { 36 } else { 48 })
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let (source, flow) = (inputs.required("source")?, inputs.get("flow"));
        if window.is_empty() {
            return Ok(());
        }
        let law = self.law(window.cell, context.world_params);
        let (iterations, progress) = (self.iterations as usize, context.progress);
        // Talus angles are not read.
        let Some(strata) = self.prepared_strata(1.0) else {
            let done = law.run(started::<3>(source, flow), iterations, progress)?;
            write(&done, *window, out);
            return Ok(());
        };
        let mut planes = started::<4>(source, flow);
        let below = strata.thickness() + f64::from(self.iterations) * law.years * law.uplift;
        let top = inputs.get("bedding");
        for j in 0..source.height() {
            let [_, _, _, bottoms] = planes.row_mut(j);
            match top {
                Some(top) => {
                    let heights = bottoms.iter_mut().zip(top.row(j));
                    heights.for_each(|(bottom, top)| *bottom = (f64::from(*top) - below) as f32);
                }
                None => bottoms.fill(-below as f32),
            }
        }
        write(&law.run_in_strata(&strata, planes, iterations, progress)?, *window, out);
        Ok(())
    }

    fn lower(&self, cell: f64, world_params: &WorldParams) -> Lowering<Passes> {
        if !self.strata.is_empty() {
            return Lowering::Processor("strata are integrated in f64");
        }
        // The two planes of heights, which the iterations use in turn; the first one is the layer.
        const TURNS: [u32; 2] = [3, 8];
        let first = TURNS[(self.iterations % 2) as usize];
        let passes = Passes::new(CODE, &[]).with_numbers(self.law(cell, world_params).numbers()).with_scratch(3);
        let steps = alternating(self.iterations, first, TURNS);
        let iterate = |passes: Passes, (k, step)| {
            passes.then("give", step, [RADIUS * k + 1; 2]).then("take", step, [RADIUS * (k + 1); 2])
        };
        Lowering::Shader(steps.into_iter().enumerate().fold(passes.then("start", first << 8, [0; 2]), iterate))
    }

    fn cost(&self, _: f64) -> f64 {
        (if self.strata.is_empty() { 4.0 } else { COST_IN_STRATA }) * f64::from(self.iterations)
    }
}

/// Approximate time for a sample and iteration in strata, in nanoseconds.
const COST_IN_STRATA: f64 = 60.0;

/// The planes before the first iteration: heights, and drainage areas of at least a cell.
fn started<const N: usize>(source: &Grid, flow: Option<&Grid>) -> Planes<N> {
    let own = (source.window().cell * source.window().cell) as f32;
    let mut planes = Planes::new(source.width(), source.height());
    for j in 0..source.height() {
        let row = planes.row_mut(j);
        row[HEIGHT].copy_from_slice(source.row(j));
        match flow {
            Some(flow) => row[AREA].iter_mut().zip(flow.row(j)).for_each(|(area, flow)| *area = flow.max(own)),
            None => row[AREA].fill(own),
        }
    }
    planes
}

/// Writes the wanted layers.
fn write<const N: usize>(done: &Planes<N>, window: Window, out: &mut [Option<Grid>]) {
    for (layer, plane) in out.iter_mut().zip([HEIGHT, AREA, SEDIMENT]) {
        if let Some(layer) = layer {
            *layer = done.grid(plane, window);
        }
    }
}

impl LocalStreamPower {
    fn law(&self, cell: f64, world_params: &WorldParams) -> Law {
        Law::new(cell)
            .with_years(self.years / f64::from(self.iterations.max(1)))
            .with_erodibility(self.erodibility)
            .with_area_exponent(self.area_exponent)
            .with_slope_exponent(self.slope_exponent)
            .with_uplift(self.uplift / 1000.0)
            .with_deposition(self.deposition)
            .with_creep(self.creep)
            .with_sea_level(self.sea.then_some(world_params.sea_level as f32))
    }
}
