//! The shaders of the built-in fields, filters, levels and solvers.

use orogen_engine::levelled::{Amplify, Continents, Learned};
use orogen_engine::lower::{Lowering, Over, Pass, Passes};
use orogen_engine::node::Node;
use orogen_engine::op::{Levelled, Op, WorldParams};
use orogen_grid::grid::Window;

const WORLD: WorldParams = WorldParams { seed: 1, size: None, cell: 10.0, sea_level: 0.0 };

/// The text of passes, and their number of planes.
fn text(passes: &Passes) -> (String, &str, usize) {
    (passes.head.clone(), passes.passes[0].code, passes.planes)
}

/// Asserts that the text of each pass defines its function, and that it leaves out or adds at most some samples.
fn check(name: &str, passes: &Passes, most: impl Fn(&Pass) -> usize) {
    assert!(!passes.passes.is_empty(), "{name} has no pass");
    for pass in &passes.passes {
        let header = format!("fn {}(base: u32, at: vec2<i32>) {{", pass.function);
        assert!(pass.code.contains(&header), "{name} has no function {}", pass.function);
        let (Over::Planes([left, top]) | Over::Above([left, top])) = pass.over else {
            assert!(matches!(pass.over, Over::Window(around) if around <= most(pass)), "{name}, {}", pass.function);
            continue;
        };
        assert!(left.max(top) <= most(pass), "{name} leaves out samples of the window in {}", pass.function);
    }
}

#[test]
fn every_field_says_how_a_graphics_card_computes_it() {
    for node in Node::all() {
        let Op::Field(field) = node.op() else { continue };
        // The engine computes these with its own instructions.
        if field.terms().is_some() || field.coord_map().is_some() || field.source_cell(1.0, 1.0).is_some() {
            continue;
        }
        for layer in 0..node.layers().len() {
            assert_ne!(field.lower(layer, &WORLD), Lowering::Missing, "{}", node.spec().op);
        }
    }
}

#[test]
fn every_filter_says_how_a_graphics_card_computes_it() {
    let (mut lowered, mut left) = (0, Vec::new());
    for node in Node::all() {
        let Op::Filter(filter) = node.op() else { continue };
        let name = node.spec().op;
        match filter.lower(10.0, &WORLD) {
            Lowering::Missing => panic!("{name} does not say how a graphics card computes it"),
            Lowering::Processor(_) => left.push(name),
            Lowering::Shader(passes) => {
                lowered += 1;
                check(name, &passes, |_| filter.halo(10.0));
            }
        }
    }
    assert_eq!((lowered, left), (21, vec!["dolines", "droplets", "glaciate", "glaciers", "hillslopes"]));
}

#[test]
fn the_text_of_a_filter_does_not_depend_on_the_cell() {
    for node in Node::all() {
        let Op::Filter(filter) = node.op() else { continue };
        if let (Lowering::Shader(fine), Lowering::Shader(coarse)) =
            (filter.lower(1.0, &WORLD), filter.lower(30.0, &WORLD))
        {
            assert_eq!(text(&fine), text(&coarse), "{}", node.spec().op);
        }
    }
}

/// The lowering of a level with all inputs.
fn level(levelled: &dyn Levelled, level: usize) -> Lowering<Passes> {
    levelled.lower(level, &[true; 8], &WORLD)
}

