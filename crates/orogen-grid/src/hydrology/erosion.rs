//! Landscape evolution: uplift and stream-power erosion in time steps.

use super::accumulation::{Accumulation, accumulate_rain_with};
use super::creep::{creep_again, creep_stages};
use super::deposition::Deposits;
use super::drainage;
use super::outlets::Outlets;
use super::points::Points;
use super::steepest::Descent;
use super::stream_power::{StreamPower, Substrate};
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;
use crate::strata::Bedding;

/// Parameters of an erosion run with the stream power law.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Erosion {
    /// The erosion law.
    pub law: StreamPower,
    /// Soil creep: the diffusivity, in m^2 per year.
    pub creep: f64,
    /// Duration, in years.
    pub years: f64,
    /// Number of steps. Each step routes the water anew.
    pub steps: u32,
    /// Salt of the random receivers in each step; `None` for steepest descent.
    pub scattered: Option<u32>,
    /// Jitter: displacement of the points from the lattice, as a share of half a cell, 0 to 1. Receivers are never
    /// random between jittered points.
    pub jitter: f64,
    /// G: deposition coefficient of the sediment that rivers carry; 0 for rivers that only erode.
    pub deposition: f64,
}

impl Erosion {
    /// A run with this law, duration and number of steps, without creep, with steepest descent on the lattice.
    #[must_use]
    pub const fn new(law: StreamPower, years: f64, steps: u32) -> Erosion {
        Erosion { law, creep: 0.0, years, steps, scattered: None, jitter: 0.0, deposition: 0.0 }
    }
}

orogen_noise::builder!(
    Erosion:
    with_law(law: StreamPower),
    with_creep(creep: f64),
    with_years(years: f64),
    with_steps(steps: u32),
    with_scattered(scattered: Option<u32>),
    with_jitter(jitter: f64),
    with_deposition(deposition: f64)
);

impl Erosion {
    /// Erodes `heights`. The border and, if there is a sea level, the sea keep their heights.
    ///
    /// In the result every cell is higher than its receiver, so there are no depressions and no flats; only with
    /// deposition, depressions that are deeper than [`ErosionRun::KEPT_DEPTH`] are left where sediment has not filled
    /// them. Returns the flow accumulation of the result by steepest descent. Costs O(cells) per step.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn run(
        &self,
        heights: &mut Grid,
        ground: &Substrate,
        sea_level: Option<f32>,
        progress: &Progress,
    ) -> Result<Accumulation> {
        let mut run = ErosionRun::new(*self, heights, ground, sea_level);
        progress.expect(self.work());
        for _ in 0..self.steps {
            let step = progress.part(1.0);
            run.step(heights, &step)?;
            step.finish();
        }
        run.finish(heights, &progress.part(ErosionRun::FINISHING))
    }

    /// The work of a whole run; a step counts as 1.
    #[must_use]
    pub fn work(&self) -> f64 {
        f64::from(self.steps) + ErosionRun::FINISHING
    }
}

/// The state of a run between two steps.
pub struct ErosionRun<'a> {
    erosion: Erosion,
    ground: &'a Substrate<'a>,
    outlets: Outlets,
    /// The irregular points of the heights during the run; `None` for the lattice.
    points: Option<Points>,
    buffers: Vec<Grid>,
    /// The sediment; `None` for rivers that only erode.
    deposits: Option<Deposits>,
    /// Number of completed steps.
    done: u32,
}

/// The slope of level floors after the last step of a run with deposition.
const LEVEL_SLOPE: f64 = 1e-6;

impl<'a> ErosionRun<'a> {
    /// The work after the last step; a step counts as 1.
    pub const FINISHING: f64 = 2.0;

    /// Depressions deeper than this, in metres, are left by a run with deposition.
    pub const KEPT_DEPTH: f32 = 1.0;

