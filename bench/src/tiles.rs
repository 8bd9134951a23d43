//! Area `tiles`: terrain classes, clean-up and tiles of a large map, climate and biomes, chunks of blocks at random
//! places, and maps larger than memory. Wall time of all cores.

mod streamed;

use std::time::Instant;

use orogen::grid::autotile::choose::{Variant, layers};
use orogen::grid::autotile::mask::SIMPLE_BLOB;
use orogen::grid::autotile::{ClassTiles, Classes, Drawable, Layout, Tiles, clean};
use orogen::output::blocks::land::prepare;
use orogen::output::blocks::levels::DEFAULT_BELOW;
use orogen::output::blocks::{Extent, Land};
use orogen::{Progress, Recipe, Window, World, presets};
use serde_json::{Value, json};

use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

/// Cells along a side.
const SIDE: usize = 4096;

/// Lower ends of the classes from the second on.
const THRESHOLDS: [f32; 5] = [-0.1, -0.05, 0.1, 0.25, 0.35];

/// Maximum time in seconds.
const SECONDS: f64 = 1.0;

/// Land whose classes are about ten cells wide.
const RECIPE: &str = r#"
    orogen = 1
    world = { seed = 1, cell = 1 }
    outputs = { height = "land" }
    nodes.land = { op = "fbm", wavelength = 60, octaves = 5 }
"#;

/// Number of chunks of blocks at random places, each made separately, with and without a density.
const CHUNKS: usize = 400;

/// Maximum time of a chunk in microseconds.
const MICROSECONDS: f64 = 1000.0;

/// Measures chunks of 16 x 16 columns and all levels at random places of the preset `caves` without its sides.
fn chunks(options: &Options) -> Result<Vec<Value>, String> {
    let mut rows = Vec::new();
    let text = presets::find("caves").ok_or("no preset")?.recipe().map_err(|e| e.to_string())?.to_toml();
    let endless: String =
        text.lines().filter(|line| !line.starts_with("size = ")).map(|line| format!("{line}\n")).collect();
    let plain = endless.replace("density = \"density\"", "other = \"density\"");
    for (name, text) in [("with a density", endless), ("without", plain)] {
        let case = format!("a chunk of 16 x 16 columns at a random place, {name}");
        if !case.contains(&options.case) {
            continue;
        }
        let mut recipe = Recipe::parse(&text, "caves").map_err(|e| e.to_string())?;
        prepare(&mut recipe, 1.0).map_err(|e| e.to_string())?;
        let world = World::open(recipe).map_err(|e| e.to_string())?;
        let mut times = Vec::new();
        for k in 0..CHUNKS {
            // Random places in about 16 million columns.
            let place = [0x9E37_79B9_7F4A_7C15u64, 0xC2B2_AE3D_27D4_EB4F]
                .map(|step| 16 * ((k as u64 + 1).wrapping_mul(step) >> 44) as i64);
            let window = Window::new(16, 16, 1.0).at(place[0], place[1]);
            let begun = Instant::now();
            let land = Land::of(&world, &window, Extent::Below(DEFAULT_BELOW), 1.0, &|_| Ok(()), &Progress::none())
                .map_err(|e| e.to_string())?;
            std::hint::black_box(land.blocks(&window).map_err(|e| e.to_string())?);
            times.push(begun.elapsed().as_secs_f64() * 1e6);
        }
        let target = Target::AtMost(MICROSECONDS);
        rows.push(Figure { case, ours: median(&mut times), unit: "us", other: None, target }.json());
    }
    Ok(rows)
}

/// Samples along a side of a map of biomes.
const BIOMES: usize = 2048;

/// Layers of a climate.
const CLIMATE: [&str; 5] = ["temperature", "range", "rain", "evaporation", "biome"];

/// A climate on cheap heights, with rain at a cell of 1.6 km.
const CLIMATE_RECIPE: &str = r#"
    orogen = 1
    world = { seed = 1, size = 204800, cell = 100 }
    nodes.hills = { op = "fbm", wavelength = 60000, octaves = 2 }
    nodes.land = { op = "remap", source = "hills", to = [-1500, 3000] }
    nodes.air = { op = "temperature", source = "land", latitude = 50, metres_per_degree = 5000 }
    nodes.rain = { op = "orographic-rain", source = "land", cell = 1600 }
    nodes.evaporation = { op = "evapotranspiration", temperature = "air", range = "air.range", rain = "rain" }
    nodes.biome = { op = "biome", temperature = "air", range = "air.range", rain = "rain", height = "land" }
    outputs = { height = "land", temperature = "air", range = "air.range", rain = "rain", evaporation = "evaporation", biome = "biome" }
