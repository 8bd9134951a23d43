//! The tools for the land: in 3D, on the map, and on both side by side.

use eframe::egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::settings::Settings;
use orogen_studio::settings::layout::View;
use orogen_studio::window::app::App;

use super::{click_at, drag_along, press, strokes, studio, until_done, window};

/// A position in a view, from 0, 0 to 1, 1.
fn at(harness: &Harness<'_, App>, view: &str, [right, down]: [f32; 2]) -> Pos2 {
    let rect = harness.get_by_label(view).rect();
    rect.min + rect.size() * vec2(right, down)
}

/// Draws an area in a view, and chooses its use.
fn draw_area(harness: &mut Harness<'_, App>, view: &str, corners: &[[f32; 2]], chosen: &str) {
    harness.get_by_label("Draw an area").click();
    harness.run_steps(2);
    for corner in corners {
        let corner = at(harness, view, *corner);
        click_at(harness, corner);
    }
    press(harness, Modifiers::NONE, Key::Enter);
    harness.get_by_label(chosen).click();
    harness.run_steps(3);
}

#[test]
fn land_is_raised_by_a_brush_in_3d() {
    let folder = TestFolder::new("studio-brush-3d").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let before = studio(&harness).document.text().to_owned();
    let view = harness.state().shown_view();
    harness.get_by_label("Raise").click();
    harness.run_steps(2);
    let line: Vec<Pos2> = (0..=12).map(|k| at(&harness, "relief view", [0.4 + 0.015 * k as f32, 0.55])).collect();
    drag_along(&mut harness, &line);
    let painted = strokes(&harness, "paint");
    let [first, last] = [painted[0].points[0], *painted[0].points.last().unwrap()];
    assert!(painted.len() == 1 && last[0] > first[0], "{first:?} {last:?}");
    assert_eq!(harness.state().shown_view(), view, "the camera stays where it is");
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), before, "one step");
    // The sky is no land.
    let sky = at(&harness, "relief view", [0.5, 0.02]);
    click_at(&mut harness, sky);
    assert_eq!(studio(&harness).document.text(), before);
}

#[test]
fn a_drawn_area_raises_the_land_holds_a_lake_or_limits_a_node() {
    let folder = TestFolder::new("studio-area").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let before = studio(&harness).document.text().to_owned();
    let corners = [[0.4, 0.5], [0.6, 0.5], [0.6, 0.65], [0.4, 0.65]];
    draw_area(&mut harness, "relief view", &corners, "Raise the land");
    assert!(studio(&harness).document.text().contains("[nodes.raised]"), "{}", studio(&harness).document.text());
    assert_eq!(studio(&harness).selected, ["raised"]);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), before, "one step");

    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    draw_area(&mut harness, "map view", &corners, "Hold a lake");
    assert!(studio(&harness).document.text().contains("[nodes.lakes]"));
    until_done(&mut harness);
    assert!(studio(&harness).failure.is_none());
    press(&mut harness, Modifiers::COMMAND, Key::Z);

    harness.get_by_label("node noise").click();
    harness.run_steps(3);
    draw_area(&mut harness, "map view", &corners, "Limit noise");
    let noise = studio(&harness).document.recipe().nodes().iter().find(|named| named.name == "noise").unwrap();
    assert_eq!(noise.mask, orogen::declare::Input::Node("polygon".into()));
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), before);

    // Escape discards it, and a click beside the question keeps it.
    for (ends, is_kept) in [(Key::Escape, false), (Key::A, true)] {
        harness.get_by_label("Draw an area").click();
        harness.run_steps(2);
        for corner in corners {
            let corner = at(&harness, "map view", corner);
            click_at(&mut harness, corner);
        }
        press(&mut harness, Modifiers::NONE, Key::Enter);
        press(&mut harness, Modifiers::NONE, ends);
        let beside = at(&harness, "map view", [0.1, 0.5]);
        click_at(&mut harness, beside);
        assert!(harness.query_by_label("Hold a lake").is_none());
        assert_eq!(studio(&harness).document.text().contains("[nodes.polygon]"), is_kept);
    }
}

#[test]
fn views_are_side_by_side_and_the_layout_is_remembered() {
    let folder = TestFolder::new("studio-side-by-side").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num8);
    let (relief, map) = (harness.get_by_label("relief view").rect(), harness.get_by_label("map view").rect());
    assert!(relief.right() <= map.left() && relief.width() > 200.0 && map.width() > 200.0, "{relief:?} {map:?}");
    // A stroke in one view is not ended by the other one.
    harness.get_by_label("Raise").click();
    harness.run_steps(2);
    for view in ["relief view", "map view"] {
        let line: Vec<Pos2> = (0..=12).map(|k| at(&harness, view, [0.4 + 0.015 * k as f32, 0.55])).collect();
        drag_along(&mut harness, &line);
    }
    let painted = strokes(&harness, "paint");
    assert!(painted.len() == 2 && painted.iter().all(|stroke| stroke.points.len() > 1), "{painted:?}");
    // Here the window of the map is within the first one.
    press(&mut harness, Modifiers::COMMAND, Key::Num9);
    harness.run_steps(3);
    assert!(harness.query_by_label("map view").is_some() && harness.query_by_label("relief view").is_some());
    assert_eq!(Settings::read(Some(&folder)).layout.view, View::Windows);
}
