//! Tests that use the window like a user. They need an adapter: `cargo xtask clients studio` installs Mesa's software
//! driver.
#![allow(clippy::unwrap_used, reason = "a failure is a failed test")]

#[path = "window/export.rs"]
mod export;
#[path = "window/finding.rs"]
mod finding;
#[path = "window/keyboard.rs"]
mod keyboard;
#[path = "window/manners.rs"]
mod manners;
#[path = "window/random.rs"]
mod random;
#[path = "window/reroutes.rs"]
mod reroutes;
#[path = "window/speed.rs"]
mod speed;
#[path = "window/tools.rs"]
mod tools;
#[path = "window/unsaved.rs"]
mod unsaved;
#[path = "window/views.rs"]
mod views;

use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::declare::Stroke;
use orogen::io::test_folder::TestFolder;
use orogen::node::Node;
use orogen_studio::catalogue::Language;
use orogen_studio::preview::coloring::Coloring;
use orogen_studio::preview::frame::Quality;
use orogen_studio::preview::legend::Legend;
use orogen_studio::settings::{Settings, Theme};
use orogen_studio::studio::{Studio, open};
use orogen_studio::window::app::{App, Start};

/// A window with a recipe, a preset, or the start page.
fn window(folder: &TestFolder, document: Option<&str>, language: Language) -> Harness<'static, App> {
    let settings = Settings {
        language: Some(language),
        theme: Theme::Dark,
        // The tests type into the studio's own dialogs.
        has_system_dialogs: false,
        ..Settings::default()
    };
    let folder = folder.to_path_buf();
    let document = document.map(|name| open(Path::new(name)).unwrap());
    let mut harness =
        Harness::builder().with_size([1280.0, 800.0]).with_max_steps(8).wgpu().build_eframe(move |context| {
            App::new(context, Start { settings, folder: Some(folder), document, ..Start::default() }).unwrap()
        });
    harness.step();
    harness
}

fn studio<'a>(harness: &'a Harness<'_, App>) -> &'a Studio {
    harness.state().studio().unwrap()
}

