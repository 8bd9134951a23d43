//! Solvers whose domain extends beyond the world.

use orogen_engine::declare::{Input, LinePoints, MARGIN, Param};
use orogen_engine::field::{Fbm, Multiply, Transform};
use orogen_engine::laws::Laws;
use orogen_engine::node::Node;
use orogen_engine::op::{Context, Reading, Solution, Solver, Sources};
use orogen_engine::solver::{Drainage, Fill, Normalise};
use orogen_engine::value::{Spanned, Value};
use orogen_engine::{Budget, ErrorKind, Grid, Options, Progress, Recipe, Result, Window, World, WorldSpec};

/// Cells of 10 m: positions and their offsets are exact, so the land of two worlds has the same bits.
const CELL: f64 = 10.0;

const SAMPLES: [usize; 2] = [90, 70];

/// The margin in cells.
const AROUND: usize = 24;

fn world(beyond: usize) -> WorldSpec {
    let size = SAMPLES.map(|samples| (samples + 2 * beyond) as f64 * CELL);
    WorldSpec::default().with_seed(5).with_size(Some(size)).with_cell(CELL)
}

fn set(node: &mut Node, name: &str, value: &Value) {
    if let Some(param) = node.spec().params.iter().position(|param| param.name == name) {
        node.set_param(param, value).unwrap();
    }
}

/// A solver of terrain whose origin is `shift` cells from the world's origin. Random choices that depend on a sample's
/// index are switched off.
fn recipe_of(node: &Node, world: WorldSpec, shift: usize) -> Recipe {
    let mut node = node.clone();
    let metres = shift as f64 * CELL;
    let pair = |at: [f64; 2]| Value::List(at.map(|n| Spanned::unplaced(Value::Number(n))).into());
    set(&mut node, "jitter", &Value::Number(0.0));
    set(&mut node, "random_receivers", &Value::Flag(false));
    // Water leaves only at the border of the domain.
    set(&mut node, "sea", &Value::Flag(false));
    set(&mut node, "smallest", &Value::Number(500.0));
    set(&mut node, "stream", &Value::Number(3000.0));
    set(&mut node, "observer", &pair([400.0 + metres, 300.0 + metres]));
    let places = LinePoints::from([[100.0, 100.0], [600.0, 450.0]].map(|at| at.map(|at| at + metres)).to_vec());
    set(&mut node, "places", &places.write());
    set(&mut node, "days", &pair([80.0, 100.0]));
    // Flows shorter than the world.
    set(&mut node, "volume", &pair([1e4, 1e5]));
    let mut recipe = Recipe::new(world);
    recipe.add("noise", Fbm { seed: 3, wavelength: 300.0, octaves: 4, ..Fbm::default() });
    recipe.add("moved", Transform { source: "noise".into(), offset: [-metres; 2], ..Transform::default() });
    recipe.add("land", Multiply { a: "moved".into(), b: 200.0.into() });
    if !node.inputs().is_empty() {
        node.set_input(0, "land".into());
    }
    let layers = node.layers();
    recipe.add("node", node);
    for layer in layers {
        recipe.output(layer.name, Input::Node(format!("node.{}", layer.name)));
    }
    recipe
}

fn layers_of(recipe: Recipe, window: &Window) -> Vec<Grid> {
    let layers: Vec<String> = recipe.outputs().map(str::to_string).collect();
    let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
    World::open(recipe).unwrap().grids(&layers, window, &Progress::none()).unwrap()
}

/// A world with a margin equals the middle of a world that is larger by that margin, bit for bit.
#[test]
fn a_world_with_a_margin_is_the_middle_of_a_larger_world() {
    let mut checked = 0;
    for mut node in Node::all().into_iter().filter(|node| node.margin().is_some()) {
        let op = node.spec().op;
        if op == "dunes" {
            // Its domain is a torus: what is beyond the margin differs.
            continue;
        }
        let small = Window::new(SAMPLES[0], SAMPLES[1], CELL);
        let middle = small.at(AROUND as i64, AROUND as i64);
        let larger = layers_of(recipe_of(&node, world(AROUND), AROUND), &middle);
        let without = layers_of(recipe_of(&node, world(0), 0), &small);
        set(&mut node, MARGIN, &Value::Number(AROUND as f64 * CELL));
        let with = layers_of(recipe_of(&node, world(0), 0), &small);
        let mut changed = 0;
        for (layer, ((larger, with), without)) in node.layers().iter().zip(larger.iter().zip(&with).zip(&without)) {
            let bits = |grid: &Grid| grid.data().iter().map(|sample| sample.to_bits()).collect::<Vec<u32>>();
            let differs = bits(larger).iter().zip(bits(with)).filter(|(a, b)| **a != *b).count();
            assert_eq!(differs, 0, "`{op}`, layer `{}`", layer.name);
            changed += usize::from(bits(without) != bits(with));
            checked += 1;
        }
        // Lines of sight do not leave the world, and baked samples do not change.
        if op != "viewshed" {
            assert_eq!(changed == 0, op == "bake", "`{op}`: a margin changes {changed} layers");
        }
    }
    assert!(checked > 25, "{checked}");
}

