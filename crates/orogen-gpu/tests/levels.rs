//! Levels of drained land on whatever adapter this machine has, against the processor.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod common;

use common::filters::{gpu, gpu_with_buffers_of, sampled};
use common::gpu as shared_gpu;
use orogen_engine::levelled::amplify::Amplify;
use orogen_engine::levelled::continents::Continents;
use orogen_engine::lower::{LevelPasses, Lowering};
use orogen_engine::op::{Context, Levelled, WorldParams};
use orogen_engine::{Options, Recipe, Session};
use orogen_gpu::Gpu;
use orogen_gpu::levels::refine;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use std::sync::OnceLock;

const WORLD: WorldParams = WorldParams { seed: 1, size: None, cell: 60.0, sea_level: 400.0 };

/// The planes of a level.
const PLANES: [&str; 8] = ["east", "south", "height", "area", "receiver", "variation", "uplift", "shore"];
const HEIGHT: usize = 2;
const AREA: usize = 3;
const RECEIVER: usize = 4;

/// Coarse land with rivers, and basins without an outlet: heights and drainage areas.
fn land() -> &'static [Grid; 2] {
    static LAND: OnceLock<[Grid; 2]> = OnceLock::new();
    LAND.get_or_init(|| {
        let recipe = "orogen = 1\n[world]\nseed = 2\nsize = [62400.0, 62400.0]\ncell = 480.0\n\
            [nodes.swells]\nop = \"fbm\"\nwavelength = 24000.0\noctaves = 5\n\
            [nodes.foreland]\nop = \"remap\"\nsource = \"swells\"\nfrom = [-0.5, 0.5]\nto = [100.0, 400.0]\n\
            [nodes.ranges]\nop = \"stream-power\"\nsource = \"foreland\"\ncell = 480.0\nyears = 15000000.0\nsteps = 60\n\
            erodibility = 6e-06\nuplift = 0.7\ncreep = 0.0\n[outputs]\nheight = \"ranges\"\nflow = \"ranges.flow\"\n";
        let session = Session::new(Options::default()).unwrap();
        let world = session.open(Recipe::parse(recipe, "test").unwrap()).unwrap();
        let window = Window::new(120, 120, 480.0).at(4, 4);
        let [mut height, flow] = ["height", "flow"].map(|layer| world.window(layer, &window).unwrap());
        // Two hollows.
        for (x, y) in [(60, 61), (52, 66)] {
            height.row_mut(y)[x] -= 900.0;
        }
        [height, flow]
    })
}

/// A chain of levels: each window is what the next finer one is made from.
struct Chain<'a> {
    op: &'a dyn Levelled,
    /// The windows of the levels from the coarsest.
    windows: Vec<Window>,
    /// The inputs of the coarsest level.
    coarsest: Vec<Option<Grid>>,
    /// Which of the other inputs are given, as a function of the position.
    given: Vec<bool>,
}

const fn context(progress: &Progress) -> Context<'_> {
    Context { world_params: &WORLD, progress, observer: None }
}

/// A factor by the position: smooth, with a hole.
fn factor(window: &Window, input: usize) -> Grid {
    let metres = window.cell;
    sampled(window, |x, y| {
        let (x, y) = ((x * metres).rem_euclid(61_440.0), (y * metres).rem_euclid(61_440.0));
        let wave = libm::sin(x / (1500.0 + 400.0 * input as f64)) * libm::cos(y / 2300.0 + input as f64);
        if (x - 9000.0).hypot(y - 7000.0) < 800.0 && input % 2 == 0 { f64::NAN } else { libm::exp(0.8 * wave) }
    })
}

impl Chain<'_> {
    fn new<'a>(op: &'a dyn Levelled, level: usize, window: &Window, given: &[bool]) -> Chain<'a> {
        let mut windows = vec![*window];
        for depth in (1..=level).rev() {
            windows.insert(0, op.parent(depth, &windows[0]));
        }
        let read = windows[0].grown(op.source_halo(0));
        let [height, flow] = land();
        let place = |grid: &Grid| {
            let [left, top] = [read.width, read.height].map(|side| (grid.width() - side) / 2);
            let first = height.window();
            let part = Window { x: first.x + left as i64, y: first.y + top as i64, ..read };
            Grid::from_data(read, grid.crop(&part).unwrap().data().to_vec()).unwrap()
        };
        let mut coarsest = vec![Some(place(height)), Some(place(flow))];
        coarsest.extend((2..given.len()).map(|i| given[i].then(|| factor(&read, i))));
        Chain { op, windows, coarsest, given: given.to_vec() }
    }

    fn inputs(&self, level: usize) -> Vec<Option<Grid>> {
        let read = self.windows[level].grown(self.op.source_halo(level));
        let reads = level < self.op.levels_with_inputs();
        (0..self.given.len()).map(|i| (self.given[i] && reads && i >= 2).then(|| factor(&read, i))).collect()
    }

    fn first(&self) -> Vec<Grid> {
        let inputs: Vec<Option<&Grid>> = self.coarsest.iter().map(Option::as_ref).collect();
        self.op.coarsest(&inputs, &self.windows[0], &context(&Progress::none())).unwrap()
    }

    fn on_processor(&self, level: usize, above: &[Grid]) -> Vec<Grid> {
        let inputs = self.inputs(level);
        let inputs: Vec<Option<&Grid>> = inputs.iter().map(Option::as_ref).collect();
        self.op.refine(level, above, &inputs, &self.windows[level], &context(&Progress::none())).unwrap()
    }

    fn on_card(&self, gpu: &Gpu, level: usize, above: &[Grid]) -> Vec<Grid> {
        let inputs = self.inputs(level);
        let inputs: Vec<Option<&Grid>> = inputs.iter().map(Option::as_ref).collect();
        let given: Vec<bool> = inputs.iter().map(Option::is_some).collect();
        refine(gpu, &passes(self.op, level, &given), above, &inputs, &self.windows[level], || false).unwrap().unwrap()
    }
}

