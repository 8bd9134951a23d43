//! Stream power erosion with uplift.

use super::routing::{self, Descent, Flats, LAST, Planes, then};
use super::terrain::{sea_level, sea_level_of};
use crate::budget::memory;
use crate::declare::{Declared, Input};
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::accumulation::Accumulation;
use orogen_grid::hydrology::creep::creep_strides;
use orogen_grid::hydrology::erosion::{Erosion, ErosionRun};
use orogen_grid::hydrology::points::Points;
use orogen_grid::hydrology::stream_power::{StreamPower as Law, Substrate};
use orogen_grid::strata::Bedding;

op! {
    /// The source eroded by rivers under uplift: the stream power law, dh/dt = U - K A^m S^n, with landslides and soil
    /// creep.
    ///
    /// U is the uplift rate, K the erodibility, A the drainage area and S the slope. Each time step routes the flow
    /// (carving through depressions, see `drainage`), then solves the heights implicitly from the outlets upstream
    /// (Braun and Willett 2013), which is stable for any step length. Then slopes above the talus angle slide, and soil
    /// creeps by linear diffusion (Culling 1960). The sea and the world's border keep their heights. At the end every
    /// cell is higher than its receiver: there are no depressions and no flats. Ten steps turn any relief into valleys;
    /// a few hundred reach the balance of uplift and erosion. Use `erodibility_factor` and `uplift_factor` to vary rock
    /// and uplift over the world; uniform values look less real. The result depends on the cell size. Time grows with
    /// the world and the number of steps; memory is 45 bytes per cell, and 16 more if `jitter` is above 0. With `rain`
    /// it is 16 more, and the time is longer by about a half.
    ///
    /// With `deposition` rivers also lay down what they carry: dh/dt = U - K A^m S^n + G Q / A, where G is the
    /// `deposition` and Q the sediment, all that was eroded or slid upstream and was not laid since then (Yuan and
    /// others 2019). Fans grow at the feet of mountains. Depressions are filled from the bottom up to a level floor,
    /// and only by the sediment that reaches them; those deeper than 1 m are left at the end. Deposits are as erodible
    /// as the rock at their place and height. Memory is 66 bytes more per cell, and a step takes about three times as
    /// long.
    ///
    /// With `strata` the erodibility also depends on the rock at depth, K = `erodibility` * `erodibility_factor` * that
    /// of the stratum, and rock rises with the ground. A step erodes each stratum that it passes at its own rate, so a
    /// thin hard one is not skipped, and walls have the talus angle of each of their strata: hard rock makes cliffs and
    /// benches, soft rock slopes.
    pub struct StreamPower = "stream-power", solver, revision 4;
    margin;
    strata;
    inputs {
        /// The initial heights.
        source: required,
        /// Factor of the erodibility, smaller where rock is harder. Negative values count as 0. Default: 1.
        erodibility_factor: optional, alias "softness",
        /// Factor of the uplift rate. Default: 1.
        uplift_factor: optional, alias "rise",
        /// Factor of the rain, 0.01 to 100: the erosion follows the discharge, so A is the drainage area weighted by
        /// it. Default: 1.
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
        /// G: deposition coefficient. 0: rivers carry all sediment to the outlets. Values around 1 are common in
        /// nature; fans need 3 to 10.
        deposition: f64 = 0.0, range 0.0 to 10.0;
        /// Whether flow that falls between two of the eight grid directions takes one of them at random (Rho8,
        /// Fairfield and Leymarie 1991), with a new choice in each step. It only has an effect if `jitter` is 0.
        /// Without both, slopes show straight parallel grooves.
        random_receivers: bool = true, alias "scatter";
        /// Displacement of the solution points from the grid, as a share of the cell: up to half of this share to each
        /// side. It prevents valleys and slopes at the talus angle from aligning with the grid. At the end the heights
        /// are interpolated back to the grid.
        jitter: f64 = 1.0, range 0.0 to 1.0, alias "irregular";
        /// Seed of the random choices.
        seed: u64 = 0;
        /// Whether ground at or below sea level keeps its height and is an outlet.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell. A cell four times as large takes a sixteenth of the
        /// time: solve large valleys at a large cell with many steps, then add small valleys with a second
        /// `stream-power` at the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The final heights.
        height: height, unit "m";
        /// Drainage area; weighted by `rain` if it is given.
        flow: flow, unit "m^2";
        /// Height difference to the source: negative where erosion exceeds uplift.
        change: height, unit "m";
        /// Thickness of the deposits: what was laid and not eroded again; 0 without `deposition`.
        sediment: height, unit "m";
    }
}

