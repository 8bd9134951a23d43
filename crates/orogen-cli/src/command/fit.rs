//! `orogen fit`.

use std::path::PathBuf;
use std::sync::Arc;

use orogen::fit::search::{MAX_WINDOWS, SIDE};
use orogen::fit::{Effort, FeatureVector, FitTarget, features, search};
use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::io::file::mark;
use orogen::output::survey::Measures;
use orogen::output::survey::real::FIGURES;
use orogen::recipe::presets;
use orogen::world::HEIGHT;
use orogen::{Budget, Error, ErrorKind, Grid, Progress, Recipe, Window, World};
use serde_json::json;

use crate::bar::Bar;
use crate::failure::Failure;
use crate::options::RunOptions;
use crate::sink::{Sink, is_stdout};
use crate::source::preset;
use crate::values::number::seed;
use crate::{finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A file of heights (GeoTIFF, .asc, .hgt, ...)
    place: PathBuf,
    /// Recipe to write (.toml), or - for standard output; files that were written or edited by hand are not replaced
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Seed of the search and of the resulting world
    #[arg(long, value_name = "N", value_parser = seed, default_value = "1", allow_negative_numbers = true)]
    seed: u64,
    /// Number of parameter sets to try
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(12..=10_000), default_value = "120",
          allow_negative_numbers = true)]
    tries: u32,
    /// Number of worlds with other seeds that are compared with the place at the end
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100), default_value = "2",
          allow_negative_numbers = true)]
    judges: u32,
    #[command(flatten)]
    run: RunOptions,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

/// Memory for measuring a sample, in bytes.
const MEASURED: u64 = 64;

/// Finds a recipe, compares it with the default preset in worlds of other seeds, and writes it.
pub fn run(args: &Args) -> Result<(), Failure> {
    if !is_stdout(&args.out) && args.out.extension().is_none_or(|extension| extension != "toml") {
        return Err(Failure::Usage(format!(
            "{} is not a name for a recipe; use the extension .toml",
            args.out.display()
        )));
    }
    let sink = Sink::new(&args.out, &args.run.replace.policy([&args.place]))?;
    let budget = args.run.limits.budget();
    let place = PreparedDem::read(&args.place, None, budget.left().unwrap_or(DEFAULT_MEMORY))?;
    // The place, and the memory for measuring a window.
    budget.reserve(place.memory() + MEASURED * (SIDE * SIDE) as u64)?.keep();
    if !args.run.quiet {
        place.notes.iter().for_each(|note| say::error(&format!("note: {}: {note}", args.place.display())));
    }
    let place = Arc::new(place);
    finite::check("place", &place.grid)?;
    let target = FitTarget::of(&place.grid)?;
    let random = args.tries as usize / 2;
    let effort = Effort::new(random, args.tries as usize - random).with_seed(args.seed);
    let stopped = |error: Error| interrupt::explain(error.into(), "no recipe was written");
    let options = args.run.limits.options(&budget);
    let (bar, progress) = Bar::new(args.run.quiet);
    let default = preset(presets::DEFAULT)?.recipe()?;
    // Each comparison makes a world of the fitted recipe, about as much work as the default preset, and one of that
    // preset.
    let judging = 2.0 * f64::from(args.judges) * land_work(args, &budget, default.clone(), &target)?;
    let [searching, judging] = progress.parts([effort.work(&target, &options)?, judging]);
    judging.expect(2.0 * f64::from(args.judges));
    let found = search(&target, &effort, &options, &searching).map_err(stopped)?;
    searching.finish();
    let name = args.place.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let about = format!("Synthetic terrain with the statistics of {name}; it contains none of its heights");
    let recipe = found.recipe(&target, args.seed, &about);
    let mut lands = [windows(&place.grid, &target), Vec::new(), Vec::new()];
    // Compared in worlds that the search has not used.
    for seed in (1..=u64::from(args.judges)).map(|k| args.seed.wrapping_add(1000 * k)) {
        let ours = land(args, &budget, recipe.clone(), seed, &target, &judging.part(1.0))?;
        lands[1].append(&mut windows(&ours, &target));
        let theirs = land(args, &budget, default.clone(), seed, &target, &judging.part(1.0))?;
        lands[2].append(&mut windows(&theirs, &target));
    }
    drop(bar);
    sink.write(|out| out.write_all(mark::marked(&recipe.to_toml()).as_bytes()))?;
    let report = Report::of(&target, &lands);
    let text = match (args.json, args.run.quiet) {
        (true, _) => report.json(&target, found.tried),
        (false, true) => return Ok(()),
        (false, false) => report.words(args, &name, &target, found.tried),
    };
    match sink {
        // The recipe occupies standard output.
        Sink::Stdout => say::error(text.trim_end()),
        Sink::File(_) => say::out(&text)?,
    }
    Ok(())
}

