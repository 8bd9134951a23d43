//! Layers of levels on any adapter of this machine, compared with the processor.

use crate::common;
use crate::common::filters::{gpu, gpu_with_buffers_of};
use crate::common::gpu as shared_gpu;
use crate::common::levels::{ALPINE_INPUTS, Chain, NO_INPUTS, RECEIVER, WORLD, alpine, context, windows};
use orogen_engine::device::PassStep;
use orogen_engine::levelled::{Amplify, Continents};
use orogen_engine::lower::{Lowering, Passes};
use orogen_engine::op::Levelled;
use orogen_engine::{Recipe, Session};
use orogen_gpu::{Failure, Gpu};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

const LAYERS: [&str; 7] = ["height", "flow", "lake", "surface", "receiver", "width", "depth"];

/// All layers that a card makes.
fn wanted(op: &dyn Levelled) -> Vec<bool> {
    (0..op.spec().layers.len()).map(|layer| layer < LAYERS.len()).collect()
}

fn passes(op: &dyn Levelled, level: usize, wanted: &[bool]) -> Passes {
    match op.lower_layers(level, wanted, &WORLD) {
        Lowering::Shader(passes) => passes,
        other => panic!("{other:?}"),
    }
}

/// Layers of the last level of a chain over its window without the halo, from the level above.
fn on_card(gpu: &Gpu, chain: &Chain, above: &[Grid], wanted: &[bool]) -> Result<Vec<Grid>, Failure> {
    let level = chain.windows.len() - 1;
    let halo = chain.op.surface_halo(level, wanted);
    let window = chain.windows[level].shrunk(halo);
    let layers = PassStep { passes: passes(chain.op, level, wanted), inputs: Vec::new(), window };
    Ok(common::run(gpu, &[chain.step(level), layers], above, || false)?.unwrap())
}

/// The same layers computed by the processor, from the level that the card made.
fn on_processor(gpu: &Gpu, chain: &Chain, above: &[Grid], wanted: &[bool]) -> Vec<Grid> {
    let level = chain.windows.len() - 1;
    let planes = chain.on_card(gpu, level, above);
    let window = planes[0].window().shrunk(chain.op.surface_halo(level, wanted));
    let mut out: Vec<Option<Grid>> = wanted.iter().map(|wanted| wanted.then(|| Grid::filled(window, 0.0))).collect();
    chain.op.layers_of(level, &planes, &window, &mut out, &context(&Progress::none())).unwrap();
    out.into_iter().flatten().collect()
}

/// A chain whose layers are over a window.
fn chain<'a>(op: &'a dyn Levelled, level: usize, window: &Window, given: &[bool]) -> Chain<'a> {
    let window = window.grown(op.surface_halo(level, &wanted(op)));
    if given.len() > 6 { Chain::new(op, level, &window, given) } else { Chain::of_nothing(op, level, &window) }
}

/// Compares the layers of the last level of a chain. Returns the shares of samples in water and in rivers.
fn compare(gpu: &Gpu, case: &str, chain: &Chain) -> [f64; 2] {
    let wanted = wanted(chain.op);
    let above = chain.until(chain.windows.len() - 2);
    let expected = on_processor(gpu, chain, &above, &wanted);
    let made = on_card(gpu, chain, &above, &wanted).unwrap();
    assert_eq!(made.len(), LAYERS.len());
    for (name, (expected, made)) in LAYERS.iter().zip(expected.iter().zip(&made)) {
        let apart = common::difference(expected, made);
        println!("{case:<28} {name:<8} {apart:?}");
        // A rounding error may decide which node is nearest, or whether a sample is in water.
        assert!(apart.share <= 1e-4 || apart.beyond <= 2e-3, "{case}, {name}: {apart:?}");
    }
    let share = |is: &dyn Fn(usize) -> bool| {
        let samples = 0..expected[0].data().len();
        samples.clone().filter(|k| is(*k)).count() as f64 / samples.len().max(1) as f64
    };
    [share(&|k| expected[3].data()[k] > expected[0].data()[k]), share(&|k| expected[5].data()[k] > 0.0)]
}

#[test]
fn layers_are_those_of_the_processor() {
    let gpu = shared_gpu();
    println!("{}", gpu.adapter());
    let sea = Amplify { sea: true, ..alpine() };
    // Rivers that are several cells of 30 m wide.
    let details = Amplify { details: 2, cell: 120.0, halvings: 2, runoff: 1000.0, ..alpine() };
    let cases: [(&str, &Amplify, usize); 5] = [
        ("alpine", &details, 2),
        ("a coarse level", &alpine(), 2),
        ("details", &details, 4),
        ("a sea", &sea, 3),
        ("a coarse level of a sea", &sea, 2),
    ];
    let mut shares = Vec::new();
    for (name, op, level) in cases {
        let of_windows = windows(op.levels().cell(level)).map(|(place, window)| {
            let given = if place == "odd" { &NO_INPUTS } else { &ALPINE_INPUTS };
            compare(gpu, &format!("{name}, {place}"), &chain(op, level, &window, given))
        });
        shares.push(of_windows.into_iter().fold([0.0f64; 2], |most, now| [most[0].max(now[0]), most[1].max(now[1])]));
    }
    println!("water and rivers: {shares:?}");
    assert!(shares[3][0] > 0.01 && shares[4][0] > 0.01 && shares[2][1] > 0.01, "{shares:?}");
    assert_eq!(gpu.failure(), None);
}

