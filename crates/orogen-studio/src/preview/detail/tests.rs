use std::time::{Duration, Instant};

use orogen::{Budget, Options, Session, presets};

use super::*;
use crate::preview::coloring::Coloring;
use crate::preview::worker::{Event as Made, Worker};
use crate::view::rings::around;

/// The finest picture of a request.
fn frame(session: &Session, request: &Request) -> Arc<Frame> {
    let mut worker = Worker::new(session.clone(), Arc::new(|| ()));
    worker.ask(request.clone());
    let begun = Instant::now();
    let mut last = None;
    while worker.is_busy() {
        assert!(begun.elapsed() < Duration::from_secs(120), "no picture");
        for event in worker.events() {
            match event {
                Made::Frame(frame) => last = Some(frame),
                Made::Failed(error) => panic!("{error}"),
                Made::Next(_) => {}
                Made::Done => {}
            }
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Arc::from(last.unwrap())
}

fn wait(detail: &mut Detail) {
    let begun = Instant::now();
    while detail.is_busy() {
        assert!(begun.elapsed() < Duration::from_secs(120), "no rings");
        detail.poll();
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn request(preset: &str) -> Request {
    let recipe = presets::find(preset).unwrap().recipe().unwrap();
    Request { finest: 256, ..Request::new(recipe) }
}

#[test]
fn rings_have_the_samples_and_the_colors_of_the_picture() {
    let session = Session::new(Options::default()).unwrap();
    let request = request("classic");
    let frame = frame(&session, &request);
    let mut detail = Detail::new(Arc::new(|| ()));
    let windows = around(frame.window(), [5000.0, 4000.0], 8.0, 128);
    detail.ask(&session, request.clone(), &frame, windows.clone());
    wait(&mut detail);
    let rings = detail.rings(&frame);
    assert_eq!(rings.iter().map(|ring| *ring.window()).collect::<Vec<_>>(), windows);
    let ring = &rings[0];
    let (window, land) = (ring.window(), frame.window());
    for (i, j) in [(0, 0), (2, 4), (64, 128), (128, 100)] {
        let [column, row] = [window.x + i as i64, window.y + j as i64].map(|at| (at / 2) as usize);
        assert_eq!(ring.heights.get(i, j), frame.heights.get(column, row));
        let color = |bytes: &[u8], at: usize| bytes[4 * at..4 * at + 4].to_vec();
        assert_eq!(color(&ring.albedo, j * window.width + i), color(&frame.albedo, row * land.width + column));
    }
    let place = [(window.x + 3) as f64 * window.cell, (window.y + 5) as f64 * window.cell];
    assert_eq!((ring.height(place), ring.height([-1e3, 0.0])), (ring.heights.get(3, 5), None));

    // After a small movement only what is new is computed; with other colors, the heights stay.
    let moved = around(frame.window(), [5000.0 + 8.0 * land.cell, 4000.0], 8.0, 128);
    detail.ask(&session, request.clone(), &frame, moved.clone());
    wait(&mut detail);
    assert_eq!(detail.rings(&frame).iter().map(|ring| *ring.window()).collect::<Vec<_>>(), moved);
    let recolored = Request { coloring: Coloring::Named("viridis".into()), land: Some(Arc::clone(&frame)), ..request };
    let before = detail.rings(&frame);
    let frame = Arc::new(Frame { request: 2, ..Frame::clone(&self::frame(&session, &recolored)) });
    assert!(detail.rings(&frame).is_empty());
    detail.ask(&session, recolored, &frame, moved);
    wait(&mut detail);
    let after = detail.rings(&frame);
    assert!(after.len() == before.len() && before.iter().zip(&after).all(|(a, b)| Arc::ptr_eq(&a.heights, &b.heights)));
    assert_ne!(before[0].albedo, after[0].albedo);
}

#[test]
fn level_land_and_a_small_budget_have_no_rings() {
    let text =
        "orogen = 1\n[world]\nsize = 2560\ncell = 10\n[nodes.land]\nop = \"ramp\"\n[outputs]\nheight = \"land\"\n";
    let session = Session::new(Options::default()).unwrap();
    let request = Request { finest: 256, ..Request::new(orogen::Recipe::parse(text, "level").unwrap()) };
    let frame = frame(&session, &request);
    let mut detail = Detail::new(Arc::new(|| ()));
    let windows = around(frame.window(), [1000.0; 2], 1.0, 128);
    assert!(!windows.is_empty());
    detail.ask(&session, request.clone(), &frame, windows.clone());
    wait(&mut detail);
    assert!(detail.rings(&frame).is_empty());

    let session = Session::new(Options { memory: Budget::of(256 << 20), ..Options::default() }).unwrap();
    let request = self::request("classic");
    let frame = self::frame(&session, &request);
    let windows = around(frame.window(), [5000.0, 4000.0], 8.0, 128);
    let budget = session.budget().clone();
    let _rest = budget.reserve(budget.left().unwrap() - 1000).unwrap();
    detail.ask(&session, request, &frame, windows);
    wait(&mut detail);
    assert!(detail.rings(&frame).is_empty());
}
