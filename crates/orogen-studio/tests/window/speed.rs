//! How long frames and pictures take with the present adapter, drawing included. The times are printed, and not
//! limited.

use std::time::{Duration, Instant};

use eframe::egui::{Event, Key, PointerButton, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::window::app::App;

use super::{studio, until, window};

/// Presets, and a slider that changes their land.
const CASES: [(&str, Option<&str>, &str); 2] =
    [("classic", Some("node noise"), "noise.gain"), ("alpine", None, "uplift_rate")];

/// Number of measurements of each time.
const REPETITIONS: usize = 7;

/// Draws a frame. Returns the seconds that it took until its pixels were there.
fn frame(harness: &mut Harness<'_, App>) -> f64 {
    let begun = Instant::now();
    harness.step();
    assert!(harness.render().is_ok());
    begun.elapsed().as_secs_f64()
}

fn opened(folder: &TestFolder, preset: &str) -> Harness<'static, App> {
    let mut harness = window(folder, Some(preset), Language::English);
    harness.set_size(vec2(1600.0, 1000.0));
    until(&mut harness, "all pictures", |app| {
        let studio = app.studio().unwrap();
        studio.is_done() && !studio.thumbnails.is_busy()
    });
    for _ in 0..4 {
        frame(&mut harness);
    }
    harness
}

#[allow(clippy::print_stdout, reason = "it is what the test is for")]
fn print(case: &str, mut seconds: Vec<f64>) {
    seconds.sort_by(f64::total_cmp);
    let of = |share: f64| 1000.0 * seconds[(share * (seconds.len() - 1) as f64).round() as usize];
    println!("{case}: median {:.0} ms, from {:.0} to {:.0} ms", of(0.5), of(0.0), of(1.0));
}

/// Moves the pointer while its button is down, in a frame each. Returns the seconds of the last half of the frames: the
/// resolution follows the time of the first ones.
fn dragged(harness: &mut Harness<'_, App>, from: Pos2, steps: usize) -> Vec<f64> {
    let button = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Default::default(),
    };
    harness.event(Event::PointerMoved(from));
    harness.event(button(from, true));
    harness.step();
    let mut seconds = Vec::new();
    for k in 0..steps {
        harness.event(Event::PointerMoved(from + vec2(4.0 * k as f32, 1.0)));
        seconds.push(frame(harness));
    }
    harness.event(button(from, false));
    harness.step();
    seconds.split_off(steps / 2)
}

#[test]
#[ignore = "long: measures times, which are printed"]
fn times_of_frames() {
    let folder = TestFolder::new("studio-frame-times").unwrap();
    for (preset, ..) in CASES {
        let mut harness = opened(&folder, preset);
        let view = harness.get_by_label("relief view").rect();
        print(&format!("{preset}, orbiting"), dragged(&mut harness, view.center() - vec2(200.0, 0.0), 40));
        harness.event(Event::PointerMoved(view.center()));
        harness.event(Event::MouseWheel {
            unit: eframe::egui::MouseWheelUnit::Point,
            delta: vec2(0.0, 500.0),
            phase: eframe::egui::TouchPhase::Move,
            source: eframe::egui::MouseWheelSource::Unknown,
            modifiers: Default::default(),
        });
        for _ in 0..30 {
            frame(&mut harness);
        }
        print(&format!("{preset}, orbiting close up"), dragged(&mut harness, view.center() - vec2(200.0, 0.0), 40));
        std::thread::sleep(Duration::from_millis(500));
        print(&format!("{preset}, the first frame at rest"), vec![frame(&mut harness)]);
        let hovering = (0..20).map(|k| {
            harness.event(Event::PointerMoved(Pos2::new(20.0 + 10.0 * k as f32, 10.0)));
            frame(&mut harness)
        });
        print(&format!("{preset}, the pointer over the menu"), hovering.collect());
    }
}

#[test]
#[ignore = "long: measures times, which are printed"]
fn times_from_a_slider_to_a_picture() {
    let folder = TestFolder::new("studio-slider-times").unwrap();
    for (preset, node, slider) in CASES {
        let mut harness = opened(&folder, preset);
        if let Some(node) = node {
            harness.get_by_label(node).click();
            harness.run_steps(3);
        }
        harness.get_by_role_and_label(Role::Slider, slider).focus();
        harness.run_steps(2);
        let mut seconds = [Vec::new(), Vec::new()];
        for _ in 0..REPETITIONS {
            let before = studio(&harness).frame.as_ref().unwrap().request;
            let begun = Instant::now();
            harness.key_press(Key::ArrowRight);
            frame(&mut harness);
            while studio(&harness).frame.as_ref().unwrap().request == before {
                // Like a window: it draws when it is told to.
                if harness.ctx.has_requested_repaint() {
                    frame(&mut harness);
                }
                std::thread::sleep(Duration::from_micros(500));
            }
            seconds[0].push(begun.elapsed().as_secs_f64());
            seconds[1].push(studio(&harness).frame.as_ref().unwrap().seconds);
            until(&mut harness, "all pictures", |app| app.studio().unwrap().is_done());
            for _ in 0..4 {
                frame(&mut harness);
            }
        }
        for (what, seconds) in ["the first picture drawn", "the first picture computed"].into_iter().zip(seconds) {
            print(&format!("{preset}, from the slider to {what}"), seconds);
        }
    }
}
