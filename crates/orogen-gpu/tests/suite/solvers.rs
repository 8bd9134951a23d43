//! Solvers on any adapter of this machine, compared with the processor.

use crate::common;
use crate::common::filters::{WORLD, gpu, gpu_with_buffers_of, heights, sampled};
use crate::common::solvers::{solved_by_card, solved_by_processor, solver, solver_passes, step, try_card};
use orogen_engine::Recipe;
use orogen_engine::device::{Computed, Device, PassRun, PassStep, PlanGrid};
use orogen_engine::lower::Lowering;
use orogen_engine::node::Node;
use orogen_engine::op::Op;
use orogen_engine::solver::{DepressionRouting, Drainage, HeightAboveDrainage, Lakes, StreamPower};
use orogen_gpu::Failure;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::direction::STEPS;
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::progress::Progress;
use std::time::Instant;

/// The root mean square difference, the maximum difference, and the share of samples that differ by more than 1e-4, all
/// relative to the range of the first grid.
fn differences(expected: &Grid, made: &Grid) -> [f64; 3] {
    let finite = expected.data().iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    // The range of almost level ground is too small.
    let range = (f64::from(high) - f64::from(low)).max(0.1 * expected.window().cell);
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

/// Heights over a window, by name.
fn lands(window: &Window) -> Vec<(&'static str, Grid)> {
    let hills = heights(window);
    let mut holes = hills.clone();
    for (k, h) in holes.data_mut().iter_mut().enumerate() {
        if k % 397 == 250 {
            *h = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][k % 3];
        }
    }
    let mut steps = hills.clone();
    let step = 2.0 * window.cell as f32;
    steps.data_mut().iter_mut().for_each(|h| *h = ((*h / step).round() + 0.5) * step);
    vec![("hills", hills), ("holes", holes), ("steps", steps), ("plain", Grid::filled(*window, 50.0))]
}

fn windows() -> Vec<Window> {
    let sizes = [(63, 41, 30.0), (200, 151, 10.0), (1, 1, 10.0), (2, 9, 10.0), (3, 3, 10.0), (4, 130, 1.0)];
    sizes.map(|(width, height, cell)| Window::new(width, height, cell).at(-20, 1_000_000_000_000)).to_vec()
}

/// The inputs of a solver that reads only heights.
fn alone(node: &Node, heights: &Grid) -> Vec<Option<Grid>> {
    node.inputs().into_iter().map(|input| input.required.then(|| heights.clone())).collect()
}

fn shown(differences: [f64; 3]) -> String {
    let [rms, worst, far] = differences;
    format!("RMS {rms:.1e}, worst {worst:.1e}, {far:.1e} of the samples differ by more than 1e-4 of the range")
}

#[test]
fn filled_ground_lakes_and_heights_above_drainage_are_those_of_the_processor() {
    let gpu = gpu();
    println!("{}", gpu.adapter());
    let small = Lakes { smallest: 5000.0, ..Default::default() };
    let above = |stream: f64| HeightAboveDrainage { stream, ..Default::default() }.into();
    let [fill, lakes] = ["fill", "lakes"].map(|op| Node::named(op).unwrap());
    for node in [fill, lakes, small.into(), above(5000.0), above(1e12)] {
        for window in windows() {
            for (land, heights) in lands(&window) {
                let inputs = alone(&node, &heights);
                let expected = solved_by_processor(&node, &window, &inputs);
                let made = solved_by_card(&gpu, &node, &window, &inputs);
                assert_eq!(made.len(), expected.len());
                for ((layer, expected), made) in node.layers().iter().zip(&expected).zip(&made) {
                    assert_eq!(made.window(), &window);
                    let [rms, worst, far] = differences(expected, made);
                    let (op, Window { width, height, .. }) = (node.spec().op, window);
                    let case =
                        format!("{op} {} of {land}, {width} x {height}: {}", layer.name, shown([rms, worst, far]));
                    if worst > 0.0 {
                        println!("{case}");
                    }
                    // In closed flats water takes other paths than on the processor, so streams and the ground that is
                    // raised along them also differ.
                    let most = match (land, op) {
                        ("steps", "height-above-drainage") => 1.0,
                        ("steps", _) => 1e-3,
                        _ => 1e-4,
                    };
                    assert!(rms < 0.05, "{case}");
                    assert!(worst <= most, "{case}");
                }
            }
        }
    }
}

