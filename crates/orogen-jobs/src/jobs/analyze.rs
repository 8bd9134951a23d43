//! The statistics of a world, with a page of charts.

use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::budget::Reservation;
use orogen_engine::plan::Plan;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::analysis::{Band, FORMS, FiniteCount};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::number;
use orogen_io::raster::Raster;
use orogen_output::map::canvas::Canvas;
use orogen_output::survey::page::{self, Title};
use orogen_output::survey::real::{FIGURES, SOURCE, table};
use orogen_output::survey::{Land, Measures, SurveyJob};
use serde_json::{Map, Value, json};

/// The measuring of a layer of a world, in memory or, if it does not fit there, on disk with the same numbers.
///
/// ```
/// use orogen_engine::{Progress, Window, World, presets};
/// use orogen_jobs::jobs::AnalyzeJob;
/// use orogen_jobs::options::Options;
///
/// let world = World::open(presets::find("hills").ok_or("no such preset")?.recipe()?)?;
/// let job = AnalyzeJob::new("hills", &Options::default());
/// let analysis = job.run(&world, &Window::new(64, 64, 30.0), &Progress::none())?;
/// assert!(analysis.measures.relief > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct AnalyzeJob {
    /// What is measured, as texts call it: the name of a recipe, or the path of a file.
    pub name: String,
    /// The measured layer, in metres; `height` by default.
    pub layer: String,
    /// The title of the page of charts; no page is drawn without one, which is the default.
    pub page: Option<String>,
    /// Whether the world is a real place, a file of heights: it has no sea level, and all of it is land.
    pub is_place: bool,
}

const OPTIONS: &[OptionSpec] =
    &[OptionSpec::new("layer", "L", ValueKind::Layer).with_about("Layer to measure").with_default(HEIGHT)];

/// Approximate time for measuring a sample, and for drawing its share of the page, in nanoseconds.
const MEASURING: f64 = 700.0;
const DRAWING: f64 = 200.0;

/// The same with heights on disk, and for computing a sample.
const MEASURING_ON_DISK: f64 = 2500.0;
const MAKING: f64 = 200.0;

