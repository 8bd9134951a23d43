//! Solvers on whatever adapter this machine has, against the processor.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod common;

use common::filters::{gpu, heights, sampled};
use common::solvers::{solved_by_card, solved_by_processor};
use orogen_engine::node::Node;
use orogen_engine::solver::stream_power::StreamPower;
use orogen_grid::grid::{Grid, Window};

/// Root mean square and worst difference, and the share of samples beyond 1e-4, all of the range of the first grid.
fn differences(expected: &Grid, made: &Grid) -> [f64; 3] {
    let finite = expected.data().iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let range = (f64::from(high) - f64::from(low)).max(1e-3);
    let (mut squares, mut worst, mut far) = (0.0, 0.0f64, 0usize);
    for (a, b) in expected.data().iter().zip(made.data()) {
        let apart =
            if a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()) { 0.0 } else { f64::from(a - b).abs() / range };
        let apart = if apart.is_nan() { f64::INFINITY } else { apart };
        squares += apart * apart;
        worst = worst.max(apart);
        far += usize::from(apart > 1e-4);
    }
    let n = expected.data().len() as f64;
    [(squares / n).sqrt(), worst, far as f64 / n]
}

#[test]
fn a_single_step_is_that_of_the_processor() {
    let gpu = gpu();
    println!("{}", gpu.adapter());
    for (jitter, random_receivers, creep) in [(0.0, false, 0.0), (0.0, true, 0.01), (1.0, true, 0.01)] {
        for (width, height, cell, years) in
            [(63, 41, 30.0, 1e4), (200, 150, 480.0, 125_000.0), (1, 1, 10.0, 100.0), (3, 3, 10.0, 1e5)]
        {
            let window = Window::new(width, height, cell).at(-20, 1_000_000);
            let node: Node =
                StreamPower { jitter, random_receivers, creep, years, steps: 1, ..Default::default() }.into();
            let factor = sampled(&window, |x, y| 1.0 + 0.5 * (x / 9.0).sin() * (y / 7.0).cos());
            let inputs = [Some(heights(&window)), Some(factor.clone()), Some(factor), None];
            let (expected, made) =
                (solved_by_processor(&node, &window, &inputs), solved_by_card(&gpu, &node, &window, &inputs));
            for (k, name) in ["height", "flow", "change"].into_iter().enumerate() {
                println!(
                    "{width}x{height} jitter {jitter} random {random_receivers} {name}: {:?}",
                    differences(&expected[k], &made[k]).map(|d| format!("{d:.1e}"))
                );
            }
        }
    }
}
