//! Programs on any adapter of this machine, compared with the processor.

use crate::common;
use crate::common::{compare, gpu, session};
use orogen_engine::device::{Computed, Device, DeviceGrid, LoweredProgram, PassRun, PlanGrid};
use orogen_engine::{Grid, Progress, Recipe, Result, Window};
use orogen_gpu::gpu::Options;
use orogen_gpu::{Choice, Failure, Gpu};
use std::sync::Arc;

/// Positions as numbers: `x` and `y` rise by 1 in 1000 m, and `wave` has a smooth hill and valley.
const POSITIONS: &str = "orogen = 1\n[nodes.x]\nop = \"ramp\"\n[nodes.y]\nop = \"ramp\"\nazimuth = 180\n\
    [nodes.wave]\nop = \"expr\"\nexpr = \"sin(3 * x) * cos(2 * y)\"\n";

/// Fields that read no noise, and each function of expressions.
fn fields() -> Vec<String> {
    let expressions = [
        "x + y - x * y / (2 + x)",
        "x % 0.37",
        "-y",
        "(x < y) + 2 * (x <= 0.5) + 4 * (y > 0.25) + 8 * (y >= x) + (x == y) + (x != y)",
        "pow(abs(x) + 0.1, y) + (x + 3)^0.5 + y^2 + y^3",
        "min(x, y) + max(x, 0.3) + smin(x, y, 0.2) + smax(x, y, 0.5)",
        "clamp(x, 0.2, 0.6) + mix(x, y, wave) + lerp(y, x, wave) + smoothstep(0.1, 0.9, x) + step(0.4, y)",
        "abs(wave) + sign(wave) + floor(3 * x) + ceil(3 * y) + round(5 * x) + fract(4 * y)",
        "sqrt(abs(x)) + exp(y) + log(2 + wave) + log2(2 + wave) + log10(3 + x)",
        "sin(20 * x) + cos(15 * y) + tan(wave)",
        "asin(wave) + acos(wave) + atan(5 * x) + atan2(wave, x - 0.5) + tanh(3 * wave) + hypot(x, y)",
    ];
    let ops = [
        "op = \"clamp\"\nsource = \"x\"\nlow = 0.2\nhigh = 0.5",
        "op = \"curve\"\nsource = \"wave\"\npoints = [[-1, 0], [-0.5, 0.2], [0.1, 0.25], [0.4, 0.9], [1, 1]]",
        "op = \"remap\"\nsource = \"wave\"\nfrom = [-0.5, 0.5]\nto = [3, 1]\nclamp = true",
        "op = \"terrace\"\nsource = \"wave\"\nstep = 0.3\nsharpness = 0.4",
        "op = \"radial\"\ncenter = [300, 250]\nradius = 400\ninner = 50",
        "op = \"ramp\"\nazimuth = 37\norigin = [100, -20]",
        "op = \"select-height\"\nsource = \"wave\"\nrange = [-0.1, 0.4]\nfalloff = [0.3, 0.2]",
        "op = \"label\"\nsource = \"expr\"",
        "op = \"altitude\"",
        "op = \"temperature\"\nsource = \"wave\"\nmetres_per_degree = 50",
        "op = \"select-flow\"\nsource = \"flow\"\nrange = [1e3, 1e5]",
        "op = \"warp\"\nsource = \"wave\"\nx = \"y\"\ny = \"x\"\nstrength = 70",
        "op = \"transform\"\nsource = \"warped\"\nangle = 30\nscale = 1.5\noffset = [40, -70]",
        "op = \"slice\"\nsource = \"high\"\naltitude = 70",
        "op = \"mix\"\na = \"x\"\nb = \"wave\"\namount = \"y\"\nmask = \"x\"",
    ];
    let expression = |text: &str| format!("op = \"expr\"\nexpr = \"{text}\"");
    let helpers = "[nodes.expr]\nop = \"expr\"\nexpr = \"7 * wave\"\n[nodes.flow]\nop = \"expr\"\nexpr = \"exp(12 * x)\"\n\
        [nodes.warped]\nop = \"warp\"\nsource = \"wave\"\nx = \"y\"\ny = \"x\"\nstrength = 70\n\
        [nodes.above]\nop = \"altitude\"\n[nodes.high]\nop = \"add\"\na = \"wave\"\nb = \"above\"\n";
    let nodes = expressions.map(expression).into_iter().chain(ops.map(str::to_string));
    nodes.map(|node| format!("{POSITIONS}{helpers}[nodes.made]\n{node}\n[outputs]\nheight = \"made\"\n")).collect()
}

