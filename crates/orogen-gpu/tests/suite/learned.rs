//! Learned detail on any adapter of this machine, compared with the processor.

use crate::common;
use crate::common::filters::{gpu, gpu_with_buffers_of, heights};
use crate::common::gpu as shared_gpu;
use crate::common::levels::{WORLD, context, passes, windows};
use orogen_engine::declare::Declared;
use orogen_engine::device::PassStep;
use orogen_engine::levelled::Learned;
use orogen_engine::lower::Lowering;
use orogen_engine::node::Node;
use orogen_engine::op::{GridInputs, Levelled};
use orogen_engine::{Grid, Recipe, Window};
use orogen_gpu::Failure;
use orogen_grid::progress::Progress;

fn op() -> Learned {
    Learned { cell: 60.0, halvings: 3, ..Learned::default() }
}

/// The op with a network of 16 channels and one layer.
fn small() -> Learned {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/network/small.network");
    let text = format!(
        "orogen = 1\n[nodes.flat]\nop = \"constant\"\n[nodes.land]\nop = \"learned\"\nsource = \"flat\"\n\
         cell = 60\nhalvings = 3\nweights = '{file}'\n[outputs]\nheight = \"land\"\n"
    );
    // Files are read when a recipe is opened.
    let world = common::processor().open(Recipe::parse(&text, "test").unwrap()).unwrap();
    let learned = world.recipe().nodes().iter().find_map(|named| match &named.node {
        Node::Learned(op) => Some(op.clone()),
        _ => None,
    });
    learned.unwrap()
}

/// The windows of the levels from the coarsest, down to that of the finest one.
fn chain(op: &Learned, finest: &Window) -> Vec<Window> {
    let mut all = vec![*finest];
    for level in (1..op.levels().count).rev() {
        all.insert(0, op.parent(level, &all[0]));
    }
    all
}

fn steps(op: &Learned, windows: &[Window]) -> Vec<PassStep<'static>> {
    let step = |(level, window): (usize, &Window)| common::step(passes(op, level, &[true]), &[], window);
    windows.iter().enumerate().skip(1).map(step).collect()
}

fn on_processor(op: &Learned, level: usize, above: &Grid, window: &Window) -> Grid {
    let (progress, inputs) = (Progress::none(), [None]);
    let inputs = GridInputs::new(op.spec(), &inputs);
    op.refine(level, std::slice::from_ref(above), &inputs, window, &context(&progress)).unwrap().remove(0)
}

/// Compares each level, made from the processor's level above, and all levels together.
fn compare(case: &str, op: &Learned) {
    for (place, window) in windows(60.0) {
        let chain = chain(op, &window);
        let steps = steps(op, &chain);
        let mut above = heights(&chain[0]);
        let all = common::run(shared_gpu(), &steps, std::slice::from_ref(&above), || false).unwrap().unwrap();
        for (level, step) in (1..).zip(&steps) {
            let exact = on_processor(op, level, &above, &chain[level]);
            let made = common::run(shared_gpu(), std::slice::from_ref(step), &[above], || false).unwrap().unwrap();
            let apart = common::difference(&exact, &made[0]);
            println!("{case}, {place}, level {level}: {apart:?}");
            assert!(apart.share < 1e-5, "{case}, {place}, level {level}: {apart:?}");
            above = exact;
        }
        let apart = common::difference(&above, &all[0]);
        println!("{case}, {place}, all levels: {apart:?}");
        assert!(apart.share < 1e-5, "{case}, {place}: {apart:?}");
    }
}

#[test]
fn learned_detail_is_that_of_the_processor() {
    println!("{}", shared_gpu().adapter());
    compare("a draw", &op());
    compare("the most likely land", &Learned { noise: 0.0, ..op() });
    compare("another draw", &Learned { noise: 2.0, seed: u64::MAX, ..op() });
    let small = small();
    assert_ne!(small.halo(1), op().halo(1));
    compare("another network", &small);
    assert!(matches!(op().lower(0, &[true], &WORLD), Lowering::Processor(_)));
}

