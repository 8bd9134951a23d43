//! Contours of 20 levels beside contourpy, CPU time of one thread.

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;

use cpu_time::ThreadTime;
use orogen::Grid;
use orogen::contour::trace::contours;
use orogen::format::npy;
use serde_json::Value;

use super::ground::ground;
use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

const SIDE: usize = 2048;
const LEVELS: usize = 20;

/// Where contourpy's Python is: `cargo xtask bench` installs it and sets this.
const PYTHON: &str = "OROGEN_CONTOURPY";

/// Measures both on the same ground in turn.
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
    let other = match std::env::var_os(PYTHON) {
        Some(python) => {
            let theirs = contourpy(Path::new(&python), &ground, &levels, options.repetitions)?;
            if theirs.points.abs_diff(points) * 1000 > points {
                return Err(format!(
                    "contourpy's lines have {} points, ours {points}: not the same work",
                    theirs.points
                ));
            }
            Some(("contourpy", theirs.seconds))
        }
        None => None,
    };
    Ok(vec![Figure {
        case: format!("contours of {SIDE} x {SIDE}, {LEVELS} levels, {} lines of {points} points", lines.len()),
        ours: median(&mut times),
        unit: "s of CPU",
        other,
        target: if other.is_some() { Target::FasterBy(2.0) } else { Target::None },
    }])
}

struct Theirs {
    seconds: f64,
    points: usize,
}

fn contourpy(python: &Path, ground: &Grid, levels: &[f64], repetitions: usize) -> Result<Theirs, String> {
    let file = std::env::temp_dir().join(format!("orogen-bench-{}.npy", std::process::id()));
    let written = std::fs::File::create(&file).and_then(|mut out| npy::write(&mut out, ground));
    written.map_err(|e| format!("{}: {e}", file.display()))?;
    let script = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("peers/contours.py");
    let levels: Vec<String> = levels.iter().map(f64::to_string).collect();
    let output =
        Command::new(python).arg(script).arg(&file).arg(levels.join(",")).arg(repetitions.to_string()).output();
    // Only what was made here is removed.
    let _ = std::fs::remove_file(&file);
    let output = output.map_err(|e| format!("{}: {e}", python.display()))?;
    let told: Value = serde_json::from_slice(&output.stdout)
        .map_err(|_| format!("contourpy measured nothing: {}", String::from_utf8_lossy(&output.stderr)))?;
    let mut times: Vec<f64> = told["seconds"].as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    match (times.is_empty(), told["points"].as_u64()) {
        (false, Some(points)) => Ok(Theirs { seconds: median(&mut times), points: points as usize }),
        _ => Err("contourpy did not tell what it made".into()),
    }
}
