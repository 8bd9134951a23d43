//! `orogen analyze`.

use std::path::PathBuf;

use orogen::budget::Reservation;
use orogen::grid::words::number;
use orogen::io::raster::Raster;
use orogen::output::map::canvas::Canvas;
use orogen::output::survey::page::{self, Title};
use orogen::output::survey::real::{FIGURES, SOURCE, table};
use orogen::output::survey::{Land, Measures, SurveyJob};
use orogen::plan::Plan;
use orogen::{Error, ErrorKind, Progress, Window, World};
use serde_json::{Map, Value, json};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, check_png, is_stdout};
use crate::source::title;
use crate::view::SizedView;
use crate::{finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Layer to measure
    #[arg(long, value_name = "L", default_value = orogen::world::HEIGHT)]
    layer: String,
    /// Page of charts to write (.png)
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    run: RunOptions,
    /// Print all numbers as JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// Measures the terrain and prints the result.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_seed(args.out.as_deref(), |samples, out| measure(&Args { samples, out, ..args.clone() }))
}

fn measure(args: &Args) -> Result<(), Failure> {
    args.out.as_ref().map_or(Ok(()), |out| check_png(out, "the page"))?;
    let Opened { source, recipe, budget, policy } = args.run.read(&args.recipe, &args.samples.view)?;
    let sink = args.out.as_ref().map(|out| Sink::new(out, &policy)).transpose()?;
    let world = args.run.limits.open(recipe, &budget)?;
    let window = args.samples.window(&world)?;
    // A file of heights has no sea level: all of it is land.
    let sea_level = source.dem().is_none().then(|| world.recipe().world.sea_level as f32);
    let (bar, progress) = Bar::new(args.run.quiet);
    let stopped = |error: Error| interrupt::explain(error.into(), "nothing was measured");
    let (measures, page) = match Held::of(args, &world, &window)? {
        Held::InMemory(plan, _reserved) => {
            let [making, measuring, drawing] =
                progress.parts([world.work(&plan)?, MEASURING * window.len() as f64, args.drawing(&window)]);
            let mut grids = world.run(&plan, &making).map_err(stopped)?;
            let Some(heights) = grids.pop() else { return Ok(()) };
            finite::check(&args.layer, &heights)?;
            let land = Land::in_memory(&heights, sea_level);
            let measures = SurveyJob::new(land).measure(&measuring).map_err(stopped)?;
            shown(args, &world, &land, measures, &drawing)?
        }
        Held::OnDisk(working) => {
            let _raster = world.budget().reserve(Raster::memory_on_disk(&window))?;
            let [making, measuring, drawing] = progress.parts([
                MAKING * window.len() as f64,
                MEASURING_ON_DISK * window.len() as f64,
                args.drawing(&window),
            ]);
            let (heights, count) = world.raster(&args.layer, &window, &making).map_err(stopped)?;
            finite::tell(&args.layer, count)?;
            let _working = world.budget().reserve(working)?;
            let land = Land::on_disk(&heights, sea_level);
            let survey = SurveyJob::new(land).with_scratch(world.scratch()).with_budget(world.budget().clone());
            let measures = survey.measure(&measuring).map_err(stopped)?;
            shown(args, &world, &land, measures, &drawing)?
        }
    };
    if let Some((sink, page)) = sink.as_ref().zip(page) {
        sink.picture(&page)?;
    }
    progress.finish();
    drop(bar);
    let text = match (args.json, args.run.quiet) {
        (true, _) => json(args, &window, &measures),
        (false, true) => return Ok(()),
        (false, false) => words(args, &window, &measures),
    };
    match sink {
        // The page occupies standard output.
        Some(Sink::Stdout) => say::error(text.trim_end()),
        _ => say::out(&text)?,
    }
    Ok(())
}

/// Approximate time for measuring a sample, and for drawing its share of the page, in nanoseconds.
const MEASURING: f64 = 700.0;
const DRAWING: f64 = 200.0;

/// The same with heights on disk, and for computing a sample.
const MEASURING_ON_DISK: f64 = 2500.0;
const MAKING: f64 = 200.0;

/// Where the heights are held during the measurement.
enum Held {
    /// In memory: the plan for them, and the memory reserved for measuring.
    InMemory(Plan, Reservation),
    /// On disk; measuring and drawing take this many bytes.
    OnDisk(u64),
}

