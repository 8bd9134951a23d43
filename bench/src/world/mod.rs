//! Area `world`: the cost of windows, tiles, chunks and whole builds of hills of noise.

mod build;
mod chunk;
pub mod figure;
mod grow;
mod hills;
pub mod process;
mod threads;
mod tiles;

use serde_json::{Value, json};

use crate::options::Options;
use figure::Figure;

/// A case: its name and function.
type Case = (&'static str, fn(&Options) -> Result<Vec<Figure>, String>);

/// Every case.
const CASES: &[Case] = &[
    ("chunk", chunk::measure),
    ("tiles", tiles::measure),
    ("threads", threads::measure),
    ("grow", grow::measure),
    ("build", build::measure),
];

/// Measures every case, or those selected.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows: Vec<Value> = Vec::new();
    for (name, measure) in CASES.iter().filter(|(name, _)| name.contains(&options.case)) {
        eprintln!("{name} ...");
        rows.extend(measure(options)?.iter().map(Figure::json));
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "world", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}
