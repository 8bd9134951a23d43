//! Recipes drawn at random from the declarations of all ops. New ops are included automatically.

use super::values::value;
use crate::support::{DEM, DRAWINGS, NETWORK, PICTURE, Random};
use orogen::declare::{Input, Locality};
use orogen::io::dem::FileKind;
use orogen::io::format::outlines::DrawingKind;
use orogen::node::Node;
use orogen::{Budget, ErrorKind, Options, Recipe, Session, Window, WorldSpec};

/// A recipe, and the window in which it is compared.
pub struct Grown {
    pub recipe: Recipe,
    pub window: Window,
}

/// Statistics of the nodes that were drawn.
#[derive(Debug, Default)]
pub struct Tally {
    pub graphs: usize,
    pub nodes: usize,
    /// Parameters that are not valid together, although each is in its range; the message says why.
    pub refused: usize,
    /// The plan states that a node takes more time or memory than a test should.
    pub expensive: usize,
    /// Number of requests under a memory limit, and number of them that were refused.
    pub limited: [usize; 2],
}

/// Memory of a plan in bytes, and work in nanoseconds, above which a graph is too expensive for repeated runs.
const MEMORY: u64 = 256 << 20;
const WORK: f64 = 2e8;
/// Work limit for the last node and its inputs; it is larger because the levels of `continents` are made in tiles.
const WORK_OF_LAST: f64 = 6e8;

/// Number of nodes of a graph, and number of attempts to draw each.
const NODES: u64 = 14;
const ATTEMPTS: usize = 12;

/// The graph for a seed. Each op in turn is the last node. `seen` is called with every recipe before it is opened.
pub fn grown(seed: u64, tally: &mut Tally, seen: &mut dyn FnMut(&Recipe)) -> Grown {
    let mut random = Random(seed);
    let ops = Node::all();
    let last = &ops[seed as usize % ops.len()];
    let world = world(last, &mut random);
    let session = Session::new(Options { threads: Some(1), memory: Budget::of(MEMORY), ..Options::default() }).unwrap();
    let window = window(&session, world, &mut random);
    let mut recipe = Recipe::new(world);
    let count = 1 + random.below(NODES);
    for k in (0..count).rev() {
        for _ in 0..ATTEMPTS {
            let (op, work) = if k == 0 { (last, WORK_OF_LAST) } else { (random.of(&ops), WORK) };
            if world.size.is_none() && op.spec().locality == Locality::Solver {
                continue;
            }
            let candidate = with_node(&recipe, op, &mut random);
            seen(&candidate);
            if is_possible(&session, &candidate, &window, work, tally) {
                recipe = candidate;
                tally.nodes += 1;
                break;
            }
        }
    }
    tally.graphs += 1;
    Grown { recipe: with_outputs(&recipe, &mut random), window }
}

/// A number between `least` and `decades` orders of magnitude more.
fn magnitude(least: f64, decades: f64, random: &mut Random) -> f64 {
    least * libm::pow(10.0, decades * random.share())
}

/// A world of at most 160 x 160 cells, bounded if `op` requires it.
fn world(op: &Node, random: &mut Random) -> WorldSpec {
    let cell = match random.below(4) {
        0 => magnitude(1e-4, 11.0, random),
        _ => *random.of(&[10.0, 30.0, 0.1, 1.0 / 3.0, 250.0]),
    };
    let side = |random: &mut Random| {
        let cells = if random.below(4) == 0 { 1.0 + 4.0 * random.share() } else { 160.0 * random.share() };
        (cell * cells.max(1.0)).clamp(1e-3, 1e9)
    };
    let size = (op.spec().locality == Locality::Solver || random.below(3) > 0).then(|| [(); 2].map(|()| side(random)));
    let sea_level = *random.of(&[0.0, 0.25, -1e6, 120.0]);
    WorldSpec::default().with_seed(random.below(1 << 40)).with_size(size).with_cell(cell).with_sea_level(sea_level)
}

/// A window of the world, at its cell or another one, of at most some thousand samples.
fn window(session: &Session, world: WorldSpec, random: &mut Random) -> Window {
    let cell = world.cell * random.of(&[1.0, 1.0, 1.0, 0.5, 2.0, 0.37, 1.7]);
    let [mut width, mut height] = [(); 2].map(|()| 1 + random.below(90) as usize);
    if world.size.is_none() {
        let [x, y] = [(); 2].map(|()| *random.of(&[0i64, -20, 1_000_003, -97_656_250, 1 << 40]));
        return Window::new(width, height, cell).at(x, y);
    }
    let mut bare = Recipe::new(world);
    bare.output("height", 0.0);
    let whole = session.open(bare).unwrap().surroundings(&Window::new(1, 1, cell), 1 << 12);
    (width, height) = (width.min(whole.width), height.min(whole.height));
    let mut start = |side: usize, part: usize| random.below((side - part + 1) as u64) as i64;
    let (x, y) = (start(whole.width, width), start(whole.height, height));
    Window::new(width, height, cell).at(x, y)
}

