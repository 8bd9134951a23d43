//! Drainage areas weighted by rain.

use orogen_engine::declare::Input;
use orogen_engine::field::{Fbm, Multiply, Ramp};
use orogen_engine::node::Node;
use orogen_engine::session::Options;
use orogen_engine::solver::{DepressionRouting, Drainage, StreamPower};
use orogen_engine::{Grid, Progress, Recipe, Window, World, WorldSpec};

const CELL: f64 = 10.0;

/// All layers of a solver of rough terrain over 130 x 90 samples, in memory or on disk.
fn layers_of(node: impl Into<Node>, threads: usize, on_disk: Option<usize>) -> Vec<Grid> {
    let spec = WorldSpec::default().with_seed(5).with_size(Some([1300.0, 900.0])).with_cell(CELL);
    let (mut recipe, node) = (Recipe::new(spec), node.into());
    recipe.add("noise", Fbm { seed: 3, wavelength: 300.0, octaves: 4, ..Fbm::default() });
    recipe.add("land", Multiply { a: "noise".into(), b: 200.0.into() });
    // 0 in the west, 2 in the east.
    recipe.add("east", Ramp { length: 1300.0, ..Ramp::default() });
    recipe.add("rain", Multiply { a: "east".into(), b: 2.0.into() });
    let layers = node.layers();
    recipe.add("node", node);
    for layer in layers {
        recipe.output(layer.name, Input::Node(format!("node.{}", layer.name)));
    }
    let world = World::with_options(recipe, Options { threads: Some(threads), ..Options::default() }).unwrap();
    let layers: Vec<String> = world.recipe().outputs().map(str::to_string).collect();
    let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
    let mut plan = world.plan(&layers, &Window::new(130, 90, CELL)).unwrap();
    if let Some(side) = on_disk {
        plan.solve_on_disk(side);
    }
    world.run(&plan, &Progress::none()).unwrap()
}

fn bits(grids: &[Grid]) -> Vec<Vec<u32>> {
    grids.iter().map(|grid| grid.data().iter().map(|sample| sample.to_bits()).collect()).collect()
}

fn drainage(rain: Input, over: DepressionRouting) -> Drainage {
    Drainage { source: "land".into(), rain, over, stream: 8000.0, ..Drainage::default() }
}

fn stream_power(rain: Input) -> StreamPower {
    StreamPower { source: "land".into(), rain, steps: 3, ..StreamPower::default() }
}

#[test]
fn even_rain_changes_nothing() {
    for over in [DepressionRouting::Bed, DepressionRouting::Surface] {
        let made = |rain: Input, on_disk| bits(&layers_of(drainage(rain, over), 2, on_disk));
        let none = made(Input::None, None);
        assert_eq!(made(1.0.into(), None), none);
        assert_eq!(made(1.0.into(), Some(37)), none);
    }
    let made = |rain: Input| bits(&layers_of(stream_power(rain), 2, None));
    assert_eq!(made(1.0.into()), made(Input::None));
}

#[test]
fn rain_weights_the_flow_in_memory_and_on_disk() {
    for over in [DepressionRouting::Bed, DepressionRouting::Surface] {
        let dry = layers_of(drainage(Input::None, over), 1, None);
        let wet = layers_of(drainage("rain".into(), over), 1, None);
        for (threads, side) in [(3, None), (1, Some(1000)), (2, Some(41))] {
            assert_eq!(
                bits(&layers_of(drainage("rain".into(), over), threads, side)),
                bits(&wet),
                "{threads}, {side:?}"
            );
        }
        // Rain does not change directions, watersheds and heights; it changes flow and orders.
        let same: Vec<bool> = bits(&dry).iter().zip(&bits(&wet)).map(|(dry, wet)| dry == wet).collect();
        assert_eq!(same, [false, true, true, false, true]);
        // Between 0.01 and about twice the area: the domain is a few cells wider than the world.
        let ratios = || wet[0].data().iter().zip(dry[0].data()).map(|(wet, dry)| wet / dry);
        assert!(ratios().all(|ratio| (0.0099..2.05).contains(&ratio)));
        assert!(ratios().any(|ratio| ratio < 0.1) && ratios().any(|ratio| ratio > 1.9));
    }
}

#[test]
fn rivers_cut_deeper_where_more_rain_falls() {
    let [dry, wet] = [Input::None, "rain".into()].map(|rain| layers_of(stream_power(rain), 2, None));
    assert_eq!(bits(&layers_of(stream_power("rain".into()), 1, Some(41))), bits(&wet));
    // The mean height of the columns from 10 % to 30 %, where it is dry, and from 70 % to 90 %, where it is wet.
    let mean = |layers: &[Grid], columns: std::ops::Range<usize>| {
        let row = |j: usize| layers[0].row(j)[columns.clone()].iter().map(|height| f64::from(*height)).sum::<f64>();
        (0..90).map(row).sum::<f64>() / (90 * columns.len()) as f64
    };
    assert!(mean(&wet, 13..39) > mean(&dry, 13..39) && mean(&wet, 91..117) < mean(&dry, 91..117));
}
