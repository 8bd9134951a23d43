//! Filters on any adapter of this machine, compared with the processor.

use crate::common::filters::{
    apply, filter, gpu, gpu_with_buffers_of, inputs, lowered, on_card, on_processor, tried_on_card, variants,
};
use orogen_engine::node::Node;
use orogen_grid::grid::{Grid, Window};
use std::collections::BTreeMap;

/// The allowed difference between the layers of a filter and the processor's.
#[derive(Clone, Copy)]
enum Budget {
    /// Every sample within 1e-4 of the layer's range.
    Close,
    /// As [`Budget::Close`], except for this share of the samples, which are close to a threshold.
    Labels(f64),
    /// Mean and standard deviation within 2 % of the processor's standard deviation; this share of the samples may be
    /// farther than 1e-4 of the range.
    Chaotic(f64),
}

fn budget(op: &str, layer: &str) -> Budget {
    match (op, layer) {
        ("geomorphons", _) | ("topographic-position", "class") => Budget::Labels(2e-3),
        // Soil ends at the critical slope, and a mask without a fall-off is a label.
        ("soil-depth" | "select-slope", _) => Budget::Labels(5e-4),
        // On almost level ground the direction of water depends on the last digits of the heights.
        ("pipes" | "local-stream-power", _) => Budget::Chaotic(5e-3),
        _ => Budget::Close,
    }
}

/// Differences of a layer, over all cases.
#[derive(Default)]
struct Differences {
    samples: usize,
    squares: f64,
    worst: f64,
    /// Samples that are farther than 1e-4 of the range.
    far: usize,
    worst_case: String,
    /// Whether the processor's samples differ in any case.
    is_varied: bool,
}

/// Mean and standard deviation.
fn statistics(grid: &Grid) -> [f64; 2] {
    let n = grid.data().len() as f64;
    let mean = grid.data().iter().map(|v| f64::from(*v)).sum::<f64>() / n;
    let variance = grid.data().iter().map(|v| (f64::from(*v) - mean) * (f64::from(*v) - mean)).sum::<f64>() / n;
    [mean, variance.sqrt()]
}

/// The range of the values, at least `floor`; for a single sample, its value.
fn range(layer: &Grid, floor: f64) -> f64 {
    if let [only] = layer.data() {
        return f64::from(only.abs()).max(floor);
    }
    let finite = layer.data().iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    (f64::from(high) - f64::from(low)).max(floor)
}

fn windows(cell: f64) -> Vec<Window> {
    vec![Window::new(1, 1, cell).at(1, -2), Window::new(37, 23, cell).at(-40, 15), Window::new(64, 51, cell).at(100, 7)]
}

