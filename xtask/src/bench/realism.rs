//! `cargo xtask bench realism`: compares presets with real terrain, using a script and real places that are not part of
//! the project: with all places, and with land of their own type, which the script defines.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::failure::{Failure, Result, on_file};
use crate::{host, shell, table};

/// A preset, what is made of it, and what it is compared with.
struct Case {
    preset: &'static str,
    /// The name in the table.
    name: &'static str,
    made: Made,
    beside: &'static [Beside],
}

/// The compared samples of a preset.
#[derive(Clone, Copy)]
enum Made {
    /// [`SIDE`] x [`SIDE`] samples at [`CELL`] metres from this sample.
    From([i64; 2]),
    /// As many samples around the highest place within 490 km of this sample: land elsewhere may be sea or plain.
    Highest([i64; 2]),
    /// The whole world at a cell in metres.
    World(u32),
}

/// Real land that a preset is compared with, and the targets.
struct Beside {
    /// The type of land; all places of the folder if it is absent.
    kind: Option<&'static str>,
    targets: Targets,
}

/// Maximum values of the figures.
struct Targets {
    median: f64,
    p90: f64,
    energy: f64,
    outliers: f64,
    bias: f64,
    worst_bias: f64,
    /// Minimum share of windows that are judged.
    judged: f64,
}

/// No target.
const ANY: f64 = f64::INFINITY;

const MOUNTAINS: Beside = Beside {
    kind: None,
    targets: Targets {
        median: 0.72,
        p90: 0.90,
        energy: 0.42,
        outliers: 0.0,
        bias: 0.010,
        worst_bias: 0.020,
        judged: 0.9,
    },
};

const ENDLESS: Beside = Beside {
    kind: None,
    targets: Targets {
        median: 0.82,
        p90: 1.0,
        energy: 0.5,
        outliers: 0.0,
        bias: 0.010,
        worst_bias: 0.020,
        judged: 0.0,
    },
};

const fn land(kind: &'static str) -> Beside {
    let targets =
        Targets { median: 0.90, p90: ANY, energy: 1.0, outliers: 1.0, bias: ANY, worst_bias: ANY, judged: 0.0 };
    Beside { kind: Some(kind), targets }
}

const fn case(preset: &'static str, made: Made, beside: &'static [Beside]) -> Case {
    Case { preset, name: preset, made, beside }
}

const CASES: &[Case] = &[
    case("alpine", Made::From([0, 0]), &[MOUNTAINS, land("alpine")]),
    case("himalaya", Made::World(90), &[MOUNTAINS, land("alpine")]),
    case("dla-peaks", Made::World(40), &[land("alpine")]),
    case("glaciers", Made::World(60), &[land("glacial")]),
    case("fjords", Made::World(60), &[land("glacial")]),
    // The origin is in mountains; land elsewhere may be sea or plain.
    case("endless", Made::From([-512, -512]), &[ENDLESS]),
    // 10 000 km from the origin, across the borders of the tiles of all levels.
    Case { preset: "endless", name: "endless, 10 000 km out", made: Made::Highest([FAR, -FAR]), beside: &[ENDLESS] },
    // Their real windows have cells of 10 to 90 m.
    case("rolling", Made::World(45), &[land("rolling_hills")]),
    case("hills", Made::World(45), &[land("rolling_hills")]),
    case("island", Made::World(40), &[land("islands_coasts")]),
    case("archipelago", Made::World(40), &[land("islands_coasts")]),
    case("volcano", Made::World(40), &[land("volcanoes")]),
    case("canyon", Made::World(30), &[land("canyons")]),
    case("mesa", Made::World(30), &[land("canyons")]),
    // Among the deserts is the basin of Guadix and Baza, which is badlands.
    case("badlands", Made::World(30), &[land("deserts")]),
    case("basin", Made::World(60), &[land("deserts")]),
];