fn passes(op: &dyn Levelled, level: usize, given: &[bool]) -> LevelPasses {
    match op.lower(level, given, &WORLD) {
        Lowering::Shader(passes) => passes,
        other => panic!("level {level}: {other:?}"),
    }
}

/// How two levels differ.
#[derive(Debug)]
struct Difference {
    /// Share of the samples with another receiver.
    receivers: f64,
    /// Heights: the worst difference and the root of the mean square, in metres, and the share of samples that are off by more than 1e-4 of the range.
    worst: f64,
    rms: f64,
    far: f64,
    /// Share of the samples whose area is off by more than a thousandth.
    areas: f64,
    /// The worst difference of the other planes.
    others: [f64; 8],
}

fn difference(expected: &[Grid], made: &[Grid]) -> Difference {
    assert_eq!(made.len(), expected.len());
    let samples = expected[0].data().len() as f64;
    let share = |plane: usize, is_off: &dyn Fn(f32, f32) -> bool| {
        let pairs = expected[plane].data().iter().zip(made[plane].data());
        pairs.filter(|(a, b)| is_off(**a, **b)).count() as f64 / samples
    };
    let (low, high) = expected[HEIGHT].data().iter().fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let range = (high - low).max(0.1);
    let apart = |plane: usize| {
        assert_eq!(expected[plane].window(), made[plane].window());
        let pairs = expected[plane].data().iter().zip(made[plane].data());
        pairs.map(|(a, b)| f64::from((a - b).abs())).collect::<Vec<_>>()
    };
    let heights = apart(HEIGHT);
    Difference {
        receivers: share(RECEIVER, &|a, b| a != b),
        worst: heights.iter().copied().fold(0.0, f64::max),
        rms: (heights.iter().map(|d| d * d).sum::<f64>() / samples).sqrt(),
        far: share(HEIGHT, &|a, b| (a - b).abs().is_nan() || (a - b).abs() > 1e-4 * range),
        areas: share(AREA, &|a, b| (a - b).abs() > 1e-3 * a),
        others: std::array::from_fn(|plane| apart(plane).into_iter().fold(0.0, f64::max)),
    }
}

fn report(case: &str, level: usize, difference: &Difference) {
    let Difference { receivers, worst, rms, far, areas, others } = difference;
    println!(
        "{case:<32} level {level}: receivers {receivers:.1e}, heights: worst {worst:.1e} m, RMS {rms:.1e} m, far {far:.1e}, areas {areas:.1e}"
    );
    for (name, worst) in PLANES.iter().zip(others).filter(|(_, worst)| **worst > 1e-5) {
        if !["height", "area", "receiver"].contains(name) {
            println!("    {name}: {worst:.1e}");
        }
    }
}

/// As the preset `alpine` has it.
fn alpine() -> Amplify {
    Amplify { cell: 60.0, halvings: 3, creep: 1.2, variation: 0.75, ..Default::default() }
}

/// No optional input, and those that `alpine` gives.
const NO_INPUTS: [bool; 8] = [true, true, false, false, false, false, false, false];
const ALPINE_INPUTS: [bool; 8] = [true, true, false, true, true, true, true, false];
const ALL_INPUTS: [bool; 8] = [true, true, false, true, true, true, true, true];

fn windows(cell: f64) -> [(&'static str, Window); 4] {
    let far = (1e6 / cell) as i64;
    [
        ("near", Window::new(64, 51, cell).at(10, 7)),
        ("odd", Window::new(37, 23, cell).at(-41, 15)),
        ("far", Window::new(33, 40, cell).at(far, -far - 3)),
        ("one sample", Window::new(1, 1, cell).at(1, -2)),
    ]
}

/// Compares each level, made from the processor's level above, and all levels together.
fn compare(gpu: &Gpu, name: &str, op: &dyn Levelled, given: &[bool]) {
    let finest = op.levels().count - 1;
    for (place, window) in windows(op.levels().cell(finest)) {
        let chain = Chain::new(op, finest, &window, given);
        let case = format!("{name}, {place}");
        let mut above = chain.first();
        let mut on_card = above.clone();
        for level in 1..=finest {
            let expected = chain.on_processor(level, &above);
            let made = chain.on_card(gpu, level, &above);
            let one = difference(&expected, &made);
            report(&case, level, &one);
            on_card = chain.on_card(gpu, level, &on_card);
            if level == finest {
                report(&format!("{case}, all on the card"), level, &difference(&expected, &on_card));
            }
            above = expected;
        }
    }
}

#[test]
fn levels_are_those_of_the_processor() {
    let gpu = shared_gpu();
    println!("{}", gpu.adapter());
    compare(gpu, "alpine", &alpine(), &ALPINE_INPUTS);
    compare(gpu, "no inputs", &Amplify { halvings: 3, creep: 0.0, ..alpine() }, &NO_INPUTS);
    compare(gpu, "rain", &Amplify { relief: 2.0, seed: 7, variation: 2.0, ..alpine() }, &ALL_INPUTS);
    compare(gpu, "sea", &Amplify { sea: true, ..alpine() }, &ALPINE_INPUTS);
    compare(gpu, "details", &Amplify { details: 2, cell: 120.0, halvings: 2, ..alpine() }, &ALPINE_INPUTS);
}
