//! Points of the graph's wires: added, moved and removed, with the mouse and with keys.

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::editing::reader::Reader;
use orogen_studio::window::app::App;

use super::{click_at, double_click, drag_along, press, studio, until_done, window};

const WIRE: &str = "wire noise to terrain.source";
const POINT: &str = "point 1 of the wire noise to terrain.source";
const SECOND: &str = "point 2 of the wire noise to terrain.source";

fn opened(folder: &TestFolder) -> Harness<'static, App> {
    let mut harness = window(folder, Some("classic"), Language::English);
    until_done(&mut harness);
    harness.run_steps(3);
    harness
}

/// The kept points of the first wire that has some.
fn points<'a>(harness: &'a Harness<'_, App>) -> &'a [[f64; 3]] {
    studio(harness).document.kept().reroutes.first().map_or(&[], |reroute| &reroute.points)
}

fn rect(harness: &Harness<'_, App>, label: &str) -> Rect {
    harness.get_by_label(label).rect()
}

fn right_click(harness: &mut Harness<'_, App>, at: Pos2) {
    harness.event(Event::PointerMoved(at));
    harness.run_steps(1);
    for pressed in [true, false] {
        let button = PointerButton::Secondary;
        harness.event(Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE });
    }
    harness.run_steps(30);
}

#[test]
fn a_point_is_added_dragged_undone_and_removed() {
    let folder = TestFolder::new("studio-reroutes").unwrap();
    let mut harness = opened(&folder);
    let before = studio(&harness).document.text().to_owned();
    let heights = studio(&harness).frame.clone().unwrap().heights.clone();
    let middle = rect(&harness, WIRE).center();
    double_click(&mut harness, middle);
    assert_eq!(points(&harness).len(), 1, "{}", studio(&harness).document.text());
    let reroute = studio(&harness).document.kept().reroutes[0].clone();
    let reader = Reader::Input { node: "terrain".into(), key: "source".into() };
    assert_eq!((reroute.from.as_str(), reroute.reader, reroute.group.as_str()), ("noise", reader, ""));
    assert!(harness.query_by_label("Add a node").is_none(), "no search is open");
    let at = rect(&harness, POINT).center();
    assert!(at.distance(middle) < 2.0, "{at} is not at {middle}");
    let added = studio(&harness).document.text().to_owned();

    // A drag is one step.
    let to = at + vec2(12.0, 60.0);
    drag_along(&mut harness, &[at, at + vec2(3.0, 20.0), at + vec2(20.0, 40.0), to]);
    assert!(rect(&harness, POINT).center().distance(to) < 2.0);
    let moved = studio(&harness).document.text().to_owned();
    assert_ne!(moved, added);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), added);
    assert!(rect(&harness, POINT).center().distance(at) < 2.0);
    press(&mut harness, Modifiers::COMMAND, Key::Y);
    assert_eq!(studio(&harness).document.text(), moved);
    // Escape gives a drag up.
    harness.drag_at(to);
    harness.run_steps(1);
    harness.event(Event::PointerMoved(at));
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    harness.drop_at(at);
    harness.run_steps(30);
    assert_eq!(studio(&harness).document.text(), moved);

    // It moves with both boxes, and has its place in a tidy graph.
    let noise = rect(&harness, "node noise").center();
    for label in ["node noise", "node terrain"] {
        let from = rect(&harness, label).center();
        drag_along(&mut harness, &[from, from + vec2(-9.0, 5.0), from + vec2(-10.0, 8.0)]);
    }
    assert!(rect(&harness, POINT).center().distance(to + vec2(-10.0, 8.0)) < 3.0);
    harness.get_by_label("Tidy").click();
    harness.run_steps(3);
    assert!(rect(&harness, "node noise").center().distance(noise) < 40.0);
    assert_eq!(studio(&harness).document.text(), moved);

    // A right click removes it; so does a double click, and Delete with the pointer on it.
    let at = rect(&harness, POINT).center();
    right_click(&mut harness, at);
    assert_eq!(studio(&harness).document.text(), before);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    double_click(&mut harness, at);
    assert_eq!(studio(&harness).document.text(), before);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    harness.event(Event::PointerMoved(at));
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!(studio(&harness).document.text(), before);
    // Nothing of it changed the land.
    until_done(&mut harness);
    assert_eq!(studio(&harness).frame.as_ref().unwrap().heights, heights);
}