#[test]
fn every_level_says_how_a_graphics_card_computes_it() {
    for node in Node::all() {
        let Op::Levelled(levelled) = node.op() else { continue };
        let name = node.spec().op;
        for depth in 0..levelled.levels().count {
            match level(levelled, depth) {
                Lowering::Missing => panic!("{name} does not say how a graphics card computes level {depth}"),
                Lowering::Processor(reason) => assert!(!reason.is_empty(), "{name}"),
                Lowering::Shader(passes) => {
                    assert_eq!(passes.layers.len(), levelled.planes(), "{name}");
                    let factor = |pass: &Pass| if matches!(pass.over, Over::Above(_)) { 1 } else { 2 };
                    check(name, &passes, |pass| factor(pass) * levelled.halo(depth));
                }
            }
            let mut heights = vec![false; levelled.spec().layers.len()];
            heights[0] = true;
            match levelled.lower_layers(depth, &heights, &WORLD) {
                Lowering::Missing => panic!("{name} does not say how a graphics card reads layers from level {depth}"),
                Lowering::Processor(reason) => assert!(!reason.is_empty(), "{name}"),
                Lowering::Shader(passes) => {
                    assert_eq!(passes.layers.len(), 1, "{name}");
                    // A layer may be a plane of the level.
                    if !passes.passes.is_empty() {
                        check(name, &passes, |_| levelled.surface_halo(depth, &heights));
                    }
                }
            }
        }
    }
}

/// The levels that a graphics card computes.
fn lowered(levelled: &dyn Levelled) -> Vec<usize> {
    (0..levelled.levels().count).filter(|depth| matches!(level(levelled, *depth), Lowering::Shader(_))).collect()
}

#[test]
fn levels_are_computed_on_a_graphics_card_except_where_they_cannot_be() {
    let amplify = Amplify { details: 2, ..Default::default() };
    assert_eq!(lowered(&amplify), [1, 2, 3, 4, 5, 6]);
    // Levels with cells of 960 m and 480 m have new lakes, which the level below starts from.
    assert_eq!(lowered(&Amplify { lakes: 0.5, ..amplify }), [3, 4, 5, 6]);
    assert_eq!(lowered(&Continents::default()), [6, 7, 8, 9, 10, 11]);
    assert_eq!(lowered(&Learned { halvings: 3, ..Default::default() }), [1, 2, 3]);
}

#[test]
fn every_solver_says_how_a_graphics_card_computes_it() {
    let (mut lowered, mut left) = (Vec::new(), Vec::new());
    let window = Window::new(40, 30, 10.0);
    for node in Node::all() {
        let Op::Solver(solver) = node.op() else { continue };
        let (name, inputs) = (node.spec().op, node.inputs());
        let required: Vec<bool> = inputs.iter().map(|input| input.required).collect();
        // With all inputs the processor may have to compute it; the op must say so.
        assert_ne!(solver.lower(&window, &vec![true; inputs.len()], &WORLD), Lowering::Missing, "{name}");
        match solver.lower(&window, &required, &WORLD) {
            Lowering::Missing => panic!("{name} does not say how a graphics card computes it"),
            Lowering::Processor(why) => {
                assert!(!why.is_empty());
                left.push(name);
            }
            Lowering::Shader(passes) => {
                lowered.push(name);
                assert_eq!(passes.layers.len(), node.layers().len(), "{name}");
                check(name, &passes, |_| 0);
            }
        }
    }
    assert_eq!(lowered, ["drainage", "fill", "height-above-drainage", "lakes", "stream-power"]);
    let processor = ["bake", "breach", "coast", "dla", "dunes", "insolation", "lava", "normalise"];
    assert_eq!(left, [&processor[..], &["orographic-rain", "rivers", "roads", "select-share", "viewshed"]].concat());
}

#[test]
fn the_text_of_a_solver_depends_neither_on_the_window_nor_on_the_cell() {
    for node in Node::all() {
        let Op::Solver(solver) = node.op() else { continue };
        let given: Vec<bool> = node.inputs().iter().map(|input| input.required).collect();
        let passes = |window: Window| solver.lower(&window, &given, &WORLD);
        if let (Lowering::Shader(small), Lowering::Shader(large)) =
            (passes(Window::new(20, 10, 1.0)), passes(Window::new(300, 400, 30.0).at(-9, 7)))
        {
            assert_eq!(text(&small), text(&large), "{}", node.spec().op);
        }
    }
}
