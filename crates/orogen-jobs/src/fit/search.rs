//! Search for the parameters of the template whose terrain is closest to a place.

use super::features::{FeatureVector, of_windows};
use super::template::{FittedWorld, MARGIN, PARAMS, ParamValues, Stretch, recipe, trial};
use orogen_engine::recipe::document::Recipe;
use orogen_engine::session::Options;
use orogen_engine::world::World;
use orogen_grid::analysis::slope::steepness;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::random::Random;
use orogen_output::survey::measures::Measures;
use orogen_output::survey::stretch::{integral, mean_slope, quantile};

/// Side of the compared windows in samples, if the place is large enough.
pub const SIDE: usize = 256;

/// Maximum number of windows of a place.
pub const MAX_WINDOWS: usize = 12;

/// The statistics of the place to approximate.
#[derive(Debug, Clone)]
pub struct FitTarget {
    /// Distance between samples, in metres.
    pub cell: f64,
    /// Side of the compared windows.
    pub side: usize,
    /// Columns and rows of the place.
    pub size: [usize; 2],
    /// The median of its windows.
    pub middle: FeatureVector,
    /// Number of windows.
    pub windows: usize,
    /// Distances of its own windows from that median.
    pub own: Vec<f64>,
    lowest: f64,
    slope: f64,
    integral: f64,
}

impl FitTarget {
    /// Measures a place.
    ///
    /// # Errors
    /// If it has no window of 64 x 64 samples with relief.
    pub fn of(place: &Grid) -> Result<FitTarget> {
        let window = place.window();
        let side = window.width.min(window.height).min(SIDE);
        let features = of_windows(place, side.max(1), MAX_WINDOWS);
        let measures: Vec<Measures> = super::features::windows(window, side.max(1), MAX_WINDOWS)
            .into_iter()
            .filter_map(|window| Measures::of(&place.crop(&window)?, None))
            .collect();
        if measures.is_empty() {
            let message =
                "the place is too small or too flat for a fit; at least 64 x 64 samples and some relief are needed";
            return Err(Error::new(ErrorKind::Request, message));
        }
        let middle = FeatureVector::middle(&features);
        let median = |of: fn(&Measures) -> f64| {
            let mut values: Vec<f64> = measures.iter().map(of).collect();
            values.sort_unstable_by(f64::total_cmp);
            values[values.len() / 2]
        };
        Ok(FitTarget {
            cell: window.cell,
            side,
            size: [window.width, window.height],
            own: features.iter().map(|one| one.distance(&middle)).collect(),
            windows: features.len(),
            middle,
            lowest: median(|m| m.base),
            slope: median(|m| m.slope_mean),
            integral: median(|m| m.hypsometric_integral),
        })
    }

    /// Windows along a side of the final worlds.
    fn across(&self) -> usize {
        (self.size[0].min(self.size[1]) / self.side).clamp(1, WIDEST)
    }
}

/// The effort of a search, and its seed.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Effort {
    /// Number of random candidates before the best are improved.
    pub random: usize,
    /// Number of candidates during improvement.
    pub improving: usize,
    /// Seed of the random candidates, and of the worlds.
    pub seed: u64,
}

/// The result of a search.
#[derive(Debug, Clone)]
pub struct Found {
    /// The parameters.
    pub values: ParamValues,
    /// The stretching of its terrain.
    pub stretch: Stretch,
    /// The mean distance of the worlds by which it was chosen.
    pub distance: f64,
    /// Number of candidates.
    pub tried: usize,
}

impl Found {
    /// The recipe, for a world of the size of the place.
    #[must_use]
    pub fn recipe(&self, target: &FitTarget, seed: u64, about: &str) -> Recipe {
        let ground = FittedWorld { size: target.size, cell: target.cell, seed };
        let mut recipe = recipe(&self.values, &self.stretch, &ground);
        recipe.about = about.to_string();
        recipe
    }
}

/// Number of final candidates, and of worlds with other seeds for each.
const FINALISTS: usize = 6;
const OTHER_WORLDS: u64 = 2;

/// Windows along a side of these worlds, if the place has as many.
const WIDEST: usize = 2;

/// The distance of a candidate without terrain.
const FARTHEST: f64 = 100.0;

