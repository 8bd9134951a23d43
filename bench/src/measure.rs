//! Timing that is robust on a busy machine: CPU time of this thread, jobs in turns, medians.

use std::hint::black_box;
use std::time::Instant;

use cpu_time::ThreadTime;

/// A job that fills a buffer.
pub struct Job {
    /// The name in the table.
    pub name: &'static str,
    /// Fills the buffer; a job that can only return a new buffer replaces it.
    pub fill: Fill,
}

/// The function that fills the buffer.
pub type Fill = Box<dyn FnMut(&mut Vec<f32>)>;

impl Job {
    /// A job with this name.
    pub fn new(name: &'static str, fill: impl FnMut(&mut Vec<f32>) + 'static) -> Self {
        Self { name, fill: Box::new(fill) }
    }
}

/// Minimum duration of a timing, in seconds, so that the cost of the clock is negligible.
const AT_LEAST: f64 = 0.01;

/// Maximum number of fills per timing.
const AT_MOST: usize = 500;

/// The clock of a timing.
#[derive(Clone, Copy)]
pub enum Clock {
    /// CPU time of the calling thread.
    Thread,
    /// Wall time, for jobs with their own threads. It includes the effect of other work on the machine.
    Wall,
}

/// The rate of each job in samples per second: the median of timings in which the jobs take turns, so that a temporary
/// slowdown of the machine affects all of them.
pub fn rates(clock: Clock, jobs: &mut [Job], samples: usize, repetitions: usize) -> Result<Vec<f64>, String> {
    let mut buffer = vec![0.0; samples];
    let mut fills = Vec::new();
    for job in jobs.iter_mut() {
        buffer.clear();
        buffer.resize(samples, 0.0);
        // The first fill sets up tables and maps pages; the second determines the number of fills per timing.
        (job.fill)(&mut buffer);
        check(job.name, &buffer, samples)?;
        let once = seconds(clock, job, &mut buffer, 1);
        fills.push(((AT_LEAST / once.max(1e-9)).ceil() as usize).clamp(1, AT_MOST));
    }
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); jobs.len()];
    for _ in 0..repetitions {
        for ((job, &fills), times) in jobs.iter_mut().zip(&fills).zip(&mut times) {
            times.push(seconds(clock, job, &mut buffer, fills) / fills as f64);
        }
    }
    Ok(times.iter_mut().map(|t| samples as f64 / median(t)).collect())
}

fn seconds(clock: Clock, job: &mut Job, buffer: &mut Vec<f32>, fills: usize) -> f64 {
    let (thread, wall) = (ThreadTime::now(), Instant::now());
    for _ in 0..fills {
        (job.fill)(black_box(buffer));
        black_box(&buffer);
    }
    match clock {
        Clock::Thread => thread.elapsed().as_secs_f64(),
        Clock::Wall => wall.elapsed().as_secs_f64(),
    }
}

/// The median.
pub fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    let middle = times.len() / 2;
    if times.len() % 2 == 1 { times[middle] } else { (times[middle - 1] + times[middle]) / 2.0 }
}

/// The value of the plain fill, which writes one value at the speed of memory.
pub const PLAIN: f32 = 0.123;

/// Checks a job's output: every sample written, finite, and not all the same.
fn check(name: &str, buffer: &[f32], samples: usize) -> Result<(), String> {
    let (low, high) = buffer.iter().fold((f32::MAX, f32::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    let finite = buffer.iter().all(|v| v.is_finite());
    // The plain fill writes one value; it is recognized by that value.
    if buffer.len() == samples && finite && (high - low > 0.01 || low == PLAIN) {
        return Ok(());
    }
    Err(format!("{name} wrote {} of {samples} samples from {low} to {high}: that is no noise", buffer.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_one() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
    }

    #[test]
    fn a_job_that_does_nothing_is_found_out() {
        let error = rates(Clock::Thread, &mut [Job::new("idle", |_| {})], 64, 1).expect_err("nothing was written");
        assert!(error.starts_with("idle wrote"), "{error}");
    }

    #[test]
    fn rates_of_real_work() {
        let count = |out: &mut Vec<f32>| out.iter_mut().enumerate().for_each(|(i, v)| *v = i as f32);
        let rates = rates(Clock::Thread, &mut [Job::new("count", count)], 64, 3).expect("it counts");
        assert!(rates.len() == 1 && rates[0] > 0.0, "{rates:?}");
    }
}