#[test]
fn drainage_is_that_of_the_processor() {
    let gpu = gpu();
    for (over, window) in [DepressionRouting::Bed, DepressionRouting::Surface]
        .into_iter()
        .flat_map(|over| windows().into_iter().map(move |window| (over, window)))
    {
        let node: Node = Drainage { over, stream: 5000.0, ..Default::default() }.into();
        for (land, heights) in lands(&window) {
            let inputs = alone(&node, &heights);
            let expected = solved_by_processor(&node, &window, &inputs);
            let made = solved_by_card(&gpu, &node, &window, &inputs);
            let outlets = Outlets::new(&heights, Some(WORLD.sea_level as f32));
            drains(&made[1], &made[0], &outlets);
            let same = |k: usize| {
                let pairs = expected[k].data().iter().zip(made[k].data());
                pairs.filter(|(a, b)| a == b).count() as f64 / window.len() as f64
            };
            let Window { width, height, .. } = window;
            println!(
                "{land}, {over:?}, {width} x {height}: same flow, receivers, watersheds, orders: {:.4?}",
                [0, 1, 2, 3].map(same)
            );
            assert!(differences(&expected[4], &made[4])[1] <= 1e-4);
            // On level ground the processor's gradients lead to the nearest outlet, and the card's spanning tree to any
            // outlet.
            if land == "hills" || land == "holes" {
                assert!((0..4).all(|k| same(k) > 0.999), "{land}");
            }
        }
    }
}

/// Checks that all cells drain to outlets, by the directions and areas of a map.
fn drains(directions: &Grid, flow: &Grid, outlets: &Outlets) {
    let window = *flow.window();
    let (width, own) = (window.width as isize, window.cell * window.cell);
    let receiver = |cell: usize| {
        let (east, south) = STEPS[directions.data()[cell] as usize];
        cell.wrapping_add_signed(south * width + east)
    };
    let mut areas = vec![own; window.len()];
    let mut ready: Vec<usize> = Vec::new();
    let mut waiting = vec![0u32; window.len()];
    for cell in 0..window.len() {
        assert_eq!(directions.data()[cell] == 8.0, outlets.at(cell), "only outlets have no receiver");
        if !outlets.at(cell) {
            waiting[receiver(cell)] += 1;
        }
    }
    ready.extend((0..window.len()).filter(|cell| waiting[*cell] == 0));
    let mut visited = 0;
    while let Some(cell) = ready.pop() {
        visited += 1;
        assert!((f64::from(flow.data()[cell]) - areas[cell]).abs() <= 1e-6 * areas[cell]);
        if !outlets.at(cell) {
            let to = receiver(cell);
            areas[to] += areas[cell];
            waiting[to] -= 1;
            if waiting[to] == 0 {
                ready.push(to);
            }
        }
    }
    assert_eq!(visited, window.len(), "there is a cycle");
    let out: f64 = (0..window.len()).filter(|cell| outlets.at(*cell)).map(|cell| areas[cell]).sum();
    assert!((out / own - window.len() as f64).abs() < 1e-6 * out / own);
}

/// Factors of erodibility and uplift.
fn factors(window: &Window) -> [Option<Grid>; 2] {
    let factor = |phase: f64| Some(sampled(window, |x, y| 1.0 + 0.5 * libm::sin(x / 9.0 + phase) * libm::cos(y / 7.0)));
    [factor(0.0), factor(1.0)]
}

#[test]
fn a_step_of_stream_power_is_that_of_the_processor() {
    let gpu = gpu();
    let runs = [(0.0, false, 0.0, 0.45), (0.0, false, 0.01, 0.6), (0.0, true, 0.01, 0.45), (1.0, true, 1.0, 0.45)];
    for (jitter, random_receivers, creep, area_exponent) in runs {
        for window in windows() {
            for (land, heights) in lands(&window) {
                let years = if window.cell > 10.0 { 1e5 } else { 1e3 };
                let law = StreamPower {
                    jitter,
                    random_receivers,
                    creep,
                    area_exponent,
                    years,
                    steps: 1,
                    ..Default::default()
                };
                let node: Node = law.into();
                let [erodibility, uplift] = if land == "holes" { [None, None] } else { factors(&window) };
                let inputs = [Some(heights.clone()), erodibility, uplift, None];
                let expected = solved_by_processor(&node, &window, &inputs);
                let made = solved_by_card(&gpu, &node, &window, &inputs);
                let found = differences(&expected[0], &made[0]);
                let Window { width, height, .. } = window;
                println!("{land}, {width} x {height}, jitter {jitter}, creep {creep}: {}", shown(found));
                let outlets = Outlets::new(&heights, Some(WORLD.sea_level as f32));
                for (cell, (before, after)) in heights.data().iter().zip(made[0].data()).enumerate() {
                    assert!(after.is_finite() || outlets.at(cell));
                    assert!(!outlets.at(cell) || before.to_bits() == after.to_bits(), "outlets keep their heights");
                }
                // Where slopes are at the limit, several neighbors are equally low, and rounding errors decide. On
                // level ground water takes other paths.
                if land == "hills" || land == "holes" {
                    assert!(found[0] < 2e-3 && found[2] < 1e-2);
                }
            }
        }
    }
}