/// The window that is compared with the place.
fn land_window(world: &World, target: &FitTarget) -> Result<Window, Failure> {
    let whole = world.full_window(target.cell)?;
    let [width, height] = target.size;
    Ok(Window { width: whole.width.min(width), height: whole.height.min(height), ..whole })
}

/// The work of [`land`].
fn land_work(args: &Args, budget: &Budget, recipe: Recipe, target: &FitTarget) -> Result<f64, Failure> {
    let world = args.run.limits.open(recipe, budget)?;
    let plan = world.plan(&[HEIGHT], &land_window(&world, target)?)?;
    Ok(world.work(&plan)?)
}

/// The heights of a world with another seed at the place's cell, of the place's size.
fn land(
    args: &Args,
    budget: &Budget,
    mut recipe: Recipe,
    seed: u64,
    target: &FitTarget,
    progress: &Progress,
) -> Result<Grid, Failure> {
    recipe.world.seed = seed;
    let world = args.run.limits.open(recipe, budget)?;
    let grids = world.grids(&[HEIGHT], &land_window(&world, target)?, progress);
    let mut grids = grids.map_err(|error| interrupt::explain(error.into(), "no recipe was written"))?;
    grids.pop().ok_or_else(|| Error::new(ErrorKind::Request, "the world made no layer").into())
}

/// The measurements of windows, without those that cannot be measured.
fn windows(land: &Grid, target: &FitTarget) -> Vec<Measures> {
    let windows = features::windows(land.window(), target.side, MAX_WINDOWS);
    windows.into_iter().filter_map(|window| Measures::of(&land.crop(&window)?, None)).collect()
}

/// Three terrains side by side: the place, the fitted recipe's, the default preset's.
struct Report {
    /// Number of windows, and the median distance from the place's median.
    distances: [(usize, f64); 3],
    /// The median of each statistic over the windows of each terrain.
    figures: Vec<[Option<f64>; 3]>,
}

impl Report {
    fn of(target: &FitTarget, lands: &[Vec<Measures>; 3]) -> Report {
        let apart = |land: &[Measures]| {
            let distances = land.iter().map(|window| FeatureVector::of(window).distance(&target.middle)).collect();
            (land.len(), median(distances).unwrap_or(f64::NAN))
        };
        let own = (target.windows, median(target.own.clone()).unwrap_or(f64::NAN));
        let figures = FIGURES
            .iter()
            .map(|figure| {
                [0, 1, 2].map(|k| median(lands[k].iter().filter_map(|measures| figure.value(measures)).collect()))
            })
            .collect();
        Report { distances: [own, apart(&lands[1]), apart(&lands[2])], figures }
    }

    fn words(&self, args: &Args, name: &str, target: &FitTarget, tried: usize) -> String {
        let [place, ours, defaults] = self.distances;
        let mut out = format!("{:<24}{:>12}{:>12}{:>12}\n", "", "the place", "the recipe", presets::DEFAULT);
        for (figure, values) in FIGURES.iter().zip(&self.figures) {
            let texts = values.map(|value| value.map_or("-".to_string(), |value| figure.text(value)));
            out.push_str(
                format!("{:<24}{:>12}{:>12}{:>12} {}", figure.name, texts[0], texts[1], texts[2], figure.unit)
                    .trim_end(),
            );
            out.push('\n');
        }
        out.push_str(&format!(
            "{:<24}{:>12.2}{:>12.2}{:>12.2}\n",
            "distance from the place", place.1, ours.1, defaults.1
        ));
        out.push_str(&format!("{:<24}{:>12}{:>12}{:>12}\n", "windows", place.0, ours.0, defaults.0));
        format!(
            "{}: land like {name}, found among {tried} settings; medians over windows of {side} x {side} samples of {:.1} m\n\n{out}\n\
             make it:  orogen generate {0}\n",
            args.out.display(),
            target.cell,
            side = target.side,
        )
    }

    fn json(&self, target: &FitTarget, tried: usize) -> String {
        let land = |k: usize| {
            let figures: serde_json::Map<String, serde_json::Value> = FIGURES
                .iter()
                .zip(&self.figures)
                .map(|(figure, values)| (figure.key.to_string(), json!(values[k])))
                .collect();
            json!({ "windows": self.distances[k].0, "distance": self.distances[k].1, "figures": figures })
        };
        let whole = json!({
            "cell": target.cell, "side": target.side, "tried": tried,
            "place": land(0), "recipe": land(1), "default_preset": land(2),
        });
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    match values.len() {
        0 => None,
        count if count.is_multiple_of(2) => Some((values[half - 1] + values[half]) / 2.0),
        _ => Some(values[half]),
    }
}
