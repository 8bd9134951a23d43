//! Keys, menus, and what the window does while nothing happens.

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Role, ViewportId, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::settings::Settings;
use orogen_studio::window::app::App;
use std::time::Duration;

use super::{click_at, press, studio, until, until_done, window};

#[test]
fn keys_do_what_other_programs_do() {
    let folder = TestFolder::new("studio-keys").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    let before = studio(&harness).document.text().to_owned();
    press(&mut harness, Modifiers::COMMAND, Key::R);
    let after = studio(&harness).document.text().to_owned();
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), before);
    press(&mut harness, Modifiers::COMMAND, Key::Y);
    assert_eq!(studio(&harness).document.text(), after);
    // In the text, Home goes to the beginning of the line.
    press(&mut harness, Modifiers::COMMAND, Key::Num4);
    harness.get_by_role_and_label(Role::TextInput, "recipe").focus();
    harness.run_steps(2);
    press(&mut harness, Modifiers::COMMAND, Key::End);
    harness.get_by_role_and_label(Role::TextInput, "recipe").type_text("# a");
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Home);
    harness.get_by_role_and_label(Role::TextInput, "recipe").type_text("# b ");
    harness.run_steps(2);
    assert!(studio(&harness).document.text().ends_with("# b # a"), "{}", studio(&harness).document.text());
}

#[test]
fn a_broken_recipe_is_not_being_computed() {
    let folder = TestFolder::new("studio-not-computing").unwrap();
    let broken = folder.join("broken.toml");
    std::fs::write(&broken, "orogen = 1\n[nodes.a]\nop = \"fbm\"\nwavelength = -1\n[outputs]\nheight = \"a\"\n")
        .unwrap();
    let mut harness = window(&folder, broken.to_str(), Language::English);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("No land yet").is_some());
    assert!(harness.query_by_label_contains("Computing").is_none());
}

#[test]
fn a_click_that_closes_a_menu_does_not_paint_and_the_map_stays_in_place() {
    let folder = TestFolder::new("studio-menu-paint").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    let before = harness.get_by_label("map view").rect();
    harness.get_by_label("Raise").click();
    harness.run_steps(3);
    let map = harness.get_by_label("map view").rect();
    assert_eq!(map, before, "the settings of a brush need no more room");
    let text = studio(&harness).document.text().to_owned();
    harness.get_by_label("Help").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("About Orogen").is_some());
    click_at(&mut harness, map.center());
    assert!(harness.query_by_label("About Orogen").is_none());
    assert_eq!(studio(&harness).document.text(), text);
    click_at(&mut harness, map.center());
    assert_ne!(studio(&harness).document.text(), text);
}

#[test]
fn higher_land_looks_higher() {
    let folder = TestFolder::new("studio-exaggeration").unwrap();
    let path = folder.join("a.toml");
    let text = |height: f64| {
        format!(
            "orogen = 1\n[world]\nsize = 5000\ncell = 20\n[nodes.a]\nop = \"fbm\"\nwavelength = 2000\n\
             [nodes.b]\nop = \"multiply\"\na = \"a\"\nb = {height}\n[outputs]\nheight = \"b\"\n"
        )
    };
    std::fs::write(&path, text(100.0)).unwrap();
    let mut harness = window(&folder, path.to_str(), Language::English);
    until_done(&mut harness);
    harness.run_steps(2);
    let view = |harness: &Harness<'_, App>| harness.state().shown_view().unwrap().exaggeration;
    let before = view(&harness);
    assert!(before > 1.0);
    press(&mut harness, Modifiers::COMMAND, Key::Num4);
    for height in [400.0, 30.0] {
        std::fs::write(&path, text(height)).unwrap();
        let later = std::time::SystemTime::now() + Duration::from_secs(height as u64);
        std::fs::File::options().append(true).open(&path).unwrap().set_modified(later).unwrap();
        let has = format!("b = {height}");
        until(&mut harness, "the changed file", |app| app.studio().unwrap().document.text().contains(&has));
        until_done(&mut harness);
        harness.run_steps(2);
        assert_eq!(view(&harness), before);
    }
}

