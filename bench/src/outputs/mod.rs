//! Area `outputs`: the cost of output files, compared with other programs.

mod cog;
mod contours;
mod counted;
mod exr;
mod ground;
mod maps;
mod meshes;
mod python;
mod render;

use serde_json::{Value, json};

use crate::options::Options;
use crate::world::figure::Figure;

/// A case: its name and function.
type Case = (&'static str, fn(&Options) -> Result<Vec<Figure>, String>);

/// Every case.
const CASES: &[Case] = &[
    ("cog", cog::measure),
    ("contours", contours::measure),
    ("exr", exr::measure),
    ("maps", maps::measure),
    ("meshes", meshes::measure),
    ("render", render::measure),
];

/// Measures every case, or those selected.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows: Vec<Value> = Vec::new();
    for (name, measure) in CASES.iter().filter(|(name, _)| name.contains(&options.case)) {
        eprintln!("{name} ...");
        rows.extend(measure(options)?.iter().map(Figure::json));
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "outputs", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}
