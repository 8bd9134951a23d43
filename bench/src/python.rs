//! Area `python`: the Python package compared with the same calls in Rust and with other Python packages. CPU time;
//! ours on one thread, packages with theirs.

use std::collections::BTreeMap;
use std::path::Path;

use cpu_time::ProcessTime;
use orogen::grid::analysis::slope::{extended, slope_degrees};
use orogen::grid::analysis::{Light, hillshade};
use orogen::grid::hydrology::{Outlets, accumulate, drainage, fill, steepest::Descent};
use orogen::recipe::presets;
use orogen::{Grid, Window, World};
use orogen_noise::{Fractal, Kind, OpenSimplex2, Points};
use serde_json::{Value, json};

use crate::erosion::{CELL, ground};
use crate::measure::median;
use crate::options::Options;
use crate::peer::{Parts, ground_file};
use crate::world::figure::{Figure, Target};

/// Side of the heights, of the window, and of noise as in `peers/python.py`.
const SIDE: usize = 2048;
const WINDOW: usize = 4096;
const NOISE: usize = 1024;

/// What the names of its cases begin with.
const CLUSTER: &str = "cluster";

/// Side of the build by a cluster, and numbers of tasks that do nothing.
const BUILD: usize = 16384;
const TASKS: [usize; 2] = [1000, 10_000];

/// Our package, and the environment variable that has the path of a Python which has it. `cargo xtask bench` installs
/// packages and sets the variables.
const OURS: (&str, &str) = ("orogen", "OROGEN_PYTHON");

/// Other packages.
const PEERS: [(&str, &str); 7] = [
    ("richdem", "OROGEN_RICHDEM"),
    ("fastscapelib", "OROGEN_FASTSCAPELIB"),
    ("pysheds", "OROGEN_PYSHEDS"),
    ("xrspatial", "OROGEN_XRSPATIAL"),
    ("whitebox_workflows", "OROGEN_WHITEBOX"),
    ("noise", "OROGEN_NOISE"),
    ("opensimplex", "OROGEN_OPENSIMPLEX"),
];

/// A case: the part of `peers/python.py`, the call in Rust, and the targets.
struct Case {
    name: &'static str,
    part: &'static str,
    /// The call, which is timed, on heights.
    rust: fn(&Grid) -> Result<(), orogen::Error>,
    /// Maximum ratio to the call in Rust.
    overhead: f64,
    /// Minimum speedup compared with each other package.
    faster: f64,
    /// Samples of a call if figures are nanoseconds a sample.
    samples: Option<usize>,
}

const CASES: &[Case] = &[
    Case {
        name: "window of hills into NumPy, 4096 x 4096",
        part: "window",
        rust: window,
        overhead: 1.03,
        faster: 3.0,
        samples: None,
    },
    Case {
        name: "depressions filled, 2048 x 2048",
        part: "fill",
        rust: filled,
        overhead: 1.05,
        faster: 3.0,
        samples: None,
    },
    Case {
        name: "depressions drained, D8, accumulation, 2048 x 2048",
        part: "accumulate",
        rust: accumulated,
        overhead: 1.05,
        faster: 3.0,
        samples: None,
    },
    Case { name: "slope, 2048 x 2048", part: "slope", rust: sloped, overhead: 1.05, faster: 3.0, samples: None },
    Case {
        name: "hillshade, 2048 x 2048",
        part: "hillshade",
        rust: shaded,
        overhead: 1.05,
        faster: 3.0,
        samples: None,
    },
    Case {
        name: "fBm of Perlin noise, 6 octaves",
        part: "perlin",
        rust: perlin,
        overhead: 1.05,
        faster: 20.0,
        samples: Some(NOISE * NOISE),
    },
    Case {
        name: "OpenSimplex noise",
        part: "simplex",
        rust: simplex,
        overhead: 1.05,
        faster: 20.0,
        samples: Some(NOISE * NOISE),
    },
];