/// Work for a window that nobody touches: none. What is drawn again and again keeps a processor busy.
#[test]
fn an_idle_window_is_not_drawn() {
    let folder = TestFolder::new("studio-idle").unwrap();
    let path = folder.join("a.toml");
    std::fs::write(&path, studio(&window(&folder, Some("classic"), Language::English)).document.text()).unwrap();
    let mut harness = window(&folder, path.to_str(), Language::English);
    for view in [Key::Num1, Key::Num2] {
        press(&mut harness, Modifiers::COMMAND, view);
        until(&mut harness, "all pictures", |app| {
            let studio = app.studio().unwrap();
            studio.is_done() && !studio.thumbnails.is_busy() && studio.thumbnails.of("terrain").is_some()
        });
        harness.run_steps(40);
        let delay = harness.output().viewport_output[&ViewportId::ROOT].repaint_delay;
        assert!(delay > Duration::from_secs(60), "drawn again after {delay:?}: {:?}", harness.ctx.repaint_causes());
    }
}

/// The colors around a position.
fn around(harness: &mut Harness<'_, App>, at: Pos2) -> Vec<[u8; 4]> {
    let picture = harness.render().unwrap();
    let (left, top) = (at.x as u32 - 60, at.y as u32 - 60);
    (0..120).flat_map(|y| (0..120).map(move |x| (left + x, top + y))).map(|(x, y)| picture.get_pixel(x, y).0).collect()
}

/// The ring of a brush is where the pointer is, and nowhere else.
#[test]
fn the_ring_of_a_brush_goes_with_the_pointer() {
    let folder = TestFolder::new("studio-ring").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    harness.get_by_label("Raise").click();
    harness.event(Event::PointerGone);
    harness.run_steps(4);
    let map = harness.get_by_label("map view").rect();
    let at = map.center();
    let without = around(&mut harness, at);
    harness.event(Event::PointerMoved(at));
    harness.run_steps(4);
    assert_ne!(around(&mut harness, at), without);
    for leave in [Event::PointerGone, Event::PointerMoved(map.right_center() + vec2(60.0, 0.0))] {
        harness.event(Event::PointerMoved(at));
        harness.run_steps(4);
        harness.event(leave);
        harness.run_steps(4);
        assert_eq!(around(&mut harness, at), without);
    }
    // Also after a stroke that ends outside.
    let text = studio(&harness).document.text().to_owned();
    for (pos, pressed) in [(at, true), (map.right_center() + vec2(60.0, 0.0), false)] {
        harness.event(Event::PointerMoved(pos));
        let button = PointerButton::Primary;
        harness.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
        harness.run_steps(2);
    }
    assert_ne!(studio(&harness).document.text(), text);
}

/// Every field has a name for screen readers: in each panel, each dialog, and for a node of each kind of parameter.
#[test]
fn every_field_has_a_name() {
    let folder = TestFolder::new("studio-names").unwrap();
    let path = folder.join("a.toml");
    let recipe = "orogen = 1\n[parameters]\nrelief = { default = 300, range = [1, 1000] }\n[world]\nsize = 2000\ncell = 20\n\
        [nodes.a]\nop = \"fbm\"\n[nodes.b]\nop = \"curve\"\nsource = \"a\"\n[nodes.c]\nop = \"select-height\"\nsource = \"b\"\n\
        [nodes.d]\nop = \"mix\"\na = \"b\"\nb = 5\namount = \"c\"\n[nodes.e]\nop = \"expr\"\nexpr = \"d * relief\"\n[nodes.f]\nop = \"fill\"\nsource = \"e\"\n\
        [outputs]\nheight = \"f\"\n";
    std::fs::write(&path, recipe).unwrap();
    let mut harness = window(&folder, path.to_str(), Language::English);
    assert!(studio(&harness).document.is_valid(), "{:?}", studio(&harness).document.diagnostics());
    until_done(&mut harness);
    for key in [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num3] {
        press(&mut harness, Modifiers::COMMAND, key);
        harness.check_accessibility();
    }
    for node in ["a", "b", "c", "d", "e", "f"] {
        harness.get_by_label(&format!("node {node}")).click();
        harness.run_steps(3);
        assert_eq!(studio(&harness).selected, [node]);
        harness.check_accessibility();
    }
    for tool in ["Contours", "Raise", "Paint", "Compare"] {
        harness.get_by_label(tool).click();
        harness.run_steps(3);
        harness.check_accessibility();
    }
    for dialog in [Key::O, Key::E, Key::S] {
        press(
            &mut harness,
            Modifiers::COMMAND.plus(if dialog == Key::S { Modifiers::SHIFT } else { Modifiers::NONE }),
            dialog,
        );
        harness.check_accessibility();
        for kind in ["Game engine", "Map sheet", "Render", "Tilemap"].into_iter().filter(|_| dialog == Key::E) {
            harness.get_by_label(kind).click();
            harness.run_steps(3);
            harness.check_accessibility();
        }
        press(&mut harness, Modifiers::NONE, Key::Escape);
    }
    harness.get_by_label("Edit colors").click();
    harness.run_steps(3);
    harness.check_accessibility();
}