/// Searches: random candidates, the best ones improved by the simplex method of Nelder and Mead (1965); then the
/// closest candidates are tested in worlds with other seeds, because one world may be close by chance. The same effort
/// gives the same result.
///
/// # Errors
/// If the work is cancelled, or memory does not suffice.
pub fn search(target: &FitTarget, effort: &Effort, options: &Options, progress: &Progress) -> Result<Found> {
    progress.expect(effort.windows(target));
    let mut trial = Trial { target, effort, options, progress, tried: 0, nearest: Vec::new() };
    let mut chance = Random::of_state(effort.seed);
    let mut tried: Vec<(f64, ParamValues)> = Vec::new();
    for k in 0..effort.random.max(1) {
        // The first is the center of all ranges.
        let values = std::array::from_fn(|_| if k == 0 { 0.5 } else { chance.share() });
        tried.push((trial.distance(&values)?, values));
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let corners = (PARAMS.len() + 1).min(tried.len());
    let mut simplex: Vec<(f64, ParamValues)> = tried[..corners].to_vec();
    // Around the best: the other points of the first simplex are moved towards it.
    let best = simplex[0].1;
    for (distance, corner) in simplex.iter_mut().skip(1) {
        *corner = along(&best, corner, 0.5);
        *distance = trial.distance(corner)?;
    }
    let end = trial.tried + effort.improving;
    while trial.tried < end && simplex.len() > 2 {
        simplex.sort_by(|a, b| a.0.total_cmp(&b.0));
        let last = simplex.len() - 1;
        let middle: ParamValues =
            std::array::from_fn(|k| simplex[..last].iter().map(|(_, s)| s[k]).sum::<f64>() / last as f64);
        let worst = simplex[last];
        let mut attempt = |share: f64| -> Result<(f64, ParamValues)> {
            let values = along(&middle, &worst.1, share);
            Ok((trial.distance(&values)?, values))
        };
        let reflected = attempt(-1.0)?;
        let better = if reflected.0 < simplex[0].0 {
            let further = attempt(-2.0)?;
            Some(if further.0 < reflected.0 { further } else { reflected })
        } else if reflected.0 < simplex[last - 1].0 {
            Some(reflected)
        } else {
            let nearer = attempt(if reflected.0 < worst.0 { -0.5 } else { 0.5 })?;
            (nearer.0 < worst.0.min(reflected.0)).then_some(nearer)
        };
        match better {
            Some(better) => simplex[last] = better,
            None => {
                let best = simplex[0].1;
                for (distance, corner) in simplex.iter_mut().skip(1) {
                    *corner = along(&best, corner, 0.5);
                    *distance = trial.distance(corner)?;
                }
            }
        }
    }
    trial.choose()
}

/// Moves values towards others, within their ranges.
fn along(from: &ParamValues, to: &ParamValues, share: f64) -> ParamValues {
    std::array::from_fn(|k| (from[k] + share * (to[k] - from[k])).clamp(0.0, 1.0))
}

struct Trial<'a> {
    target: &'a FitTarget,
    effort: &'a Effort,
    options: &'a Options,
    progress: &'a Progress,
    tried: usize,
    /// The [`FINALISTS`] closest candidates so far, the closest first.
    nearest: Vec<(f64, ParamValues)>,
}