impl Held {
    /// In memory if they fit there together with the memory for measuring, otherwise on disk.
    fn of(args: &Args, world: &World, window: &Window) -> Result<Held, Error> {
        let page = if args.out.is_some() { page::MEMORY } else { 0 };
        // The heights count in the plan and in the memory for measuring.
        let measuring = Measures::memory(window.len() as u64).saturating_sub((window.len() as u64).saturating_mul(4));
        if let Ok(reserved) = world.budget().reserve(measuring.saturating_add(page))
            && let Ok(plan) = world.plan(&[&args.layer], window)
            && world.budget().afford(world.memory_of(&plan)?).is_ok()
        {
            return Ok(Held::InMemory(plan, reserved));
        }
        if u32::try_from(window.len()).is_err() {
            let message = "at most 2^32 samples can be measured at once; use a smaller window or a larger cell";
            return Err(Error::new(ErrorKind::Request, message));
        }
        // The page is drawn after the measurement.
        let drawing = if page > 0 { page + page::rows_memory(window) } else { 0 };
        let working = Measures::memory_on_disk(window).max(drawing);
        // The heights are made in bands first; measuring follows.
        world.bands(&[&args.layer], window, Raster::memory_on_disk(window), &Progress::none()).map(drop)?;
        world.budget().afford(working.saturating_add(Raster::memory_on_disk(window)))?;
        Ok(Held::OnDisk(working))
    }
}

impl Args {
    /// The work of drawing, if there is a page.
    fn drawing(&self, window: &Window) -> f64 {
        if self.out.is_some() { DRAWING * window.len() as f64 } else { 0.0 }
    }
}

/// The measurements, and the page if one was requested.
fn shown(
    args: &Args,
    world: &World,
    land: &Land,
    measures: Option<Measures>,
    progress: &Progress,
) -> Result<(Measures, Option<Canvas>), Error> {
    let measures = measures.ok_or_else(|| {
        let message = "there is too little land to measure: at least 64 x 64 samples are needed, 1 % of them above sea level, and some relief";
        Error::new(ErrorKind::Request, message)
    })?;
    let title = Title::new(title(&args.recipe)).with_about(about(args, world));
    let page = args.out.is_some().then(|| page::draw(&title, land, &measures)).transpose()?;
    progress.finish();
    Ok((measures, page))
}

fn about(args: &Args, world: &World) -> String {
    let spec = &world.recipe().world;
    match world.recipe().about.as_str() {
        "" => format!("{}, seed {}", args.recipe.display(), spec.seed),
        about if world.recipe().nodes().len() == 1 => about.to_string(),
        about => format!("{about}; seed {}", spec.seed),
    }
}

fn words(args: &Args, window: &Window, measures: &Measures) -> String {
    let page = args
        .out
        .as_ref()
        .filter(|out| !is_stdout(out))
        .map_or(String::new(), |out| format!("\n{}: the page\n", out.display()));
    let [low, mean, high] = measures.heights;
    let land = match measures.land_share {
        share if share < 1.0 => format!(", {:.1} % land", 100.0 * share),
        _ => String::new(),
    };
    format!(
        "{}: {} x {} samples of {} m, heights {low:.1} to {high:.1} m, {mean:.1} m on average{land}\n\n{}\nreal: {SOURCE}\n{page}",
        args.recipe.display(),
        window.width,
        window.height,
        number(window.cell),
        table(measures),
    )
}

fn json(args: &Args, window: &Window, measures: &Measures) -> String {
    let mut figures = Map::new();
    for figure in FIGURES {
        let value = figure.value(measures);
        figures.insert(
            figure.key.to_string(),
            json!({ "value": value, "unit": figure.unit, "real": figure.real, "verdict": value.map(|v| figure.verdict(v)) }),
        );
    }
    let forms: Map<String, Value> = (orogen::grid::analysis::FORMS.iter().zip(&measures.forms))
        .map(|(name, share)| ((*name).to_string(), json!(share)))
        .collect();
    let bands: Vec<Value> =
        measures.bands.iter().map(|band| json!({ "wavelength": band.wavelength, "power": band.power })).collect();
    let whole = json!({
        "of": args.recipe.display().to_string(),
        "layer": args.layer,
        "width": window.width,
        "height": window.height,
        "cell": window.cell,
        "height_min": measures.heights[0],
        "height_mean": measures.heights[1],
        "height_max": measures.heights[2],
        "land_share": measures.land_share,
        "figures": figures,
        "geomorphons": forms,
        "hypsometric_curve": measures.hypsometry,
        "slope_histogram": measures.slopes,
        "aspect_rose": measures.aspects,
        "spectrum": bands,
        "strahler_order": measures.water.order,
    });
    // A tree of numbers and strings can always be serialized.
    serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
}
