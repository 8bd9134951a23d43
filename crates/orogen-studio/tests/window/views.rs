//! Compares the main views with stored pictures. `UPDATE_SNAPSHOTS=1` writes the pictures again; check them before
//! committing.

use eframe::egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, vec2};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions};
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::preview::ring::Ring;
use orogen_studio::studio::Studio;
use orogen_studio::window::app::App;

use super::{press, until, window};

/// The threshold for the difference of a pixel, in the unit of the comparison library: drivers draw edges differently.
const DIFFERENCE: f32 = 2.0;

/// Maximum number of pixels, of 540 000, that may exceed the threshold: the seconds in the bottom line do, and a few
/// along edges of the land.
const PIXELS: usize = 2500;

fn compare(harness: &mut Harness<'_, App>, name: &str) {
    harness.run_steps(4);
    let [red, green, blue, _] = harness.ctx.global_style().visuals.panel_fill.to_array();
    let mut picture = harness.render().unwrap();
    // A window is cleared with the color of its panels; here nothing is.
    for pixel in picture.pixels_mut() {
        let clear = 255 - u32::from(pixel.0[3]);
        let over = |value: u8, own: u8| (u32::from(value) + (u32::from(own) * clear + 127) / 255).min(255) as u8;
        *pixel = [over(pixel.0[0], red), over(pixel.0[1], green), over(pixel.0[2], blue), 255].into();
    }
    let options = SnapshotOptions::new().threshold(DIFFERENCE).max_failed_pixels(PIXELS);
    egui_kittest::image_snapshot_options(&picture, name, &options);
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

#[test]
fn the_land_becomes_finer_where_the_camera_looks() {
    let folder = TestFolder::new("studio-rings").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until(&mut harness, "the picture", |app| app.studio().is_some_and(Studio::is_done));
    harness.run_steps(3);
    let rings = |harness: &Harness<'_, App>| harness.state().studio().unwrap().rings();
    assert!(rings(&harness).is_empty(), "from afar the picture is fine enough");
    let middle = harness.get_by_label("relief view").rect().center();
    harness.event(Event::PointerMoved(middle));
    harness.run_steps(2);
    harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 600.0),
        phase: TouchPhase::Move,
        source: MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    let is_refined = |app: &App| {
        let studio = app.studio().unwrap();
        studio.refining().is_some_and(|windows| !windows.is_empty()) && !studio.is_refining()
    };
    until(&mut harness, "the rings", is_refined);
    harness.run_steps(3);
    let made = rings(&harness);
    let cells: Vec<f64> = made.iter().map(|ring| ring.window().cell).collect();
    assert!(cells.len() > 1 && cells[0] == 5.0 && cells.is_sorted_by(|a, b| *a == 2.0 * b), "{cells:?}");
    let fine = harness.render().unwrap();
    // A change of the land removes them, and they come again.
    press(&mut harness, Modifiers::COMMAND, Key::R);
    assert!(harness.state().studio().unwrap().refining().is_none());
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    until(&mut harness, "the rings again", is_refined);
    harness.run_steps(3);
    let windows = |rings: &[std::sync::Arc<Ring>]| rings.iter().map(|ring| *ring.window()).collect::<Vec<_>>();
    assert_eq!(windows(&rings(&harness)), windows(&made));
    let again = harness.render().unwrap();
    let differ = (0..300).filter(|k| {
        let at = [middle.x as u32 + k - 150, middle.y as u32];
        fine.get_pixel(at[0], at[1]) != again.get_pixel(at[0], at[1])
    });
    assert_eq!(differ.count(), 0);
}

/// A steep hill on the sea floor, 20 m below the water.
const SHOAL: &str = r#"orogen = 1

[world]
size = 1280
cell = 10

[nodes.hill]
op = "radial"
center = [640, 640]
radius = 200

[nodes.floor]
op = "expr"
expr = "hill * 380 - 400"

[outputs]
height = "floor"
"#;

#[test]
fn a_hill_of_the_sea_floor_casts_no_shadow_on_the_water() {
    let folder = TestFolder::new("studio-shoal").unwrap();
    let file = folder.join("shoal.toml");
    std::fs::write(&file, SHOAL).unwrap();
    let mut harness = window(&folder, file.to_str(), Language::English);
    until(&mut harness, "the picture", |app| app.studio().is_some_and(Studio::is_done));
    // The middle of the view: the water above the hill and its shadow, but not the table, on which the land also casts
    // a shadow.
    let middle = harness.get_by_label("relief view").rect().center();
    let mut look = |label: &str| {
        harness.get_by_label(label).click();
        harness.run_steps(4);
        let picture = harness.render().unwrap();
        let at = |i: u32, j: u32| picture.get_pixel(middle.x as u32 + i - 100, middle.y as u32 + j - 40).0;
        (0..200 * 80).map(|k| at(k % 200, k / 200)).collect::<Vec<_>>()
    };
    let (without, with) = (look("Shadows"), look("Shadows"));
    assert!(without == with, "with water");
    // Without water, the hill's shadow is visible.
    let with = look("Water");
    assert!(look("Shadows") != with, "without water");
}
