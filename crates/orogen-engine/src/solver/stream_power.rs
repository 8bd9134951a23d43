//! Stream power erosion with uplift.

use super::terrain::{flow_layer, memory, sea_level};
use crate::declare::{Declared, Input};
use crate::op::{Context, Solution, Solver, Sources};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::accumulation::Accumulation;
use orogen_grid::hydrology::erosion::{Erosion, ErosionRun};
use orogen_grid::hydrology::stream_power::{StreamPower as Law, Substrate};

op! {
    /// The source eroded by rivers under uplift: the stream power law, dh/dt = U - K A^m S^n, with landslides and soil creep.
    ///
    /// U is the uplift rate, K the erodibility, A the drainage area and S the slope. Each time step routes the flow (carving through
    /// depressions, see `drainage`), then solves the heights implicitly from the outlets upstream (Braun and Willett 2013), which is stable
    /// for any step length. Then slopes above the talus angle slide, and soil creeps by linear diffusion (Culling 1960). The sea and the
    /// world's border keep their heights. At the end every cell is higher than its receiver: there are no depressions and no flats. Ten
    /// steps turn any relief into valleys; a few hundred reach the balance of uplift and erosion. Use `erodibility_factor` and
    /// `uplift_factor` to vary rock and uplift over the world; uniform values look less real. The result depends on the cell size. Time
    /// grows with the world and the number of steps; memory is 45 bytes per cell, and 16 more if `jitter` is above 0. With `rain` it is 16 more,
    /// and the time is longer by about a half.
    pub struct StreamPower = "stream-power", solver, revision 2;
    margin;
    inputs {
        /// The initial heights.
        source: required,
        /// Factor of the erodibility, smaller where rock is harder. Negative values count as 0. Default: 1.
        erodibility_factor: optional, alias "softness",
        /// Factor of the uplift rate. Default: 1.
        uplift_factor: optional, alias "rise",
        /// Factor of the rain, 0.01 to 100: the erosion follows the discharge, so A is the drainage area weighted by it. Default: 1.
        rain: optional,
    }
    params {
        /// Simulated time.
        years: f64 = 3e5, unit "yr", range 0.0 to 1e9;
        /// Number of time steps.
        steps: u32 = 10, range 1.0 to 10000.0;
        /// K: erodibility; for m = 0.45 from 1e-6 (granite) to 5e-5 (mudstone).
        erodibility: f64 = 2e-5, unit "m^(1-2m)/yr", range 0.0 to 1.0;
        /// m: exponent of the drainage area.
        area_exponent: f64 = 0.45, range 0.0 to 2.0;
        /// n: exponent of the slope.
        slope_exponent: f64 = 1.0, range 0.2 to 5.0;
        /// U: uplift rate.
        uplift: f64 = 0.2, unit "mm/yr", range 0.0 to 100.0;
        /// Maximum stable slope.
        talus_angle: f64 = 50.0, unit "deg", range 1.0 to 89.0;
        /// Diffusivity of soil creep. It rounds crests, and widens hills to about sqrt(creep * time).
        creep: f64 = 0.01, unit "m^2/yr", range 0.0 to 100.0;
        /// Whether flow that falls between two of the eight grid directions takes one of them at random (Rho8, Fairfield and Leymarie
        /// 1991), with a new choice in each step. It only has an effect if `jitter` is 0. Without both, slopes show straight parallel
        /// grooves.
        random_receivers: bool = true, alias "scatter";
        /// Displacement of the solution points from the grid, as a share of the cell: up to half of this share to each side. It prevents
        /// valleys and slopes at the talus angle from aligning with the grid. At the end the heights are interpolated back to the grid.
        jitter: f64 = 1.0, range 0.0 to 1.0, alias "irregular";
        /// Seed of the random choices.
        seed: u64 = 0;
        /// Whether ground at or below sea level keeps its height and is an outlet.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell. A cell four times as large takes a sixteenth of the time: solve large
        /// valleys at a large cell with many steps, then add small valleys with a second `stream-power` at the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The final heights.
        height: height, unit "m";
        /// Drainage area; weighted by `rain` if it is given.
        flow: flow, unit "m^2";
        /// Height difference to the source: negative where erosion exceeds uplift.
        change: height, unit "m";
    }
}

impl Solver for StreamPower {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        let rain = if self.rain == Input::None { 0 } else { 16 };
        memory(padded, rain + if self.jitter > 0.0 { 61 } else { 45 })
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let window = *sources.padded();
        let source = sources.whole(0, &window)?;
        let given = |i: usize| sources.given(i).then(|| sources.whole(i, &window)).transpose();
        let (erodibility_factor, uplift_factor, rain) = (given(1)?, given(2)?, given(3)?);
        let erosion = Erosion::new(
            Law::default()
                .with_erodibility(self.erodibility)
                .with_area_exponent(self.area_exponent)
                .with_slope_exponent(self.slope_exponent)
                .with_uplift(self.uplift / 1000.0)
                .with_max_slope(libm::tan(self.talus_angle.to_radians()))
                .with_min_slope(Law::default().min_slope),
            self.years,
            self.steps,
        )
        .with_creep(self.creep)
        .with_jitter(self.jitter)
        .with_scattered(self.random_receivers.then_some(context.world_params.seed_of(self.seed) as u32));
        let substrate = Substrate::default()
            .with_erodibility_factor(erodibility_factor.as_ref())
            .with_uplift_factor(uplift_factor.as_ref())
            .with_rain(rain.as_ref())
            .with_points(None);
        let mut heights = source.clone();
        let sea_level = sea_level(self.sea, context);
        let progress = context.progress;
        progress.expect(erosion.work());
        let observe = |done: u32, run: &ErosionRun, mut now: Grid| {
            let Some(observer) = context.observer else { return Ok(()) };
            let part = progress.part(0.0);
            if (1..self.spec().layers.len()).any(|layer| observer.reads(layer)) {
                let drained = run.finish(&mut now, &part)?;
                return observer.take(done, solution(sources, now, &drained, source.clone())?);
            }
            run.settle(&mut now, &part)?;
            observer.take(done, Solution { layers: vec![sources.keep(now)?], scalars: Vec::new() })
        };
        let wants = |done: u32| context.observer.is_some_and(|observer| observer.wants(done));
        if wants(0) {
            let mut begun = ErosionRun::new(erosion.with_years(0.0).with_steps(1), &heights, &substrate, sea_level);
            let mut now = heights.clone();
            begun.step(&mut now, &progress.part(0.0))?;
            observe(0, &begun, now)?;
        }
        let mut run = ErosionRun::new(erosion, &heights, &substrate, sea_level);
        for done in 1..=self.steps {
            let part = progress.part(1.0);
            run.step(&mut heights, &part)?;
            part.finish();
            if done < self.steps && wants(done) {
                observe(done, &run, heights.clone())?;
            }
        }
        let drained = run.finish(&mut heights, &progress.part(ErosionRun::FINISHING))?;
        solution(sources, heights, &drained, source)
    }

    fn cost(&self) -> f64 {
        45.0 * f64::from(self.steps)
    }
}

/// The layers of heights that started as `source`.
fn solution(sources: &dyn Sources, heights: Grid, drained: &Accumulation, source: Grid) -> Result<Solution> {
    let mut change = source;
    for (change, height) in change.data_mut().iter_mut().zip(heights.data()) {
        *change = height - *change;
    }
    let layers = vec![sources.keep(heights)?, sources.keep(flow_layer(drained))?, sources.keep(change)?];
    Ok(Solution { layers, scalars: Vec::new() })
}
