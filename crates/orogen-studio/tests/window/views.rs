//! The main views, compared with pictures of them. `UPDATE_SNAPSHOTS=1` makes the pictures anew; look at them before they are committed.

use eframe::egui::{Key, Modifiers};
use egui_kittest::{Harness, SnapshotOptions};
use orogen::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::window::app::App;

use super::{press, until, window};

/// The difference of a pixel that counts, as the library measures it: drivers draw edges differently.
const DIFFERENCE: f32 = 2.0;

/// The most pixels that may differ by more, of 540 000: the seconds in the bottom line do, and a few along edges of the land.
const PIXELS: usize = 2500;

fn compare(harness: &mut Harness<'_, App>, name: &str) {
    harness.run_steps(4);
    harness.snapshot_options(name, &SnapshotOptions::new().threshold(DIFFERENCE).max_failed_pixels(PIXELS));
}

#[test]
fn the_start_page_looks_as_it_did() {
    let folder = TestFolder::new("studio-start").unwrap();
    let mut harness = window(&folder, None, Language::English);
    harness.set_size([600.0, 400.0].into());
    compare(&mut harness, "start");
}

#[test]
fn the_main_views_look_as_they_did() {
    let folder = TestFolder::new("studio-views").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    harness.set_size([900.0, 600.0].into());
    until(&mut harness, "all pictures", |app| {
        let studio = app.studio().unwrap();
        studio.is_done() && !studio.thumbnails.is_busy() && studio.thumbnails.of("terrain").is_some()
    });
    compare(&mut harness, "relief-and-graph");
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    press(&mut harness, Modifiers::COMMAND, Key::Num4);
    compare(&mut harness, "map-and-text");
    press(&mut harness, Modifiers::COMMAND, Key::Num5);
    compare(&mut harness, "analysis");
    press(&mut harness, Modifiers::COMMAND, Key::E);
    compare(&mut harness, "export");
}