#[test]
fn fields_are_close_to_those_of_the_processor() {
    let session = session();
    let windows = [Window::new(67, 45, 13.7).at(-11, 5), Window::new(1, 1, 10.0), Window::new(9, 130, 7.3).at(3, -40)];
    for recipe in fields() {
        let recipe = Recipe::parse(&recipe, "test").unwrap();
        for window in &windows {
            let difference = compare(&session, &recipe, "height", window);
            // A sample that is rounded to another step may differ by the step.
            assert!(difference.share <= 1e-4 || difference.beyond <= 2e-3, "{window:?} {difference:?}\n{recipe:?}");
        }
    }
    assert_eq!(gpu().failure(), None);
}

#[test]
fn islands_have_their_edges() {
    let text = "orogen = 1\n[world]\nsize = [1000, 800]\ncell = 10\n[nodes.land]\nop = \"edge\"\nwidth = 150\n[outputs]\nheight = \"land\"\n";
    for text in [text.to_string(), text.replace("150", "300\ncorners = \"square\"")] {
        let recipe = Recipe::parse(&text, "test").unwrap();
        let difference = compare(&session(), &recipe, "height", &Window::new(100, 80, 10.0));
        assert!(difference.worst < 1e-5, "{difference:?}");
    }
}

#[test]
fn small_buffers_and_small_kernels_give_the_same() {
    let recipe = Recipe::parse(&fields()[10], "test").unwrap();
    let window = Window::new(200, 150, 5.0).at(-20, 9);
    let made = |options: &Options| {
        let gpu = Gpu::open(options).unwrap();
        let session = common::session_of(&gpu);
        let grid = session.open(recipe.clone()).unwrap().window("height", &window).unwrap();
        assert_eq!(gpu.failure(), None);
        grid
    };
    let whole = made(&Options::new(Choice::Any));
    for options in [
        Options::new(Choice::Any).with_buffer(60_000),
        Options::new(Choice::Any).with_kernel(1),
        Options::new(Choice::Any).with_kernel(3).with_buffer(40_000),
    ] {
        let tiled = made(&options);
        let worst = whole.data().iter().zip(tiled.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst <= 1e-6, "{options:?}: {worst}");
    }
}

#[test]
fn a_slider_compiles_nothing() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let session = common::session_of(&gpu);
    let window = Window::new(64, 64, 10.0);
    let mut compiled = Vec::new();
    for (step, strength) in [(0.3, 70.0), (0.2, 71.5), (7.0, 1.0)] {
        let text = format!(
            "{POSITIONS}[nodes.warped]\nop = \"warp\"\nsource = \"wave\"\nx = \"y\"\ny = \"x\"\nstrength = {strength}\n\
             [nodes.made]\nop = \"terrace\"\nsource = \"warped\"\nstep = {step}\n[outputs]\nheight = \"made\"\n"
        );
        session.open(Recipe::parse(&text, "test").unwrap()).unwrap().window("height", &window).unwrap();
        compiled.push(gpu.shaders_compiled());
    }
    assert!(compiled[0] > 0 && compiled.iter().all(|count| *count == compiled[0]), "{compiled:?}");
}

#[test]
fn a_lost_device_leaves_the_work_to_the_processor() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let session = common::session_of(&gpu);
    let recipe = Recipe::parse(&fields()[0], "test").unwrap();
    let window = Window::new(50, 40, 10.0);
    let exact = common::exact(&recipe, "height", &window);
    gpu.lose();
    assert_eq!(session.open(recipe).unwrap().window("height", &window).unwrap(), exact);
    assert!(gpu.failure().is_some_and(|failure| failure.to_string().contains("lost")));
}

/// A card that is lost when its first grid is read.
struct LostWhenRead(Gpu);

impl Device for LostWhenRead {
    fn fill(
        &self,
        program: &LoweredProgram,
        window: &Window,
        grids: &[&PlanGrid],
        progress: &Progress,
    ) -> Result<Computed<Vec<PlanGrid>>> {
        self.0.fill(program, window, grids, progress)
    }

    fn run(&self, run: &PassRun, progress: &Progress) -> Result<Computed<Vec<PlanGrid>>> {
        self.0.run(run, progress)
    }

    fn read(&self, grids: &[&DeviceGrid], progress: &Progress) -> Result<Computed<Vec<Grid>>> {
        self.0.lose();
        self.0.read(grids, progress)
    }
}

