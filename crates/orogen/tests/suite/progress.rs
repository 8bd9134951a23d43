//! Progress is reported correctly and work can be cancelled, for every node. New nodes are included automatically.

use crate::support::{Random, laws_of, open, recipe_of, world_of};
use orogen::node::Node;
use orogen::op::Op;
use orogen::{ErrorKind, Grid, Progress, Recipe, Result, Window, World};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Number of samples along a side of the worlds in the regular tests.
const SIDE: usize = 384;

/// A node in a world large enough to take some time.
fn recipe(node: &Node, side: usize) -> Recipe {
    let size = (side - 1) as f64 * 10.0;
    let world = world_of(10.0).with_size(Some([size, size]));
    recipe_of(node, world, false)
}

fn make(world: &World, side: usize, progress: &Progress) -> Result<Vec<Grid>> {
    let layers: Vec<&str> = world.recipe().outputs().collect();
    world.grids(&layers, &Window::new(side, side, 10.0), progress)
}

/// Times and shares of the progress reports.
type Told = Vec<(Duration, f64)>;

fn recorded(world: &World, side: usize) -> (Told, Duration) {
    let told = Arc::new(Mutex::new(Told::new()));
    let (heard, begun) = (Arc::clone(&told), Instant::now());
    make(world, side, &Progress::new(move |share| heard.lock().unwrap().push((begun.elapsed(), share)))).unwrap();
    (std::mem::take(&mut told.lock().unwrap()), begun.elapsed())
}

/// The longest time without a report, from start to end.
fn silence(told: &Told, all: Duration) -> Duration {
    let times = || told.iter().map(|(at, _)| *at);
    let pairs = std::iter::once(Duration::ZERO).chain(times()).zip(times().chain([all]));
    pairs.map(|(one, next)| next.saturating_sub(one)).max().unwrap_or_default()
}

#[test]
fn shares_grow_from_nothing_to_all_in_small_steps() {
    for node in Node::all() {
        let world = open(&recipe(&node, SIDE), 2);
        let layers: Vec<&str> = world.recipe().outputs().collect();
        let plan = world.plan(&layers, &Window::new(SIDE, SIDE, 10.0)).unwrap();
        let all = Duration::from_secs_f64(world.work(&plan).unwrap() * 1e-9);
        let (told, _) = recorded(&world, SIDE);
        let shares = checked_shares(&node, &told);
        let largest = std::iter::once(0.0).chain(shares.clone()).zip(shares).map(|(one, next)| next - one);
        let step = largest.fold(0.0, f64::max);
        let name = node.spec().op;
        println!("{name:24} {:4} reports, steps of up to {:5.1} % of {all:.1?}", told.len(), 100.0 * step);
        // Short work needs no reports. Times are those that the ops state; no clock is read.
        assert!(step < 1.0 / 3.0 || all.mul_f64(step) < LONGEST_SILENCE, "{name}: {step} of {all:?}");
    }
}

/// The maximum time without a report, for work that takes longer than three times as long.
const LONGEST_SILENCE: Duration = Duration::from_millis(100);

/// The reported shares, which must increase from above 0 to 1.
fn checked_shares(node: &Node, told: &Told) -> impl Iterator<Item = f64> + Clone {
    let name = node.spec().op;
    let shares: Vec<f64> = told.iter().map(|(_, share)| *share).collect();
    assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{name}: never backwards: {shares:?}");
    assert!(shares.first().is_some_and(|share| *share > 0.0), "{name}: {shares:?}");
    assert_eq!(shares.last(), Some(&1.0), "{name}: ends at all");
    shares.into_iter()
}

#[test]
#[ignore = "long: every node, and the time between its reports"]
fn there_are_no_long_silences() {
    for side in [SIDE, 1024] {
        for node in Node::all() {
            let name = node.spec().op;
            // A busy machine may delay reports, so the best of three runs counts.
            let mut runs = Vec::new();
            for _ in 0..3 {
                let (told, all) = recorded(&open(&recipe(&node, side), 2), side);
                let _ = checked_shares(&node, &told);
                runs.push((silence(&told, all), all, told.len()));
                if is_short(runs[runs.len() - 1]) {
                    break;
                }
            }
            let (silence, all, reports) = runs[runs.len() - 1];
            println!("{name:20} {reports:4} reports in {all:8.1?}, the longest silence {silence:7.1?}");
            assert!(runs.into_iter().any(is_short), "{name}: {silence:?} of {all:?}");
        }
    }
}

/// Short work needs no reports.
fn is_short((silence, all, _): (Duration, Duration, usize)) -> bool {
    silence < all / 3 || silence < LONGEST_SILENCE
}

/// All nodes except those whose work is divided into blocks by the engine.
fn divided_by_themselves() -> impl Iterator<Item = Node> {
    Node::all().into_iter().filter(|node| !matches!(node.op(), Op::Field(_)))
}

