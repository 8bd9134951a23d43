//! Progress is reported correctly and work can be cancelled, for every node. New nodes are included automatically.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod support;

use orogen::node::Node;
use orogen::op::Op;
use orogen::{Grid, Progress, Recipe, Result, Window, World};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use support::{laws_of, open, recipe_of, world_of};

/// Samples along a side of the test worlds.
fn side() -> usize {
    if std::env::var_os("OROGEN_LONG").is_some() { 1024 } else { 384 }
}

/// A node in a world large enough to take some time.
fn recipe(node: &Node) -> Recipe {
    let size = (side() - 1) as f64 * 10.0;
    let world = world_of(10.0).with_size(Some([size, size]));
    recipe_of(node, world, false)
}

fn make(world: &World, progress: &Progress) -> Result<Vec<Grid>> {
    let layers: Vec<&str> = world.recipe().outputs().collect();
    world.grids(&layers, &Window::new(side(), side(), 10.0), progress)
}

/// Times and shares of the reports.
type Told = Vec<(Duration, f64)>;

fn recorded(world: &World) -> (Told, Duration) {
    let told = Arc::new(Mutex::new(Told::new()));
    let (heard, begun) = (Arc::clone(&told), Instant::now());
    make(world, &Progress::new(move |share| heard.lock().unwrap().push((begun.elapsed(), share)))).unwrap();
    (std::mem::take(&mut told.lock().unwrap()), begun.elapsed())
}

/// The longest time without a report, from the beginning to the end.
fn silence(told: &Told, all: Duration) -> Duration {
    let times = || told.iter().map(|(at, _)| *at);
    let pairs = std::iter::once(Duration::ZERO).chain(times()).zip(times().chain([all]));
    pairs.map(|(one, next)| next.saturating_sub(one)).max().unwrap_or_default()
}

#[test]
fn shares_grow_from_nothing_to_all_without_long_silences() {
    for node in Node::all() {
        let name = node.spec().op;
        // A busy machine may delay reports: the best of three runs counts.
        let mut runs = Vec::new();
        for _ in 0..3 {
            let (told, all) = recorded(&open(&recipe(&node), 2));
            let shares: Vec<f64> = told.iter().map(|(_, share)| *share).collect();
            assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{name}: never backwards: {shares:?}");
            assert!(shares.first().is_some_and(|share| *share > 0.0), "{name}: {shares:?}");
            assert_eq!(shares.last(), Some(&1.0), "{name}: ends at all");
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

/// Short work needs no reports.
fn is_short((silence, all, _): (Duration, Duration, usize)) -> bool {
    silence < all / 3 || silence < Duration::from_millis(100)
}

#[test]
fn whatever_is_cancelled_at_any_moment_ends_at_once() {
    for node in Node::all().iter().filter(|node| !matches!(node.op(), Op::Field(_))) {
        let late = laws_of(node).cancel(side()).unwrap_or_else(|violation| panic!("{violation}"));
        println!("{:20} stopped within {late:7.1?}", node.spec().op);
    }
}