/// A window that has lakes for some seeds.
const LAKES: Window = Window { x: -20, y: 31, width: 150, height: 120, cell: 60.0 };

#[test]
fn beds_and_lakes_are_cut_as_by_the_processor() {
    let gpu = shared_gpu();
    // So much water that rivers are several cells wide.
    let op = Amplify { details: 2, cell: 120.0, halvings: 2, runoff: 1000.0, stream: 1e5, ..alpine() };
    let window = Window::new(120, 90, 30.0).at(50, 20);
    let chain = chain(&op, 4, &window, &ALPINE_INPUTS);
    let above = chain.until(3);
    let heights = |op: &Amplify| {
        let chain = Chain { op, windows: chain.windows.clone(), coarsest: Vec::new(), given: chain.given.clone() };
        on_card(gpu, &chain, &above, &wanted(op)).unwrap().remove(0)
    };
    let (cut, uncut) = (heights(&op), heights(&Amplify { runoff: 0.0, ..op.clone() }));
    let lowered = cut.data().iter().zip(uncut.data()).filter(|(cut, uncut)| *cut < *uncut).count();
    println!("{lowered} samples in beds");
    assert!(lowered > 100);
    compare(gpu, "rivers", &chain);
    // A seed with lakes in the window.
    let op = (0..40).map(|seed| Amplify { lakes: 1.0, seed, ..alpine() }).find(|op| {
        let chain = self::chain(op, 3, &LAKES, &ALPINE_INPUTS);
        let receivers = chain.until(3).remove(RECEIVER).crop(&LAKES).unwrap();
        receivers.data().iter().filter(|code| **code >= 16.0).count() > 20
    });
    let op = op.unwrap();
    let [water, _] = compare(gpu, "lakes", &self::chain(&op, 3, &LAKES, &ALPINE_INPUTS));
    assert!(water > 0.0);
    let op = Continents { halvings: 8, cell: 480.0, creep: 1.0, ..Default::default() };
    compare(gpu, "continents", &self::chain(&op, 8, &Window::new(50, 40, 480.0).at(700, -311), &[false; 6]));
}

#[test]
fn tiles_and_other_layers_give_the_same() {
    let op = Amplify { details: 1, cell: 60.0, halvings: 2, runoff: 1000.0, ..alpine() };
    let chain = chain(&op, 3, &Window::new(70, 50, 30.0).at(-7, 3), &ALPINE_INPUTS);
    let above = chain.until(2);
    let all = wanted(&op);
    let whole = on_card(shared_gpu(), &chain, &above, &all).unwrap();
    let smaller = gpu_with_buffers_of(4 << 20);
    let tiled = on_card(&smaller, &chain, &above, &all).unwrap();
    for (whole, tiled) in whole.iter().zip(&tiled) {
        assert!(common::difference(whole, tiled).share < 1e-6);
    }
    let two: Vec<bool> = (0..all.len()).map(|layer| layer == 1 || layer == 5).collect();
    assert_eq!(on_card(shared_gpu(), &chain, &above, &two).unwrap(), [whole[1].clone(), whole[5].clone()]);
    let made = on_card(&gpu_with_buffers_of(10_000), &chain, &above, &all);
    assert!(matches!(made, Err(Failure::Memory(_))));
    let floods: Vec<bool> = (0..all.len()).map(|layer| layer == 7).collect();
    assert!(matches!(op.lower_layers(3, &floods, &WORLD), Lowering::Processor(_)));
}

#[test]
fn only_layers_of_levels_are_copied_back() {
    let text = "orogen = 1\n[world]\nsize = [30720, 30720]\ncell = 60\n[nodes.hills]\nop = \"fbm\"\nwavelength = 9000\n\
        [nodes.heights]\nop = \"multiply\"\na = \"hills\"\nb = 900\n[nodes.water]\nop = \"drainage\"\nsource = \"heights\"\ncell = 480\n\
        [nodes.land]\nop = \"amplify\"\nsource = \"heights\"\nflow = \"water.flow\"\ncell = 480\nhalvings = 3\n\
        [nodes.soft]\nop = \"blur\"\nsource = \"land\"\nradius = 90\n[outputs]\nheight = \"soft\"\n";
    let recipe = Recipe::parse(text, "test").unwrap();
    let gpu = gpu();
    let session: Session = common::session_of(&gpu);
    let window = Window::new(400, 300, 60.0).at(40, 50);
    let made = |recipe: &Recipe| session.open(recipe.clone()).unwrap().window("height", &window).unwrap();
    made(&recipe);
    let _ = gpu.take_moved();
    let mut other = recipe.clone();
    other.change(|node| {
        if let orogen_engine::node::Node::Amplify(op) = node {
            op.creep += 0.1;
        }
    });
    let compiled = gpu.shaders_compiled();
    let heights = made(&other);
    assert_eq!(gpu.failure(), None);
    // Samples are copied for the heights and for the coarse levels that the processor makes; a level has eight planes.
    let moved = gpu.take_moved();
    assert!(moved.back < 3 * window.len() as u64, "{moved:?}");
    assert_eq!(gpu.shaders_compiled(), compiled);
    let exact = common::exact(&other, "height", &window);
    assert!(common::difference(&exact, &heights).beyond < 1e-2, "{:?}", common::difference(&exact, &heights));
}
