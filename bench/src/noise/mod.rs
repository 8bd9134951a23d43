//! Area `noise`: our kernels compared with other crates, one thread, a picture of 1024 x 1024 samples; then a picture
//! larger than the caches, and two threads compared with one.

mod cases;
mod large;
mod levels;
mod ours;
mod peers;
mod threads;

use serde_json::{Value, json};

use crate::measure::{self, Clock, Job};
use crate::options::Options;
use crate::rows::Row;
use cases::{CASES, Case, SIZE};

/// Measures every case, or those selected.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows = Vec::new();
    for case in CASES.iter().filter(|c| c.name.contains(&options.case)) {
        eprintln!("{} ...", case.name);
        rows.extend(measure_case(case, options.repetitions)?);
    }
    rows.extend(large::rows(options)?);
    rows.extend(threads::rows(options)?);
    let rows: Vec<Value> = rows.iter().map(Row::json).collect();
    Ok(json!({ "area": "noise", "simd": ours::level(), "threads": 1, "rows": rows }))
}

fn measure_case(case: &Case, repetitions: usize) -> Result<Vec<Row>, String> {
    let mut jobs: Vec<Job> = vec![ours::job(case)];
    jobs.extend(peers::PEERS.iter().filter_map(|peer| peer(case)));
    let peers = jobs.len();
    jobs.extend(levels::below(case));
    let rates = measure::rates(Clock::Thread, &mut jobs, SIZE * SIZE, repetitions)?;
    let rates: Vec<f64> = rates.iter().map(|r| r / 1e6).collect();
    let ours = rates.first().copied();
    let rows = jobs.iter().zip(&rates).enumerate().skip(1).map(|(number, (job, &rate))| {
        if number >= peers {
            return levels::row(case, rate, ours);
        }
        let target = case.target.filter(|t| t.peer == job.name);
        Row { case: case.name.to_owned(), ours, peer: Some((job.name, rate)), target }
    });
    Ok(rows.collect())
}
