//! A chunk of 256 x 256 samples of fields only, on one core, into a reused buffer.

use cpu_time::ThreadTime;
use orogen::{Sampler, Window};

use super::figure::{Figure, Target};
use super::hills;
use crate::measure::median;
use crate::options::Options;

/// Maximum time for a chunk, in milliseconds.
const MOST: f64 = 1.0;

const SIDE: usize = 256;

/// Chunks per timing.
const CHUNKS: i64 = 20;

/// Measures at the world's own cell and at 1 m, where noise changes more slowly from sample to sample.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let mut recipe = hills::fields()?;
    let cell = recipe.world.cell;
    recipe.world.size = None;
    let ground = Sampler::new(hills::open(recipe, 1)?, "height").map_err(|e| e.to_string())?;
    let mut heights = vec![0.0; SIDE * SIDE];
    let mut figures = Vec::new();
    for (cell, target) in [(cell, Target::AtMost(MOST)), (1.0, Target::AtMost(MOST))] {
        let mut times = Vec::new();
        for round in 0..=options.repetitions as i64 {
            let start = ThreadTime::now();
            for column in 0..CHUNKS {
                let chunk = Window::new(SIDE, SIDE, cell).at(column * SIDE as i64, round * SIDE as i64);
                ground.fill(&chunk, &mut heights).map_err(|e| e.to_string())?;
            }
            times.push(start.elapsed().as_secs_f64() * 1000.0 / CHUNKS as f64);
        }
        // The first round sets up tables and buffers.
        times.remove(0);
        figures.push(Figure {
            case: format!("chunk of {SIDE} x {SIDE} at {cell} m, one core, at most"),
            ours: median(&mut times),
            unit: "ms",
            other: None,
            target,
        });
    }
    Ok(figures)
}