impl Trial<'_> {
    /// The distance of the terrain of these values from the target.
    fn distance(&mut self, values: &ParamValues) -> Result<f64> {
        self.tried += 1;
        let (_, distance) = self.look(values, self.effort.seed, 1)?;
        let at = self.nearest.partition_point(|(nearer, _)| *nearer <= distance);
        self.nearest.insert(at, (distance, *values));
        self.nearest.truncate(FINALISTS);
        Ok(distance)
    }

    /// The stretching of the terrain of one world, `across` windows wide, and the mean distance of its windows; the
    /// largest distance if there is no terrain.
    fn look(&self, values: &ParamValues, seed: u64, across: usize) -> Result<(Stretch, f64)> {
        let part = self.progress.part((across * across) as f64);
        let (stretch, windows) = self.make(values, seed, across, &part)?;
        self.progress.check()?;
        let far = |land: &Grid| {
            Measures::of(land, None).map_or(FARTHEST, |made| FeatureVector::of(&made).distance(&self.target.middle))
        };
        if windows.is_empty() {
            return Ok((stretch, FARTHEST));
        }
        Ok((stretch, windows.iter().map(far).sum::<f64>() / windows.len() as f64))
    }

    /// The final candidate with the smallest mean distance over its worlds, with the mean stretching.
    fn choose(mut self) -> Result<Found> {
        // Terrain differs in a larger world: more of it is far from river mouths.
        let across = self.target.across();
        let mut best: Option<Found> = None;
        for (_, values) in std::mem::take(&mut self.nearest) {
            let seeds = self.effort.seed..=self.effort.seed.saturating_add(OTHER_WORLDS);
            let worlds: Result<Vec<(Stretch, f64)>> = seeds.map(|seed| self.look(&values, seed, across)).collect();
            let worlds = worlds?;
            self.tried += worlds.len() - 1;
            let mean = |of: fn(&(Stretch, f64)) -> f64| worlds.iter().map(of).sum::<f64>() / worlds.len() as f64;
            let stretch = Stretch {
                from: [mean(|world| world.0.from[0]), mean(|world| world.0.from[1])],
                to: [mean(|world| world.0.to[0]), mean(|world| world.0.to[1])],
                bend: mean(|world| world.0.bend),
            };
            let distance = mean(|world| world.1);
            if best.as_ref().is_none_or(|best| distance < best.distance) {
                best = Some(Found { values, stretch, distance, tried: 0 });
            }
        }
        let best = best.ok_or_else(|| Error::new(ErrorKind::Request, "no parameter set was tried"))?;
        Ok(Found { tried: self.tried, ..best })
    }

    /// The windows of a world of these values, stretched so that the medians of their hypsometric integrals and mean
    /// slopes equal the target's.
    fn make(
        &self,
        values: &ParamValues,
        seed: u64,
        across: usize,
        progress: &Progress,
    ) -> Result<(Stretch, Vec<Grid>)> {
        let FitTarget { side, lowest, .. } = *self.target;
        let plain = Stretch { from: [0.0, 1.0], to: [0.0, 1.0], bend: 0.0 };
        let (world, inside) = trial_world(self.target, values, seed, across, self.options)?;
        let mut grids = world.grids(&["soft"], &inside, progress)?;
        let soft =
            grids.pop().ok_or_else(|| Error::new(ErrorKind::Request, "no window of the world could be measured"))?;
        // Extreme parameters may lead to heights beyond all numbers.
        if soft.data().iter().any(|height| !height.is_finite()) {
            return Ok((plain, Vec::new()));
        }
        let from = [quantile(&soft, 0.001), quantile(&soft, 0.999)];
        // So little relief at so great a height would be lost in the digits of the curve.
        if from[1] - from[0] < 2e-3 * from[0].abs().max(from[1].abs()) {
            return Ok((plain, Vec::new()));
        }
        let windows: Vec<Grid> = inside.tiles(side).filter_map(|window| soft.crop(&window)).collect();
        if from[1] - from[0] < 1e-3 {
            return Ok((plain, windows));
        }
        let made = |to: [f64; 2], bend: f64| {
            let stretch = Stretch { from, to, bend };
            let function = stretch.curve().function();
            let bent = |soft: &Grid| {
                let mut out = soft.clone();
                out.data_mut().iter_mut().for_each(|height| *height = function(*height));
                out
            };
            (stretch, windows.iter().map(bent).collect::<Vec<Grid>>())
        };
        // The stronger the bend, the lower the mean.
        let bend =
            bisect([-5.0, 5.0], |bend| middle(made([0.0, 1e3], bend).1.iter().map(integral)) > self.target.integral);
        let rises: Vec<Grid> = made([0.0, 1e3], bend).1.iter().map(steepness).collect();
        let relief = libm::exp(bisect([0.0, 10.0], |log| {
            middle(rises.iter().map(|rises| mean_slope(rises, (libm::exp(log) / 1e3) as f32))) < self.target.slope
        }));
        Ok(made([lowest, lowest + relief], bend))
    }
}

/// A world of these values, `across` windows wide, and the window to measure.
fn trial_world(
    target: &FitTarget,
    values: &ParamValues,
    seed: u64,
    across: usize,
    options: &Options,
) -> Result<(World, Window)> {
    let inner = target.side * across;
    let plain = Stretch { from: [0.0, 1.0], to: [0.0, 1.0], bend: 0.0 };
    let recipe = trial(values, &plain, &FittedWorld { size: [inner + 2 * MARGIN; 2], cell: target.cell, seed });
    let world = World::with_options(recipe, Options { store: None, ..options.clone() })?;
    let inside = Window::new(inner, inner, target.cell).at(MARGIN as i64, MARGIN as i64);
    Ok((world, inside))
}

impl Effort {
    /// A search of this many random candidates and as many steps of improvement, with seed 1.
    #[must_use]
    pub fn new(random: usize, improving: usize) -> Effort {
        Effort { random, improving, seed: 1 }
    }

    /// The same with this seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Effort {
        Effort { seed, ..self }
    }

    /// Approximate number of windows in a search.
    fn windows(&self, target: &FitTarget) -> f64 {
        let first = self.random.max(1) + PARAMS.len() + self.improving;
        let last = FINALISTS * (OTHER_WORLDS as usize + 1) * target.across() * target.across();
        (first + last) as f64
    }

    /// Approximate time of a search on one core, in nanoseconds, as the weight of a [part](Progress::part) of more
    /// work.
    ///
    /// # Errors
    /// The errors of [`search`].
    pub fn work(&self, target: &FitTarget, options: &Options) -> Result<f64> {
        let (world, inside) = trial_world(target, &[0.5; PARAMS.len()], self.seed, 1, options)?;
        let plan = world.plan(&["soft"], &inside)?;
        Ok(self.windows(target) * (world.work(&plan)? + MEASURING * inside.len() as f64))
    }
}

/// Approximate time for measuring and stretching a sample of a window, in nanoseconds.
const MEASURING: f64 = 400.0;

/// The median.
fn middle(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    let (low, high) = (values.len().saturating_sub(1) / 2, values.len() / 2);
    match (values.get(low), values.get(high)) {
        (Some(low), Some(high)) => 0.5 * (low + high),
        _ => 0.0,
    }
}

/// The number between two at which `above` stops being true, by bisection.
fn bisect([mut low, mut high]: [f64; 2], above: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..18 {
        let middle = 0.5 * (low + high);
        if above(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