/// Readers beyond the world get solved samples as far as the margin reaches.
#[test]
fn readers_beyond_the_world_get_what_is_solved_there() {
    let mut recipe = recipe_of(&Fill { margin: AROUND as f64 * CELL, ..Fill::default() }.into(), world(0), 0);
    let metres = -(AROUND as f64) * CELL;
    recipe.add("corner", Transform { source: "node".into(), offset: [metres; 2], ..Transform::default() });
    recipe.output("corner", "corner");
    let window = Window::new(SAMPLES[0], SAMPLES[1], CELL);
    let corner = layers_of(recipe, &window).pop().unwrap();
    let mut larger = recipe_of(&Fill::default().into(), world(AROUND), AROUND);
    larger.output("corner", "node");
    let expect = layers_of(larger, &window).pop().unwrap();
    let steep = |grid: &Grid| (0..AROUND).filter(|j| grid[(3, *j)] != grid[(4, *j)]).count();
    assert!(steep(&corner) > AROUND / 2, "not the edge's samples repeated");
    assert_eq!(corner.data(), expect.data());
}

#[test]
fn a_margin_is_in_plans_memory_keys_and_explanations() {
    let open = |margin: f64| {
        let node = Drainage { margin, ..Drainage::default() };
        World::open(recipe_of(&node.into(), world(0), 0)).unwrap()
    };
    let (none, some) = (open(0.0), open(AROUND as f64 * CELL));
    let window = Window::new(8, 8, CELL);
    let [of_none, of_some] = [&none, &some].map(|world| world.plan(&["flow"], &window).unwrap());
    // 54 bytes for every cell of the domain.
    let cells = |around: usize| ((SAMPLES[0] + 5 + 2 * around) * (SAMPLES[1] + 5 + 2 * around)) as u64;
    let more = some.memory_of(&of_some).unwrap() - none.memory_of(&of_none).unwrap();
    assert!(more >= 54 * (cells(AROUND) - cells(0)), "{more}");
    assert_ne!(none.key("flow").unwrap(), some.key("flow").unwrap());
    assert_ne!(some.key("flow").unwrap(), open(AROUND as f64 * CELL + 1.0).key("flow").unwrap());
    let text = some.explain(&of_some).unwrap();
    assert!(text.contains("solve `node` over the world and 240 m around, 139 x 119 samples at 10 m"), "{text}");
    assert!(none.explain(&of_none).unwrap().contains("over the world, 91 x 71 samples at 10 m"));
}

#[test]
fn margins_that_cannot_be_are_named() {
    let text = |margin: &str, cell: &str| {
        format!(
            "orogen = 1\n[world]\nsize = 1000\ncell = {cell}\n[nodes.a]\nop = \"fbm\"\n[nodes.b]\nop = \"fill\"\nsource = \"a\"\nmargin = {margin}\n[outputs]\nheight = \"b\"\n"
        )
    };
    let error = |margin: &str, cell: &str| match Recipe::parse(&text(margin, cell), "t").and_then(World::open) {
        Ok(_) => panic!("{margin} is accepted"),
        Err(error) => error.to_string(),
    };
    for wrong in ["-1", "nan", "inf", "1000001", "\"wide\""] {
        let error = error(wrong, "10");
        assert!(error.contains("`margin` must be a finite number from 0 to 1e6 (m)"), "{wrong}: {error}");
    }
    let tiny = error("1e6", "0.0005");
    assert!(tiny.contains("Lower `margin` or raise `cell`"), "{tiny}");
    // A margin that fits no memory is refused before anything is made.
    let wide = Recipe::parse(&text("1e6", "1"), "t").unwrap();
    let options = Options { memory: Budget::of(1 << 30), ..Options::default() };
    let error = World::with_options(wide, options).unwrap().window("height", &Window::new(8, 8, 1.0)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Memory, "{error}");
    // The same for a recipe made in code.
    let mut recipe = recipe_of(&Normalise { margin: f64::NAN, ..Normalise::default() }.into(), world(0), 0);
    recipe.about.clear();
    assert!(World::open(recipe).is_err_and(|error| error.to_string().contains("`margin` must be")));
}

orogen_engine::op! {
    /// The lowest sample of the domain, everywhere.
    pub struct Lowest = "test.lowest", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Added to it.
        raise: f64 = 0.0, unit "m", range -1e4 to 1e4;
    }
}

impl Solver for Lowest {
    fn rasters(&self) -> usize {
        0
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut lowest = f32::INFINITY;
        sources.each_tile("source", sources.domain(), &mut |tile| {
            lowest = tile.data().iter().copied().fold(lowest, f32::min);
            Ok(())
        })?;
        Ok(Solution { layers: Vec::new(), scalars: vec![f64::from(lowest) + self.raise] })
    }

    fn read(&self, solution: &Solution, _: &Reading, out: &mut [f32]) -> Result<()> {
        out.fill(solution.scalars[0] as f32);
        Ok(())
    }
}

#[test]
fn a_solver_of_a_program_has_a_margin_by_declaring_it() {
    Laws::of(|cell| Lowest { raise: cell, ..Lowest::default() }).margin(10.24).unwrap();
    let lowest = |margin: f64| {
        let recipe = recipe_of(&Lowest { margin, ..Lowest::default() }.into(), world(0), 0);
        layers_of(recipe, &Window::new(1, 1, CELL))[0][(0, 0)]
    };
    assert!(lowest(AROUND as f64 * CELL) < lowest(0.0));
}
