//! A sampler returns the values of its world, independent of earlier requests and of the number of threads.

use crate::support::{Random, open, recipe_of, world_of};
use orogen::field::{Fbm, Warp};
use orogen::filter::Blur;
use orogen::node::Node;
use orogen::{Budget, ErrorKind, Options, Recipe, Sampler, Window, World, WorldSpec};
use std::sync::Arc;

fn same_bits(name: &str, a: &[f32], b: &[f32]) {
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<u32>>();
    assert!(bits(a) == bits(b), "{name}: {a:?} and {b:?}");
}

#[test]
fn windows_and_points_of_every_node_are_the_worlds() {
    for node in Node::all() {
        for masked in [false, true] {
            let recipe = recipe_of(&node, world_of(1.0 / 3.0), masked);
            let (world, name) = (open(&recipe, 2), node.spec().op);
            let sampler = Sampler::new(open(&recipe, 1), "height").unwrap();
            let mut random = Random(7);
            for size in [1, 5, 33, 70] {
                let window = Window::new(size, size, 1.0 / 3.0).at(random.below(20) as i64, random.below(10) as i64);
                let made = sampler.window(&window).unwrap();
                assert_eq!(made.window(), &window);
                same_bits(name, made.data(), world.window("height", &window).unwrap().data());
            }
            let mut points =
                |length: f64| -> Vec<f64> { (0..40).map(|_| random.below(1000) as f64 / 999.0 * length).collect() };
            let (x, y) = (points(32.0), points(26.0));
            let mut values = vec![0.0; x.len()];
            sampler.points(&x, &y, &mut values).unwrap();
            same_bits(name, &values, &world.points("height", &x, &y).unwrap());
            let one = sampler.at(x[3], y[3]).unwrap();
            assert_eq!(one.to_bits(), values[3].to_bits(), "{name}");
        }
    }
}

/// An unbounded world whose ground needs a halo and is interpolated from the grid.
fn soft() -> Recipe {
    let mut recipe = Recipe::new(WorldSpec::default().with_seed(5).with_size(None).with_cell(2.0));
    recipe.add("noise", Fbm { wavelength: 70.0, ..Fbm::default() });
    recipe.add("soft", Blur { source: "noise".into(), radius: 9.0 });
    recipe.add("bent", Warp { source: "soft".into(), x: "noise".into(), y: "noise".into(), strength: 30.0 });
    recipe.output("height", "bent");
    recipe
}

#[test]
fn patches_of_ground_have_no_seams_and_do_not_run_out() {
    let (world, sampler) = (open(&soft(), 1), Sampler::new(open(&soft(), 1), "height").unwrap());
    // A path across far more patches than are cached, along and across their borders (every 128 m), and back again.
    let x: Vec<f64> = (-30..30).map(|i| f64::from(i) * 97.3).chain((-5..5).map(|i| f64::from(i) * 128.0)).collect();
    let y: Vec<f64> = x.iter().map(|x| 128.0 - x * 0.4).collect();
    let expect = world.points("height", &x, &y).unwrap();
    for _ in 0..2 {
        let made: Vec<f32> = x.iter().zip(&y).map(|(x, y)| sampler.at(*x, *y).unwrap()).collect();
        same_bits("walk", &made, &expect);
    }
    for (x, y) in [(1e9, -3e9), (-7e12, 5.0)] {
        assert_eq!(sampler.at(x, y).unwrap().to_bits(), world.height(x, y).unwrap().to_bits());
    }
}

#[test]
fn one_sampler_serves_many_threads() {
    for recipe in [soft(), recipe_of(&Node::named("fbm").unwrap(), WorldSpec::default(), false)] {
        let world = open(&recipe, 1);
        let sampler = Arc::new(Sampler::new(open(&recipe, 2), "height").unwrap());
        let window = |i: i64| Window::new(33, 20, 2.0).at(i * 31 - 200, i * -7);
        let threads: Vec<_> = (0..4)
            .map(|thread| {
                let sampler = Arc::clone(&sampler);
                std::thread::spawn(move || {
                    let own = (0..12).filter(move |i| i % 4 == thread);
                    own.map(|i| (i, sampler.window(&window(i)).unwrap(), sampler.at(i as f64, 0.5).unwrap()))
                        .collect::<Vec<_>>()
                })
            })
            .collect();
        for (i, grid, value) in threads.into_iter().flat_map(|thread| thread.join().unwrap()) {
            same_bits("threads", grid.data(), world.window("height", &window(i)).unwrap().data());
            assert_eq!(value.to_bits(), world.height(i as f64, 0.5).unwrap().to_bits());
        }
    }
}

#[test]
fn what_cannot_be_is_said() {
    let recipe = recipe_of(&Node::named("fbm").unwrap(), world_of(10.0), false);
    let sampler = Sampler::new(open(&recipe, 1), "height").unwrap();
    let said = |error: orogen::Error| error.to_string();
    let missing = Sampler::new(open(&recipe, 1), "hight").err().map(said).unwrap();
    assert!(missing.contains("did you mean `height`?"), "{missing}");
    let outside = said(sampler.window(&Window::new(5, 5, 10.0).at(-1, 0)).unwrap_err());
    assert!(outside.contains("not inside the world"), "{outside}");
    let outside = said(sampler.at(-0.1, 3.0).unwrap_err());
    assert!(outside.contains("outside the world"), "{outside}");
    assert!(said(sampler.at(f64::NAN, 3.0).unwrap_err()).contains("finite"));
    let short = said(sampler.fill(&Window::new(5, 4, 10.0), &mut [0.0; 19]).unwrap_err());
    assert!(short.contains("5 x 4") && short.contains("buffer of 19") && short.contains("needs 20"), "{short}");
    let unpaired = said(sampler.points(&[1.0], &[1.0, 2.0], &mut [0.0]).unwrap_err());
    assert!(unpaired.contains("1 eastings, 2 southings"), "{unpaired}");
    let options = Options { threads: Some(1), memory: Budget::of(64 << 20), ..Options::default() };
    let world = World::with_options(recipe_of(&Node::named("fbm").unwrap(), WorldSpec::default(), false), options);
    let error =
        Sampler::new(world.unwrap(), "height").unwrap().window(&Window::new(1 << 20, 1 << 20, 1.0)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Memory);
}