/// Presets that no real land at the cells of the script is like, and why.
#[cfg(test)]
const NOT_JUDGED: &[(&str, &str)] = &[
    ("biomes", "its cells are 800 m"),
    ("caves", "its land is blocks of a metre"),
    ("classic", "it is noise, for textbooks"),
    ("continent", "its land is that of `endless`"),
    ("craters", "its land is that of the Moon"),
    ("dunes", "no type of real land is sand"),
    ("floodplain", "most of its windows are too flat to be judged"),
    ("folds", "no type of real land is a fold belt"),
    ("karst", "its type has one real place, too few for a unit of distance"),
    ("tile-continent", "its land is made to be read as tiles"),
    ("tile-island", "its land is made to be read as tiles"),
];

/// Samples per side, and the cell in metres, as the script expects.
const SIDE: u32 = 1024;
const CELL: u32 = 60;

/// 10 066 km in samples, a border of the tiles of all levels: a coarsest tile has 128 x 2048 samples per side.
const FAR: i64 = 640 << 18;

/// The cell at which the highest place is searched, in samples.
const FAR_CELL: i64 = 128;
/// Side of the window in which the highest place is searched, in samples at that cell.
const FAR_SIDE: i64 = 128;

/// Options of area `realism`.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Options {
    pub score: Option<PathBuf>,
    pub dems: Option<PathBuf>,
    /// The first of sixteen seeds; by default taken from the clock, so that they are new.
    pub first: Option<u64>,
    /// Only cases whose name contains this.
    pub case: Option<String>,
    /// Only one half of the real regions.
    pub half: Option<Half>,
}

/// A half of the real regions: every second one of each type, by name. What is tuned on one is reported on the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    First,
    Second,
}

impl Half {
    /// Parses the value of `--half`.
    pub fn parse(text: &str) -> Result<Self> {
        match text {
            "first" => Ok(Self::First),
            "second" => Ok(Self::Second),
            _ => Err(Failure::usage(format!("--half is 'first' or 'second', not '{text}'"))),
        }
    }

    /// Whether a region is in this half, by its index among those of its type.
    const fn has(self, index: usize) -> bool {
        index % 2 == self as usize
    }
}

const SEEDS: u64 = 16;

/// The result of the script.
#[derive(Debug, PartialEq)]
struct Score {
    judged: f64,
    dropped: f64,
    median: f64,
    p90: f64,
    energy: f64,
    outliers: f64,
    bias: f64,
    worst_bias: f64,
}

/// Runs the measurements, prints a table, and fails if a figure misses its target.
pub fn run(options: &Options, program: &Path) -> Result {
    let (Some(score), Some(dems)) = (&options.score, &options.dems) else {
        return Err(Failure::usage("realism needs --score SCRIPT and --dems DIR: neither is part of the project"));
    };
    let score = std::path::absolute(score).map_err(|e| on_file("find", score, &e))?;
    let python = python()?;
    let folder = shell::target_dir().join("bench").join("realism-made");
    shell::empty_dir(&folder)?;
    let real = folder.join("real.json");
    let mut measure = shell::program(&python);
    shell::run(measure.arg(&score).arg("--features").arg(&real).args(rasters(dems, options.half)?))?;
    let types = options.half.map(|half| write_half(half, &score, &folder)).transpose()?;
    let first = options.first.unwrap_or_else(clock);
    let mut rows = Vec::new();
    let mut missed = Vec::new();
    for case in CASES.iter().filter(|case| options.case.as_ref().is_none_or(|text| case.name.contains(text))) {
        let mut files = Vec::new();
        for seed in first..first + SEEDS {
            let file = folder.join(format!("{}-{seed}.tif", case.preset));
            make(program, case, seed, &file)?;
            files.push(file);
        }
        for beside in case.beside {
            let mut compare = shell::program(&python);
            compare.arg(&score);
            match (beside.kind, &types) {
                (None, _) => compare.arg("--real").arg(&real),
                (Some(kind), None) => compare.args(["--type", kind]),
                (Some(kind), Some(types)) => compare.arg("--real").arg(types).args(["--type", kind]),
            };
            let said = shell::capture(compare.args(&files))?;
            let found =
                read(&said).ok_or_else(|| Failure::new(format!("the script's answer has no score:\n{said}")))?;
            rows.push(cells(case, beside, &found));
            missed.extend(misses(case, beside, &found));
        }
        for file in files {
            std::fs::remove_file(&file).map_err(|e| on_file("delete", &file, &e))?;
        }
    }
    println!("{}, {}", host::date(), host::processor());
    let regions = match options.half {
        None => "all real regions",
        Some(Half::First) => "the first half of the real regions",
        Some(Half::Second) => "the second half of the real regions",
    };
    println!("seeds {first} to {}, {regions}\n", first + SEEDS - 1);
    println!("{}", table::render(&HEAD, &rows));
    if missed.is_empty() { Ok(()) } else { Err(Failure::new(missed.join("\n"))) }
}

