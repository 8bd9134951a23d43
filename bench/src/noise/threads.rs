//! Two threads compared with one, where arithmetic and not memory is the limit; wall time.

use orogen_noise::{Falloff, Fractal, Kind, LengthMismatch, Points, Worley};

use super::cases::{OCTAVES, SEED};
use crate::measure::{self, Clock, Job};
use crate::options::Options;
use crate::rows::{Row, Target};

/// Samples per side.
const SIDE: usize = 2048;
/// Number of fills per thread, because one fill takes less than ten times as long as starting a thread.
const TIMES: usize = 16;
const TARGET: Target = Target { peer: "one thread", ratio: 1.9, or_rate: None };

type Fill = fn(&Points, &mut [f32]) -> Result<(), LengthMismatch>;

const CASES: &[(&str, Fill)] = &[
    ("fBm 6 octaves, two threads", |at, out| fractal(Kind::Fbm).fill(at, out)),
    ("ridged 6 octaves, two threads", |at, out| fractal(Kind::Ridged).fill(at, out)),
    ("weighted fBm 6 octaves, two threads", |at, out| {
        fractal(Kind::Weighted { k: 1.0, falloff: Falloff::Reciprocal }).fill(at, out)
    }),
    ("Worley F1 2D, two threads", |at, out| Worley::new(SEED as u64, 100.0).fill(at, out)),
];

fn fractal(kind: Kind) -> Fractal {
    Fractal::new(SEED as u64, 100.0).with_kind(kind).with_octaves(OCTAVES as u32)
}

/// Measures the selected cases, if there are two processors.
pub fn rows(options: &Options) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    if std::thread::available_parallelism().map_or(1, usize::from) < 2 {
        return Ok(rows);
    }
    for (name, fill) in CASES.iter().filter(|(name, _)| name.contains(&options.case)) {
        eprintln!("{name} ...");
        let mut jobs = [job("two threads", *fill, 2), job(TARGET.peer, *fill, 1)];
        let rates = measure::rates(Clock::Wall, &mut jobs, SIDE * SIDE, options.repetitions)?;
        let [two, one] = [0, 1].map(|i| rates.get(i).map_or(0.0, |rate| TIMES as f64 * rate / 1e6));
        rows.push(Row {
            case: (*name).to_owned(),
            ours: Some(two),
            peer: Some((TARGET.peer, one)),
            target: Some(TARGET),
        });
    }
    Ok(rows)
}

/// Fills the picture in `threads` bands of rows, with one thread for each; a single band needs no thread.
fn job(name: &'static str, fill: Fill, threads: usize) -> Job {
    let axis: Vec<f64> = (0..SIDE).map(|i| i as f64).collect();
    let rows = SIDE / threads;
    Job::new(name, move |out| {
        let band = |(out, ys): (&mut [f32], &[f64])| {
            for _ in 0..TIMES {
                _ = fill(&Points::Lattice { xs: &axis, ys }, out);
            }
        };
        let mut bands = out.chunks_mut(rows * SIDE).zip(axis.chunks(rows));
        let first = bands.next();
        std::thread::scope(|scope| {
            bands.for_each(|work| _ = scope.spawn(move || band(work)));
            first.map(band)
        });
    })
}
