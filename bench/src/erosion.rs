//! Area `erosion`: hydrology and filters compared with richdem, fastscapelib and matplotlib, in memory, CPU time of one
//! thread.

use std::path::Path;

use cpu_time::ThreadTime;
use orogen::grid::hydrology::steepest::Descent;
use orogen::grid::hydrology::{Outlets, StreamPower, Substrate, accumulate, drainage, fill};
use orogen::{Grid, Recipe, Window, World};
use serde_json::{Value, json};

use crate::measure::median;
use crate::options::Options;
use crate::peer::Parts;
use crate::world::figure::Figure;
use crate::{filters, peer, sizes};

/// Metres between the samples of [`ground`].
pub const CELL: f64 = 60.0;

/// The peers, each with the environment variable that has the path of its Python. `cargo xtask bench` installs the
/// peers and sets the variables.
const PEERS: [(&str, &str); 3] =
    [("richdem", "OROGEN_RICHDEM"), ("fastscapelib", "OROGEN_FASTSCAPELIB"), ("matplotlib", "OROGEN_MATPLOTLIB")];

/// A case: its name, side, our time in seconds, the peer and its parts that do the same work, and the required ratio.
struct Case {
    name: &'static str,
    side: usize,
    ours: fn(&Grid),
    peer: usize,
    parts: &'static [&'static str],
    target: Option<f64>,
}

const CASES: &[Case] = &[
    Case { name: "depressions filled", side: 2048, ours: |g| drop(filled(g)), peer: 0, parts: &["fill"], target: None },
    Case {
        name: "filled, flats drained, D8, accumulation",
        side: 2048,
        ours: over_surface,
        peer: 0,
        parts: &["fill", "flats", "accumulation"],
        target: Some(3.0),
    },
    Case {
        name: "filled, drained over the bed, accumulation (richdem: flats left undrained)",
        side: 2048,
        ours: route_carving,
        peer: 0,
        parts: &["fill", "accumulation"],
        target: Some(3.0),
    },
    Case {
        name: "stream power step with routing",
        side: 1024,
        ours: step,
        peer: 1,
        parts: &["step"],
        target: Some(5.0),
    },
    Case {
        name: "stream power step with routing",
        side: 2048,
        ours: step,
        peer: 1,
        parts: &["step"],
        target: Some(5.0),
    },
    Case { name: "hillshade", side: 2048, ours: filters::shaded, peer: 2, parts: &["hillshade"], target: Some(5.0) },
];

/// Runs the cases.
pub fn run(options: &Options) -> Result<Value, String> {
    let folder = std::env::temp_dir().join(format!("orogen-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let rows = measured(options, &folder);
    // The folder has only files that were made here.
    let _ = std::fs::remove_dir_all(&folder);
    Ok(json!({ "area": "erosion", "simd": orogen_simd::Level::current().name(), "threads": 1, "rows": rows? }))
}

fn measured(options: &Options, folder: &Path) -> Result<Vec<Value>, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let mut rows = Vec::new();
    for case in CASES.iter().filter(|case| case.name.contains(&options.case)) {
        eprintln!("{} ...", case.name);
        let ground = ground(case.side)?;
        let (name, variable) = PEERS[case.peer];
        let theirs = match std::env::var_os(variable) {
            Some(python) => {
                let file = peer::ground_file(folder, &ground)?.display().to_string();
                let arguments = [file, CELL.to_string(), options.repetitions.to_string()];
                Some(Parts::measure(Path::new(&python), "erosion.py", name, &arguments)?.seconds(case.parts)?)
            }
            None => None,
        };
        let mut times: Vec<f64> =
            (0..options.repetitions).map(|_| pool.install(|| seconds(case.ours, &ground))).collect();
        let ours = median(&mut times);
        let ratio = theirs.map(|theirs| theirs / ours);
        let round = |x: f64| (x * 1000.0).round() / 1000.0;
        rows.push(json!({
            "case": format!("{}, {side} x {side}", case.name, side = case.side),
            "ours": round(ours), "unit": "s of CPU",
            "peer": theirs.map(|_| name), "peer_value": theirs.map(round), "ratio": ratio.map(round),
            "target": case.target, "met": case.target.map(|target| ratio.is_some_and(|ratio| ratio >= target)),
        }));
    }
    rows.extend(filters::figures(options, ground)?.iter().map(Figure::json));
    rows.extend(sizes::figures(options)?.iter().map(Figure::json));
    Ok(rows)
}

/// Rough terrain with depressions: ten octaves of fBm with a relief of 3000 m.
pub fn ground(side: usize) -> Result<Grid, String> {
    let text = "orogen = 1\n[world]\nseed = 3\n[nodes.noise]\nop = \"fbm\"\nwavelength = 20000\noctaves = 10\n\
                [nodes.ground]\nop = \"remap\"\nsource = \"noise\"\nto = [0, 3000]\n[outputs]\nheight = \"ground\"\n";
    let world = Recipe::parse(text, "ground").and_then(World::open).map_err(|e| e.to_string())?;
    world.window("height", &Window::new(side, side, CELL)).map_err(|e| e.to_string())
}

fn seconds(work: fn(&Grid), ground: &Grid) -> f64 {
    let start = ThreadTime::now();
    work(std::hint::black_box(ground));
    start.elapsed().as_secs_f64()
}

fn filled(ground: &Grid) -> Grid {
    fill(ground, &Outlets::new(ground, None))
}

fn over_surface(ground: &Grid) {
    let outlets = Outlets::new(ground, None);
    let filled = fill(ground, &outlets);
    std::hint::black_box(accumulate(&drainage::over_surface(&filled, &outlets, Descent::Steepest)));
}

fn route_carving(ground: &Grid) {
    let outlets = Outlets::new(ground, None);
    let drained = drainage::route_carving(ground, &outlets, Descent::Steepest);
    std::hint::black_box((fill::filled(ground, &drained.basins), accumulate(&drained.receivers)));
}

fn step(ground: &Grid) {
    let mut heights = ground.clone();
    let receivers = drainage::route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
    StreamPower::default().step(&mut heights, &receivers, &accumulate(&receivers), &Substrate::default(), 3e4);
    std::hint::black_box(heights);
}