#[test]
fn whatever_is_cancelled_at_any_share_ends_soon_after_it() {
    for node in divided_by_themselves() {
        let late = laws_of(&node).stops(SIDE).unwrap_or_else(|violation| panic!("{violation}"));
        println!("{:24} stopped within {late:7.1?}", node.spec().op);
    }
}

#[test]
#[ignore = "long: every filter and solver, cancelled at 384 x 384 and 1024 x 1024, and the time until it ends"]
fn whatever_is_cancelled_at_any_moment_ends_at_once() {
    for side in [SIDE, 1024] {
        for node in divided_by_themselves() {
            let late = laws_of(&node).cancel(side).unwrap_or_else(|violation| panic!("{violation}"));
            println!("{:24} stopped within {late:7.1?}", node.spec().op);
        }
    }
}

/// Sides of large worlds, the maximum time that work may continue after cancellation, and the number of moments at
/// which it is cancelled.
const LARGE: [(usize, Duration, usize); 2] =
    [(1024, Duration::from_millis(100), 8), (4096, Duration::from_millis(300), 4)];

/// CPU time of this process so far, if the system provides it; it does not depend on how busy the machine is.
fn cpu_time() -> Option<Duration> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name, in parentheses, may contain spaces. Times are in hundredths of a second.
    let ticks = stat.rsplit_once(')')?.1.split_whitespace().skip(11).take(2);
    Some(Duration::from_millis(10 * ticks.filter_map(|ticks| ticks.parse::<u64>().ok()).sum::<u64>()))
}

/// Cancels the work after a time; returns how long it continued. `None` if it ended before.
fn late(node: &Node, side: usize, after: Duration) -> Option<Duration> {
    let world = open(&recipe(node, side), 2);
    let progress = Progress::none();
    let (made, ended, asked) = std::thread::scope(|scope| {
        let stopper = scope.spawn(|| {
            std::thread::sleep(after);
            progress.cancel();
            (Instant::now(), cpu_time())
        });
        let made = make(&world, side, &progress);
        let ended = (Instant::now(), cpu_time());
        (made, ended, stopper.join().unwrap())
    });
    let error = made.err()?;
    assert_eq!(error.kind(), ErrorKind::Cancelled, "{error}");
    let late = ended.0.saturating_duration_since(asked.0);
    Some(match (asked.1, ended.1) {
        (Some(asked), Some(ended)) => late.min(ended.saturating_sub(asked) + Duration::from_millis(10)),
        _ => late,
    })
}

#[test]
#[ignore = "long: every filter and solver, cancelled several times at 1024 x 1024 and 4096 x 4096"]
fn large_work_that_is_cancelled_at_random_moments_ends_soon() {
    // A build with little optimization takes three times as long between two checks.
    let slack = if cfg!(debug_assertions) { 3 } else { 1 };
    let only = std::env::var("OROGEN_OPS").unwrap_or_default();
    let chosen = |node: &Node| only.is_empty() || only.split(',').any(|name| name == node.spec().op);
    let mut broken = Vec::new();
    println!("{:24} {:>6} {:>9} {:>8} {:>9} {:>9}", "op", "side", "work", "reports", "silence", "stopped");
    for node in divided_by_themselves().filter(&chosen) {
        let name = node.spec().op;
        let mut all = Duration::ZERO;
        for (side, limit, moments) in LARGE {
            let mut told = Told::new();
            // Sixteen times the samples take about sixteen times as long; an additional run would take as long as all
            // the others.
            match all.is_zero() {
                true => (told, all) = recorded(&open(&recipe(&node, side), 2), side),
                false => all *= 16,
            }
            let quiet = silence(&told, all);
            let mut random = Random(side as u64);
            let mut longest = Duration::ZERO;
            for _ in 0..moments {
                let after = all.mul_f64(random.below(1000) as f64 / 1000.0);
                // A busy machine may cause delays, so the best of three runs counts.
                let mut best = None;
                for _ in 0..3 {
                    let Some(late) = late(&node, side, after) else { break };
                    best = Some(best.map_or(late, |best: Duration| best.min(late)));
                    if late <= limit * slack {
                        break;
                    }
                }
                longest = longest.max(best.unwrap_or_default());
            }
            let [reports, quiet] = match told.is_empty() {
                true => ["-".to_string(), "-".to_string()],
                false => [told.len().to_string(), format!("{quiet:.0?}")],
            };
            let [work, stopped] = [all, longest].map(|time| format!("{time:.0?}"));
            println!("{name:24} {side:6} {work:>9} {reports:>8} {quiet:>9} {stopped:>9}");
            if longest > limit * slack {
                broken.push(format!("{name} at {side} x {side}: {longest:.0?}"));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}