/// Runs the cases.
pub fn run(options: &Options) -> Result<Value, String> {
    let folder = std::env::temp_dir().join(format!("orogen-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let figures = figures(options, &folder);
    // The folder has only files that were made here.
    let _ = std::fs::remove_dir_all(&folder);
    let rows: Vec<Value> = figures?.iter().map(Figure::json).collect();
    Ok(json!({ "area": "python", "simd": orogen_simd::Level::current().name(), "threads": 1, "rows": rows }))
}

fn figures(options: &Options, folder: &Path) -> Result<Vec<Figure>, String> {
    let heights = ground(SIDE)?;
    let arguments =
        [ground_file(folder, &heights)?.display().to_string(), CELL.to_string(), options.repetitions.to_string()];
    let parts = |(package, variable): (&'static str, &str)| -> Result<Option<Parts>, String> {
        let Some(python) = std::env::var_os(variable) else { return Ok(None) };
        eprintln!("{package} ...");
        Parts::measure(Path::new(&python), "python.py", package, &arguments).map(Some)
    };
    let ours = parts(OURS)?.ok_or_else(|| format!("{} names no Python that has the package", OURS.1))?;
    let mut peers = BTreeMap::new();
    for peer in PEERS {
        if let Some(parts) = parts(peer)? {
            peers.insert(peer.0, parts);
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let mut figures = clusters(options)?;
    for case in CASES.iter().filter(|case| case.name.contains(&options.case)) {
        eprintln!("{} ...", case.name);
        let mut rust = Vec::new();
        for _ in 0..options.repetitions {
            rust.push(pool.install(|| seconds(case, &heights))?);
        }
        // Parts of noise are seconds a sample, in nanoseconds here.
        let (unit, scale) = case.samples.map_or(("s of CPU", 1.0), |_| ("ns a sample", 1e9));
        let figure = |other: (&'static str, f64), target| -> Result<Figure, String> {
            let ours = ours.seconds(&[case.part])? * scale;
            let other = (other.0, other.1 * scale);
            Ok(Figure { case: case.name.to_owned(), ours, unit, other: Some(other), target })
        };
        let samples = case.samples.map_or(1.0, |samples| samples as f64);
        figures.push(figure(("the call in Rust", median(&mut rust) / samples), Target::RatioAtMost(case.overhead))?);
        for (name, parts) in &peers {
            if let Ok(theirs) = parts.seconds(&[case.part]) {
                figures.push(figure((name, theirs), Target::FasterBy(case.faster))?);
            }
        }
    }
    Ok(figures)
}

/// Builds by workers of a cluster on this machine.
fn clusters(options: &Options) -> Result<Vec<Figure>, String> {
    let is_asked = CLUSTER.contains(&options.case) || options.case.contains(CLUSTER);
    let Some(python) = std::env::var_os(OURS.1).filter(|_| is_asked) else { return Ok(Vec::new()) };
    eprintln!("{CLUSTER} ...");
    let [few, many] = TASKS.map(|tasks| tasks.to_string());
    let arguments = [BUILD.to_string(), few.clone(), many.clone()];
    let parts = Parts::measure(Path::new(&python), "cluster.py", CLUSTER, &arguments)?;
    let part = |name: &str| parts.seconds(&[name]);
    let case = |what: &str| format!("{CLUSTER}: {what}");
    let build = format!("hills, {BUILD} x {BUILD}");
    let (one, two) = (part("one worker")?, part("two workers")?);
    let figure = |case: String, ours: f64, unit, other: (&'static str, f64), target| Figure {
        case,
        ours,
        unit,
        other: Some(other),
        target,
    };
    let scheduler = format!("scheduler and client after {many} tasks");
    Ok(vec![
        figure(case(&format!("{build}, two workers")), two, "s", ("one worker", one), Target::FasterBy(1.8)),
        figure(
            case(&format!("{build}, one worker")),
            one,
            "s",
            ("one process", part("one process")?),
            Target::RatioAtMost(1.05),
        ),
        figure(case("peak of a worker"), part("worker")?, "MB", ("limit", part("limit")?), Target::RatioAtMost(1.0)),
        figure(
            case(&scheduler),
            part(&format!("memory, {many}"))?,
            "MB",
            ("after a tenth", part(&format!("memory, {few}"))?),
            Target::RatioAtMost(1.1),
        ),
        Figure {
            case: case("a task that does nothing"),
            ours: 1e3 * part(&format!("CPU, {many}"))?,
            unit: "ms of CPU",
            other: None,
            target: Target::None,
        },
    ])
}

/// Seconds of CPU of a call in Rust.
fn seconds(case: &Case, heights: &Grid) -> Result<f64, String> {
    // A world has threads of its own.
    let start = ProcessTime::now();
    (case.rust)(std::hint::black_box(heights)).map_err(|e| e.to_string())?;
    Ok(start.elapsed().as_secs_f64())
}

fn window(_: &Grid) -> Result<(), orogen::Error> {
    let Some(preset) = presets::find("hills") else { return Ok(()) };
    let world = World::open(preset.recipe()?)?;
    let Some(size) = world.recipe().world.size else { return Ok(()) };
    let cell = size[0] / WINDOW as f64;
    world.window("height", &Window::new(WINDOW, WINDOW, cell)).map(drop)
}

fn filled(heights: &Grid) -> Result<(), orogen::Error> {
    let drained = drainage::route_carving(heights, &Outlets::new(heights, None), Descent::Steepest);
    std::hint::black_box(fill::filled(heights, &drained.basins));
    Ok(())
}

fn accumulated(heights: &Grid) -> Result<(), orogen::Error> {
    let drained = drainage::route_carving(heights, &Outlets::new(heights, None), Descent::Steepest);
    std::hint::black_box(accumulate(&drained.receivers).areas());
    Ok(())
}

fn sloped(heights: &Grid) -> Result<(), orogen::Error> {
    std::hint::black_box(slope_degrees(&extended(heights)));
    Ok(())
}

fn shaded(heights: &Grid) -> Result<(), orogen::Error> {
    std::hint::black_box(hillshade(&extended(heights), &Light::new(315.0, 45.0, 1.0)));
    Ok(())
}

/// Columns and rows of noise.
fn axis() -> Vec<f64> {
    (0..NOISE).map(|i| i as f64).collect()
}

fn perlin(_: &Grid) -> Result<(), orogen::Error> {
    let axis = axis();
    let mut out = vec![0.0; NOISE * NOISE];
    let noise = Fractal::new(0, 64.0).with_kind(Kind::Fbm).with_octaves(6);
    let filled = noise.fill(&Points::Lattice { xs: &axis, ys: &axis }, &mut out);
    debug_assert!(filled.is_ok(), "one sample for each position");
    std::hint::black_box(out);
    Ok(())
}

fn simplex(_: &Grid) -> Result<(), orogen::Error> {
    let axis = axis();
    let mut out = vec![0.0; NOISE * NOISE];
    let filled = OpenSimplex2::new(0, 64.0).fill(&Points::Lattice { xs: &axis, ys: &axis }, &mut out);
    debug_assert!(filled.is_ok(), "one sample for each position");
    std::hint::black_box(out);
    Ok(())
}