impl AnalyzeJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The measuring that is chosen by [`OPTIONS`](AnalyzeJob::OPTIONS), without a page; `name` is that of the recipe
    /// or file in texts.
    pub fn new(name: impl Into<String>, options: &Options) -> AnalyzeJob {
        let layer = options.text("layer").unwrap_or(HEIGHT).into();
        AnalyzeJob { name: name.into(), layer, page: None, is_place: false }
    }

    /// The same with a page of charts under this title.
    pub fn with_page(self, title: impl Into<String>) -> AnalyzeJob {
        AnalyzeJob { page: Some(title.into()), ..self }
    }

    /// The same of a real place, or not.
    pub fn with_place(self, is_place: bool) -> AnalyzeJob {
        AnalyzeJob { is_place, ..self }
    }

    /// Measures the layer over a window, and draws the page.
    ///
    /// # Errors
    /// If the world has no such layer or cannot make the window; if no sample is finite, or too few are land; if memory
    /// does not suffice (then nothing was started), or the disk fails; or the work was cancelled.
    pub fn run(&self, world: &World, window: &Window, progress: &Progress) -> Result<Analysis> {
        let samples = window.len() as f64;
        let drawing = if self.page.is_some() { DRAWING * samples } else { 0.0 };
        let sea_level = (!self.is_place).then(|| world.recipe().world.sea_level as f32);
        match Storage::of(self, world, window)? {
            Storage::Memory(plan, _reserved) => {
                let [making, measuring, drawing] = progress.parts([world.work(&plan)?, MEASURING * samples, drawing]);
                let made = world.run(&plan, &making)?.pop();
                let heights = made.ok_or_else(|| Error::new(ErrorKind::Internal, "a plan of a layer made none"))?;
                let finite = self.finite(FiniteCount::of(heights.data()))?;
                let land = Land::in_memory(&heights, sea_level);
                let measures = world.install(|| SurveyJob::new(land).measure(&measuring))?;
                self.shown(world, &land, finite, measures, &drawing)
            }
            Storage::Disk(working) => {
                let _raster = world.budget().reserve(Raster::memory_on_disk(window))?;
                let [making, measuring, drawing] =
                    progress.parts([MAKING * samples, MEASURING_ON_DISK * samples, drawing]);
                let (heights, count) = world.raster(&self.layer, window, &making)?;
                let finite = self.finite(count)?;
                let _working = world.budget().reserve(working)?;
                let land = Land::on_disk(&heights, sea_level);
                let survey = SurveyJob::new(land).with_scratch(world.scratch()).with_budget(world.budget().clone());
                let measures = world.install(|| survey.measure(&measuring))?;
                self.shown(world, &land, finite, measures, &drawing)
            }
        }
    }

    /// The same count, of which some samples are finite.
    fn finite(&self, count: FiniteCount) -> Result<FiniteCount> {
        count.check(&format!("the layer `{}`", self.layer)).map(|_| count)
    }

    /// The measures, and the page if there is one.
    fn shown(
        &self,
        world: &World,
        land: &Land,
        finite: FiniteCount,
        measures: Option<Measures>,
        progress: &Progress,
    ) -> Result<Analysis> {
        let measures = measures.ok_or_else(|| {
            let message = "there is too little land to measure: at least 64 x 64 samples are needed, 1 % of them above \
                           sea level, and some relief";
            Error::new(ErrorKind::Request, message)
        })?;
        let title = self.page.as_ref().map(|title| Title::new(title).with_about(self.about(world)));
        let page = title.map(|title| world.install(|| page::draw(&title, land, &measures))).transpose()?;
        progress.finish();
        let (name, layer) = (self.name.clone(), self.layer.clone());
        Ok(Analysis { name, layer, window: *land.window(), finite, measures, page })
    }

    /// The small print of the page.
    fn about(&self, world: &World) -> String {
        let recipe = world.recipe();
        let seed = recipe.world.seed;
        match recipe.about.as_str() {
            "" => format!("{}, seed {seed}", self.name),
            about if recipe.nodes().len() == 1 => about.to_string(),
            about => format!("{about}; seed {seed}"),
        }
    }
}

/// Where the heights are during the measurement.
enum Storage {
    /// In memory: the plan for them, and the memory reserved for measuring.
    Memory(Plan, Reservation),
    /// On disk; measuring and drawing take this many bytes.
    Disk(u64),
}

impl Storage {
    /// In memory if they fit there together with the memory for measuring, otherwise on disk.
    fn of(job: &AnalyzeJob, world: &World, window: &Window) -> Result<Storage> {
        let (page, layer) = (if job.page.is_some() { page::MEMORY } else { 0 }, job.layer.as_str());
        // The heights count in the plan and in the memory for measuring.
        let samples = window.len() as u64;
        let measuring = Measures::memory(samples).saturating_sub(samples.saturating_mul(4));
        if let Ok(reserved) = world.budget().reserve(measuring.saturating_add(page))
            && let Ok(plan) = world.plan(&[layer], window)
            && world.budget().afford(world.memory_of(&plan)?).is_ok()
        {
            return Ok(Storage::Memory(plan, reserved));
        }
        if u32::try_from(window.len()).is_err() {
            let message = "at most 2^32 samples can be measured at once; use a smaller window or a larger cell";
            return Err(Error::new(ErrorKind::Request, message));
        }
        // The page is drawn after the measurement.
        let drawing = if page > 0 { page + page::rows_memory(window) } else { 0 };
        let working = Measures::memory_on_disk(window).max(drawing);
        // The heights are made in bands first; measuring follows.
        world.bands(&[layer], window, Raster::memory_on_disk(window), &Progress::none()).map(drop)?;
        world.budget().afford(working.saturating_add(Raster::memory_on_disk(window)))?;
        Ok(Storage::Disk(working))
    }
}

/// The statistics of a layer over a window.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Analysis {
    /// What was measured, as texts call it.
    pub name: String,
    /// The measured layer.
    pub layer: String,
    /// The window.
    pub window: Window,
    /// How many samples are finite; the others are not measured.
    pub finite: FiniteCount,
    /// The statistics.
    pub measures: Measures,
    /// The page of charts, if the job has one.
    pub page: Option<Canvas>,
}

