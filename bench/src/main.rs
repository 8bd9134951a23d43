//! Benchmarks of Orogen against its peers and physical limits, measured in one run. `cargo xtask bench` is the front
//! end.
//!
//! Prints one JSON object, {"area", "simd", "threads", "rows"}; areas `coasts`, `fans`, `valleys` and `water` print a
//! table. Progress goes to standard error.
#![forbid(unsafe_code)]

mod coasts;
mod erosion;
mod fans;
mod filters;
mod generate;
#[cfg(feature = "gpu")]
mod gpu;
mod land;
mod measure;
mod noise;
mod options;
mod outputs;
mod peer;
mod python;
mod resolution;
mod rows;
mod serve;
mod sizes;
mod studio;
mod tiles;
mod valleys;
mod water;
mod world;

use std::process::ExitCode;

use options::Options;

/// An area of measurement: its name and function.
type Area = (&'static str, fn(&Options) -> Result<serde_json::Value, String>);

const AREAS: &[Area] = &[
    ("noise", noise::run),
    ("erosion", erosion::run),
    ("generate", generate::run),
    ("world", world::run),
    ("outputs", outputs::run),
    ("tiles", tiles::run),
    ("studio", studio::run),
    ("python", python::run),
    #[cfg(feature = "gpu")]
    ("gpu", gpu::run),
    ("serve", serve::run),
    ("resolution", resolution::run),
];

/// Areas with options of their own, which print a table.
type Table = (&'static str, fn(&[String]) -> Result<(), String>);

const TABLES: &[Table] =
    &[("coasts", coasts::run), ("fans", fans::run), ("valleys", valleys::run), ("water", water::run)];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    if let [area, rest @ ..] = args.as_slice()
        && let Some((_, measure)) = TABLES.iter().find(|(name, _)| name == area)
    {
        return finished(measure(rest));
    }
    finished(run(&args).map(|report| println!("{report:#}")))
}

fn finished(result: Result<(), String>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(args: &[String]) -> Result<serde_json::Value, String> {
    let (area, flags) = args.split_first().ok_or("expected an area; run `cargo xtask bench --help`")?;
    let (_, measure) =
        AREAS.iter().find(|(name, _)| name == area).ok_or_else(|| format!("there is no area '{area}'"))?;
    let mut options = Options { case: String::new(), repetitions: 9 };
    let mut flags = flags.iter();
    while let Some(flag) = flags.next() {
        match flag.as_str() {
            "--case" => options.case = flags.next().ok_or("--case needs a text after it")?.clone(),
            "--quick" => options.repetitions = 3,
            other => return Err(format!("there is no option '{other}'")),
        }
    }
    measure(&options)
}