/// Runs steps until a condition holds.
fn until(harness: &mut Harness<'_, App>, what: &str, holds: impl Fn(&App) -> bool) {
    let begun = Instant::now();
    while !holds(harness.state()) {
        assert!(begun.elapsed() < Duration::from_secs(300), "{what}: not after 300 s");
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

    // Another seed, and back, ten times.
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

    // Another program replaces the file. Some file systems store times in steps of several milliseconds, so the file
    // gets an explicit time.
    let new = path.with_extension("new");
    std::fs::write(&new, text.replace("octaves = 6", "octaves = 2")).unwrap();
    let later = std::time::SystemTime::now() + Duration::from_secs(9);
    std::fs::File::options().append(true).open(&new).unwrap().set_modified(later).unwrap();
    std::fs::rename(&new, &path).unwrap();
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

/// Every preset opens and is drawn; the first picture of the default preset comes soon.
#[test]
fn every_preset_is_drawn() {
    let folder = TestFolder::new("studio-presets").unwrap();
    for preset in orogen::presets::all() {
        let mut harness = window(&folder, Some(preset.name), Language::English);
        until(&mut harness, preset.name, |app| app.studio().unwrap().frame.is_some());
        harness.run_steps(2);
        let picture = harness.render().unwrap();
        // The land is in the middle of the view, and has several colors.
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
    // Without a font it reports so, in English.
    let speaks = harness.query_by_label("节点图").is_some();
    assert!(speaks || harness.query_by_label("Graph").is_some());
}

/// Errors are in the language of the interface, in the text and in messages.
#[test]
fn errors_are_told_in_chinese() {
    let folder = TestFolder::new("studio-chinese-errors").unwrap();
    let broken = folder.join("broken.toml");
    let text = "orogen = 1\n[nodes.land]\nop = \"fbmm\"\n[outputs]\nheight = \"lnd\"\n";
    std::fs::write(&broken, text).unwrap();
    let mut harness = window(&folder, broken.to_str(), Language::Chinese);
    harness.run_steps(3);
    // Without a font the interface is in English.
    let speaks = harness.query_by_label("节点图").is_some();
    let (own, other) = ("3: 没有名为“fbmm”的算子；是否想写“fbm”？", "3: unknown op `fbmm`; did you mean `fbm`?");
    assert_eq!((harness.query_by_label(own).is_some(), harness.query_by_label(other).is_some()), (speaks, !speaks));
}

/// Broken and huge recipes open; without a graphics card everything except the 3D view is available.
#[test]
fn broken_and_huge_recipes_open_and_so_does_a_window_without_a_graphics_card() {
    let folder = TestFolder::new("studio-broken").unwrap();
    let broken = folder.join("broken.toml");
    std::fs::write(&broken, "orogen = 1\n[world]\ncell = \"wide\"\n").unwrap();
    let mut harness = window(&folder, broken.to_str(), Language::English);
    harness.run_steps(3);
    assert!(!studio(&harness).document.is_valid());
    // The text is shown with its error, and can be fixed.
    assert!(harness.query_by_label_contains("The text has errors").is_some());
    assert!(harness.query_by_role_and_label(Role::TextInput, "recipe").is_some());
    assert!(harness.render().is_ok());

    let mut text = String::from("orogen = 1\n\n[world]\ncell = 10\nsize = 1000\n\n[nodes.n0]\nop = \"fbm\"\n");
    (1..400).for_each(|n| text.push_str(&format!("[nodes.n{n}]\nop = \"add\"\na = \"n{}\"\nb = 0.5\n", n - 1)));
    text.push_str("[outputs]\nheight = \"n399\"\n");
    let huge = folder.join("huge.toml");
    std::fs::write(&huge, text).unwrap();
    let mut harness = window(&folder, huge.to_str(), Language::English);
    until_done(&mut harness);
    assert!(harness.render().is_ok() && studio(&harness).failure.is_none());

    let settings = Settings { language: Some(Language::English), ..Settings::default() };
    let start = Start { settings, document: Some(open(Path::new("classic")).unwrap()), ..Start::default() };
    let mut harness = Harness::builder()
        .with_size([800.0, 600.0])
        .with_max_steps(8)
        .build_eframe(move |context| App::new(context, start).unwrap());
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    assert!(harness.query_by_label("map view").is_some());
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

/// Clicks twice, as fast as for a double click.
fn double_click(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.event(Event::PointerMoved(at));
    harness.run_steps(1);
    // In a single step, because separate steps are further apart than the clicks of a double click.
    for pressed in [true, false, true, false] {
        let button = PointerButton::Primary;
        let click = Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE };
        harness.input_mut().events.push(click);
    }
    // So that the next click is none of them.
    harness.run_steps(30);
}

/// Presses and releases the pointer button at a position.
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
    // Longer than the time between the clicks of a double click.
    harness.run_steps(30);
}

/// Moves the pointer along a line with its button pressed.
fn drag_along(harness: &mut Harness<'_, App>, line: &[Pos2]) {
    let (first, last) = (line[0], line[line.len() - 1]);
    harness.event(Event::PointerMoved(first));
    harness.run_steps(1);
    harness.drag_at(first);
    harness.run_steps(1);
    for at in line {
        harness.event(Event::PointerMoved(*at));
        harness.run_steps(1);
    }
    harness.drop_at(last);
    harness.run_steps(3);
}

/// The strokes of a node; empty if it is not a paint node.
fn strokes<'a>(harness: &'a Harness<'_, App>, name: &str) -> &'a [Stroke] {
    let mut nodes = studio(harness).document.recipe().nodes().iter();
    match nodes.find(|named| named.name == name).map(|named| &named.node) {
        Some(Node::Paint(paint)) => paint.strokes.list(),
        _ => &[],
    }
}

/// From a change of a slider to the first picture: typical times are far below these limits.
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

/// Selects an entry in the list of colorings.
fn choose_color(harness: &mut Harness<'_, App>, from: &str, to: &str) {
    harness.get_by_value(from).click();
    harness.run_steps(3);
    harness.get_by_label(to).click();
    harness.run_steps(3);
}

#[test]
fn colors_are_chosen_and_edited() {
    let folder = TestFolder::new("studio-colors").unwrap();
    let mut harness = window(&folder, Some("tile-island"), Language::English);
    until_done(&mut harness);
    let plain = studio(&harness).frame.clone().unwrap();
    assert!(matches!(plain.legend, Legend::Ramp { .. }));
    choose_color(&mut harness, "palette of the layer", "terrain classes");
    until(&mut harness, "the classes", |app| app.studio().unwrap().frame.as_ref().unwrap().request > plain.request);
    let classes = studio(&harness).frame.clone().unwrap();
    let Legend::Entries(entries) = &classes.legend else { panic!() };
    assert!(entries.len() > 2 && classes.albedo != plain.albedo && classes.heights == plain.heights);

    // Edits the ramp of the view: a color is added by a double click, dragged, and removed again.
    harness.get_by_label("Edit colors").click();
    harness.run_steps(3);
    let Coloring::Edited(before) = studio(&harness).look.coloring.clone() else { panic!() };
    let bar = harness.get_by_label("color ramp").rect();
    let at = bar.min + bar.size() * egui::vec2(0.31, 0.3);
    double_click(&mut harness, at);
    let Coloring::Edited(after) = studio(&harness).look.coloring.clone() else { panic!() };
    assert_eq!(after.stops.len(), before.stops.len() + 1);
    harness.get_by_label("Remove").click();
    harness.run_steps(3);
    let Coloring::Edited(removed) = studio(&harness).look.coloring.clone() else { panic!() };
    assert_eq!(removed.stops, before.stops);
}

#[test]
fn the_land_is_compared_with_real_land_and_with_itself() {
    let folder = TestFolder::new("studio-real").unwrap();
    let mut harness = window(&folder, Some("hills"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num7);
    let begun = Instant::now();
    while harness.query_by_label("mean slope").is_none() {
        assert!(begun.elapsed() < Duration::from_secs(300), "no figures");
        std::thread::sleep(Duration::from_millis(10));
        harness.step();
    }
    assert!(harness.query_all_by_label("as real land").count() > 3);

    // Two pictures side by side, and back to the first recipe.
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    harness.get_by_label("Compare").click();
    harness.run_steps(2);
    let before = studio(&harness).document.text().to_owned();
    press(&mut harness, Modifiers::COMMAND, Key::R);
    until_done(&mut harness);
    harness.get_by_label("Side by side").click();
    harness.run_steps(2);
    assert!(harness.render().is_ok());
    harness.get_by_label("Back to A").click();
    harness.run_steps(2);
    assert_eq!(studio(&harness).document.text(), before);
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

#[test]
fn nodes_are_grouped_entered_renamed_and_all_of_it_is_undone() {
    let folder = TestFolder::new("studio-groups").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let before = studio(&harness).document.text().to_owned();
    let heights = studio(&harness).frame.clone().unwrap().heights.clone();
    // A selection rectangle from one corner of the graph to the other.
    let rects = ["node noise", "node terrain"].map(|label| harness.get_by_label(label).rect());
    let all = rects[0].union(rects[1]).expand(6.0);
    harness.drag_at(all.min);
    harness.run_steps(2);
    harness.event(Event::PointerMoved(all.center()));
    harness.run_steps(2);
    harness.drop_at(all.max);
    harness.run_steps(3);
    let mut selected = studio(&harness).selected.clone();
    selected.sort();
    assert_eq!(selected, ["noise", "terrain"]);
    press(&mut harness, Modifiers::COMMAND, Key::G);
    assert!(studio(&harness).document.text().contains("[nodes.\"group/noise\"]"));
    assert!(harness.query_by_label("node group/noise").is_none());
    // Its inner nodes are visible, and its name is changed in the inspector.
    harness.get_by_label("Open").click();
    harness.run_steps(3);
    let inner = harness.get_by_label("node group/noise").rect().center();
    press(&mut harness, Modifiers::NONE, Key::F2);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.event(Event::Text("land".into()));
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(studio(&harness).document.text().contains("[nodes.\"land/noise\"]"));
    assert!(harness.query_by_label("node land/noise").is_some());
    // An inner node is selected and edited like any other.
    click_at(&mut harness, inner);
    assert_eq!(studio(&harness).selected, ["land/noise"]);
    assert!(harness.query_by_role_and_label(Role::Slider, "land/noise.gain").is_some());
    until_done(&mut harness);
    assert_eq!(studio(&harness).frame.as_ref().unwrap().heights, heights);
    harness.get_by_label("Recipe").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("group land").is_some());
    for _ in 0..2 {
        press(&mut harness, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(studio(&harness).document.text(), before);
    assert!(harness.query_by_label("node noise").is_some());
}

#[test]
fn nodes_have_small_pictures_unless_they_are_switched_off() {
    let folder = TestFolder::new("studio-thumbnails").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until(&mut harness, "the pictures of nodes", |app| {
        let studio = app.studio().unwrap();
        studio.is_done() && !studio.thumbnails.is_busy() && studio.thumbnails.of("noise").is_some()
    });
    harness.run_steps(3);
    // The picture is in the lower right corner of its box.
    let rect = harness.get_by_label("node noise").rect();
    let colors = |harness: &mut Harness<'_, App>| {
        let picture = harness.render().unwrap();
        let corner = rect.max - egui::vec2(36.0, 36.0);
        let pixels = (0..30).flat_map(|y| (0..30).map(move |x| (corner.x as u32 + x, corner.y as u32 + y)));
        pixels.map(|(x, y)| picture.get_pixel(x, y).0).collect::<std::collections::HashSet<_>>().len()
    };
    assert!(colors(&mut harness) > 50);
    let computed = studio(&harness).thumbnails.computed();
    harness.get_by_label("View").click();
    harness.run_steps(3);
    harness.get_by_label("Pictures in the graph").click();
    harness.run_steps(10);
    assert!(!studio(&harness).has_thumbnails);
    assert!(colors(&mut harness) < 50);
    assert_eq!(studio(&harness).thumbnails.computed(), computed);
}

#[test]
fn a_broken_expression_says_so_and_is_not_applied() {
    let folder = TestFolder::new("studio-expression").unwrap();
    let path = folder.join("land.toml");
    let text = "orogen = 1\n[world]\nsize = 1000\n[nodes.hills]\nop = \"fbm\"\n[nodes.land]\nop = \"expr\"\nexpr = \"hills * 100\"\n[outputs]\nheight = \"land\"\n";
    std::fs::write(&path, text).unwrap();
    let mut harness = window(&folder, path.to_str(), Language::English);
    until_done(&mut harness);
    harness.get_by_label("node land").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::TextInput, "land.expr").focus();
    harness.run_steps(2);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.get_by_role_and_label(Role::TextInput, "land.expr").type_text("hils * 100");
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("unknown node `hils`").is_some());
    assert_eq!(studio(&harness).document.text(), text);
    // Typed text is kept when another node is selected in between.
    harness.get_by_label("node hills").click();
    harness.run_steps(3);
    harness.get_by_label("node land").click();
    harness.run_steps(3);
    assert_eq!(studio(&harness).selected, ["land"]);
    assert!(harness.query_by_label_contains("unknown node `hils`").is_some());
    // A completion fixes it.
    harness.get_by_role_and_label(Role::TextInput, "land.expr").focus();
    harness.run_steps(2);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.get_by_role_and_label(Role::TextInput, "land.expr").type_text("200 * hil");
    harness.run_steps(3);
    press(&mut harness, Modifiers::CTRL, Key::Period);
    assert!(
        studio(&harness).document.text().contains("expr = \"200 * hills\""),
        "{}",
        studio(&harness).document.text()
    );
    assert!(harness.query_by_label_contains("unknown node").is_none());
}