/// Fields, two filters that read them, and fields that read both.
const FILTERED: &str = "[nodes.steep]\nop = \"slope\"\nsource = \"wave\"\n[nodes.soft]\nop = \"blur\"\nsource = \"steep\"\nradius = 45\n\
    [nodes.made]\nop = \"expr\"\nexpr = \"steep - soft + x\"\n[outputs]\nheight = \"made\"\n";

#[test]
fn grids_stay_on_the_card() {
    let recipe = Recipe::parse(&format!("{POSITIONS}{FILTERED}"), "test").unwrap();
    let window = Window::new(70, 50, 10.0).at(-20, 9);
    let made = |options: &Options| {
        let gpu = Gpu::open(options).unwrap();
        let grid = common::session_of(&gpu).open(recipe.clone()).unwrap().window("height", &window).unwrap();
        assert_eq!(gpu.failure(), None);
        (grid, gpu.take_moved())
    };
    let (whole, moved) = made(&Options::new(Choice::Any));
    assert_eq!((moved.there, moved.back), (0, window.len() as u64), "only the result is copied back");
    let exact = common::exact(&recipe, "height", &window);
    assert!(common::difference(&exact, &whole).share < 1e-4, "{:?}", common::difference(&exact, &whole));
    // Grids that are larger than a buffer are copied through memory.
    let (tiled, moved) = made(&Options::new(Choice::Any).with_buffer(12_000));
    assert!(moved.there > 0 && moved.back > window.len() as u64, "{moved:?}");
    let worst = whole.data().iter().zip(tiled.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(worst <= 1e-5, "{worst}");
    // Grids in tiles, each of which fits into a buffer with its planes.
    let (tiled, moved) = made(&Options::new(Choice::Any).with_buffer(40_000));
    assert_eq!((moved.there, moved.back), (0, window.len() as u64));
    let worst = whole.data().iter().zip(tiled.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(worst <= 1e-5, "{worst}");
}

#[test]
fn a_device_that_is_lost_with_its_grids_leaves_the_work_to_the_processor() {
    let gpu = Gpu::open(&Options::new(Choice::Any)).unwrap();
    let session = common::processor().with_device(Arc::new(LostWhenRead(gpu.clone())));
    let recipe = Recipe::parse(&format!("{POSITIONS}{FILTERED}"), "test").unwrap();
    let window = Window::new(50, 40, 10.0);
    let exact = common::exact(&recipe, "height", &window);
    assert_eq!(session.open(recipe).unwrap().window("height", &window).unwrap(), exact);
    assert!(gpu.failure().is_some_and(|failure| failure.to_string().contains("lost")));
}

/// Presets whose solvers take about ten seconds each with a software driver.
const SLOW: [&str; 7] = ["badlands", "canyon", "fjords", "glaciers", "himalaya", "hills", "rolling"];

#[test]
fn presets_are_close_to_those_of_the_processor() {
    compare_presets(|name| !SLOW.contains(&name));
}

#[test]
#[ignore = "long: a minute with a software driver"]
fn presets_with_more_lakes_are_close_to_those_of_the_processor() {
    compare_presets(|name| SLOW.contains(&name));
}

fn compare_presets(is_wanted: impl Fn(&str) -> bool) {
    let session = session();
    for preset in orogen_engine::presets::all().iter().filter(|preset| is_wanted(preset.name)) {
        let recipe = preset.recipe().unwrap();
        let world = session.open(recipe.clone()).unwrap();
        let window = world.window_fitting(96).unwrap_or(Window::new(96, 96, recipe.world.cell));
        let begun = std::time::Instant::now();
        let made = world.window("height", &window).unwrap();
        let seconds = begun.elapsed().as_secs_f64();
        let difference = common::difference(&common::exact(&recipe, "height", &window), &made);
        println!("{} {difference:?} {seconds:.2} s, {} shaders", preset.name, gpu().shaders_compiled());
        assert!(difference.beyond < 1e-2, "{} {difference:?}", preset.name);
        // Domains of some presets are larger than the buffers of software drivers.
        let failure = gpu().failure();
        assert!(matches!(failure, None | Some(Failure::Memory(_))), "{} {failure:?}", preset.name);
    }
}

#[test]
fn concurrent_requests_share_a_device() {
    let session = session();
    let recipe = Recipe::parse(&fields()[9], "test").unwrap();
    let window = Window::new(120, 90, 9.0);
    let expect = common::exact(&recipe, "height", &window);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                for _ in 0..5 {
                    let made = session.open(recipe.clone()).unwrap().window("height", &window).unwrap();
                    assert!(common::difference(&expect, &made).share < 1e-4);
                }
            });
        }
    });
    assert_eq!(gpu().failure(), None);
}
