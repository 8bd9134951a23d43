//! Two threads compared with one: wall time of a window of 2048 x 2048. The best of many runs counts, because other
//! load only makes a run slower. It affects two threads more, so the figure needs an idle machine.

use std::time::Instant;

use orogen::Window;

use super::figure::{Figure, Target};
use super::hills;
use crate::options::Options;

/// Required speedup of two threads.
const FASTER: f64 = 1.9;

const SIDE: usize = 2048;

/// Measures fields, and fields with a filter.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let length = hills::fields()?.world.size.ok_or("`hills` has bounds")?[0];
    let cell = length / SIDE as f64;
    let mut figures = Vec::new();
    for (what, recipe, layer) in
        [("fields", hills::fields()?, "height"), ("fields and a filter", hills::with_halo(cell)?, "stretched")]
    {
        let worlds = [hills::open(recipe.clone(), 1)?, hills::open(recipe, 2)?];
        let window = Window::new(SIDE, SIDE, cell);
        let mut best = [f64::INFINITY; 2];
        for round in 0..=3 * options.repetitions {
            for (world, best) in worlds.iter().zip(&mut best) {
                let start = Instant::now();
                world.window(layer, &window).map_err(|e| e.to_string())?;
                // The first round includes solving.
                if round > 0 {
                    *best = best.min(start.elapsed().as_secs_f64() * 1000.0);
                }
            }
        }
        let [one, two] = best;
        figures.push(Figure {
            case: format!("two threads, {what}, {SIDE} x {SIDE}, faster by"),
            ours: two,
            unit: "ms on the wall",
            other: Some(("one thread", one)),
            target: Target::FasterBy(FASTER),
        });
    }
    Ok(figures)
}