/// The whole graph is shown, however large it is, and nothing covers its boxes.
#[test]
fn the_whole_graph_is_in_its_panel() {
    let folder = TestFolder::new("studio-whole-graph").unwrap();
    let path = folder.join("a.toml");
    for count in [3, 40, 400] {
        let mut text = String::from("orogen = 1\n[world]\nsize = 1000\ncell = 10\n[nodes.n0]\nop = \"fbm\"\n");
        for n in 1..count {
            // A chain with branches.
            text.push_str(&format!("[nodes.n{n}]\nop = \"add\"\na = \"n{}\"\nb = \"n{}\"\n", n - 1, n / 2));
        }
        text.push_str(&format!("[outputs]\nheight = \"n{}\"\n", count - 1));
        std::fs::write(&path, text).unwrap();
        let mut harness = window(&folder, path.to_str(), Language::English);
        for size in [[1280.0, 800.0], [700.0, 500.0]] {
            harness.set_size(size.into());
            harness.run_steps(4);
            let panel = harness.get_by_label("graph").rect();
            let tidy = harness.get_by_label("Tidy").rect();
            let boxes = harness.query_all_by_label_contains("node n").map(|node| node.rect()).collect::<Vec<_>>();
            assert_eq!(boxes.len(), count);
            // What is outside of the panel is cut off.
            let widest = boxes.iter().map(|own| own.width()).fold(0.0, f32::max);
            let is_whole = boxes.iter().all(|own| own.width() > 0.9 * widest);
            assert!(widest > 0.1 && is_whole, "{count} at {size:?}: {panel:?} {boxes:?}");
            for own in boxes {
                assert!(panel.expand(1.0).contains_rect(own), "{count}: {own:?} in {panel:?}");
                assert!(!tidy.intersects(own), "{count}: {own:?}");
            }
        }
    }
}

#[test]
fn a_new_node_is_in_the_panel_of_the_graph() {
    let folder = TestFolder::new("studio-new-node").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    harness.get_by_label("node terrain").click();
    harness.run_steps(3);
    for op in ["blur", "terrace", "thermal", "warp"] {
        press(&mut harness, Modifiers::COMMAND, Key::Space);
        harness.event(Event::Text(op.to_owned()));
        harness.run_steps(3);
        press(&mut harness, Modifiers::NONE, Key::Enter);
        harness.run_steps(4);
        // What is outside of the panel is cut off.
        let sides = |name: &str| harness.get_by_label(name).rect().size();
        let boxes = ["noise", "terrain", op].map(|node| sides(&format!("node {node}")).x);
        let widest = boxes.into_iter().fold(sides("output box height").x, f32::max);
        assert!(
            boxes.iter().all(|own| *own > 0.9 * widest) && sides("output box height").x > 0.9 * widest,
            "{op}: {boxes:?}"
        );
    }
}