"#;

/// Measures the climate and biomes of a new world, without the start of its threads.
fn climate(options: &Options) -> Result<Option<Value>, String> {
    let name = "climate and biomes";
    if !name.contains(&options.case) {
        return Ok(None);
    }
    let recipe = Recipe::parse(CLIMATE_RECIPE, "climate").map_err(|e| e.to_string())?;
    let window = Window::new(BIOMES, BIOMES, 100.0);
    let mut times = Vec::new();
    for _ in 0..options.repetitions.div_ceil(2) {
        let world = World::open(recipe.clone()).map_err(|e| e.to_string())?;
        let begun = Instant::now();
        std::hint::black_box(world.grids(&CLIMATE, &window, &Progress::none()).map_err(|e| e.to_string())?);
        times.push(begun.elapsed().as_secs_f64());
    }
    let case = format!("{name}, {BIOMES} x {BIOMES} samples");
    let target = Target::AtMost(SECONDS);
    Ok(Some(Figure { case, ours: median(&mut times), unit: "s", other: None, target }.json()))
}

/// Measures each step, and all steps together.
pub fn run(options: &Options) -> Result<Value, String> {
    let world = World::open(Recipe::parse(RECIPE, "tiles").map_err(|e| e.to_string())?).map_err(|e| e.to_string())?;
    let grid = world.window("height", &Window::new(SIDE, SIDE, 1.0)).map_err(|e| e.to_string())?;
    let mut rows = Vec::new();
    let sets = [("47 tiles a class", Layout::Blob.masks()), ("13 tiles a class", SIMPLE_BLOB.to_vec())];
    for (name, masks) in sets.into_iter().filter(|(name, _)| name.contains(&options.case)) {
        let drawable = Drawable::new(Layout::Blob, THRESHOLDS.iter().map(|_| masks.as_slice()));
        let tile = |(n, mask): (usize, &u8)| (*mask, Variant { tile: n as u32, weight: 1.0 });
        let tiles: Vec<(u8, Variant)> = masks.iter().enumerate().map(tile).collect();
        let tiles = Tiles::Layers(vec![ClassTiles::new(Layout::Blob, &tiles); THRESHOLDS.len() + 1]);
        let mut times: [Vec<f64>; 4] = Default::default();
        for _ in 0..options.repetitions.div_ceil(2) {
            let begun = Instant::now();
            let class = |height: &f32| THRESHOLDS.iter().filter(|from| height >= from).count() as u8;
            let samples = orogen::grid::parallel::samples(grid.data().len(), |at| class(&grid.data()[at]));
            let mut classes = Classes::new([0, 0], SIDE, SIDE, samples);
            let classified = begun.elapsed().as_secs_f64();
            clean(&mut classes, &drawable, &Progress::none()).map_err(|e| e.to_string())?;
            let cleaned = begun.elapsed().as_secs_f64();
            std::hint::black_box(layers(&classes, &drawable, &tiles, 1));
            let drawn = begun.elapsed().as_secs_f64();
            if !drawable.gaps(&classes).is_empty() {
                return Err(format!("{name}: places without a tile are left"));
            }
            for (times, time) in times.iter_mut().zip([classified, cleaned - classified, drawn - cleaned, drawn]) {
                times.push(time);
            }
        }
        let steps = ["classified", "cleaned", "drawn", "classified, cleaned and drawn"];
        for (step, mut times) in steps.into_iter().zip(times) {
            let target = if step.contains(',') { Target::AtMost(SECONDS) } else { Target::None };
            let case = format!("blob, {name}, {SIDE} x {SIDE} cells: {step}");
            rows.push(Figure { case, ours: median(&mut times), unit: "s", other: None, target }.json());
        }
    }
    rows.extend(chunks(options)?);
    rows.extend(climate(options)?);
    rows.extend(streamed::measure(options)?.iter().map(Figure::json));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "tiles", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}
