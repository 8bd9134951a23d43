//! Area `noise`: our kernels beside other crates, one thread, a picture of 1024 x 1024 samples.

mod cases;
mod ours;
mod peers;

use serde_json::{Value, json};

use crate::measure::{self, Job};
use crate::options::Options;
use crate::rows::Row;
use cases::{CASES, Case, SIZE};

/// Measures every case, or those named.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows = Vec::new();
    for case in CASES.iter().filter(|c| c.name.contains(&options.case)) {
        eprintln!("{} ...", case.name);
        rows.extend(measure_case(case, options.repetitions)?.iter().map(Row::json));
    }
    Ok(json!({ "area": "noise", "simd": ours::level(), "threads": 1, "rows": rows }))
}

fn measure_case(case: &Case, repetitions: usize) -> Result<Vec<Row>, String> {
    let Some(ours) = ours::job(case) else {
        // Peers alone would say nothing: what is missing is ours.
        return Ok(vec![Row { case: case.name, ours: None, peer: None, target: case.target }]);
    };
    let mut jobs: Vec<Job> = vec![ours];
    jobs.extend(peers::PEERS.iter().filter_map(|peer| peer(case)));
    let rates = measure::rates(&mut jobs, SIZE * SIZE, repetitions)?;
    let rates: Vec<f64> = rates.iter().map(|r| r / 1e6).collect();
    let rows = jobs.iter().zip(&rates).skip(1).map(|(job, &rate)| Row {
        case: case.name,
        ours: rates.first().copied(),
        peer: Some((job.name, rate)),
        target: case.target.filter(|t| t.peer == job.name),
    });
    Ok(rows.collect())
}