/// The recipe with one more node of this op.
fn with_node(recipe: &Recipe, op: &Node, random: &mut Random) -> Recipe {
    let (mut recipe, mut node, cell) = (recipe.clone(), op.clone(), recipe.world.cell);
    let file = match node.files().first().map(|file| file.kind()) {
        Some(FileKind::Picture) => PICTURE,
        Some(FileKind::Drawing(DrawingKind::Lines)) => DRAWINGS[0],
        Some(FileKind::Drawing(DrawingKind::Areas)) => DRAWINGS[1],
        Some(FileKind::Network) => NETWORK,
        Some(FileKind::Drawing(DrawingKind::Ridges)) => DRAWINGS[2],
        _ => DEM,
    };
    for (i, spec) in op.spec().params.iter().enumerate() {
        // Some parameters keep their defaults, as in most recipes.
        if random.below(3) > 0 {
            let file = if spec.name == "ridges_file" { DRAWINGS[2] } else { file };
            let drawn = value(spec, cell, file, random);
            node.set_param(i, &drawn)
                .unwrap_or_else(|why| panic!("`{}` of `{}` = {}: {why}", spec.name, op.spec().op, drawn.to_toml()));
        }
    }
    let inputs: Vec<bool> = node.inputs().iter().map(|input| input.required).collect();
    for (i, required) in inputs.into_iter().enumerate() {
        if required || random.below(2) == 0 {
            let input = input(&recipe, random);
            node.set_input(i, input);
        }
    }
    let mask = if random.below(5) == 0 { input(&recipe, random) } else { Input::None };
    let name = format!("n{}", recipe.nodes().len());
    recipe.add_masked(&name, node, mask);
    recipe
}

/// A layer of a node, or a number if there is none, and sometimes also otherwise.
fn input(recipe: &Recipe, random: &mut Random) -> Input {
    if recipe.nodes().is_empty() || random.below(8) == 0 {
        return Input::Value(*random.of(&[0.0, 1.0, -0.5, 300.0, 1e-9, 1e9]));
    }
    let named = random.of(recipe.nodes());
    Input::Node(format!("{}.{}", named.name, random.of(named.node.layers()).name))
}

/// The recipe with outputs: some layers of the last node, and one layer of any node.
fn with_outputs(recipe: &Recipe, random: &mut Random) -> Recipe {
    let mut made = recipe.clone();
    if let Some(last) = recipe.nodes().last() {
        let layers = last.node.layers();
        let first = random.below(layers.len() as u64) as usize;
        for layer in layers.iter().cycle().skip(first).take(layers.len().min(4)) {
            made.output(layer.name, Input::Node(format!("{}.{}", last.name, layer.name)));
        }
    }
    made.output("other", input(recipe, random));
    made
}

/// Whether a recipe can be made over a window, at a cost that allows many runs.
fn is_possible(session: &Session, recipe: &Recipe, window: &Window, most_work: f64, tally: &mut Tally) -> bool {
    let mut recipe = recipe.clone();
    let Some(last) = recipe.nodes().last() else { return false };
    let layers: Vec<Input> =
        last.node.layers().iter().map(|layer| Input::Node(format!("{}.{}", last.name, layer.name))).collect();
    for (k, layer) in layers.into_iter().enumerate() {
        recipe.output(&format!("layer{k}"), layer);
    }
    let planned = session.open(recipe).and_then(|world| {
        let layers: Vec<&str> = world.recipe().outputs().collect();
        let plan = world.plan(&layers, window)?;
        let [memory, work] = [world.memory_of(&plan)? as f64 / MEMORY as f64, world.work(&plan)? / most_work];
        if memory > 1.0 {
            let refused = world.run(&plan, &orogen::Progress::none()).map(drop).unwrap_err();
            assert_eq!(refused.kind(), ErrorKind::Memory, "{refused}");
        }
        Ok(memory.max(work) <= 1.0)
    });
    match planned {
        Ok(true) => true,
        Ok(false) => {
            tally.expensive += 1;
            false
        }
        Err(error) => {
            assert!(error.kind() != ErrorKind::Internal && error.to_string().len() > 20, "{error}");
            tally.refused += 1;
            false
        }
    }
}
