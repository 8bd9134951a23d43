//! Solvers on whatever adapter this machine has, against the processor.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod common;

use common::filters::{gpu, heights, sampled};
use common::solvers::{solved_by_card, solved_by_processor, solver_passes};
use orogen_engine::Recipe;
use orogen_engine::node::Node;
use orogen_engine::solver::stream_power::StreamPower;
use orogen_grid::grid::{Grid, Window};
use std::time::Instant;

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
    for (jitter, random_receivers, creep) in
        [(0.0, false, 0.0), (0.0, false, 0.01), (0.0, true, 0.01), (1.0, true, 0.01)]
    {
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

#[test]
fn water_is_that_of_the_processor() {
    let gpu = gpu();
    for op in ["fill", "drainage", "lakes"] {
        for (width, height, cell) in [(63, 41, 30.0), (200, 151, 10.0), (1, 1, 10.0), (3, 3, 10.0), (2, 9, 1.0)] {
            let window = Window::new(width, height, cell).at(-20, 1_000_000);
            let node = Node::named(op).unwrap();
            let inputs: Vec<Option<Grid>> =
                node.inputs().into_iter().map(|input| input.required.then(|| heights(&window))).collect();
            let (expected, made) =
                (solved_by_processor(&node, &window, &inputs), solved_by_card(&gpu, &node, &window, &inputs));
            for (k, layer) in node.layers().iter().enumerate() {
                let differ = expected[k].data().iter().zip(made[k].data()).filter(|(a, b)| a != b).count();
                println!(
                    "{op} {width}x{height} {}: {:?}, differ {differ}",
                    layer.name,
                    differences(&expected[k], &made[k]).map(|d| format!("{d:.1e}"))
                );
            }
        }
    }
}

/// The inputs of the solvers of the preset `alpine`: heights before the first of them, and the factors of erodibility and uplift, over their domain.
fn alpine() -> [Grid; 3] {
    // The world's 129 samples, 104 of the margin on each side, and one beyond.
    let window = Window::new(339, 339, 480.0).at(-105, -105);
    // Without bounds and solvers, what is beyond the world can be asked for.
    let text = include_str!("../../orogen-engine/recipes/alpine.toml").replace("size = [61440.0, 61440.0]\n", "");
    let (nodes, _) = text.split_once("[nodes.ranges]").unwrap();
    ["foreland", "erodibility", "uplift"].map(|node| {
        let recipe = Recipe::parse(&format!("{nodes}[outputs]\nheight = \"{node}\"\n"), "alpine").unwrap();
        common::exact(&recipe, "height", &window)
    })
}

/// Statistics of heights in metres and of drainage areas.
fn landscape(layers: &[Grid]) -> Vec<(&'static str, f64)> {
    let (heights, flow) = (&layers[0], &layers[1]);
    let cell = heights.window().cell;
    let mut sorted: Vec<f64> = heights.data().iter().map(|h| f64::from(*h)).collect();
    sorted.sort_by(f64::total_cmp);
    let mut slopes = Vec::new();
    for j in 1..heights.height() - 1 {
        for i in 1..heights.width() - 1 {
            let east = f64::from(heights[(i + 1, j)] - heights[(i - 1, j)]);
            let south = f64::from(heights[(i, j + 1)] - heights[(i, j - 1)]);
            slopes.push(east.hypot(south) / (2.0 * cell));
        }
    }
    slopes.sort_by(f64::total_cmp);
    let quantile = |sorted: &[f64], share: f64| sorted[(share * (sorted.len() - 1) as f64) as usize];
    let n = sorted.len() as f64;
    let mean = sorted.iter().sum::<f64>() / n;
    let deviation = (sorted.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / n).sqrt();
    let hypsometry = (mean - sorted[0]) / (sorted[sorted.len() - 1] - sorted[0]);
    let rivers =
        |cells: f64| flow.data().iter().filter(|area| f64::from(**area) >= cells * cell * cell).count() as f64 / n;
    vec![
        ("mean", mean),
        ("standard deviation", deviation),
        ("height 5 %", quantile(&sorted, 0.05)),
        ("height 25 %", quantile(&sorted, 0.25)),
        ("height 50 %", quantile(&sorted, 0.5)),
        ("height 75 %", quantile(&sorted, 0.75)),
        ("height 95 %", quantile(&sorted, 0.95)),
        ("hypsometric integral", hypsometry),
        ("slope 25 %", quantile(&slopes, 0.25)),
        ("slope 50 %", quantile(&slopes, 0.5)),
        ("slope 75 %", quantile(&slopes, 0.75)),
        ("slope 95 %", quantile(&slopes, 0.95)),
        ("share of rivers from 20 cells", rivers(20.0)),
        ("share of rivers from 200 cells", rivers(200.0)),
    ]
}

#[test]
fn ranges_have_the_statistics_of_the_processor() {
    let gpu = gpu();
    let [foreland, erodibility, uplift] = alpine();
    let window = *foreland.window();
    let ranges = StreamPower { years: 1.5e7, steps: 120, jitter: 0.0, ..alpine_law() };
    let valleys = StreamPower { years: 3e5, steps: 10, ..alpine_law() };
    let mut source = [foreland.clone(), foreland];
    for (name, node) in [("ranges", ranges.into()), ("valleys", valleys.into())] {
        let node: Node = node;
        let [on_processor, on_card] =
            source.map(|source| [Some(source), Some(erodibility.clone()), Some(uplift.clone()), None]);
        let begun = Instant::now();
        let expected = solved_by_processor(&node, &window, &on_processor);
        let processor = begun.elapsed();
        let begun = Instant::now();
        let made = solved_by_card(&gpu, &node, &window, &on_card);
        let passes = solver_passes(&node, &window, &on_card).unwrap().passes.len();
        println!("{name}: {passes} passes, {:.2?}; processor {processor:.2?}", begun.elapsed());
        println!("{:?}", differences(&expected[0], &made[0]).map(|d| format!("{d:.1e}")));
        for ((what, expected), (_, made)) in landscape(&expected).into_iter().zip(landscape(&made)) {
            println!("{what:<34}{expected:>12.4}{made:>12.4}{:>9.2} %", 100.0 * (made / expected - 1.0));
        }
        source = [expected, made].map(|layers| layers.into_iter().next().unwrap());
    }
}

/// What both solvers of the preset `alpine` have in common.
fn alpine_law() -> StreamPower {
    StreamPower { erodibility: 6e-6, uplift: 0.7, talus_angle: 45.0, creep: 0.0, ..Default::default() }
}