impl Solver for StreamPower {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        let rain = if self.rain == Input::None { 0 } else { 16 };
        let bedding = if self.strata.is_empty() || self.bedding == Input::None { 0 } else { 4 };
        let sediment = if self.deposition > 0.0 { 66 } else { 0 };
        memory(padded, rain + bedding + sediment + if self.jitter > 0.0 { 61 } else { 45 })
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let window = *sources.padded();
        let source = sources.whole("source", &window)?;
        let given = |name: &str| sources.given(name).then(|| sources.whole(name, &window)).transpose();
        let (erodibility_factor, uplift_factor) = (given("erodibility_factor")?, given("uplift_factor")?);
        let rain = given("rain")?;
        let erosion = self.erosion(context.world_params);
        let strata = self.prepared_strata(erosion.law.max_slope);
        let top = if strata.is_some() { given("bedding")? } else { None };
        let substrate = Substrate::default()
            .with_erodibility_factor(erodibility_factor.as_ref())
            .with_uplift_factor(uplift_factor.as_ref())
            .with_rain(rain.as_ref())
            .with_points(None)
            .with_bedding(strata.as_ref().map(|strata| Bedding::new(strata, top.as_ref())));
        let mut heights = source.clone();
        let sea_level = sea_level(self.sea, context);
        let progress = context.progress;
        progress.expect(erosion.work());
        let observe = |done: u32, run: &ErosionRun, mut now: Grid| {
            let Some(observer) = context.observer else { return Ok(()) };
            let part = progress.part(0.0);
            if (1..self.spec().layers.len()).any(|layer| observer.reads(layer)) {
                let drained = run.finish(&mut now, &part)?;
                return observer.take(done, solution(sources, run, now, &drained, source.clone())?);
            }
            run.settle(&mut now, &part)?;
            observer.take(done, Solution { layers: vec![sources.keep(now)?], scalars: Vec::new() })
        };
        let wants = |done: u32| context.observer.is_some_and(|observer| observer.wants(done));
        if wants(0) {
            let risen = erosion.years * erosion.law.uplift;
            let substrate = substrate.with_bedding(substrate.bedding.map(|bedding| bedding.before(risen)));
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
        solution(sources, &run, heights, &drained, source)
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        solution.read_positive(&[SEDIMENT], asked, out)
    }

    fn lower(&self, padded: &Window, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let given = |name: &str| self.spec().given_input(name, given);
        let rain = given("rain");
        if !self.strata.is_empty() {
            return Lowering::Processor("strata are integrated in f64");
        }
        if self.deposition > 0.0 {
            return Lowering::Processor("sediment is summed along rivers in one order");
        }
        let planes =
            Planes { inputs: self.spec().inputs.len(), layers: self.spec().layers.len(), scratch: SCRATCH, rain };
        if !planes.can_rain(padded) {
            return Lowering::Processor(routing::RAIN);
        }
        if self.passes_of_steps(padded) > MAX_PASSES {
            return Lowering::Processor("so many passes are submitted no faster than the processor computes");
        }
        let factors = ["erodibility_factor", "uplift_factor"].map(|name| given(name).is_some());
        // The courses of rivers in the first steps depend on the last digits of nearly level ground.
        Lowering::Shader(self.passes(padded, planes, factors, world_params).chaotic())
    }

    fn cost(&self) -> f64 {
        let cost = if self.strata.is_empty() { 45.0 } else { COST_WITH_STRATA };
        let sediment = if self.deposition > 0.0 { COST_OF_SEDIMENT } else { 0.0 };
        (cost + sediment) * f64::from(self.steps)
    }
}

