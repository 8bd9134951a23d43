//! The window, used as a person uses it. Needs an adapter: `cargo xtask clients studio` installs Mesa's software driver.
#![allow(clippy::unwrap_used, reason = "a failure is a failed test")]

#[path = "window/export.rs"]
mod export;

use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::editing::drawing::points_of;
use orogen_studio::preview::frame::Quality;
use orogen_studio::settings::Settings;
use orogen_studio::studio::{Studio, open};
use orogen_studio::window::app::App;

/// A window with a recipe, a preset, or the start page.
fn window(folder: &TestFolder, document: Option<&str>, language: Language) -> Harness<'static, App> {
    let settings = Settings { language: Some(language), ..Settings::default() };
    let folder = folder.to_path_buf();
    let document = document.map(|name| open(Path::new(name)).unwrap());
    let mut harness = Harness::builder()
        .with_size([1280.0, 800.0])
        .with_max_steps(8)
        .wgpu()
        .build_eframe(move |context| App::new(context, settings, Some(folder), document).unwrap());
    harness.step();
    harness
}

fn studio<'a>(harness: &'a Harness<'_, App>) -> &'a Studio {
    harness.state().studio().unwrap()
}

/// Steps until something holds.
fn until(harness: &mut Harness<'_, App>, what: &str, holds: impl Fn(&App) -> bool) {
    let begun = Instant::now();
    while !holds(harness.state()) {
        assert!(begun.elapsed() < Duration::from_secs(120), "{what}: not after 120 s");
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
}

fn until_done(harness: &mut Harness<'_, App>) {
    until(harness, "the finest picture", |app| app.studio().is_some_and(Studio::is_done));
}

fn press(harness: &mut Harness<'_, App>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

#[test]
fn a_preset_is_opened_changed_undone_saved_and_opened_again() {
    let folder = TestFolder::new("studio-window").unwrap();
    let mut harness = window(&folder, None, Language::English);
    harness.get_by_label("preset classic").click();
    until(&mut harness, "the preset", |app| app.studio().is_some());
    until_done(&mut harness);
    let frame = studio(&harness).frame.clone().unwrap();
    assert!(frame.quality == Quality::Fine && frame.window().width == 1024);

    // Another seed, and back: ten times.
    let before = studio(&harness).document.text().to_owned();
    for _ in 0..10 {
        press(&mut harness, Modifiers::COMMAND, Key::R);
    }
    assert_eq!(studio(&harness).document.recipe().world.seed, 11);
    for _ in 0..10 {
        assert_ne!(studio(&harness).document.text(), before);
        press(&mut harness, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(studio(&harness).document.text(), before);
    press(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    until_done(&mut harness);
    assert_ne!(studio(&harness).frame.clone().unwrap().heights, frame.heights);

    // Saved under a name, it is the same recipe for the library.
    press(&mut harness, Modifiers::COMMAND, Key::S);
    let path = folder.join("mine.toml");
    let field = harness.get_by_role_and_label(Role::TextInput, "file name");
    field.focus();
    harness.run_steps(2);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.get_by_role_and_label(Role::TextInput, "file name").type_text(&path.to_string_lossy());
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(!studio(&harness).document.is_changed());
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text, studio(&harness).document.text());
    assert_eq!(orogen::Recipe::read(&path).unwrap(), *studio(&harness).document.recipe());

    // Another program changes the file.
    std::fs::write(&path, text.replace("octaves = 6", "octaves = 2")).unwrap();
    until(&mut harness, "the changed file", |app| app.studio().unwrap().document.text().contains("octaves = 2"));
}

#[test]
fn text_is_broken_and_mended() {
    let folder = TestFolder::new("studio-text").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num4);
    let text = studio(&harness).document.text().to_owned();
    let field = harness.get_by_role_and_label(Role::TextInput, "recipe");
    field.focus();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::TextInput, "recipe").type_text("x");
    harness.run_steps(4);
    assert!(!studio(&harness).document.is_valid());
    assert!(harness.query_by_label_contains("The text has errors").is_some());
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(studio(&harness).document.is_valid());
    assert_eq!(studio(&harness).document.text(), text);
}

#[test]
fn a_node_is_selected_shown_and_deleted() {
    let folder = TestFolder::new("studio-graph").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    harness.get_by_label("node noise").click();
    harness.run_steps(3);
    assert_eq!(studio(&harness).selected, ["noise"]);
    harness.get_by_label("Show").click();
    until(&mut harness, "the layer", |app| app.studio().unwrap().look.layer == "noise");
    until_done(&mut harness);
    assert!(studio(&harness).frame.as_ref().unwrap().values.is_some());
    harness.get_by_label("node terrain").click();
    harness.run_steps(3);
    harness.get_by_label("Delete").click();
    harness.run_steps(3);
    let recipe = studio(&harness).document.recipe();
    assert!(recipe.nodes().len() == 1 && studio(&harness).document.text().contains("height = \"noise\""));
}

/// Every preset opens and is drawn; the first picture of the default comes soon.
#[test]
fn every_preset_is_drawn() {
    let folder = TestFolder::new("studio-presets").unwrap();
    for preset in orogen::presets::all() {
        let mut harness = window(&folder, Some(preset.name), Language::English);
        until(&mut harness, preset.name, |app| app.studio().unwrap().frame.is_some());
        harness.run_steps(2);
        let picture = harness.render().unwrap();
        // The land is in the middle of the view, and is not of one color.
        let mut colors = std::collections::HashSet::new();
        for y in 200..400 {
            for x in 300..700 {
                colors.insert(picture.get_pixel(x, y).0);
            }
        }
        assert!(colors.len() > 100, "{}: {} colors", preset.name, colors.len());
        assert!(studio(&harness).failure.is_none(), "{:?}", studio(&harness).failure);
    }
}

#[test]
fn it_speaks_chinese_if_the_system_has_letters_for_it() {
    let folder = TestFolder::new("studio-chinese").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::Chinese);
    harness.run_steps(3);
    // Without a font it says so, in English.
    let speaks = harness.query_by_label("节点图").is_some();
    assert!(speaks || harness.query_by_label("Graph").is_some());
}

#[test]
fn sizes_from_tiny_to_large_are_drawn() {
    let folder = TestFolder::new("studio-sizes").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    for size in [[200.0, 120.0], [60.0, 40.0], [1920.0, 1200.0]] {
        harness.set_size(size.into());
        harness.run_steps(3);
        assert!(harness.render().is_ok());
    }
}

/// Presses and releases the button of the pointer at a position.
fn click_at(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.event(Event::PointerMoved(at));
    for pressed in [true, false] {
        harness.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    // Longer than between the clicks of a double click.
    harness.run_steps(30);
}

#[test]
fn a_line_is_drawn_on_the_map_and_its_points_are_moved() {
    let folder = TestFolder::new("studio-drawing").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    harness.get_by_label("Draw a line").click();
    harness.run_steps(2);
    let map = harness.get_by_label("map view").rect();
    let at = |x: f32, y: f32| map.min + map.size() * egui::vec2(x, y);
    for place in [at(0.4, 0.4), at(0.5, 0.6), at(0.6, 0.5)] {
        click_at(&mut harness, place);
    }
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let points = |harness: &Harness<'_, App>| {
        let recipe = studio(harness).document.recipe();
        let named = recipe.nodes().iter().find(|named| named.name == "path").unwrap();
        points_of(&named.node).unwrap()
    };
    let before = points(&harness);
    assert!(before.len() == 3 && before[0][0] < before[1][0] && before[1][1] > before[2][1], "{before:?}");
    assert_eq!(studio(&harness).selected, ["path"]);
    // Its first point is dragged to the right.
    harness.drag_at(at(0.4, 0.4));
    harness.run_steps(2);
    for step in 1..=5 {
        harness.event(Event::PointerMoved(at(0.4, 0.4) + egui::vec2(8.0 * step as f32, 0.0)));
        harness.run_steps(1);
    }
    harness.drop_at(at(0.4, 0.4) + egui::vec2(40.0, 0.0));
    harness.run_steps(3);
    let after = points(&harness);
    assert!(after[0][0] > before[0][0] && after[1..] == before[1..], "{before:?} {after:?}");
    // The drag is one step.
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(points(&harness), before);
}

/// From a change of a slider to the first picture: the times that the machine allows are far below these limits.
#[test]
fn a_slider_shows_the_land_soon() {
    let folder = TestFolder::new("studio-slider").unwrap();
    let mut harness = window(&folder, Some("alpine"), Language::English);
    until_done(&mut harness);
    let request = studio(&harness).frame.as_ref().unwrap().request;
    let slider = harness.get_by_role_and_label(Role::Slider, "uplift_rate");
    slider.focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowRight);
    until(&mut harness, "a picture after the change", |app| {
        app.studio().unwrap().frame.as_ref().unwrap().request > request
    });
    let frame = studio(&harness).frame.clone().unwrap();
    assert!(frame.quality == Quality::Draft && frame.window().width == 256, "{:?}", frame.quality);
    assert!(studio(&harness).document.text().contains("[parameters.uplift_rate]"));
}

#[test]
fn a_variant_is_taken_over_and_compared() {
    let folder = TestFolder::new("studio-variants").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    harness.get_by_label("Compare").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("End the comparison").is_some());
    press(&mut harness, Modifiers::COMMAND, Key::Num6);
    harness.get_by_label("variant 4").click();
    harness.run_steps(3);
    assert_eq!(studio(&harness).document.recipe().world.seed, 4);
    until_done(&mut harness);
    assert!(harness.render().is_ok());
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.recipe().world.seed, 1);
}
