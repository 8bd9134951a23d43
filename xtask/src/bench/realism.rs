//! `cargo xtask bench realism`: compares presets with windows of real land, those of mountains and those of their own
//! type, by the scripts of the folder `realism`.

mod judge;
mod leaderboard;
mod make;

use std::path::Path;

use judge::{Judge, Score};
pub use judge::{folder as scripts, python};
use make::Made;

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

/// Real land that a preset is compared with, and the targets.
struct Beside {
    /// The type of land.
    kind: &'static str,
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
    kind: "mountains",
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
    kind: "mountains",
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
    Beside { kind, targets }
}

const fn case(preset: &'static str, made: Made, beside: &'static [Beside]) -> Case {
    Case { preset, name: preset, made, beside }
}

const CASES: &[Case] = &[
    case("alpine", Made::From([0, 0], SIDE), &[MOUNTAINS, land("alpine")]),
    case("himalaya", Made::World(90), &[MOUNTAINS, land("alpine")]),
    case("dla-peaks", Made::World(40), &[land("alpine")]),
    case("glaciers", Made::World(60), &[land("glacial")]),
    case("fjords", Made::World(60), &[land("glacial")]),
    // The origin is in mountains; land elsewhere may be sea or plain.
    case("endless", Made::From([-512, -512], SIDE), &[ENDLESS]),
    // 10 000 km from the origin, across the borders of the tiles of all levels.
    Case { preset: "endless", name: "endless, 10 000 km out", made: Made::Highest([FAR, -FAR]), beside: &[ENDLESS] },
    // Their real windows have cells of 10 to 90 m.
    case("rolling", Made::World(45), &[land("rolling_hills")]),
    case("hills", Made::World(45), &[land("rolling_hills")]),
    // With a larger cell each window has more sea than is judged.
    case("island", Made::World(20), &[land("islands_coasts")]),
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

/// Samples per side of windows of mountains.
const SIDE: u32 = 1024;

/// 10 066 km in samples, a border of the tiles of all levels: a coarsest tile has 128 x 2048 samples per side.
const FAR: i64 = 640 << 18;

/// Options of area `realism`.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The first of the seeds; by default taken from the clock, so that they are new.
    pub first: Option<u64>,
    /// Only cases whose name contains this.
    pub case: Option<String>,
    /// Only one half of the real regions.
    pub half: Option<Half>,
    /// Other generators too, without targets.
    pub peers: bool,
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

    /// Its name, as the script expects it.
    const fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Second => "second",
        }
    }
}

const SEEDS: u64 = 16;

/// Runs the measurements, prints a table, and fails if a figure misses its target.
pub fn run(options: &Options, program: &Path) -> Result {
    let first = options.first.unwrap_or_else(clock);
    let is_named = |name: &str| options.case.as_ref().is_none_or(|text| name.contains(text));
    let judge = Judge::new(options.half)?;
    let folder = shell::target_dir().join("bench").join("realism-made");
    shell::empty_dir(&folder)?;
    if options.peers {
        return leaderboard::run(&judge, program, &folder, first, is_named);
    }
    let mut rows = Vec::new();
    let mut missed = Vec::new();
    for case in CASES.iter().filter(|case| is_named(case.name)) {
        let mut files = Vec::new();
        for seed in first..first + SEEDS {
            let file = folder.join(format!("{}-{seed}.tif", case.preset));
            make::preset(program, case.preset, case.made, seed, &file)?;
            files.push(file);
        }
        for beside in case.beside.iter().filter(|beside| judge.knows(beside.kind)) {
            match judge.compare(&files, beside.kind, case.made.cell())? {
                Some(found) => {
                    rows.push(cells(case, beside, &found));
                    missed.extend(misses(case, beside, &found));
                }
                None => missed.push(format!("{} beside {}: no window is hilly enough", case.name, beside.kind)),
            }
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
    vec![
        case.name.to_owned(),
        format!("{}, at {} m", beside.kind.replace('_', " "), case.made.cell()),
        format!("{} of {}", score.judged, score.judged + score.dropped),
        format!("{:.2}", score.median),
        format!("{:.2}", score.p90),
        if score.energy.is_nan() { "-".to_owned() } else { format!("{:.2}", score.energy) },
        format!("{}", score.stand_out),
        format!("{:.3}", score.bias),
        format!("{:.3}", score.worst_bias),
    ]
}

/// A message for each missed target.
fn misses(case: &Case, beside: &Beside, score: &Score) -> Vec<String> {
    let targets = &beside.targets;
    let name = format!("{} beside {}", case.name, beside.kind.replace('_', " "));
    // Types without a region of five windows have no unit of the energy.
    let energy = if score.energy.is_nan() { 0.0 } else { score.energy };
    let most = [
        ("median score", score.median, targets.median),
        ("p90", score.p90, targets.p90),
        ("energy", energy, targets.energy),
        ("outliers", score.stand_out, targets.outliers),
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

fn clock() -> u64 {
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(1, |time| time.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_misses_is_named() {
        let mut score = judge::SAMPLE;
        let missed = misses(&CASES[0], &MOUNTAINS, &score);
        let expect = [
            "alpine beside mountains: outliers 1, more than 0",
            "alpine beside mountains: worst grid bias 0.035, more than 0.02",
        ];
        assert_eq!(missed, expect);
        (score.stand_out, score.worst_bias, score.judged, score.dropped) = (0.0, 0.01, 100.0, 50.0);
        assert_eq!(misses(&CASES[0], &MOUNTAINS, &score), ["alpine beside mountains: 67 % judged, less than 90 %"]);
        (score.median, score.energy) = (0.95, f64::NAN);
        let missed = misses(&CASES[0], &land("alpine"), &score);
        assert_eq!(missed, ["alpine beside alpine: median score 0.95, more than 0.9"]);
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