/// Approximate time for a cell and step with strata, in nanoseconds.
const COST_WITH_STRATA: f64 = 100.0;

/// Approximate additional time for a cell and step with deposition, in nanoseconds.
const COST_OF_SEDIMENT: f64 = 80.0;

/// The layer with the thickness of the sediment.
const SEDIMENT: usize = 3;

const CODE: &str =
    concat!(include_str!("routing.wgsl"), include_str!("../lower/power.wgsl"), include_str!("stream_power.wgsl"));

/// The planes of the source and of the heights.
const SOURCE: u32 = 0;
const HEIGHTS: [u32; 3] = [5, 18, 19];

/// Number of planes of the shaders in addition to inputs, layers, the routing, counters and the rain.
const SCRATCH: usize = 7;

/// Number of times that the pieces of the law are chosen in a step: without an initial guess, and with the pieces of
/// the previous step as the guess. Passes after the last change end at once.
const ITERATIONS: [u32; 2] = [12, 8];

/// Additional iterations in a step whose law is not affine in the heights.
const MORE_ITERATIONS: u32 = 4;

/// Maximum number of passes of all steps, whose submission takes about a second.
const MAX_PASSES: f64 = 5e5;

/// Approximate number of passes of a step without creep.
const PASSES_OF_STEP: f64 = 100.0;

impl StreamPower {
    /// Approximate number of passes of all steps.
    fn passes_of_steps(&self, padded: &Window) -> f64 {
        let steps = f64::from(self.steps.max(1));
        let creep = creep_strides(padded, self.years / steps * self.creep);
        steps * (PASSES_OF_STEP + creep.map_or(0.0, |[strides, stages, _]| strides * stages))
    }

    /// The parameters of the erosion.
    fn erosion(&self, world_params: &WorldParams) -> Erosion {
        let law = Law::default()
            .with_erodibility(self.erodibility)
            .with_area_exponent(self.area_exponent)
            .with_slope_exponent(self.slope_exponent)
            .with_uplift(self.uplift / 1000.0)
            .with_max_slope(libm::tan(self.talus_angle.to_radians()))
            .with_min_slope(Law::default().min_slope);
        Erosion::new(law, self.years, self.steps)
            .with_creep(self.creep)
            .with_jitter(self.jitter)
            .with_deposition(self.deposition)
            .with_scattered(self.random_receivers.then_some(world_params.seed_of(self.seed) as u32))
    }