const HEAD: [&str; 9] = ["preset", "beside", "judged", "median", "p90", "energy", "outliers", "grid bias", "its worst"];

fn cells(case: &Case, beside: &Beside, score: &Score) -> Vec<String> {
    let land = beside.kind.map_or_else(|| "all".to_owned(), |kind| kind.replace('_', " "));
    let cell = match case.made {
        Made::From(_) | Made::Highest(_) => CELL,
        Made::World(cell) => cell,
    };
    vec![
        case.name.to_owned(),
        format!("{land}, at {cell} m"),
        format!("{} of {}", score.judged, score.judged + score.dropped),
        format!("{:.2}", score.median),
        format!("{:.2}", score.p90),
        if score.energy.is_nan() { "-".to_owned() } else { format!("{:.2}", score.energy) },
        format!("{}", score.outliers),
        format!("{:.3}", score.bias),
        format!("{:.3}", score.worst_bias),
    ]
}

/// A message for each missed target.
fn misses(case: &Case, beside: &Beside, score: &Score) -> Vec<String> {
    let targets = &beside.targets;
    let name = match beside.kind {
        None => case.name.to_owned(),
        Some(kind) => format!("{} beside {}", case.name, kind.replace('_', " ")),
    };
    // Without a region of five windows the script has no unit of the energy.
    let energy = if beside.kind.is_some() && score.energy.is_nan() { 0.0 } else { score.energy };
    let most = [
        ("median score", score.median, targets.median),
        ("p90", score.p90, targets.p90),
        ("energy", energy, targets.energy),
        ("outliers", score.outliers, targets.outliers),
        ("grid bias", score.bias, targets.bias),
        ("worst grid bias", score.worst_bias, targets.worst_bias),
    ];
    let over = most.into_iter().filter(|(_, found, most)| found.is_nan() || found > most);
    let mut missed: Vec<String> =
        over.map(|(what, found, most)| format!("{name}: {what} {found}, more than {most}")).collect();
    let share = score.judged / (score.judged + score.dropped).max(1.0);
    if share < targets.judged {
        missed.push(format!("{name}: {:.0} % judged, less than {:.0} %", share * 100.0, targets.judged * 100.0));
    }
    missed
}

fn make(program: &Path, case: &Case, seed: u64, file: &Path) -> Result {
    let mut command = shell::program(program);
    let layer = layer(case.preset)?;
    command.args(["export", case.preset, "--quiet", "--layer", layer, "--seed", &seed.to_string()]);
    let corner = match case.made {
        Made::From(at) => Some(at),
        Made::Highest(at) => Some(highest(program, case, seed, at)?.map(|index| index - i64::from(SIDE) / 2)),
        Made::World(_) => None,
    };
    match (corner, case.made) {
        (Some([x, y]), _) => command.args(["--cell", &CELL.to_string(), "--window", &format!("{x},{y},{SIDE},{SIDE}")]),
        (None, Made::World(cell)) => command.args(["--cell", &cell.to_string()]),
        (None, _) => &mut command,
    };
    shell::run(command.arg("-o").arg(file))
}