#[test]
fn filters_are_those_of_the_processor() {
    let gpu = gpu();
    println!("{}", gpu.adapter());
    let mut table: BTreeMap<(&str, &str), Differences> = BTreeMap::new();
    let mut failures = Vec::new();
    for default in Node::all().into_iter().filter(|node| lowered(node, 10.0).is_some()) {
        let op = default.spec().op;
        let has_optional = default.inputs().iter().any(|input| !input.required);
        for (v, node) in [vec![default.clone()], variants(&default)].concat().into_iter().enumerate() {
            for cell in [1.0, 10.0, 30.0] {
                let all = windows(cell);
                // A wide halo costs the same for each window.
                let halo = filter(&node).unwrap().halo(cell);
                let windows = if halo > 60 { &all[2..] } else { &all[..] };
                for window in windows {
                    for optional in if has_optional { vec![false, true] } else { vec![true] } {
                        let given = inputs(&node, window, optional);
                        let expected = on_processor(&node, window, &given);
                        let made = match tried_on_card(&gpu, &node, window, &given) {
                            Ok(made) => made,
                            Err(failure) => {
                                failures.push(format!("{op}: {failure}"));
                                continue;
                            }
                        };
                        assert_eq!(made.len(), expected.len());
                        for ((layer, expected), made) in node.layers().iter().zip(&expected).zip(&made) {
                            assert_eq!(made.window(), window);
                            let case =
                                format!("{op} {v}, {}, {cell} m, {} x {}", layer.name, window.width, window.height);
                            let entry = table.entry((op, layer.name)).or_default();
                            if let Some(failure) = compare(entry, budget(op, layer.name), expected, made, &case) {
                                failures.push(format!("{case}: {failure}"));
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{:<22}{:<14}{:>10}{:>11}{:>11}{:>11}  worst case", "filter", "layer", "samples", "RMS", "worst", "far");
    for ((op, layer), d) in &table {
        let (n, far) = (d.samples as f64, d.far as f64 / d.samples as f64);
        let rms = (d.squares / n).sqrt();
        println!("{op:<22}{layer:<14}{:>10}{rms:>11.1e}{:>11.1e}{far:>11.1e}  {}", d.samples, d.worst, d.worst_case);
        let most = match budget(op, layer) {
            Budget::Close => 0.0,
            Budget::Labels(most) | Budget::Chaotic(most) => most,
        };
        assert!(d.is_varied, "the test of {op} {layer} compares constants");
        if far > most {
            failures.push(format!("{op} {layer}: {far:.1e} of the samples differ by more than 1e-4 of the range"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Adds the differences of a case. Returns a problem other than the share of samples that differ, if there is one.
fn compare(entry: &mut Differences, budget: Budget, expected: &Grid, made: &Grid, case: &str) -> Option<String> {
    let range = range(expected, 1e-3 * expected.window().cell);
    let mut worst: f64 = 0.0;
    for (expected, made) in expected.data().iter().zip(made.data()) {
        let difference = match (expected.is_nan(), made.is_nan()) {
            (true, true) => 0.0,
            (false, false) => f64::from((expected - made).abs()) / range,
            _ => f64::INFINITY,
        };
        entry.samples += 1;
        entry.squares += difference * difference;
        entry.far += usize::from(difference > 1e-4);
        worst = worst.max(difference);
    }
    entry.is_varied |= expected.data().iter().any(|value| *value != expected.data()[0]);
    if worst > entry.worst {
        (entry.worst, entry.worst_case) = (worst, case.to_string());
    }
    match budget {
        Budget::Close if worst > 1e-4 => Some(format!("{worst:.1e} of the range {range}")),
        Budget::Chaotic(_) => {
            let ([mean, deviation], [made_mean, made_deviation]) = (statistics(expected), statistics(made));
            let unit = 0.02 * deviation.max(1e-3 * range);
            let is_off = (mean - made_mean).abs() > unit || (deviation - made_deviation).abs() > unit;
            is_off.then(|| format!("mean {made_mean} of {mean}, standard deviation {made_deviation} of {deviation}"))
        }
        _ => None,
    }
}

#[test]
fn tiles_give_the_same() {
    let whole = gpu();
    let window = Window::new(61, 45, 10.0).at(-7, 3);
    for default in Node::all().into_iter().filter(|node| lowered(node, 10.0).is_some()) {
        let node = variants(&default).pop().unwrap_or(default);
        let halo = filter(&node).unwrap().halo(window.cell);
        let planes = node.inputs().len() + node.layers().len() + lowered(&node, window.cell).unwrap().planes;
        let grown = Window::new(17, 12, window.cell).grown(halo);
        let tiled = gpu_with_buffers_of(4 * (planes * grown.len()) as u64);
        let given = inputs(&node, &window, true);
        let (one, many) = (on_card(&whole, &node, &window, &given), on_card(&tiled, &node, &window, &given));
        for (layer, (one, many)) in node.layers().iter().zip(one.iter().zip(&many)) {
            let range = range(one, 1e-3);
            let off =
                one.data().iter().zip(many.data()).map(|(a, b)| f64::from((a - b).abs()) / range).fold(0.0, f64::max);
            assert!(off < 1e-6, "{} {}: {off}", node.spec().op, layer.name);
        }
    }
}

#[test]
fn a_sample_that_fits_into_no_buffer_is_an_error() {
    let gpu = gpu_with_buffers_of(1000);
    let node = Node::named("thermal").unwrap();
    let window = Window::new(9, 9, 10.0);
    let given = inputs(&node, &window, true);
    let passes = lowered(&node, window.cell).unwrap();
    let made = apply(&gpu, passes.clone(), &given[..1], (window, 50), &[true], false);
    assert!(matches!(made, Err(orogen_gpu::Failure::Memory(_))), "{made:?}");
    let made = apply(&gpu, passes, &given[..1], (window.grown(1), 50), &[true], false);
    assert!(made.is_err());
}

#[test]
fn layers_that_nobody_wants_are_left_out_and_cancelled_work_ends() {
    let gpu = gpu();
    let node = Node::named("slope").unwrap();
    let window = Window::new(20, 10, 10.0);
    let given = inputs(&node, &window, true);
    let passes = lowered(&node, window.cell).unwrap();
    let apply = |wanted: [bool; 3], window: &Window, is_cancelled: bool| {
        apply(&gpu, passes.clone(), &given[..1], (*window, 1), &wanted, is_cancelled).unwrap()
    };
    let made = apply([false, true, false], &window, false).unwrap();
    assert_eq!(made, on_card(&gpu, &node, &window, &given)[1..2]);
    // A part of the window that the inputs cover.
    let part = Window::new(5, 3, 10.0).at(4, 2);
    let crop = made[0].crop(&part).unwrap();
    assert_eq!(apply([false, true, false], &part, false).unwrap(), [crop]);
    assert!(apply([true; 3], &window, true).is_none());
    let empty = Window::new(0, 4, 10.0);
    assert_eq!(apply([true; 3], &empty, false).unwrap()[0].data().len(), 0);
}

#[test]
fn other_parameters_and_sizes_compile_nothing() {
    let gpu = gpu();
    for default in Node::all().into_iter().filter(|node| lowered(node, 10.0).is_some()) {
        let window = Window::new(9, 7, 30.0);
        let node = variants(&default).pop().unwrap_or_else(|| default.clone());
        on_card(&gpu, &node, &window, &inputs(&node, &window, true));
        let compiled = gpu.shaders_compiled();
        for (node, cell) in variants(&default).into_iter().flat_map(|node| [(node.clone(), 30.0), (node, 20.0)]) {
            let window = Window::new(5, 8, cell);
            on_card(&gpu, &node, &window, &inputs(&node, &window, false));
        }
        assert_eq!(gpu.shaders_compiled(), compiled, "{}", default.spec().op);
    }
}

#[test]
fn missing_samples_are_those_of_the_processor() {
    let gpu = gpu();
    let window = Window::new(24, 18, 10.0);
    let with_infinite = ["slope", "hillshade", "normal", "aspect", "select-slope", "select-aspect", "flow-indices"];
    let others = ["curvature", "select-curvature", "ruggedness", "soil-depth", "geomorphons", "occlusion"];
    for op in with_infinite.into_iter().chain(others).chain(["topographic-position", "distance", "extrapolate"]) {
        let node = Node::named(op).unwrap();
        let mut given = inputs(&node, &window, true);
        let (source, halo) = (given[0].as_mut().unwrap(), filter(&node).unwrap().halo(window.cell));
        source.row_mut(halo + 7)[halo + 9] = f32::NAN;
        if with_infinite.contains(&op) {
            source.row_mut(halo + 12)[halo + 3] = f32::INFINITY;
        }
        let (expected, made) = (on_processor(&node, &window, &given), on_card(&gpu, &node, &window, &given));
        for (expected, made) in expected.iter().zip(&made) {
            let range = range(expected, 1e-3);
            for (expected, made) in expected.data().iter().zip(made.data()) {
                let is_close = f64::from((expected - made).abs()) <= 1e-4 * range;
                assert!(is_close || (expected.is_nan() && made.is_nan()), "{op}: {made}, not {expected}");
            }
        }
    }
}

/// Run it with `--ignored --nocapture` and `--release`.
#[test]
#[ignore = "long: minutes with a software driver"]
fn time_of_pipes() {
    let gpu = gpu();
    let window = Window::new(2048, 2048, 10.0);
    let node = Node::named("pipes").unwrap();
    let given = inputs(&node, &window, true);
    // Compiles the shaders, and warms up.
    let small = Window::new(8, 8, 10.0);
    on_card(&gpu, &node, &small, &inputs(&node, &small, true));
    let begin = std::time::Instant::now();
    let made = on_card(&gpu, &node, &window, &given);
    let card = begin.elapsed();
    let begin = std::time::Instant::now();
    let expected = on_processor(&node, &window, &given);
    let processor = begin.elapsed();
    println!(
        "100 iterations of pipes on 2048 x 2048 samples: {}: {card:.2?}; processor: {processor:.2?}",
        gpu.adapter()
    );
    let ([mean, _], [made_mean, _]) = (statistics(&expected[0]), statistics(&made[0]));
    println!("mean height {made_mean}, on the processor {mean}");
}