impl Analysis {
    /// The statistics as text for a terminal: a line about the samples, the table beside real land, and its source.
    #[must_use]
    pub fn words(&self) -> String {
        let Window { width, height, cell, .. } = self.window;
        let [low, mean, high] = self.measures.heights;
        let land = match self.measures.land_share {
            share if share < 1.0 => format!(", {:.1} % land", 100.0 * share),
            _ => String::new(),
        };
        format!(
            "{}: {width} x {height} samples of {} m, heights {low:.1} to {high:.1} m, {mean:.1} m on average{land}\n\n\
             {}\nreal: {SOURCE}\n",
            self.name,
            number(cell),
            table(&self.measures),
        )
    }

    /// All numbers as an object of JSON, with a line end.
    #[must_use]
    pub fn to_json(&self) -> String {
        let measures = &self.measures;
        let mut figures = Map::new();
        for figure in FIGURES {
            let value = figure.value(measures);
            let verdict = value.map(|value| figure.verdict(value));
            let told = json!({ "value": value, "unit": figure.unit, "real": figure.real, "verdict": verdict });
            figures.insert(figure.key.to_string(), told);
        }
        let forms = FORMS.iter().zip(&measures.forms).map(|(name, share)| ((*name).to_string(), json!(share)));
        let forms: Map<String, Value> = forms.collect();
        let band = |band: &Band| json!({ "wavelength": band.wavelength, "power": band.power });
        let bands: Vec<Value> = measures.bands.iter().map(band).collect();
        let whole = json!({
            "of": self.name,
            "layer": self.layer,
            "width": self.window.width,
            "height": self.window.height,
            "cell": self.window.cell,
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::presets;

    fn job(given: &[(&str, &str)]) -> AnalyzeJob {
        AnalyzeJob::new("hills", &Options::of(OPTIONS, given.iter().copied()).unwrap())
    }

    fn run(job: &AnalyzeJob, side: usize) -> std::result::Result<Analysis, String> {
        let world = World::open(presets::find("hills").unwrap().recipe().unwrap()).unwrap();
        job.run(&world, &Window::new(side, side, 30.0), &Progress::none()).map_err(|error| error.to_string())
    }

    #[test]
    fn the_layer_is_the_heights_unless_it_is_given() {
        let own = format!("{:?}", job(&[]));
        assert_eq!(own, r#"AnalyzeJob { name: "hills", layer: "height", page: None, is_place: false }"#);
        for spec in OPTIONS {
            assert_eq!(format!("{:?}", job(&[(spec.name, spec.default)])), own);
        }
        assert_eq!(job(&[("layer", "flow")]).layer, "flow");
    }

    #[test]
    fn an_analysis_is_a_text_an_object_and_a_page() {
        let analysis = run(&job(&[]).with_page("Hills"), 80).unwrap();
        let words = analysis.words();
        assert!(words.starts_with("hills: 80 x 80 samples of 30 m, heights ") && words.contains("\nmean slope"));
        assert!(words.ends_with(&format!("\nreal: {SOURCE}\n")), "{words}");
        let json: Value = serde_json::from_str(&analysis.to_json()).unwrap();
        assert_eq!((json["of"].as_str(), json["layer"].as_str()), (Some("hills"), Some("height")));
        assert_eq!(json["figures"].as_object().unwrap().len(), FIGURES.len());
        assert_eq!(json["height_max"].as_f64(), Some(analysis.measures.heights[2]));
        assert!(analysis.page.is_some() && analysis.finite.samples == 6400 && analysis.finite.finite == 6400);
        let without = run(&job(&[]), 80).unwrap();
        assert!(without.page.is_none() && without.to_json() == analysis.to_json());
    }

    #[test]
    fn what_cannot_be_measured_is_a_sentence() {
        assert!(run(&job(&[]), 20).unwrap_err().starts_with("there is too little land to measure"));
        let why = run(&job(&[("layer", "none")]), 80).unwrap_err();
        assert!(why.contains("`none`"), "{why}");
    }
}
