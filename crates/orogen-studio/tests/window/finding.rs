//! Going back, finding ops and palettes, looking from other sides.

use eframe::egui::{Key, Modifiers, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::preview::coloring::Coloring;
use orogen_studio::window::app::App;

use super::{drag_along, press, studio, until, until_done, window};

#[test]
fn the_history_goes_to_any_step() {
    let folder = TestFolder::new("studio-history").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    let first = studio(&harness).document.text().to_owned();
    for _ in 0..3 {
        press(&mut harness, Modifiers::COMMAND, Key::R);
    }
    let last = studio(&harness).document.text().to_owned();
    for (entry, text) in [("0   as opened", &first), ("3   seed", &last)] {
        harness.get_by_label("Edit").click();
        harness.run_steps(3);
        harness.get_by_label_contains("History").click();
        harness.run_steps(3);
        harness.get_by_label(entry).click();
        harness.run_steps(3);
        assert_eq!(studio(&harness).document.text(), text);
    }
}

#[test]
fn versions_are_saved_beside_the_first() {
    let folder = TestFolder::new("studio-versions").unwrap();
    let path = folder.join("land.toml");
    std::fs::write(&path, orogen::presets::find("hills").unwrap().text).unwrap();
    let mut harness = window(&folder, path.to_str(), Language::English);
    let before = std::fs::read_to_string(&path).unwrap();
    for version in ["land-001.toml", "land-002.toml"] {
        press(&mut harness, Modifiers::COMMAND, Key::R);
        press(&mut harness, Modifiers::COMMAND.plus(Modifiers::ALT), Key::S);
        assert_eq!(studio(&harness).document.path(), Some(folder.join(version).as_path()));
        assert_eq!(std::fs::read_to_string(folder.join(version)).unwrap(), studio(&harness).document.text());
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap(), before);
}

#[test]
fn ops_are_found_in_their_groups() {
    let folder = TestFolder::new("studio-groups").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    let before = studio(&harness).document.recipe().nodes().len();
    press(&mut harness, Modifiers::COMMAND, Key::Space);
    assert!(harness.query_by_label("ridged").is_none());
    harness.get_by_label("Noise").click();
    // The group opens in some frames.
    harness.run_steps(30);
    harness.get_by_label("ridged").click();
    harness.run_steps(3);
    assert_eq!(studio(&harness).document.recipe().nodes().len(), before + 1);
}

#[test]
fn the_camera_looks_from_a_side_and_keeps_views() {
    let folder = TestFolder::new("studio-cameras").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let begun = harness.state().shown_view().unwrap().camera;
    let choose = |harness: &mut Harness<'_, _>, name: &str| {
        harness.get_by_label("Views").click();
        harness.run_steps(3);
        harness.get_by_label(name).click();
        harness.run_steps(3);
    };
    choose(&mut harness, "Keep this view");
    choose(&mut harness, "From the north");
    assert_eq!(harness.state().shown_view().unwrap().camera[0], 0.0);
    choose(&mut harness, "View 1");
    assert_eq!(harness.state().shown_view().unwrap().camera, begun);
    choose(&mut harness, "Forget this view 1");
    harness.run_steps(3);
    assert!(harness.query_by_label("View 1").is_none());
}

#[test]
fn palettes_are_chosen_by_their_colors() {
    let folder = TestFolder::new("studio-swatches").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    let first = orogen::io::palette::named::all()[0].name;
    harness.get_by_role_and_label(Role::ComboBox, "Colors of the layer").click();
    harness.run_steps(3);
    harness.get_by_label(first).click();
    harness.run_steps(3);
    assert_eq!(studio(&harness).look.coloring, Coloring::Named(first.into()));
}

#[test]
fn the_tour_makes_a_mountain_from_nothing() {
    let folder = TestFolder::new("studio-tour").unwrap();
    for language in Language::ALL {
        let mut harness = window(&folder, None, language);
        harness.get_by_label(language.text("command.tour")).click();
        harness.run_steps(3);
        let do_it = language.text("tour.do_it");
        harness.get_by_label(do_it).click();
        until(&mut harness, "an empty project", |app| app.studio().is_some());
        for (nth, op) in ["ridged", "remap", "stream-power"].into_iter().enumerate() {
            harness.run_steps(3);
            assert_eq!(studio(&harness).document.recipe().nodes().len(), nth);
            harness.get_by_label(do_it).click();
            harness.run_steps(3);
            let nodes = studio(&harness).document.recipe().nodes();
            assert_eq!(nodes.last().unwrap().node.spec().op, op);
        }
        until_done(&mut harness);
        let [low, high] = studio(&harness).frame.as_ref().unwrap().range();
        assert!(high - low > 500.0, "{low} to {high}");
        harness.get_by_label(do_it).click();
        harness.run_steps(3);
        assert!(harness.state().export_dialog().is_some());
        assert!(harness.query_by_label(do_it).is_none(), "the tour is over");
    }
}

#[test]
fn a_node_has_a_note_in_the_recipe() {
    let folder = TestFolder::new("studio-note").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    harness.run_steps(3);
    harness.get_by_label("node terrain").click();
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::MultilineTextInput, "Note").focus();
    harness.run_steps(2);
    press(&mut harness, Modifiers::COMMAND, Key::A);
    harness.get_by_role_and_label(Role::MultilineTextInput, "Note").type_text("from -160 to 240 m");
    harness.run_steps(3);
    let text = studio(&harness).document.text();
    assert!(text.contains("# from -160 to 240 m\n[nodes.terrain]\n"), "{text}");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
}

#[test]
fn nodes_are_locked_baked_and_framed() {
    let folder = TestFolder::new("studio-frames").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let choose = |harness: &mut Harness<'_, App>, box_name: &str, entry: &str| {
        harness.get_by_label(box_name).click_secondary();
        harness.run_steps(4);
        harness.get_by_label(entry).click();
        harness.run_steps(4);
    };
    choose(&mut harness, "node noise", "Lock");
    assert_eq!(studio(&harness).document.kept().locked, ["noise"]);
    let text = studio(&harness).document.text().to_owned();
    harness.get_by_label("node noise").click();
    harness.run_steps(3);
    harness.get_by_label("Delete").click();
    harness.run_steps(4);
    assert_eq!(studio(&harness).document.text(), text);
    assert!(harness.query_by_label_contains("is locked").is_some());
    press(&mut harness, Modifiers::NONE, Key::Escape);
    harness.get_by_label("Unlock").click();
    harness.run_steps(4);
    choose(&mut harness, "node noise", "Put a frame around the selection");
    assert!(harness.query_by_label("frame Frame").is_some());
    // The frame moves its boxes.
    let before = harness.get_by_label("node noise").rect();
    let title = harness.get_by_label("frame Frame").rect().center();
    drag_along(&mut harness, &[title, title + vec2(0.0, 15.0), title + vec2(0.0, 30.0)]);
    assert!(harness.get_by_label("node noise").rect().top() > before.top() + 15.0);
    choose(&mut harness, "node noise", "Bake (compute once for the whole world)");
    assert!(studio(&harness).document.text().contains("op = \"bake\"\nsource = \"noise\""));
    choose(&mut harness, "frame Frame", "Remove the frame");
    assert!(studio(&harness).document.kept().frames.is_empty());
}
