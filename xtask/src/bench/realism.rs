//! `cargo xtask bench realism`: compares presets with real terrain, using a script and real places that are not part of
//! the project. Mountains are compared with all places, other presets with land of their type, which the script
//! defines.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, Result, on_file};
use crate::{host, shell, table};

/// A case: the window and its targets.
struct Case {
    preset: &'static str,
    /// The name in the table.
    name: &'static str,
    land: Land,
    targets: Targets,
}

/// The real land with which a preset is compared, and the compared samples of the preset.
enum Land {
    /// All places of the folder, compared with [`SIDE`] x [`SIDE`] samples at [`CELL`] metres, starting from this
    /// sample.
    Any([i64; 2]),
    /// All places, compared with as many samples around the highest place within 490 km of this sample: land elsewhere
    /// may be sea or plain.
    Highest([i64; 2]),
    /// All places, compared with the whole world at a cell in metres.
    Whole(u32),
    /// Land of this type, compared with the whole world at a cell in metres.
    Type(&'static str, u32),
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

const MOUNTAINS: Targets =
    Targets { median: 0.72, p90: 0.90, energy: 0.42, outliers: 0.0, bias: 0.010, worst_bias: 0.020, judged: 0.9 };

const ENDLESS: Targets =
    Targets { median: 0.82, p90: 1.0, energy: 0.5, outliers: 0.0, bias: 0.010, worst_bias: 0.020, judged: 0.0 };

const TYPED: Targets =
    Targets { median: 0.90, p90: ANY, energy: 1.0, outliers: 1.0, bias: ANY, worst_bias: ANY, judged: 0.0 };

const CASES: &[Case] = &[
    Case { preset: "alpine", name: "alpine", land: Land::Any([0, 0]), targets: MOUNTAINS },
    Case { preset: "himalaya", name: "himalaya", land: Land::Whole(90), targets: MOUNTAINS },
    // The origin is in mountains; land elsewhere may be sea or plain.
    Case { preset: "endless", name: "endless", land: Land::Any([-512, -512]), targets: ENDLESS },
    // 10 000 km from the origin, across the borders of the tiles of all levels.
    Case { preset: "endless", name: "endless, 10 000 km out", land: Land::Highest([FAR, -FAR]), targets: ENDLESS },
    Case { preset: "rolling", name: "rolling", land: Land::Type("rolling_hills", 30), targets: TYPED },
    Case { preset: "hills", name: "hills", land: Land::Type("rolling_hills", 30), targets: TYPED },
    Case { preset: "island", name: "island", land: Land::Type("islands_coasts", 40), targets: TYPED },
    Case { preset: "archipelago", name: "archipelago", land: Land::Type("islands_coasts", 40), targets: TYPED },
    Case { preset: "volcano", name: "volcano", land: Land::Type("volcanoes", 40), targets: TYPED },
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
    shell::run(measure.arg(&score).arg("--features").arg(&real).args(rasters(dems)?))?;
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
        let mut compare = shell::program(&python);
        compare.arg(&score);
        match case.land {
            Land::Any(_) | Land::Highest(_) | Land::Whole(_) => compare.arg("--real").arg(&real),
            Land::Type(name, _) => compare.args(["--type", name]),
        };
        let said = shell::capture(compare.args(&files))?;
        let found = read(&said).ok_or_else(|| Failure::new(format!("the script's answer has no score:\n{said}")))?;
        rows.push(cells(case, &found));
        missed.extend(misses(case, &found));
        for file in files {
            std::fs::remove_file(&file).map_err(|e| on_file("delete", &file, &e))?;
        }
    }
    println!("{}, {}", host::date(), host::processor());
    println!("seeds {first} to {}\n", first + SEEDS - 1);
    println!("{}", table::render(&HEAD, &rows));
    if missed.is_empty() { Ok(()) } else { Err(Failure::new(missed.join("\n"))) }
}

const HEAD: [&str; 9] = ["preset", "beside", "judged", "median", "p90", "energy", "outliers", "grid bias", "its worst"];

fn cells(case: &Case, score: &Score) -> Vec<String> {
    let beside = match case.land {
        Land::Any(_) | Land::Highest(_) => format!("all, at {CELL} m"),
        Land::Whole(cell) => format!("all, at {cell} m"),
        Land::Type(name, cell) => format!("{}, at {cell} m", name.replace('_', " ")),
    };
    vec![
        case.name.to_owned(),
        beside,
        format!("{} of {}", score.judged, score.judged + score.dropped),
        format!("{:.2}", score.median),
        format!("{:.2}", score.p90),
        format!("{:.2}", score.energy),
        format!("{}", score.outliers),
        format!("{:.3}", score.bias),
        format!("{:.3}", score.worst_bias),
    ]
}

/// A message for each missed target.
fn misses(case: &Case, score: &Score) -> Vec<String> {
    let targets = &case.targets;
    let most = [
        ("median score", score.median, targets.median),
        ("p90", score.p90, targets.p90),
        ("energy", score.energy, targets.energy),
        ("outliers", score.outliers, targets.outliers),
        ("grid bias", score.bias, targets.bias),
        ("worst grid bias", score.worst_bias, targets.worst_bias),
    ];
    let over = most.into_iter().filter(|(_, found, most)| found.is_nan() || found > most);
    let mut missed: Vec<String> =
        over.map(|(what, found, most)| format!("{}: {what} {found}, more than {most}", case.name)).collect();
    let share = score.judged / (score.judged + score.dropped).max(1.0);
    if share < targets.judged {
        missed.push(format!("{}: {:.0} % judged, less than {:.0} %", case.name, share * 100.0, targets.judged * 100.0));
    }
    missed
}

fn make(program: &Path, case: &Case, seed: u64, file: &Path) -> Result {
    let window = match case.land {
        Land::Any(at) => Some(at),
        Land::Highest(at) => Some(highest(program, case, seed, at)?.map(|index| index - i64::from(SIDE) / 2)),
        Land::Whole(_) | Land::Type(..) => None,
    };
    let mut command = shell::program(program);
    command.args(["export", case.preset, "--quiet", "--seed", &seed.to_string()]);
    // Models of real heights have the surface of lakes, not their beds.
    if !matches!(case.land, Land::Type(..)) {
        command.args(["--layer", "surface"]);
    }
    match (window, &case.land) {
        (Some([x, y]), _) => command.args(["--cell", &CELL.to_string(), "--window", &format!("{x},{y},{SIDE},{SIDE}")]),
        (None, Land::Whole(cell) | Land::Type(_, cell)) => command.args(["--cell", &cell.to_string()]),
        (None, _) => &mut command,
    };
    shell::run(command.arg("-o").arg(file))
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
fn rasters(dems: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(dems).map_err(|e| on_file("read", dems, &e))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(|e| on_file("read", dems, &e))?.path();
        if path.extension().is_some_and(|extension| extension == "tif") {
            files.push(std::path::absolute(&path).map_err(|e| on_file("find", &path, &e))?);
        }
    }
    files.sort();
    match files.is_empty() {
        true => Err(Failure::new(format!("there is no .tif in {}", dems.display()))),
        false => Ok(files),
    }
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
    fn what_misses_is_named() {
        let mut score = read(SAID).expect("well formed");
        let missed = misses(&CASES[0], &score);
        assert_eq!(missed, ["alpine: outliers 1, more than 0", "alpine: worst grid bias 0.035, more than 0.02"]);
        (score.outliers, score.worst_bias, score.judged, score.dropped) = (0.0, 0.01, 100.0, 50.0);
        assert_eq!(misses(&CASES[0], &score), ["alpine: 67 % judged, less than 90 %"]);
    }
}