#[test]
fn a_wire_has_several_points_in_their_order_and_a_menu() {
    let folder = TestFolder::new("studio-reroutes-menu").unwrap();
    let mut harness = opened(&folder);
    let before = studio(&harness).document.text().to_owned();
    let middle = rect(&harness, WIRE).center();
    double_click(&mut harness, middle);
    let to = middle + vec2(0.0, 60.0);
    drag_along(&mut harness, &[middle, to]);
    // Before it and after it.
    for _ in 0..2 {
        let free = rect(&harness, WIRE).center();
        right_click(&mut harness, free);
        harness.get_by_label("Add a point").click();
        harness.run_steps(30);
    }
    assert_eq!(points(&harness).len(), 3);
    assert!(points(&harness).windows(2).all(|pair| pair[0][0] < pair[1][0]), "{:?}", points(&harness));
    assert!(rect(&harness, SECOND).center().distance(to) < 2.0);
    // The selected point is removed with the pointer elsewhere in the graph.
    click_at(&mut harness, to);
    assert!(studio(&harness).selected.is_empty());
    let elsewhere = rect(&harness, "graph").left_bottom() + vec2(20.0, -20.0);
    harness.event(Event::PointerMoved(elsewhere));
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!(points(&harness).len(), 2);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!((points(&harness).len(), studio(&harness).document.recipe().nodes().len()), (2, 2));
    // The menu also removes all of them, and cuts the wire.
    let free = rect(&harness, WIRE).center();
    right_click(&mut harness, free);
    harness.get_by_label("Remove the points").click();
    harness.run_steps(30);
    assert_eq!(studio(&harness).document.text(), before);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(points(&harness).len(), 2);
    right_click(&mut harness, free);
    harness.get_by_label("Cut the wire").click();
    harness.run_steps(30);
    assert!(harness.query_by_label(WIRE).is_none() && points(&harness).is_empty());
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(points(&harness).len(), 2, "the points of a cut wire come back with it");
}

#[test]
fn keys_add_move_and_remove_points() {
    let folder = TestFolder::new("studio-reroutes-keys").unwrap();
    let mut harness = opened(&folder);
    let before = studio(&harness).document.text().to_owned();
    harness.get_by_label(WIRE).focus();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(points(&harness).len(), 1);
    let at = rect(&harness, POINT).center();
    harness.get_by_label(POINT).focus();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::ArrowDown);
    press(&mut harness, Modifiers::NONE, Key::ArrowDown);
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    let by = rect(&harness, POINT).center() - at;
    assert!(by.x > 4.0 && (by.y - 2.0 * by.x).abs() < 2.0, "{by}");
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert_eq!(studio(&harness).document.text(), before);
    for _ in 0..5 {
        press(&mut harness, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(studio(&harness).document.text(), before);
    assert!(studio(&harness).document.history().undo_label().is_none(), "each was one step");
    harness.get_by_label(WIRE).focus();
    harness.run_steps(3);
    press(&mut harness, Modifiers::NONE, Key::Delete);
    assert!(harness.query_by_label(WIRE).is_none());
}

/// Wires to outputs and masks, and wires within groups and at their sides, have points, too.
#[test]
fn every_wire_can_have_points() {
    let folder = TestFolder::new("studio-reroutes-all").unwrap();
    let path = folder.join("land.toml");
    let text = "orogen = 1\n[world]\nsize = 1000\n[nodes.hills]\nop = \"fbm\"\n[nodes.\"g/base\"]\nop = \"fbm\"\n[nodes.\"g/soft\"]\nop = \"blur\"\nsource = \"g/base\"\nmask = \"hills\"\n[outputs]\nheight = \"g/soft\"\n";
    std::fs::write(&path, text).unwrap();
    let mut harness = window(&folder, path.to_str(), Language::English);
    until_done(&mut harness);
    let add = |harness: &mut Harness<'_, App>, wires: &[&str]| {
        for wire in wires {
            harness.get_by_label(&format!("wire {wire}")).focus();
            harness.run_steps(3);
            press(harness, Modifiers::NONE, Key::Enter);
            assert!(harness.query_by_label(&format!("point 1 of the wire {wire}")).is_some(), "{wire}");
        }
    };
    add(&mut harness, &["hills to g/soft.mask", "g/soft to height"]);
    harness.get_by_label("group g").click();
    harness.run_steps(3);
    harness.get_by_label("Open").click();
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("point 1").is_none(), "each view of a wire has its own points");
    add(&mut harness, &["hills to g/soft.mask", "g/base to g/soft.source"]);
    let groups: Vec<&str> =
        studio(&harness).document.kept().reroutes.iter().map(|reroute| reroute.group.as_str()).collect();
    assert_eq!(groups, ["", "", "g", "g"]);
    assert!(harness.render().is_ok());
}