/// The layer of a preset that is compared. Models of real heights have the surface of lakes and of the sea, not their
/// beds.
fn layer(preset: &str) -> Result<&'static str> {
    let recipe = shell::root().join(format!("crates/orogen-engine/recipes/{preset}.toml"));
    let text = std::fs::read_to_string(&recipe).map_err(|e| on_file("read", &recipe, &e))?;
    Ok(if text.lines().any(|line| line.starts_with("surface = ")) { "surface" } else { "height" })
}

/// The sample at the highest place around a sample, found at a larger cell.
fn highest(program: &Path, case: &Case, seed: u64, at: [i64; 2]) -> Result<[i64; 2]> {
    let first = at.map(|index| index / FAR_CELL - FAR_SIDE / 2);
    let window = format!("{},{},{FAR_SIDE},{FAR_SIDE}", first[0], first[1]);
    let cell = (i64::from(CELL) * FAR_CELL).to_string();
    let mut command = shell::program(program);
    command.args(["export", case.preset, "--quiet", "--seed", &seed.to_string(), "--cell", &cell, "--window", &window]);
    let text = shell::capture(command.args(["--format", "asc", "-o", "-"]))?;
    // A header of lines that begin with a letter, then rows from north to south.
    let rows = text.lines().filter(|line| !line.trim_start().starts_with(|first: char| first.is_ascii_alphabetic()));
    let mut best = (f64::NEG_INFINITY, first);
    for (row, y) in rows.zip(first[1]..) {
        for (height, x) in row.split_whitespace().filter_map(|word| word.parse::<f64>().ok()).zip(first[0]..) {
            if height > best.0 {
                best = (height, [x, y].map(|index| index * FAR_CELL));
            }
        }
    }
    Ok(best.1)
}

/// The real places, sorted by name.
fn rasters(dems: &Path, half: Option<Half>) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(dems).map_err(|e| on_file("read", dems, &e))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| on_file("read", dems, &e))?.path();
        if path.extension().is_some_and(|extension| extension == "tif") {
            files.push(std::path::absolute(&path).map_err(|e| on_file("find", &path, &e))?);
        }
    }
    files.sort();
    let halved = files.into_iter().enumerate().filter(|(index, _)| half.is_none_or(|half| half.has(*index)));
    let files: Vec<PathBuf> = halved.map(|(_, path)| path).collect();
    match files.is_empty() {
        true => Err(Failure::new(format!("there is no .tif in {}", dems.display()))),
        false => Ok(files),
    }
}

/// Writes the windows of one half of the regions of each type, as the script reads them.
fn write_half(half: Half, score: &Path, folder: &Path) -> Result<PathBuf> {
    let path = score.with_file_name("types.json");
    let text = std::fs::read_to_string(&path).map_err(|e| on_file("read", &path, &e))?;
    let windows: Vec<Value> =
        serde_json::from_str(&text).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
    let kept = halved(half, windows);
    let file = folder.join("types-half.json");
    std::fs::write(&file, Value::Array(kept).to_string()).map_err(|e| on_file("write", &file, &e))?;
    Ok(file)
}

/// The windows of one half of the regions of each type.
fn halved(half: Half, windows: Vec<Value>) -> Vec<Value> {
    let word = |window: &Value, key: &str| window[key].as_str().unwrap_or_default().to_owned();
    let mut regions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for window in &windows {
        regions.entry(word(window, "type")).or_default().insert(word(window, "region"));
    }
    let is_kept = |window: &Value| {
        let region = word(window, "region");
        let index = regions[&word(window, "type")].iter().position(|other| *other == region);
        index.is_some_and(|index| half.has(index))
    };
    windows.into_iter().filter(is_kept).collect()
}

/// A Python with the script's packages: `OROGEN_REALISM`, or one in the target folder.
fn python() -> Result<PathBuf> {
    if let Some(python) = std::env::var_os("OROGEN_REALISM") {
        return Ok(python.into());
    }
    let venv = shell::target_dir().join("bench").join("realism");
    let python = venv.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let imports = || shell::succeeds(shell::program(&python).args(["-c", "import scipy, rasterio, numba"]));
    if python.is_file() && imports() {
        return Ok(python);
    }
    eprintln!("installing scipy, rasterio and numba ...");
    shell::run(shell::program("python3").args(["-m", "venv", "--clear"]).arg(&venv))?;
    let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check"];
    shell::run(shell::program(&python).args(install).args(["numpy", "scipy", "rasterio", "numba"]))?;
    Ok(python)
}