    /// The passes of a run; `given` are the factors of the erodibility and the uplift.
    fn passes(&self, padded: &Window, planes: Planes, given: [bool; 2], world_params: &WorldParams) -> Passes {
        let erosion = self.erosion(world_params);
        let (law, cell) = (erosion.law, padded.cell);
        let years = erosion.years / f64::from(erosion.steps.max(1));
        let salt = erosion.scattered.unwrap_or_default();
        let is_between_points = erosion.jitter > 0.0;
        let descent = match (is_between_points, erosion.scattered) {
            (true, _) => Descent::Points(salt, Points::reach(erosion.jitter)),
            (false, Some(salt)) => Descent::Scattered(salt),
            (false, None) => Descent::Steepest,
        };
        let creep = creep_strides(padded, years * erosion.creep);
        // Slopes above the limit have already slid between the points.
        let last_max_slope = if is_between_points { f64::INFINITY } else { law.max_slope };
        let numbers = [
            ("cut_of_cell", years * law.erodibility * libm::pow(cell, 2.0 * law.area_exponent - law.slope_exponent)),
            ("area_exponent", law.area_exponent),
            ("min_drop", law.min_slope * cell),
            ("max_drop", law.max_slope * cell),
            ("last_max_drop", last_max_slope * cell),
            ("raised", years * law.uplift),
            ("creep_share", creep.map_or(0.0, |[_, _, share]| share / 6.0)),
            ("cell_area", cell * cell),
            ("slope_exponent", law.slope_exponent),
        ];
        let sea_level = sea_level_of(self.sea, world_params);
        let mut passes = routing::passes(CODE, padded, sea_level, descent, planes)
            .with_constants([("SOURCE", SOURCE), ("HEIGHT", HEIGHTS[0]), ("SPARE", HEIGHTS[1])])
            // WGSL has no infinities.
            .with_numbers(numbers.map(|(name, number)| (name, number.min(1e30) as f32)))
            .with_named_words(["has_erodibility", "has_uplift"].into_iter().zip(given.map(u32::from)));
        let step = |from, to, number| routing::step(from, to, number);
        passes = then(passes, "outlets", step(SOURCE, 0, 0));
        if is_between_points {
            passes = then(passes, "draw_points", 0);
        }
        // The current plane of heights; each step continues with the next of the three.
        let mut turn = HEIGHTS.into_iter().cycle();
        let mut here = SOURCE;
        let mut next = || turn.next().unwrap_or_default();
        let all = routing::all_rounds(padded);
        let more = if law.slope_exponent == 1.0 { 0 } else { MORE_ITERATIONS };
        for done in 0..erosion.steps {
            let (rounds, flats) =
                if done == 0 { (all, Flats::Graded) } else { (all.min(routing::FEW_ROUNDS), Flats::Basins) };
            passes = routing::route(passes, padded, rounds, flats, step(here, 0, done));
            passes = routing::gather(passes, padded);
            let to = next();
            passes = solved(passes, padded, [here, to], u32::from(done > 0), more);
            here = to;
            let [strides, stages, _] = creep.unwrap_or_default();
            for stage in (0..strides as u32).flat_map(|_| 1..=stages as u32) {
                let to = next();
                passes = then(passes, "creep", step(here, to, stage));
                here = to;
            }
        }
        if is_between_points {
            let to = next();
            passes = then(passes, "onto_lattice", step(here, to, 0));
            here = to;
        }
        let to = next();
        passes = routing::route(passes, padded, all, Flats::Basins, step(here, 0, 0) | LAST);
        passes = solved(passes, padded, [here, to], LAST, 0);
        // Rounding of gentle slopes may have made pits, so the flow is routed through depressions again.
        passes = routing::route(passes, padded, all, Flats::Basins, step(to, 0, 0) | LAST);
        then(routing::gather(passes, padded), "finish", step(to, 0, 0))
    }
}

/// Appends the passes that solve the law for the heights of one plane and write them to another. `kind` is [`LAST`], or
/// 1 if there was an earlier time step, otherwise 0.
fn solved(mut passes: Passes, padded: &Window, [from, to]: [u32; 2], kind: u32, more: u32) -> Passes {
    let (last, known) = (kind & LAST, kind & 1);
    // An odd number of passes leaves the result in the second of two planes.
    let compositions = routing::following(padded) as u32 | 1;
    if known == 0 {
        passes = then(passes, "begin_raise", routing::step(from, 0, 0) | last);
        for k in 0..compositions {
            passes = then(passes, "compose_raise", routing::step(from, k % 2, 0) | last);
        }
        passes = then(passes, "end_raise", routing::step(from, 0, 0) | last);
    }
    for iteration in 0..ITERATIONS[known as usize] + more {
        passes = then(passes, "choose_piece", routing::step(from, known, iteration) | last);
        for k in 0..compositions {
            passes = then(passes, "compose_pieces", routing::step(from, k % 2, iteration) | last);
        }
    }
    then(passes, "set_heights", routing::step(from, to, 0) | last)
}

/// The layers of the solution; `source` are the initial heights.
fn solution(
    sources: &dyn Sources,
    run: &ErosionRun,
    heights: Grid,
    drained: &Accumulation,
    source: Grid,
) -> Result<Solution> {
    let mut change = source;
    for (change, height) in change.data_mut().iter_mut().zip(heights.data()) {
        *change = height - *change;
    }
    let none = || Grid::filled(*heights.window(), 0.0);
    let sediment = run.deposits().map_or_else(none, |deposits| deposits.thickness.clone());
    let layers = [heights, drained.areas(), change, sediment];
    let layers = layers.into_iter().map(|layer| sources.keep(layer)).collect::<Result<Vec<_>>>()?;
    Ok(Solution { layers, scalars: Vec::new() })
}
