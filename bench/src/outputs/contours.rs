//! Contours of 20 levels compared with contourpy, CPU time of one thread.

use std::hint::black_box;

use cpu_time::ThreadTime;
use orogen::grid::contour::contours;

use super::ground::ground;
use super::python;
use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

const SIDE: usize = 2048;
const LEVELS: usize = 20;

/// The environment variable with contourpy's Python: `cargo xtask bench` installs it and sets this.
const PYTHON: &str = "OROGEN_CONTOURPY";

/// Measures both on the same terrain in turns.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let ground = ground(SIDE)?;
    let [low, high] =
        ground.data().iter().fold([f32::MAX, f32::MIN], |[l, h], v| [l.min(*v), h.max(*v)]).map(f64::from);
    let levels: Vec<f64> = (0..LEVELS).map(|k| low + (high - low) * (k as f64 + 0.5) / LEVELS as f64).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let lines = contours(&ground, &levels).map_err(|e| e.to_string())?;
    let points: usize = lines.iter().map(|line| line.path().count()).sum();
    let mut times: Vec<f64> = (0..options.repetitions)
        .map(|_| {
            pool.install(|| {
                let start = ThreadTime::now();
                drop(black_box(contours(black_box(&ground), &levels)));
                start.elapsed().as_secs_f64()
            })
        })
        .collect();
    let listed: Vec<String> = levels.iter().map(f64::to_string).collect();
    let theirs = python::run(PYTHON, "contours.py", &ground, &[listed.join(","), options.repetitions.to_string()])?;
    if let Some(theirs) = &theirs {
        let made = theirs.values["points"].as_u64().unwrap_or_default() as usize;
        if made.abs_diff(points) * 1000 > points {
            return Err(format!("contourpy's lines have {made} points, ours {points}: not the same work"));
        }
    }
    let other = theirs.map(|theirs| ("contourpy", theirs.seconds));
    Ok(vec![Figure {
        case: format!("contours of {SIDE} x {SIDE}, {LEVELS} levels, {} lines of {points} points", lines.len()),
        ours: median(&mut times),
        unit: "s of CPU",
        other,
        target: if other.is_some() { Target::FasterBy(2.0) } else { Target::None },
    }])
}