fn clock() -> u64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(1, |time| time.as_secs())
}

/// Parses the script's lines: a name, then numbers among words.
fn read(said: &str) -> Option<Score> {
    let numbers = |name: &str| -> Option<Vec<f64>> {
        let line = said.lines().find_map(|line| line.strip_prefix(name))?;
        Some(line.split_whitespace().filter_map(|word| word.parse().ok()).collect())
    };
    let of = |name: &str, i: usize| numbers(name)?.get(i).copied();
    Some(Score {
        judged: of("windows", 0)?,
        dropped: of("windows", 1)?,
        median: of("score", 0)?,
        p90: of("score", 1)?,
        energy: of("energy", 0)?,
        outliers: of("outliers", 0)?,
        bias: of("grid bias", 0)?,
        worst_bias: of("grid bias", 1)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAID: &str = "\
windows    250  too flat 6
score      median 0.70  p90 0.85   (real 1.00, 1.38)
energy     0.41 x a real region
outliers   1  fill_asym -2.3
grid bias  median 0.006  max 0.035   (real 0.006, 0.014)
";

    #[test]
    fn the_answer_is_read() {
        let score = read(SAID).expect("well formed");
        let expect = Score {
            judged: 250.0,
            dropped: 6.0,
            median: 0.70,
            p90: 0.85,
            energy: 0.41,
            outliers: 1.0,
            bias: 0.006,
            worst_bias: 0.035,
        };
        assert_eq!(score, expect);
        assert_eq!(read("windows 3"), None);
    }

    #[test]
    fn presets_without_lakes_are_compared_by_their_heights() {
        assert_eq!(layer("hills").ok(), Some("surface"));
        assert_eq!(layer("mesa").ok(), Some("height"));
    }

    #[test]
    fn what_misses_is_named() {
        let mut score = read(SAID).expect("well formed");
        let missed = misses(&CASES[0], &MOUNTAINS, &score);
        assert_eq!(missed, ["alpine: outliers 1, more than 0", "alpine: worst grid bias 0.035, more than 0.02"]);
        (score.outliers, score.worst_bias, score.judged, score.dropped) = (0.0, 0.01, 100.0, 50.0);
        assert_eq!(misses(&CASES[0], &MOUNTAINS, &score), ["alpine: 67 % judged, less than 90 %"]);
        (score.median, score.energy) = (0.95, f64::NAN);
        let missed = misses(&CASES[0], &land("alpine"), &score);
        assert_eq!(missed, ["alpine beside alpine: median score 0.95, more than 0.9"]);
    }

    #[test]
    fn the_halves_share_no_region() {
        let window = |kind: &str, region: &str| serde_json::json!({ "type": kind, "region": region });
        let windows = vec![
            window("alpine", "b"),
            window("alpine", "a"),
            window("alpine", "a"),
            window("alpine", "c"),
            window("karst", "b"),
        ];
        let first = halved(Half::First, windows.clone());
        let second = halved(Half::Second, windows.clone());
        assert_eq!(first, [window("alpine", "a"), window("alpine", "a"), window("alpine", "c"), window("karst", "b")]);
        assert_eq!(second, [window("alpine", "b")]);
    }

    #[test]
    fn every_preset_is_judged_or_has_a_reason() {
        let recipes = shell::root().join("crates/orogen-engine/recipes");
        for entry in std::fs::read_dir(&recipes).expect("the presets are there") {
            let name = entry.expect("readable").file_name().into_string().expect("plain names");
            let Some(name) = name.strip_suffix(".toml") else { continue };
            let judged = CASES.iter().any(|case| case.preset == name);
            let excused = NOT_JUDGED.iter().any(|(other, why)| *other == name && !why.is_empty());
            assert!(judged != excused, "{name} is judged beside no land, and nothing says why, or both");
        }
    }
}
