//! Area `gpu`: terrain and pictures on a graphics card, compared with the bandwidth of its memory and with the
//! processor. Wall time. On a software adapter there are no targets, because it shares the processor.

use std::sync::Arc;
use std::time::Instant;

use orogen::gpu::gpu::Options as GpuOptions;
use orogen::gpu::{Choice, Gpu, adapters::Kind};
use orogen::jobs::RenderJob;
use orogen::node::Node;
use orogen::{Options as SessionOptions, Progress, Recipe, Session, Window, presets};
use serde_json::{Value, json};

use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

/// Maximum time of a preview after a parameter of fields and a filter changes, over 1024 x 1024 samples, in seconds.
const PREVIEW: f64 = 0.005;

/// Maximum time of a picture of 1920 x 1080 pixels, in seconds.
const PICTURE: f64 = 0.050;

/// The card, the sessions with and without it, and the number of timings.
struct Bench {
    gpu: Gpu,
    card: Session,
    processor: Session,
    repetitions: usize,
}

/// Measures each case.
pub fn run(options: &Options) -> Result<Value, String> {
    let gpu = Gpu::open(&GpuOptions::new(Choice::Any)).map_err(|e| e.to_string())?;
    let processor = Session::new(SessionOptions::default()).map_err(|e| e.to_string())?;
    let card = processor.with_device(Arc::new(gpu.clone()));
    let is_software = gpu.adapter().kind == Kind::Software;
    // A software adapter takes minutes for the full size.
    let side = if is_software { 2048 } else { 8192 };
    let repetitions = if is_software { 1 } else { options.repetitions };
    let bench = Bench { gpu, card, processor, repetitions };
    let mut rows = Vec::new();
    let mut row = |figure: Figure| {
        let target = if is_software { Target::None } else { figure.target };
        rows.push(Figure { target, ..figure }.json());
    };
    let is_wanted = |case: &str| case.contains(&options.case);
    let bytes = 4 * (side * side) as u64;
    let copied = bench.gpu.copy_seconds(bytes.min(bench.gpu.buffer_limit())).map_err(|e| e.to_string())?;
    let copied = copied * bytes as f64 / bytes.min(bench.gpu.buffer_limit()) as f64;
    if is_wanted("copy") {
        let case = format!("{}: copy within its memory", bench.gpu.adapter());
        row(Figure { case, ours: bytes as f64 / copied / 1e9, unit: "GB/s", other: None, target: Target::None });
    }
    if is_wanted("fbm") {
        let ours = bench.kernels(FBM, side)?;
        let other = Some(("a copy of the same size", copied));
        let case = format!("fbm, 6 octaves, {side} x {side}: kernels");
        row(Figure { case, ours, unit: "s", other, target: Target::FasterBy(0.5) });
    }
    if is_wanted("pipes") {
        let ours = bench.kernels(PIPES, 2048)?;
        let begun = Instant::now();
        window(&bench.processor, PIPES, 2048, 0)?;
        let other = Some(("the processor, all cores", begun.elapsed().as_secs_f64()));
        let case = "pipes, 100 iterations, 2048 x 2048: kernels".to_string();
        row(Figure { case, ours, unit: "s", other, target: Target::FasterBy(20.0) });
    }
    if is_wanted("preview") {
        let mut times = bench.previews()?;
        let case = "terraces, 1024 x 1024 after a slider's move: heights in memory".to_string();
        row(Figure { case, ours: median(&mut times), unit: "s", other: None, target: Target::AtMost(PREVIEW) });
    }
    for (part, about) in [
        (Part::Rivers, "rivers of alpine, 339 x 339, 130 steps: a draft"),
        (Part::Levels, "levels of alpine, 1024 x 1024, after a slider's move: heights in memory"),
    ] {
        if is_wanted(about) {
            let card = match part {
                Part::Rivers => bench.card.drafting(),
                Part::Levels => bench.card.clone(),
            };
            let [ours, other] = [bench.alpine(part, &card)?, bench.alpine(part, &bench.processor)?];
            let other = Some(("the processor, all cores", other));
            row(Figure { case: about.to_string(), ours, unit: "s", other, target: Target::None });
        }
    }
    if is_wanted("render") {
        let [ours, other] = bench.pictures()?;
        let case = "render of mesa, 1920 x 1080, 5 samples a pixel".to_string();
        let other = Some(("the processor, all cores", other));
        row(Figure { case, ours, unit: "s", other, target: Target::AtMost(PICTURE) });
    }
    if let Some(failure) = bench.gpu.failure() {
        return Err(failure.to_string());
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "gpu", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}

const FBM: &str = "orogen = 1\n[nodes.land]\nop = \"fbm\"\nwavelength = 1000\n[outputs]\nheight = \"land\"\n";

const TERRACES: &str = include_str!("terraces.toml");

const PIPES: &str = "orogen = 1\n[nodes.hills]\nop = \"fbm\"\nwavelength = 5000\n[nodes.heights]\nop = \"multiply\"\na = \"hills\"\nb = 800\n\
    [nodes.land]\nop = \"pipes\"\nsource = \"heights\"\niterations = 100\n[outputs]\nheight = \"land\"\n";

/// A measured part of the preset `alpine`.
#[derive(Clone, Copy)]
enum Part {
    /// Its two solves of `stream-power`.
    Rivers,
    /// The levels of `amplify` below them.
    Levels,
}

/// Makes the heights of a recipe. Each call needs another seed, because grids of filters are kept.
fn window(session: &Session, recipe: &str, side: usize, seed: u64) -> Result<(), String> {
    let mut recipe = Recipe::parse(recipe, "bench").map_err(|e| e.to_string())?;
    recipe.world.seed = seed;
    let world = session.open(recipe).map_err(|e| e.to_string())?;
    world.window("height", &Window::new(side, side, 10.0)).map(drop).map_err(|e| e.to_string())
}

impl Bench {
    /// The seconds of the kernels for a recipe; the first run, which compiles, is not counted.
    fn kernels(&self, recipe: &str, side: usize) -> Result<f64, String> {
        let mut times = Vec::new();
        for k in 0..=self.repetitions {
            let _ = self.gpu.take_seconds();
            window(&self.card, recipe, side, k as u64)?;
            if k > 0 {
                times.push(self.gpu.take_seconds());
            }
        }
        Ok(median(&mut times))
    }

    /// The seconds from a changed parameter of a recipe of fields and a filter to its heights.
    fn previews(&self) -> Result<Vec<f64>, String> {
        let mut times = Vec::new();
        for k in 0..=self.repetitions {
            let mut recipe = Recipe::parse(TERRACES, "terraces.toml").map_err(|e| e.to_string())?;
            recipe.world.seed = k as u64;
            let begun = Instant::now();
            let world = self.card.open(recipe).map_err(|e| e.to_string())?;
            let window = world.window_fitting(1024).unwrap_or(Window::new(1024, 1024, 10.0));
            world.window("height", &window).map_err(|e| e.to_string())?;
            if k > 0 {
                times.push(begun.elapsed().as_secs_f64());
            }
        }
        Ok(times)
    }

    /// The seconds of a part of the preset `alpine` in a session; a parameter changes before each timing.
    fn alpine(&self, part: Part, session: &Session) -> Result<f64, String> {
        let preset = presets::find("alpine").ok_or("no such preset")?;
        let mut times = Vec::new();
        for k in 0..=self.repetitions {
            let mut recipe = preset.recipe().map_err(|e| e.to_string())?;
            let (layer, window) = match part {
                Part::Rivers => ("valleys", Window::new(128, 128, 480.0)),
                Part::Levels => ("amplified", Window::new(1024, 1024, 60.0)),
            };
            match part {
                Part::Rivers => recipe.world.seed = 100 + k as u64,
                Part::Levels => recipe.change(|node| {
                    if let Node::Amplify(levels) = node {
                        levels.creep += 0.01 * k as f64;
                    }
                }),
            }
            let world = session.open(recipe).map_err(|e| e.to_string())?;
            // The rivers from which the levels start are not measured.
            if let Part::Levels = part {
                world.window("valleys", &Window::new(1, 1, 480.0)).map_err(|e| e.to_string())?;
            }
            let begun = Instant::now();
            world.window(layer, &window).map_err(|e| e.to_string())?;
            if k > 0 {
                times.push(begun.elapsed().as_secs_f64());
            }
        }
        Ok(median(&mut times))
    }

    /// The seconds of painting a picture on the card and on the processor.
    fn pictures(&self) -> Result<[f64; 2], String> {
        let preset = presets::find("mesa").ok_or("no such preset")?;
        let world = self.processor.open(preset.recipe().map_err(|e| e.to_string())?).map_err(|e| e.to_string())?;
        let land = world.window_fitting(1024).map_err(|e| e.to_string())?;
        let mut seconds = [0.0; 2];
        for (seconds, on_card) in seconds.iter_mut().zip([true, false]) {
            let mut job = RenderJob::default().with_window(land);
            if on_card {
                job = job.with_device(Arc::new(self.gpu.clone()));
            }
            let progress = Progress::none();
            let rendering = job.scene(&world, 1.0, 0, &progress).map_err(|e| e.to_string())?;
            let [width, height] = rendering.spec.size;
            let camera = rendering.scene.camera(&rendering.spec);
            let mut times = Vec::new();
            for k in 0..=self.repetitions {
                let mut bytes = vec![0; 3 * width * height];
                let begun = Instant::now();
                rendering
                    .paint(&camera, [width, height], 0..height, &mut bytes, &Progress::none())
                    .map_err(|e| e.to_string())?;
                if k > 0 {
                    times.push(begun.elapsed().as_secs_f64());
                }
            }
            if let Some(why) = rendering.refused() {
                return Err(why.to_string());
            }
            *seconds = median(&mut times);
        }
        Ok(seconds)
    }
}
