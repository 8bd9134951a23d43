//! Adaptive meshes compared with pydelatin, CPU time of one thread; and the time to write the full grid.

use std::hint::black_box;

use cpu_time::ThreadTime;
use orogen::grid::analysis::halo::Halo;
use orogen::output::map::Painter;
use orogen::output::mesh::glb::write as write_glb;
use orogen::output::mesh::{Model, Shape, Surface, adaptive};
use orogen::{Grid, World};

use super::counted::Counted;
use super::ground::ground;
use super::python;
use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

const SIDE: usize = 1024;
/// The maximum error, as a share of the relief.
const SHARE: f64 = 0.01;

/// The environment variable with pydelatin's Python: `cargo xtask bench` installs it and sets this.
const PYTHON: &str = "OROGEN_PYDELATIN";

/// Measures on uniformly rough terrain and on the preset `alpine`.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let preset = orogen::presets::find("alpine").ok_or("there is no preset alpine")?;
    let world = preset.recipe().and_then(World::open).map_err(|e| e.to_string())?;
    let alpine =
        world.window_fitting(SIDE).and_then(|window| world.window("height", &window)).map_err(|e| e.to_string())?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let mut figures = Vec::new();
    for (name, grid) in [("alpine", &alpine), ("fbm", &ground(SIDE)?)] {
        figures.push(pool.install(|| few_triangles(name, grid, options))?);
    }
    figures.push(pool.install(|| full_grid(&alpine, options))?);
    Ok(figures)
}

/// CPU seconds of this thread for each repetition.
fn times<T>(repetitions: usize, mut work: impl FnMut() -> Result<T, String>) -> Result<Vec<f64>, String> {
    (0..repetitions)
        .map(|_| {
            let start = ThreadTime::now();
            black_box(work()?);
            Ok(start.elapsed().as_secs_f64())
        })
        .collect()
}

fn few_triangles(name: &str, grid: &Grid, options: &Options) -> Result<Figure, String> {
    let [low, high] = grid.data().iter().fold([f32::MAX, f32::MIN], |[l, h], v| [l.min(*v), h.max(*v)]).map(f64::from);
    let max_error = SHARE * (high - low);
    let theirs = pydelatin(grid, max_error, options.repetitions)?;
    // Our mesh gets the error that the peer reached.
    let max_error = theirs.as_ref().map_or(max_error, |theirs| theirs.error);
    let shape = adaptive(grid, max_error).map_err(|e| e.to_string())?;
    let error = shape.deviation(grid);
    if error > max_error {
        return Err(format!("the mesh of {name} is {error} m off, and {max_error} m were allowed"));
    }
    let mut ours = times(options.repetitions, || adaptive(black_box(grid), max_error).map_err(|e| e.to_string()))?;
    let mut case = format!("{name} {SIDE} x {SIDE} within {max_error:.2} m: {} triangles", shape.triangles());
    if let Some(theirs) = &theirs {
        case.push_str(&format!(", pydelatin {}", theirs.triangles));
        if shape.triangles() > theirs.triangles {
            return Err(format!("{case}: ours are more"));
        }
    }
    let other = theirs.map(|theirs| ("pydelatin", theirs.seconds));
    let target = if other.is_some() { Target::FasterBy(2.0) } else { Target::None };
    Ok(Figure { case, ours: median(&mut ours), unit: "s of CPU", other, target })
}

fn full_grid(grid: &Grid, options: &Options) -> Result<Figure, String> {
    let painter = Painter::fit(grid, 0.0);
    let mut bytes = Counted(0);
    let mut ours = times(options.repetitions, || {
        bytes.0 = 0;
        let shape = Shape::lattice(black_box(grid), 1).map_err(|e| e.to_string())?;
        let mut texture = Vec::new();
        let drawn = painter.write_png(&mut texture, grid, None, &[]);
        let halo = Halo::default();
        let levels = [Surface { grid, halo: &halo, shape: &shape, exaggeration: 1.0, painter: None, progress: None }];
        let model = Model {
            levels: &levels,
            texture: Some(&texture),
            normal_maps: &[],
            material: None,
            bodies: &[],
            water: &[],
            objects: &[],
            extras: serde_json::Map::new(),
        };
        drawn.and_then(|()| write_glb(&mut bytes, &model)).map_err(|e| e.to_string())
    })?;
    let mib = bytes.0 as f64 / f64::from(1 << 20);
    let case = format!(
        "GLB of {SIDE} x {SIDE}: all {} triangles, normals, texture, {mib:.0} MiB",
        2 * (SIDE - 1) * (SIDE - 1)
    );
    Ok(Figure { case, ours: median(&mut ours), unit: "s of CPU", other: None, target: Target::AtMost(0.3) })
}

struct Theirs {
    seconds: f64,
    triangles: usize,
    error: f64,
}

fn pydelatin(grid: &Grid, max_error: f64, repetitions: usize) -> Result<Option<Theirs>, String> {
    let arguments = [max_error.to_string(), repetitions.to_string()];
    let Some(told) = python::run(PYTHON, "meshes.py", grid, &arguments)? else { return Ok(None) };
    match (told.values["triangles"].as_u64(), told.values["error"].as_f64()) {
        (Some(triangles), Some(error)) => {
            Ok(Some(Theirs { seconds: told.seconds, triangles: triangles as usize, error }))
        }
        _ => Err("pydelatin did not tell what it made".into()),
    }
}
