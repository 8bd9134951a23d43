//! A fit as one job: the search, and the comparison of its result with the default preset.

use super::features::windows;
use super::report::FitReport;
use super::search::{Effort, FitTarget, MAX_WINDOWS, SIDE, search};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::{presets, source};
use orogen_engine::session;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_output::survey::measures::Measures;

/// The search for a recipe with the statistics of a real place, and its comparison with that place.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FitJob {
    /// Seed of the search and of the resulting world.
    pub seed: u64,
    /// Number of parameter sets to try.
    pub tries: u32,
    /// Number of worlds with other seeds that are compared with the place at the end.
    pub judges: u32,
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("seed", "N", ValueKind::Whole(0, i64::MAX as u64))
        .with_about("Seed of the search and of the resulting world")
        .with_default("1"),
    OptionSpec::new("tries", "N", ValueKind::Whole(12, 10_000))
        .with_about("Number of parameter sets to try")
        .with_default("120"),
    OptionSpec::new("judges", "N", ValueKind::Whole(1, 100))
        .with_about("Number of worlds with other seeds that are compared with the place at the end")
        .with_default("2"),
];

/// Memory for measuring a sample, in bytes.
const MEASURED: u64 = 64;

/// The difference between the seeds of the worlds that are compared: the search uses those next to its own seed.
const SEEDS_APART: u64 = 1000;

/// The result of a fit.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FitResult {
    /// The recipe, for a world of the size and cell of the place.
    pub recipe: Recipe,
    /// Its statistics beside those of the place and of the default preset.
    pub report: FitReport,
}

impl FitJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The search that is chosen by [`OPTIONS`](FitJob::OPTIONS).
    #[must_use]
    pub fn new(options: &Options) -> FitJob {
        FitJob {
            seed: options.whole("seed").unwrap_or(1),
            tries: options.whole("tries").unwrap_or(120) as u32,
            judges: options.whole("judges").unwrap_or(2) as u32,
        }
    }

    /// Finds a recipe whose terrain is like a place, and compares it and the default preset with the place in worlds of
    /// other seeds. `name` is that of the place in texts. The caller holds the memory of the place; `limits` are those
    /// of every world that is made. The same job finds the same recipe on any number of threads.
    ///
    /// # Errors
    /// If the place has no window of 64 x 64 samples with relief, memory does not suffice, or the work was cancelled.
    pub fn run(&self, place: &Grid, name: &str, limits: &session::Options, progress: &Progress) -> Result<FitResult> {
        let _window = limits.memory.reserve(MEASURED * (SIDE * SIDE) as u64)?;
        let target = FitTarget::of(place)?;
        let random = self.tries as usize / 2;
        let effort = Effort::new(random, self.tries as usize - random).with_seed(self.seed);
        let default = source::preset(presets::DEFAULT)?.recipe()?;
        // Each comparison makes a world of the fitted recipe, about as much work as the default preset, and one of that
        // preset.
        let worlds = 2.0 * f64::from(self.judges);
        let judging = worlds * land_work(default.clone(), &target, limits)?;
        let [searching, judging] = progress.parts([effort.work(&target, limits)?, judging]);
        judging.expect(worlds);
        let found = search(&target, &effort, limits, &searching)?;
        searching.finish();
        let about = format!("Synthetic terrain with the statistics of {name}; it contains none of its heights");
        let recipe = found.recipe(&target, self.seed, &about);
        let mut lands = [measured(place, &target), Vec::new(), Vec::new()];
        // Compared in worlds that the search has not used.
        for seed in (1..=u64::from(self.judges)).map(|k| self.seed.wrapping_add(SEEDS_APART * k)) {
            for (recipe, windows) in [&recipe, &default].into_iter().zip(&mut lands[1..]) {
                let land = land(recipe.clone(), seed, &target, limits, &judging.part(1.0))?;
                windows.append(&mut measured(&land, &target));
            }
        }
        Ok(FitResult { recipe, report: FitReport::of(name, &target, &lands, found.tried) })
    }
}

/// The window that is compared with the place.
fn land_window(world: &World, target: &FitTarget) -> Result<Window> {
    let whole = world.full_window(target.cell)?;
    let [width, height] = target.size;
    Ok(Window { width: whole.width.min(width), height: whole.height.min(height), ..whole })
}

/// The work of [`land`].
fn land_work(recipe: Recipe, target: &FitTarget, limits: &session::Options) -> Result<f64> {
    let world = World::with_options(recipe, limits.clone())?;
    let plan = world.plan(&[HEIGHT], &land_window(&world, target)?)?;
    world.work(&plan)
}

/// The heights of a world with another seed at the place's cell, of the place's size.
fn land(
    mut recipe: Recipe,
    seed: u64,
    target: &FitTarget,
    limits: &session::Options,
    progress: &Progress,
) -> Result<Grid> {
    recipe.world.seed = seed;
    let world = World::with_options(recipe, limits.clone())?;
    let mut grids = world.grids(&[HEIGHT], &land_window(&world, target)?, progress)?;
    grids.pop().ok_or_else(|| Error::new(ErrorKind::Internal, "a plan of a layer made none"))
}

/// The measurements of windows, without those that cannot be measured.
fn measured(land: &Grid, target: &FitTarget) -> Vec<Measures> {
    let windows = windows(land.window(), target.side, MAX_WINDOWS);
    windows.into_iter().filter_map(|window| Measures::of(&land.crop(&window)?, None)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(given: &[(&str, &str)]) -> std::result::Result<FitJob, String> {
        let options = Options::of(OPTIONS, given.iter().copied()).map_err(|error| error.to_string())?;
        Ok(FitJob::new(&options))
    }

    #[test]
    fn defaults_are_those_of_the_list() {
        let own = format!("{:?}", job(&[]).unwrap());
        assert_eq!(own, "FitJob { seed: 1, tries: 120, judges: 2 }");
        for spec in OPTIONS {
            assert_eq!(format!("{:?}", job(&[(spec.name, spec.default)]).unwrap()), own, "{}", spec.name);
        }
        let all = job(&[("seed", "7"), ("tries", "10000"), ("judges", "100")]).unwrap();
        assert_eq!((all.seed, all.tries, all.judges), (7, 10_000, 100));
    }

    #[test]
    fn what_is_out_of_range_is_a_sentence() {
        for (given, expect) in [
            (("seed", "-1"), "it must be a whole number from 0 to 9223372036854775807"),
            (("tries", "11"), "it must be a whole number from 12 to 10000"),
            (("judges", "0"), "it must be a whole number from 1 to 100"),
        ] {
            let why = job(&[given]).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }

    #[test]
    fn a_flat_place_is_refused() {
        let flat = Grid::filled(Window::new(80, 80, 30.0), 5.0);
        let job = job(&[]).unwrap();
        let why = job.run(&flat, "flat", &session::Options::default(), &Progress::none()).unwrap_err().to_string();
        assert!(why.starts_with("the place is too small or too flat for a fit"), "{why}");
    }
}