/// The inputs of the solvers of the preset `alpine` over a part of their domain: the initial heights, and the factors
/// of erodibility and uplift.
fn alpine(side: usize) -> [Grid; 3] {
    // The domain has 129 samples of the world, 104 of the margin on each side, and one beyond.
    let window = Window::new(side, side, 480.0).at(-105, -105);
    // Without bounds and solvers, samples beyond the world can be requested.
    let text = include_str!("../../../orogen-engine/recipes/alpine.toml").replace("size = [61440.0, 61440.0]\n", "");
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
            slopes.push(libm::hypot(east, south) / (2.0 * cell));
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

/// Runs both solvers with these numbers of steps, and compares the results.
fn compare_alpine(side: usize, steps: [u32; 2], most: f64) {
    let gpu = gpu();
    println!("{}", gpu.adapter());
    let [foreland, erodibility, uplift] = alpine(side);
    let window = *foreland.window();
    let law = StreamPower { erodibility: 6e-6, uplift: 0.7, talus_angle: 45.0, creep: 0.0, ..Default::default() };
    let ranges = StreamPower { years: 125_000.0 * f64::from(steps[0]), steps: steps[0], jitter: 0.0, ..law.clone() };
    let valleys = StreamPower { years: 30_000.0 * f64::from(steps[1]), steps: steps[1], ..law };
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
        println!("{}", shown(differences(&expected[0], &made[0])));
        for ((what, expected), (_, made)) in landscape(&expected).into_iter().zip(landscape(&made)) {
            println!("{what:<34}{expected:>12.4}{made:>12.4}{:>9.2} %", 100.0 * (made / expected - 1.0));
            assert!((made / expected - 1.0).abs() < most, "{what}: {made}, not {expected}");
        }
        source = [expected, made].map(|layers| layers.into_iter().next().unwrap());
    }
}

#[test]
fn landscapes_have_the_statistics_of_the_processor() {
    compare_alpine(121, [20, 4], 0.05);
}

/// Run it with `--ignored --nocapture` and `--release`.
#[test]
#[ignore = "long: a minute with a software driver"]
fn alpine_has_the_statistics_of_the_processor() {
    compare_alpine(339, [120, 10], 0.03);
}

/// A solver of each op that a card can solve, with its inputs.
fn all_solvers(window: &Window) -> Vec<(Node, Vec<Option<Grid>>)> {
    let mut all = Vec::new();
    for node in Node::all() {
        let inputs = alone(&node, &heights(window));
        if matches!(node.op(), Op::Solver(_)) && solver_passes(&node, window, &inputs).is_some() {
            all.push((node, inputs));
        }
    }
    assert_eq!(all.len(), 5);
    all
}

#[test]
fn every_run_gives_the_same_bits_and_parameters_compile_nothing() {
    let gpu = gpu();
    let window = Window::new(90, 70, 20.0);
    for (node, inputs) in all_solvers(&window) {
        let first = solved_by_card(&gpu, &node, &window, &inputs);
        assert_eq!(solved_by_card(&gpu, &node, &window, &inputs), first, "{}", node.spec().op);
    }
    let compiled = gpu.shaders_compiled();
    let others: [Node; 3] = [
        StreamPower { years: 5e4, steps: 3, uplift: 1.0, creep: 0.1, sea: false, seed: 7, ..Default::default() }.into(),
        Lakes { smallest: 1e5, ..Default::default() }.into(),
        Drainage { stream: 1e4, sea: false, ..Default::default() }.into(),
    ];
    let window = Window::new(37, 51, 30.0).at(-5, 9);
    for node in others {
        solved_by_card(&gpu, &node, &window, &alone(&node, &heights(&window)));
    }
    assert_eq!(gpu.shaders_compiled(), compiled);
}

#[test]
fn failures_are_errors_and_cancelled_work_ends() {
    let window = Window::new(40, 30, 20.0);
    let small = gpu_with_buffers_of(50_000);
    let gpu = gpu();
    let mut solvers = all_solvers(&window);
    for (node, inputs) in &solvers {
        assert!(matches!(try_card(&small, node, &window, inputs), Err(Failure::Memory(_))), "{}", node.spec().op);
        assert!(matches!(try_card(&gpu, node, &window.grown(1), inputs), Err(Failure::Input(_))));
        let step = step(node, &window, inputs);
        assert_eq!(common::run(&gpu, std::slice::from_ref(&step), &[], || true), Ok(None));
        let empty = PassStep { window: Window::new(0, 4, 20.0), ..step };
        let none = common::run(&gpu, &[empty], &[], || false).unwrap().unwrap();
        assert!(none.len() == node.layers().len() && none.iter().all(|layer| layer.data().is_empty()));
    }
    // As the engine does: the processor computes what a lost device cannot.
    let (node, inputs) = solvers.remove(0);
    let (steps, progress) = ([step(&node, &window, &inputs)], Progress::none());
    let run = PassRun { steps: &steps, above: &[], stays: false };
    let solved = gpu.run(&run, &progress).unwrap().done().unwrap();
    let solved: Vec<Grid> = solved.into_iter().filter_map(PlanGrid::into_memory).collect();
    assert_eq!(solved, solved_by_card(&gpu, &node, &window, &inputs));
    gpu.lose();
    assert!(matches!(gpu.run(&run, &progress).unwrap(), Computed::Declined));
    assert!(gpu.failure().is_some_and(|failure| failure.to_string().contains("lost")));
    progress.cancel();
    assert!(gpu.run(&run, &progress).is_err());
}

