//! Mountains that rivers cut while they rise.

use crate::declare::Declared;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::accumulation::Accumulation;
use crate::hydrology::erosion::{Erosion, ErosionRun};
use crate::hydrology::stream_power::{StreamPower as Law, Substrate};
use crate::op::{Context, Solution, Solver, Sources};

op! {
    /// The source eroded by rivers while it is lifted: the stream power law, dh/dt = U - K A^m S^n, with landslides and creep.
    ///
    /// U is the uplift, K the erodibility, A the drainage area and S the slope. In every step water finds its way anew (over
    /// the bed of depressions, see `drainage`), then the heights are solved implicitly from the outlets up (Braun and Willett
    /// 2013), which is stable however long the step; what is steeper than the talus angle slides; then soil creeps by linear
    /// diffusion (Culling 1960). The sea and the world's border stay as they are. In the end every cell is higher than the
    /// one it drains to: no depressions, no flats. Ten steps turn any relief into valleys; some hundred bring it to where uplift and
    /// erosion balance. Rock and uplift that differ from place to place (`erodibility_factor`, `uplift_factor`) make it look real. What comes out
    /// depends on the cell it is solved at. Time grows with the world and the steps; memory is 45 bytes
    /// a cell, and 16 more if `jitter`.
    pub struct StreamPower = "stream-power", solver, revision 2;
    inputs {
        /// The heights to begin with.
        source: required,
        /// A factor of the erodibility, 1 if left out: small where rock is hard. Less than 0 counts as 0.
        erodibility_factor: optional, alias "softness",
        /// A factor of the uplift, 1 if left out.
        uplift_factor: optional, alias "rise",
    }
    params {
        /// How long it goes on.
        years: f64 = 3e5, unit "yr", range 0.0 to 1e9;
        /// In how many steps.
        steps: u32 = 10, range 1.0 to 10000.0;
        /// K: how easily rivers cut, for m = 0.45 from 1e-6 (granite) to 5e-5 (mudstone).
        erodibility: f64 = 2e-5, unit "m^(1-2m)/yr", range 0.0 to 1.0;
        /// m: how much more a larger river cuts.
        area_exponent: f64 = 0.45, range 0.0 to 2.0;
        /// n: how much more a steeper river cuts.
        slope_exponent: f64 = 1.0, range 0.2 to 5.0;
        /// U: how fast the land rises.
        uplift: f64 = 0.2, unit "mm/yr", range 0.0 to 100.0;
        /// The steepest slope that stands.
        talus_angle: f64 = 50.0, unit "deg", range 1.0 to 89.0;
        /// How fast soil creeps: the diffusivity. Rounds crests, and widens hills to sqrt(creep * time).
        creep: f64 = 0.01, unit "m^2/yr", range 0.0 to 100.0;
        /// Whether water that runs between two of a grid's eight directions takes one of them by chance (Rho8, Fairfield and
        /// Leymarie 1991), another in each step, where `jitter` is 0. Without both, slopes show straight parallel grooves.
        random_receivers: bool = true, alias "scatter";
        /// How far the points at which heights are solved stand off the grid's own: by up to half of this share of a cell to each
        /// side. The valleys and the slopes at the talus angle then do not line up with the grid. In the end the heights are carried
        /// over to it.
        jitter: f64 = 1.0, range 0.0 to 1.0, alias "irregular";
        /// Seed of the random choices.
        seed: u64 = 0;
        /// Whether the ground at or below sea level stays as it is, and water ends there.
        sea: bool = true;
        /// From one sample that it is solved on to the next; 0 takes the world's cell. Four times the cell is a sixteenth of the work:
        /// make the large valleys so, in many steps, and the small ones by a second one that erodes what the first has made.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The heights in the end.
        height: height, unit "m";
        /// The drainage area: how much ground lies upstream.
        flow: flow, unit "m^2";
        /// How much higher the ground is than the source: below 0 where more was cut than rose.
        change: height, unit "m";
    }
}

impl Solver for StreamPower {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        padded.len() as u64 * if self.jitter > 0.0 { 61 } else { 45 }
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let window = *sources.padded();
        let source = sources.whole(0, &window)?;
        let given = |i: usize| sources.given(i).then(|| sources.whole(i, &window)).transpose();
        let (erodibility_factor, uplift_factor) = (given(1)?, given(2)?);
        let erosion = Erosion {
            law: Law {
                erodibility: self.erodibility,
                area_exponent: self.area_exponent,
                slope_exponent: self.slope_exponent,
                uplift: self.uplift / 1000.0,
                max_slope: libm::tan(self.talus_angle.to_radians()),
                min_slope: Law::default().min_slope,
            },
            creep: self.creep,
            years: self.years,
            steps: self.steps,
            jitter: self.jitter,
            scattered: self.random_receivers.then_some(context.world_params.seed_of(self.seed) as u32),
        };
        let substrate = Substrate {
            erodibility_factor: erodibility_factor.as_ref(),
            uplift_factor: uplift_factor.as_ref(),
            points: None,
        };
        let mut heights = source.clone();
        let sea_level = self.sea.then_some(context.world_params.sea_level as f32);
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
            let mut begun =
                ErosionRun::new(Erosion { years: 0.0, steps: 1, ..erosion }, &heights, &substrate, sea_level);
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

/// The layers of heights that began as `source`.
fn solution(sources: &dyn Sources, heights: Grid, drained: &Accumulation, source: Grid) -> Result<Solution> {
    let window = *heights.window();
    let mut change = source;
    for (change, height) in change.data_mut().iter_mut().zip(heights.data()) {
        *change = height - *change;
    }
    let cell_area = window.cell * window.cell;
    let flow = drained.area.data().iter().map(|cells| (f64::from(*cells) * cell_area) as f32).collect();
    let flow = Grid::from_data(window, flow).unwrap_or_else(|| Grid::filled(window, 0.0));
    let layers = vec![sources.keep(heights)?, sources.keep(flow)?, sources.keep(change)?];
    Ok(Solution { layers, scalars: Vec::new() })
}
