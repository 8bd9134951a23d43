//! Part of area `erosion`: filters, and hillshade compared with matplotlib. CPU time of one thread; wall time of two
//! threads.

use std::time::Instant;

use cpu_time::ThreadTime;
use orogen::Grid;
use orogen::grid::analysis::slope::extended;
use orogen::grid::analysis::{Light, hillshade};
use orogen::grid::erosion::pipes::Wet;
use orogen::grid::erosion::planes::Planes;
use orogen::grid::erosion::{Droplets, LocalStreamPower, Pipes, Thermal, local_stream_power, pipes};

use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

/// Samples per side of the result.
pub const SIDE: usize = 1024;

/// Iterations of thermal weathering, of pipes and of local stream power.
const ITERATIONS: usize = 100;

/// Required speedup of two threads.
const FASTER: f64 = 1.8;

/// A measured filter: its halo on each side, and the maximum number of seconds.
struct Case {
    name: &'static str,
    halo: fn(f64) -> usize,
    work: fn(&Grid) -> Result<(), orogen::Error>,
    target: Option<f64>,
}

const CASES: &[Case] = &[
    Case { name: "pipes, 100 iterations within walls", halo: |_| 0, work: boxed, target: Some(0.6) },
    Case {
        name: "pipes, 100 iterations, with their halo",
        halo: |_| pipes::RADIUS * ITERATIONS,
        work: open,
        target: None,
    },
    Case {
        name: "droplets, 500 000 and those of their halo",
        halo: |cell| droplets(cell).halo(cell),
        work: |ground| droplets(ground.window().cell).run(ground, &orogen::Progress::none()).map(drop),
        target: Some(1.0),
    },
    Case { name: "thermal, 100 passes", halo: |_| ITERATIONS, work: thermal, target: None },
    Case {
        name: "local stream power, 100 iterations",
        halo: |_| local_stream_power::RADIUS * ITERATIONS,
        work: local,
        target: None,
    },
];

/// Measures the filters over terrain that `ground` makes for a side, each on one thread, then on two threads compared
/// with one.
pub fn figures(options: &Options, ground: impl Fn(usize) -> Result<Grid, String>) -> Result<Vec<Figure>, String> {
    let mut figures = Vec::new();
    let pools = [1, 2].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build());
    let [one, two] = pools.map(|pool| pool.map_err(|e| e.to_string()));
    let (one, two) = (one?, two?);
    for case in CASES.iter().filter(|case| case.name.contains(&options.case)) {
        eprintln!("{} ...", case.name);
        let cell = ground(1)?.window().cell;
        let ground = ground(SIDE + 2 * (case.halo)(cell))?;
        let work = || (case.work)(std::hint::black_box(&ground)).map_err(|e| e.to_string());
        let mut times = Vec::new();
        let mut best = [f64::INFINITY; 2];
        for _ in 0..options.repetitions {
            let (cpu, wall) = one.install(|| {
                let (cpu, wall) = (ThreadTime::now(), Instant::now());
                work().map(|()| (cpu.elapsed().as_secs_f64(), wall.elapsed().as_secs_f64()))
            })?;
            times.push(cpu);
            let both = two.install(|| {
                let wall = Instant::now();
                work().map(|()| wall.elapsed().as_secs_f64())
            })?;
            best = [best[0].min(wall), best[1].min(both)];
        }
        let ours = median(&mut times);
        figures.push(Figure {
            case: format!("{}, {SIDE} x {SIDE}", case.name),
            ours,
            unit: "s of CPU",
            other: None,
            target: case.target.map_or(Target::None, Target::AtMost),
        });
        figures.push(Figure {
            case: format!("{}, two threads", case.name),
            ours: best[1],
            unit: "s on the wall",
            other: Some(("one thread", best[0])),
            target: Target::FasterBy(FASTER),
        });
    }
    Ok(figures)
}

/// Hillshade of all samples, with an extrapolated border.
pub fn shaded(ground: &Grid) {
    std::hint::black_box(hillshade(&extended(ground), &Light::default()));
}

fn law() -> Pipes {
    Pipes::default()
        .with_rain(2e-3)
        .with_evaporation(0.01)
        .with_capacity(2.0)
        .with_erosion(0.3)
        .with_deposition(0.3)
        .with_pipe(1.0)
        .with_friction(0.05)
        .with_gravity(9.81)
        .with_time_step(5.0)
}

fn boxed(ground: &Grid) -> Result<(), orogen::Error> {
    law().enclosed(Wet::new(ground), ITERATIONS, &orogen::Progress::none()).map(|wet| _ = std::hint::black_box(wet))
}

fn open(ground: &Grid) -> Result<(), orogen::Error> {
    law().open(Wet::new(ground), ITERATIONS, &orogen::Progress::none()).map(|wet| _ = std::hint::black_box(wet))
}

fn thermal(ground: &Grid) -> Result<(), orogen::Error> {
    let law = Thermal::new(0.1).with_rate(1.0);
    law.run(ground, ITERATIONS, &orogen::Progress::none()).map(|heights| _ = std::hint::black_box(heights))
}

fn local(ground: &Grid) -> Result<(), orogen::Error> {
    let cell = ground.window().cell;
    let law = LocalStreamPower::new(cell)
        .with_years(2000.0)
        .with_erodibility(2e-5)
        .with_area_exponent(0.45)
        .with_slope_exponent(1.0)
        .with_uplift(2e-4)
        .with_deposition(0.5)
        .with_creep(0.01)
        .with_sea_level(Some(0.0));
    let mut planes = Planes::new(ground.width(), ground.height());
    for j in 0..ground.height() {
        planes.set(local_stream_power::HEIGHT, j, ground.row(j));
        planes.row_mut(j)[local_stream_power::AREA].fill((cell * cell) as f32);
    }
    law.run(planes, ITERATIONS, &orogen::Progress::none()).map(|planes| _ = std::hint::black_box(planes))
}

/// Beyer's parameters: 30 cells, a radius of 3.
fn droplets(cell: f64) -> Droplets {
    Droplets::default()
        .with_density(500_000.0 / (SIDE * SIDE) as f64 / (cell * cell) * 1e6)
        .with_batches(4)
        .with_lifetime(30.0 * cell)
        .with_radius(3.0 * cell)
        .with_inertia(0.05)
        .with_capacity(0.4)
        .with_least_slope(0.01)
        .with_erosion(0.3)
        .with_deposition(0.3)
        .with_evaporation(0.01 / cell)
        .with_gravity(4.0)
        .with_seed(1)
}