    /// The state before the first step.
    #[must_use]
    pub fn new(erosion: Erosion, heights: &Grid, ground: &'a Substrate<'a>, sea_level: Option<f32>) -> ErosionRun<'a> {
        let salt = erosion.scattered.unwrap_or_default();
        let points = (erosion.jitter > 0.0).then(|| Points::new(*heights.window(), erosion.jitter, salt));
        let outlets = Outlets::new(heights, sea_level);
        let deposits = (erosion.deposition > 0.0).then(|| Deposits::new(&outlets, erosion.deposition));
        ErosionRun { erosion, ground, outlets, points, buffers: Vec::new(), deposits, done: 0 }
    }

    /// Computes the next step. Between steps the heights are those at the run's points.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn step(&mut self, heights: &mut Grid, progress: &Progress) -> Result<()> {
        let Erosion { years, steps, creep, scattered, .. } = self.erosion;
        let years = years / f64::from(steps.max(1));
        // Random receivers differ in each step, so that on average water spreads over a slope as it does in nature.
        let descent = match (&self.points, scattered) {
            (Some(points), _) => Descent::Interpolation(points),
            (None, Some(seed)) => Descent::Scattered(seed.wrapping_add(self.done)),
            (None, None) => Descent::Steepest,
        };
        let bedding = self.bedding(self.done + 1);
        let between = Substrate { points: self.points.as_ref(), bedding, ..*self.ground };
        let amount = years * creep;
        let stages = creep_stages(heights.window(), amount);
        let [cutting, creeping] = progress.parts([45.0, 2.0 * stages]);
        let [routing, solving] = cutting.parts([3.0, 2.0]);
        let drainage = drainage::route_carving_with(heights, &self.outlets, descent, &routing)?;
        routing.finish();
        let [counting, solving] = solving.parts([1.0, 1.0]);
        let drained = accumulate_rain_with(&drainage.receivers, between.rain, &counting)?;
        counting.finish();
        progress.check()?;
        let law = self.erosion.law;
        match &mut self.deposits {
            None => law.step_with(heights, &drainage.receivers, &drained, &between, years, &solving)?,
            Some(deposits) => {
                let check = || progress.check();
                deposits.step(&law, heights, &self.outlets, &drainage, &drained, &between, years, &check)?;
            }
        }
        progress.check()?;
        cutting.finish();
        creep_again(heights, &self.outlets, amount, &mut self.buffers, &creeping)?;
        self.done += 1;
        Ok(())
    }

    /// Computes the final heights of a run that ends after this step: on the lattice and drained.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn settle(&self, heights: &mut Grid, progress: &Progress) -> Result<()> {
        progress.check()?;
        let mut law = self.erosion.law;
        if let Some(points) = &self.points {
            points.onto_lattice(heights, &self.outlets, self.ground.bedding.is_some());
            // The limit on slopes was already applied between the points; applying it on the lattice would create
            // facets.
            law.max_slope = f64::INFINITY;
        }
        let ground = Substrate { bedding: self.bedding(self.done), ..*self.ground };
        let [routing, counting, solving] = progress.parts([3.0, 1.0, 1.0]);
        let receivers = match self.deposits {
            None => drainage::route_carving_with(heights, &self.outlets, Descent::Steepest, &routing)?.receivers,
            Some(_) => {
                // On level floors a slope along receivers would make steps between neighboring rivers.
                law.min_slope = law.min_slope.min(LEVEL_SLOPE);
                // What slides here would be no sediment.
                law.max_slope = f64::INFINITY;
                drainage::route_shallow_with(heights, &self.outlets, ErosionRun::KEPT_DEPTH, &routing)?
            }
        };
        routing.finish();
        let drained = accumulate_rain_with(&receivers, ground.rain, &counting)?;
        counting.finish();
        progress.check()?;
        law.step_with(heights, &receivers, &drained, &ground, 0.0, &solving)?;
        progress.check()
    }

    /// The sediment so far; `None` if rivers only erode.
    #[must_use]
    pub fn deposits(&self) -> Option<&Deposits> {
        self.deposits.as_ref()
    }

    /// The strata after a number of steps.
    fn bedding(&self, done: u32) -> Option<Bedding<'a>> {
        let Erosion { law, years, steps, .. } = self.erosion;
        let left = f64::from(steps.saturating_sub(done)) / f64::from(steps.max(1));
        self.ground.bedding.map(|bedding| bedding.before(left * years * law.uplift))
    }

    /// Like [`ErosionRun::settle`]; also returns the flow accumulation of the final heights.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn finish(&self, heights: &mut Grid, progress: &Progress) -> Result<Accumulation> {
        let [settling, routing, counting] = progress.parts([1.0, 0.7, 0.3]);
        self.settle(heights, &settling)?;
        settling.finish();
        let receivers = drainage::over_surface_with(heights, &self.outlets, Descent::Steepest, &routing)?;
        routing.finish();
        progress.check()?;
        let drained = accumulate_rain_with(&receivers, self.ground.rain, &counting)?;
        counting.finish();
        Ok(drained)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::samples;
    use crate::strata::{Strata, Stratum};

    fn erosion() -> Erosion {
        Erosion { creep: 1e-6, scattered: Some(1), ..Erosion::new(StreamPower::default(), 1e5, 4) }
    }

    fn eroded(heights: &Grid, erosion: &Erosion, sea: Option<f32>) -> Grid {
        let mut out = heights.clone();
        erosion.run(&mut out, &Substrate::default(), sea, &Progress::none()).unwrap();
        out
    }

    #[test]
    fn every_cell_drains_downhill_and_the_sea_stays() {
        for heights in samples::grids() {
            for (sea, jitter) in [(None, 0.0), (Some(250.0), 0.0), (None, 1.0), (Some(250.0), 0.6)] {
                let outlets = Outlets::new(&heights, sea);
                let out = eroded(&heights, &Erosion { jitter, ..erosion() }, sea);
                let receivers = super::super::steepest::receivers(&out, &outlets, Descent::Steepest);
                for c in 0..out.data().len() {
                    match outlets.at(c) {
                        true => assert_eq!(out.data()[c].to_bits(), heights.data()[c].to_bits()),
                        false => assert!(receivers.of(c) != c && out.data()[c] > out.data()[receivers.of(c)]),
                    }
                }
            }
        }
    }

    #[test]
    fn any_number_of_threads_makes_the_same() {
        let heights = samples::hills(150, 130, 3);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| [0.0, 1.0].map(|jitter| eroded(&heights, &Erosion { jitter, ..erosion() }, Some(100.0))))
        };
        let one = run(1);
        assert!(one[0] != heights && one[0] != one[1] && [2, 3, 8].map(run).iter().all(|other| *other == one));
    }

    #[test]
    fn rain_weights_areas_and_even_rain_changes_nothing() {
        let heights = samples::hills(150, 130, 3);
        let run = |rain: Option<&Grid>, erodibility: f64, threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut out = heights.clone();
            let law = StreamPower { area_exponent: 0.5, erodibility, ..StreamPower::default() };
            let erosion = Erosion { law, jitter: 1.0, ..erosion() };
            let substrate = Substrate::default().with_rain(rain);
            let drained = pool.install(|| erosion.run(&mut out, &substrate, Some(100.0), &Progress::none())).unwrap();
            (out, drained.area, drained.discharge)
        };
        let filled = |factor: f32| Grid::filled(*heights.window(), factor);
        let (dry, area, none) = run(None, 2e-5, 1);
        let (even, _, discharge) = run(Some(&filled(1.0)), 2e-5, 3);
        assert!(dry == even && none.is_none());
        let unit = u64::from(super::super::accumulation::UNIT_WEIGHT);
        let discharge = discharge.unwrap();
        assert!(discharge.data().iter().zip(area.data()).all(|(sum, cells)| *sum == u64::from(*cells) * unit));
        // Four times the discharge to the power of a half is twice the erodibility.
        assert_eq!(run(Some(&filled(4.0)), 2e-5, 1).0, run(None, 4e-5, 1).0);
        let mut uneven = filled(1.0);
        uneven.data_mut().iter_mut().step_by(3).for_each(|factor| *factor = 0.2);
        let one = run(Some(&uneven), 2e-5, 1);
        assert!(
            one.0 != dry
                && [2, 3, 8].map(|threads| run(Some(&uneven), 2e-5, threads)).iter().all(|other| *other == one)
        );
    }

    #[test]
    fn slopes_between_irregular_points_do_not_face_the_grids_directions() {
        // Uplift until all ground has the maximum slope.
        let heights = samples::hills(160, 160, 3);
        let aligned = |jitter: f64| {
            let law = StreamPower { uplift: 1.0, erodibility: 1e-6, max_slope: 0.8, ..StreamPower::default() };
            let run = Erosion { jitter, creep: 1e-6, scattered: Some(1), ..Erosion::new(law, 1e6, 60) };
            let out = eroded(&heights, &run, None);
            let mut bins = [0u32; 9];
            for j in 10..150 {
                for i in 10..150 {
                    let east = out[(i + 1, j)] - out[(i - 1, j)];
                    let south = out[(i, j + 1)] - out[(i, j - 1)];
                    let off = libm::atan2(f64::from(south), f64::from(east)).to_degrees().rem_euclid(45.0);
                    bins[((off / 5.0) as usize).min(8)] += 1;
                }
            }
            f64::from(bins[4]) / f64::from(bins.iter().sum::<u32>())
        };
        // On the regular grid nearly all slopes are between two of its directions. On irregular points each ninth of
        // the directions has a ninth of the slopes.
        let (regular, jitter) = (aligned(0.0), aligned(1.0));
        assert!(regular > 0.9 && (0.08..0.14).contains(&jitter), "{regular} {jitter}");
    }

    /// A tableland of cells of 20 m, with two metres of roughness, above a border at 0, eroded without uplift. The top
    /// of the strata rises by `dip` to the east from 190 m in the middle.
    fn tableland(strata: &[Stratum], dip: f64) -> (Grid, Grid) {
        let window = Window::new(90, 60, 20.0);
        let rough = samples::hills(90, 60, 5);
        let highest = rough.data().iter().copied().fold(f32::MIN, f32::max);
        let (mut heights, mut top) = (Grid::filled(window, 0.0), Grid::filled(window, 0.0));
        for j in 0..60 {
            for i in 0..90 {
                top.row_mut(j)[i] = (190.0 + dip * (i as f64 - 45.0) * 20.0) as f32;
                if (1..89).contains(&i) && (1..59).contains(&j) {
                    heights.row_mut(j)[i] = 200.0 + 2.0 * rough[(i, j)] / highest;
                }
            }
        }
        let strata = Strata::new(strata, false, libm::tan(35f64.to_radians())).unwrap();
        let law = StreamPower { uplift: 0.0, max_slope: libm::tan(35f64.to_radians()), ..StreamPower::default() };
        let run = Erosion { scattered: Some(1), jitter: 1.0, ..Erosion::new(law, 2e5, 40) };
        let substrate = Substrate::default().with_bedding(Some(Bedding::new(&strata, Some(&top))));
        run.run(&mut heights, &substrate, None, &Progress::none()).unwrap();
        (heights, top)
    }

    const SOFT: Stratum = Stratum { thickness: 60.0, erodibility_factor: 3.0, talus_angle: 30.0 };
    const FIRM: Stratum = Stratum { thickness: 500.0, erodibility_factor: 0.5, talus_angle: 30.0 };

    #[test]
    fn a_hard_stratum_makes_benches_above_cliffs_as_high_as_it_is_thick() {
        for thickness in [20.0f32, 40.0] {
            let hard = Stratum { thickness: f64::from(thickness), erodibility_factor: 0.005, talus_angle: 85.0 };
            let (heights, _) = tableland(&[SOFT, hard, FIRM], 0.0);
            let (bench, foot) = (130.0, 130.0 - thickness);
            let inner = || (2..58).flat_map(|j| (2..88).map(move |i| (i, j)));
            let share = |low: f32, high: f32| {
                inner().filter(|at| (low..high).contains(&heights[*at])).count() as f32 / (56.0 * 86.0)
            };
            // Soft rock is gone from the bench, and the cliff takes hardly any ground.
            assert!(share(bench - 2.0, bench + 3.0) > 0.12, "{}", share(bench - 2.0, bench + 3.0));
            assert!(share(foot + 2.0, bench - 4.0) < 0.08, "{}", share(foot + 2.0, bench - 4.0));
            // The drop from the bench to the cells below its edge.
            let mut drops: Vec<f32> = inner()
                .filter_map(|(i, j)| {
                    let around = [(i - 1, j), (i + 1, j), (i, j - 1), (i, j + 1)].map(|at| heights[at]);
                    let lowest = around.into_iter().fold(f32::MAX, f32::min);
                    let is_edge = (bench - 4.0..bench + 4.0).contains(&heights[(i, j)]) && lowest < foot + 2.0;
                    is_edge.then_some(heights[(i, j)] - lowest)
                })
                .collect();
            drops.sort_by(f32::total_cmp);
            // The relief of a cell of the soft slope below.
            let relief = 20.0 * libm::tanf(30f32.to_radians());
            let median = drops[drops.len() / 2];
            assert!(
                drops.len() > 40 && (median - thickness).abs() < relief,
                "{thickness}: {median} of {}",
                drops.len()
            );
        }
    }

    #[test]
    fn the_slope_of_bare_hard_rock_is_its_dip() {
        for dip in [0.05, 0.1] {
            let hard = Stratum { thickness: 30.0, erodibility_factor: 0.005, talus_angle: 80.0 };
            let (heights, top) = tableland(&[SOFT, hard, FIRM], dip);
            // Ground on the upper side of the hard stratum.
            let is_on = |i: usize, j: usize| (heights[(i, j)] - (top[(i, j)] - 60.0)).abs() < 6.0;
            let mut slopes = Vec::new();
            for j in 3..57 {
                for i in 3..87 {
                    if (i - 1..=i + 1).all(|i| (j - 1..=j + 1).all(|j| is_on(i, j))) {
                        let east = f64::from(heights[(i + 1, j)] - heights[(i - 1, j)]) / 40.0;
                        let south = f64::from(heights[(i, j + 1)] - heights[(i, j - 1)]) / 40.0;
                        slopes.push([east, south]);
                    }
                }
            }
            let mean = |k: usize| slopes.iter().map(|slope| slope[k]).sum::<f64>() / slopes.len() as f64;
            let degrees = |slope: f64| libm::atan(slope).to_degrees();
            assert!(slopes.len() > 100, "{}", slopes.len());
            let (east, south) = (degrees(mean(0)), degrees(mean(1)));
            assert!((east - degrees(dip)).abs() < 2.0 && south.abs() < 2.0, "{east} {south}, not {}", degrees(dip));
        }
    }

    #[test]
    fn strata_of_one_factor_are_the_factor() {
        let heights = samples::hills(60, 50, 3);
        let run = |bedding: Option<Bedding>, erodibility: f64| {
            let mut out = heights.clone();
            let law = StreamPower { erodibility, max_slope: 0.8, ..StreamPower::default() };
            let erosion = Erosion { law, creep: 0.0, ..erosion() };
            let substrate = Substrate::default().with_bedding(bedding);
            erosion.run(&mut out, &substrate, None, &Progress::none()).unwrap();
            out
        };
        let stratum = |thickness: f64| Stratum { thickness, erodibility_factor: 0.5, talus_angle: 0.0 };
        let strata = Strata::new(&[stratum(11.0), stratum(3.0)], true, 0.8).unwrap();
        let (layered, plain) = (run(Some(Bedding::new(&strata, None)), 2e-5), run(None, 1e-5));
        let furthest = layered.data().iter().zip(plain.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(furthest < 0.01, "{furthest}");
        // A datum without values is no stratum.
        let nowhere = Grid::filled(*heights.window(), f32::NAN);
        assert_eq!(run(Some(Bedding::new(&strata, Some(&nowhere))), 2e-5), run(None, 2e-5));
    }

    #[test]
    fn rock_rises_with_the_ground() {
        // The same rock is reached whether it rises during the run or has risen before.
        let heights = samples::hills(60, 50, 3);
        let strata = [SOFT, Stratum { thickness: 30.0, erodibility_factor: 0.01, talus_angle: 80.0 }, SOFT];
        let strata = Strata::new(&strata, true, 1.0).unwrap();
        let law = StreamPower { uplift: 1e-3, erodibility: 0.0, max_slope: f64::INFINITY, ..StreamPower::default() };
        let erosion = Erosion { law, creep: 0.0, years: 1e5, steps: 4, ..erosion() };
        let substrate = Substrate::default().with_bedding(Some(Bedding::new(&strata, None)));
        let run = ErosionRun::new(erosion, &heights, &substrate, None);
        let risen = [0, 1, 4].map(|done| run.bedding(done).and_then(|bedding| bedding.bottom(0, 2.0)));
        let below = -strata.thickness();
        assert_eq!(risen, [Some(below - 200.0), Some(below - 150.0), Some(below)]);
    }

    #[test]
    fn it_stops_when_asked() {
        let mut heights = samples::hills(20, 20, 3);
        let progress = Progress::none();
        progress.cancel();
        assert!(erosion().run(&mut heights, &Substrate::default(), None, &progress).is_err());
    }
}