#[test]
fn panels_are_hidden_and_a_small_window_shows_the_land() {
    let folder = TestFolder::new("studio-panels").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let view = |harness: &Harness<'_, App>| harness.get_by_label("relief view").rect();
    let before = view(&harness);
    press(&mut harness, Modifiers::NONE, Key::F6);
    assert!(view(&harness).height() > before.height() + 150.0 && harness.query_by_label("Tidy").is_none());
    press(&mut harness, Modifiers::NONE, Key::F7);
    assert!(view(&harness).width() > before.width() + 150.0 && harness.query_by_label("Next seed").is_none());
    let settings = Settings::read(Some(&folder));
    assert!(settings.layout.is_view_alone(), "it is remembered");
    // What needs a panel shows it again.
    press(&mut harness, Modifiers::COMMAND, Key::Num3);
    assert!(harness.query_by_label("Tidy").is_some());
    press(&mut harness, Modifiers::NONE, Key::F11);
    assert!(harness.query_by_label("Tidy").is_none());
    press(&mut harness, Modifiers::NONE, Key::F11);
    assert!(harness.query_by_label("Tidy").is_some() && harness.query_by_label("Next seed").is_some());
    harness.set_size([480.0, 320.0].into());
    harness.run_steps(4);
    assert!(view(&harness).height() > 60.0, "{:?}", view(&harness));
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    assert!(harness.get_by_label("map view").rect().height() > 60.0);
}

/// What is pressed stays under the pointer, whatever the dialog shows next.
#[test]
fn a_dialog_stays_where_it_is() {
    let folder = TestFolder::new("studio-dialog-place").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::E);
    let place = |harness: &Harness<'_, App>| harness.get_by_label("Render").rect();
    let before = place(&harness);
    for kind in ["Map sheet", "Tilemap", "Render", "Game engine", "Layer or mesh"] {
        harness.get_by_label(kind).click();
        harness.run_steps(3);
        assert!((place(&harness).min - before.min).length() < 1.0, "{kind}: {:?}", place(&harness));
        let button = harness.get_by_role_and_label(Role::Button, "Export").rect();
        assert!(button.bottom() < 800.0, "{kind}: the button is in the window");
    }
}

#[test]
fn a_wire_takes_a_node_and_is_cut() {
    let folder = TestFolder::new("studio-wires").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let middle = |harness: &Harness<'_, App>, from: &str, to: &str| {
        let [from, to] = [from, to].map(|name| harness.get_by_label(&format!("node {name}")).rect());
        let zoom = from.width() / 150.0;
        let (start, end) = (from.right_top() + vec2(0.0, 17.0) * zoom, to.left_top() + vec2(0.0, 41.5) * zoom);
        start + (end - start) / 2.0
    };
    let at = middle(&harness, "noise", "terrain");
    click_at(&mut harness, at);
    press(&mut harness, Modifiers::COMMAND, Key::Space);
    harness.get_by_label("Add a node");
    harness.event(Event::Text("blur".into()));
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    let text = studio(&harness).document.text().to_owned();
    assert!(text.contains("op = \"blur\"\nsource = \"noise\""), "{text}");
    assert!(text.contains("source = \"blur\""), "{text}");
    assert_eq!(studio(&harness).selected, ["blur"]);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert!(!studio(&harness).document.text().contains("blur"), "one step of undo");
    // Cut: the input must be given, so it becomes a number.
    let at = middle(&harness, "noise", "terrain");
    click_at(&mut harness, at);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    let text = studio(&harness).document.text().to_owned();
    assert!(text.contains("source = 0.0") && studio(&harness).document.is_valid(), "{text}");
}

#[test]
fn a_land_begins_with_an_empty_project() {
    let folder = TestFolder::new("studio-empty").unwrap();
    let mut harness = window(&folder, None, Language::English);
    harness.get_by_label("Empty project").click();
    until(&mut harness, "the project", |app| app.studio().is_some());
    until_done(&mut harness);
    for op in ["fbm", "terrace"] {
        press(&mut harness, Modifiers::COMMAND, Key::Space);
        harness.event(Event::Text(op.into()));
        harness.run_steps(3);
        press(&mut harness, Modifiers::NONE, Key::Enter);
        let text = studio(&harness).document.text();
        assert!(text.contains(&format!("height = \"{op}\"")), "{text}");
        until_done(&mut harness);
    }
    assert!(studio(&harness).failure.is_none() && harness.query_by_label("output box height").is_some());
}