#[test]
fn what_a_card_cannot_solve_is_left_to_the_processor() {
    let window = Window::new(20, 20, 10.0);
    let law = Node::named("stream-power").unwrap();
    let long: Node = StreamPower { steps: 10_000, ..Default::default() }.into();
    assert!(solver_passes(&long, &window, &alone(&long, &heights(&window))).is_none());
    let all = |window: &Window| solver(&law).unwrap().lower(window, &[true; 4], &WORLD);
    assert!(matches!(all(&window), Lowering::Shader(_)));
    assert!(matches!(all(&Window::new(5000, 5000, 10.0)), Lowering::Processor(_)));
}

#[test]
fn rain_weights_areas_as_on_the_processor() {
    let gpu = gpu();
    let window = Window::new(150, 110, 20.0).at(-30, 40);
    let mut rain = sampled(&window, |x, y| libm::sin(x / 9.0) * libm::cos(y / 7.0) * 3.0 + 1.0);
    rain.row_mut(50)[40..43].copy_from_slice(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
    let drainage: Node = Drainage { stream: 2e4, ..Default::default() }.into();
    let inputs = [Some(heights(&window)), Some(rain.clone())];
    let expected = solved_by_processor(&drainage, &window, &inputs);
    let made = solved_by_card(&gpu, &drainage, &window, &inputs);
    for ((layer, expected), made) in drainage.layers().iter().zip(&expected).zip(&made) {
        let found = differences(expected, made);
        println!("drainage {}: {}", layer.name, shown(found));
        // Weights are rounded to 4096ths, and so are thresholds of streams.
        assert!(found[0] < 1e-2 && found[2] < 1e-2, "{}", layer.name);
    }
    let law: Node = StreamPower { years: 2e4, steps: 1, ..Default::default() }.into();
    let inputs = [Some(heights(&window)), None, None, Some(rain)];
    let expected = solved_by_processor(&law, &window, &inputs);
    let found = differences(&expected[0], &solved_by_card(&gpu, &law, &window, &inputs)[0]);
    println!("stream-power: {}", shown(found));
    assert!(found[0] < 1e-3 && found[2] < 1e-2);
}

#[test]
fn slope_exponents_are_those_of_the_processor() {
    let gpu = gpu();
    let window = Window::new(150, 110, 100.0);
    for slope_exponent in [0.4, 0.8, 1.5, 2.0, 3.0, 5.0] {
        for jitter in [0.0, 1.0] {
            let law =
                StreamPower { slope_exponent, jitter, erodibility: 1e-5, years: 3e5, steps: 1, ..Default::default() };
            let node: Node = law.into();
            let [erodibility, uplift] = factors(&window);
            let inputs = [Some(heights(&window)), erodibility, uplift, None];
            let expected = solved_by_processor(&node, &window, &inputs);
            let found = differences(&expected[0], &solved_by_card(&gpu, &node, &window, &inputs)[0]);
            println!("exponent {slope_exponent}, jitter {jitter}: {}", shown(found));
            assert!(found[0] < 1e-3 && found[2] < 1e-2);
        }
    }
}

#[test]
fn several_steps_stay_with_those_of_the_processor() {
    let gpu = gpu();
    let window = Window::new(120, 101, 480.0);
    for (slope_exponent, jitter) in [(1.0, 0.0), (1.0, 1.0), (2.0, 1.0)] {
        let law = StreamPower {
            slope_exponent,
            jitter,
            steps: 6,
            years: 7.5e5,
            uplift: 0.7,
            erodibility: 6e-6,
            ..Default::default()
        };
        let node: Node = law.into();
        let inputs = [Some(heights(&window)), None, None, None];
        let expected = solved_by_processor(&node, &window, &inputs);
        let made = solved_by_card(&gpu, &node, &window, &inputs);
        let found = differences(&expected[0], &made[0]);
        println!("exponent {slope_exponent}, jitter {jitter}: {}", shown(found));
        // Each step amplifies the differences of the previous one.
        assert!(found[0] < 5e-3 && found[2] < 5e-2);
    }
}
