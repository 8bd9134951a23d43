use super::super::coloring::Coloring;
use super::*;
use orogen::{Options, Recipe, presets};
use std::time::Duration;

fn worker() -> Worker {
    Worker::new(Session::new(Options::default()).unwrap(), Arc::new(|| ()))
}

fn preset(name: &str) -> Recipe {
    presets::find(name).unwrap().recipe().unwrap()
}

/// Waits for the end of the current request, and returns its pictures.
fn finish(worker: &mut Worker) -> Vec<Frame> {
    let mut frames = Vec::new();
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(300) {
        for event in worker.events() {
            match event {
                Event::Frame(frame) => frames.push(*frame),
                Event::Next(_) => {}
                Event::Done => return frames,
                Event::Failed(error) => panic!("{error}"),
            }
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("no end after 300 s");
}

#[test]
fn pictures_become_finer_and_the_last_one_has_the_samples_of_the_world() {
    let mut worker = worker();
    let recipe = preset("classic");
    let number = worker.ask(Request { finest: 400, ..Request::new(recipe.clone()) });
    let frames = finish(&mut worker);
    assert_eq!(frames.iter().map(|frame| frame.window().width).collect::<Vec<_>>(), [256, 400]);
    assert!(frames.iter().all(|frame| frame.request == number));
    assert!(frames[0].quality == Quality::Coarse && frames[1].quality == Quality::Fine);
    let world = World::open(recipe).unwrap();
    assert_eq!(*frames[1].heights, world.window("height", &world.window_fitting(400).unwrap()).unwrap());
    let samples = 400 * 400;
    assert_eq!(
        [frames[1].albedo.len(), frames[1].shaded.len(), frames[1].light.len()],
        [4 * samples, 4 * samples, 2 * samples]
    );
    assert!(!worker.is_busy());
}

#[test]
fn other_colors_of_the_same_land_are_those_of_a_picture_made_anew() {
    let mut worker = worker();
    let request = Request { finest: 300, ..Request::new(preset("volcano")) };
    worker.ask(request.clone());
    let land = finish(&mut worker).pop().map(Arc::new);
    for (coloring, sun) in [
        (Coloring::Named("magma".into()), [315.0, 40.0]),
        (Coloring::Surfaces, [100.0, 20.0]),
        (Coloring::Own, [100.0, 20.0]),
    ] {
        let request = Request { coloring, sun, ..request.clone() };
        worker.ask(request.clone());
        let anew = finish(&mut worker).pop().unwrap();
        worker.ask(Request { land: land.clone(), ..request });
        let frames = finish(&mut worker);
        assert!(frames.len() == 1 && Arc::ptr_eq(&frames[0].heights, &land.as_ref().unwrap().heights));
        assert!(frames[0].quality == Quality::Fine && frames[0].shaded == anew.shaded && frames[0].light == anew.light);
        assert_eq!(frames[0].legend, anew.legend);
    }
}

#[test]
fn a_later_request_is_the_only_one_that_is_heard() {
    let mut worker = worker();
    worker.ask(Request::new(preset("alpine")));
    let number = worker.ask(Request { finest: 256, ..Request::new(preset("classic")) });
    let frames = finish(&mut worker);
    assert!(!frames.is_empty() && frames.iter().all(|frame| frame.request == number));
}

#[test]
fn a_draft_comes_first_where_solvers_take_long() {
    let mut worker = worker();
    worker.ask(Request { finest: 256, ..Request::new(preset("alpine")) });
    let frames = finish(&mut worker);
    assert_eq!(frames.iter().map(|frame| frame.quality).collect::<Vec<_>>(), [Quality::Draft, Quality::Fine]);
    // The draft has the same land: the same mean height, and high areas in the same positions.
    let mean = |frame: &Frame| frame.statistics.mean;
    assert!((mean(&frames[0]) / mean(&frames[1]) - 1.0).abs() < 0.15, "{} {}", mean(&frames[0]), mean(&frames[1]));
}

#[test]
fn other_layers_are_colored_on_the_surface() {
    let mut worker = worker();
    for layer in ["slope", "noise", "drainage-area"] {
        worker.ask(Request { finest: 256, layer: layer.into(), ..Request::new(preset("classic")) });
        let frames = finish(&mut worker);
        let values = frames[0].values.as_ref().unwrap();
        assert_ne!(values, &frames[0].heights, "{layer}");
    }
}

#[test]
fn a_region_of_an_unbounded_world_is_shown() {
    let mut worker = worker();
    let region = super::super::region::Region::Square { center: [1e6, -2e6], side: 30_000.0 };
    worker.ask(Request { finest: 256, region, ..Request::new(preset("endless")) });
    let frames = finish(&mut worker);
    let window = frames[0].window();
    assert!(
        (window.east(window.width / 2) - 1e6).abs() < 200.0 && (window.south(window.height / 2) + 2e6).abs() < 200.0
    );
}

#[test]
fn failures_are_told() {
    let mut worker = worker();
    worker.ask(Request { layer: "nothing".into(), ..Request::new(preset("classic")) });
    let begun = Instant::now();
    loop {
        match worker.events().pop() {
            Some(Event::Failed(error)) => {
                assert!(error.to_string().contains("`nothing`"), "{error}");
                break;
            }
            _ => assert!(begun.elapsed() < Duration::from_secs(300)),
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}