#[test]
fn missing_heights_and_standing_water_are_those_of_the_processor() {
    let op = Learned { halvings: 1, ..op() };
    let chain = chain(&op, &Window::new(90, 80, 60.0).at(-31, 6));
    let mut above = heights(&chain[0]);
    for (j, i) in [(30, 22), (40, 51)] {
        above.row_mut(j)[i] = f32::NAN;
    }
    // A lake.
    for j in 20..34 {
        above.row_mut(j)[28..48].fill(250.0);
    }
    let exact = on_processor(&op, 1, &above, &chain[1]);
    let made = common::run(shared_gpu(), &steps(&op, &chain), &[above], || false).unwrap().unwrap();
    let apart = common::difference(&exact, &made[0]);
    println!("{apart:?}");
    assert!(apart.worst.is_finite() && apart.share < 1e-5, "{apart:?}");
    assert!(exact.data().iter().any(|height| height.is_nan()));
    let water = |grid: &Grid| grid.data().iter().filter(|height| **height == 250.0).count();
    assert!(water(&exact) > 100 && water(&exact) == water(&made[0]));
}

#[test]
fn tiles_of_learned_detail_give_the_same() {
    let op = op();
    let chain = chain(&op, &Window::new(61, 45, 60.0).at(-7, 3));
    let (steps, above) = (steps(&op, &chain), [heights(&chain[0])]);
    let whole = common::run(shared_gpu(), &steps, &above, || false).unwrap().unwrap();
    // The planes for about 20 x 20 nodes.
    let tiled = common::run(&gpu_with_buffers_of(4 * 70 * 38 * 38), &steps, &above, || false).unwrap().unwrap();
    let apart = common::difference(&whole[0], &tiled[0]);
    assert!(apart.share < 1e-6, "{apart:?}");
    let made = common::run(&gpu_with_buffers_of(10_000), &steps, &above, || false);
    assert!(matches!(made, Err(Failure::Memory(_))), "{made:?}");
    assert!(common::run(shared_gpu(), &steps, &above, || true).unwrap().is_none());
}

#[test]
fn only_the_heights_of_learned_detail_are_copied_back() {
    let text = "orogen = 1\n[world]\nsize = [30720, 30720]\ncell = 60\n[nodes.hills]\nop = \"fbm\"\nwavelength = 9000\n\
        [nodes.heights]\nop = \"multiply\"\na = \"hills\"\nb = 900\n\
        [nodes.land]\nop = \"learned\"\nsource = \"heights\"\ncell = 60\nhalvings = 3\n\
        [nodes.soft]\nop = \"blur\"\nsource = \"land\"\nradius = 90\n[outputs]\nheight = \"soft\"\n";
    let recipe = Recipe::parse(text, "test").unwrap();
    let gpu = gpu();
    let session = common::session_of(&gpu);
    let window = Window::new(400, 300, 60.0).at(40, 50);
    let made = |recipe: &Recipe| session.open(recipe.clone()).unwrap().window("height", &window).unwrap();
    made(&recipe);
    let _ = gpu.take_moved();
    let compiled = gpu.shaders_compiled();
    let mut other = recipe.clone();
    other.change(|node| {
        if let Node::Learned(op) = node {
            (op.noise, op.seed) = (0.5, 4);
        }
    });
    let heights = made(&other);
    assert_eq!(gpu.failure(), None);
    let moved = gpu.take_moved();
    println!("{moved:?}");
    assert!(moved.back < 2 * window.len() as u64, "{moved:?}");
    assert_eq!(gpu.shaders_compiled(), compiled);
    let apart = common::difference(&common::exact(&other, "height", &window), &heights);
    println!("{apart:?}");
    assert!(apart.share < 1e-5, "{apart:?}");
}
