//! Part of area `erosion`: a stream power solution at the world's cell in worlds of several sizes, from the recipe to
//! its heights. CPU time of one thread.

use cpu_time::ProcessTime;
use orogen::{Options as Limits, Progress, Recipe, World};

use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

/// Cells per side.
const SIDES: [usize; 4] = [512, 1024, 2048, 4096];

/// Maximum ratio of the cost of a cell between the most and the least expensive world.
const SPREAD: f64 = 1.2;

const NAME: &str = "stream power by world size";

/// A young range: uplifted noise, cut by rivers.
const RECIPE: &str = r#"
    orogen = 1
    world = { seed = 1, size = 20480, cell = 20 }
    outputs = { height = "range" }
    nodes.noise = { op = "fbm", wavelength = 5200, octaves = 7, gain = 0.55 }
    nodes.young = { op = "normalise", source = "noise", low = 0, high = 900 }
    nodes.range = { op = "stream-power", source = "young", years = 45000, steps = 12, erodibility = 1.6e-5 }
"#;

/// The cost of a cell in each world, and the ratio of maximum to minimum.
pub fn figures(options: &Options) -> Result<Vec<Figure>, String> {
    if !NAME.contains(&options.case) {
        return Ok(Vec::new());
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let costs = SIDES.map(|side| {
        eprintln!("{NAME}: {side} x {side} ...");
        // Large worlds vary less and take longer.
        let repetitions = (options.repetitions * SIDES[0] / side).max(1);
        let costs: Result<Vec<f64>, String> = (0..repetitions).map(|_| pool.install(|| cost(side))).collect();
        costs.map(|mut costs| median(&mut costs))
    });
    let mut figures = Vec::new();
    let mut range = [f64::INFINITY, 0.0f64];
    for (side, cost) in SIDES.iter().zip(costs) {
        let cost = cost?;
        range = [range[0].min(cost), range[1].max(cost)];
        let case = format!("{NAME}: {side} x {side} cells");
        figures.push(Figure { case, ours: cost, unit: "ns of CPU a cell", other: None, target: Target::None });
    }
    figures.push(Figure {
        case: format!("{NAME}: the dearest cell"),
        ours: range[1],
        unit: "ns of CPU a cell",
        other: Some(("the cheapest", range[0])),
        target: Target::RatioAtMost(SPREAD),
    });
    Ok(figures)
}

/// Nanoseconds per cell of a world with this many cells per side.
fn cost(side: usize) -> Result<f64, String> {
    let mut recipe = Recipe::parse(RECIPE, NAME).map_err(|e| e.to_string())?;
    let length = side as f64 * recipe.world.cell;
    recipe.world.size = Some([length; 2]);
    let start = ProcessTime::now();
    let world =
        World::with_options(recipe, Limits { threads: Some(1), ..Limits::default() }).map_err(|e| e.to_string())?;
    let window = world.full_window(world.recipe().world.cell).map_err(|e| e.to_string())?;
    let heights = world.grids(&["height"], &window, &Progress::none()).map_err(|e| e.to_string())?;
    let seconds = start.elapsed().as_secs_f64();
    std::hint::black_box(heights);
    Ok(seconds * 1e9 / window.len() as f64)
}
