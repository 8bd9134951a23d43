//! Area `tiles`: terrain classes, clean-up and tiles of a large map. Wall time of all cores.

use std::time::Instant;

use orogen::autotile::choose::{ClassTiles, Variant, layers};
use orogen::autotile::classes::Classes;
use orogen::autotile::clean::clean;
use orogen::autotile::drawable::Drawable;
use orogen::autotile::mask::{Layout, SIMPLE_BLOB};
use orogen::{Progress, Recipe, Window, World};
use rayon::prelude::*;
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

/// Measures each step, and all together.
pub fn run(options: &Options) -> Result<Value, String> {
    let world = World::open(Recipe::parse(RECIPE, "tiles").map_err(|e| e.to_string())?).map_err(|e| e.to_string())?;
    let grid = world.window("height", &Window::new(SIDE, SIDE, 1.0)).map_err(|e| e.to_string())?;
    let mut rows = Vec::new();
    let sets = [("47 tiles a class", Layout::Blob.masks()), ("13 tiles a class", SIMPLE_BLOB.to_vec())];
    for (name, masks) in sets.into_iter().filter(|(name, _)| name.contains(&options.case)) {
        let drawable = Drawable::new(Layout::Blob, THRESHOLDS.iter().map(|_| masks.as_slice()));
        let tile = |(n, mask): (usize, &u8)| (*mask, Variant { tile: n as u32, weight: 1.0 });
        let tiles: Vec<(u8, Variant)> = masks.iter().enumerate().map(tile).collect();
        let tiles = vec![ClassTiles::new(Layout::Blob, &tiles); THRESHOLDS.len() + 1];
        let mut times: [Vec<f64>; 4] = Default::default();
        for _ in 0..options.repetitions.div_ceil(2) {
            let begun = Instant::now();
            let class = |height: &f32| THRESHOLDS.iter().filter(|from| height >= from).count() as u8;
            let mut classes = Classes::new([0, 0], SIDE, SIDE, grid.data().par_iter().map(class).collect());
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
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "tiles", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}
