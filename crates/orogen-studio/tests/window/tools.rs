//! The tools for the land: in 3D, on the map, and on both side by side.

use eframe::egui::{Event, Key, Modifiers, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::editing::drawing::points_of;
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
    let layout = |folder: &TestFolder| Settings::read(Some(folder)).layout;
    assert_eq!((layout(&folder).view, layout(&folder).is_relief_apart), (View::Windows, false));
    // Either view can have the window of its own, above the other one.
    let area = |harness: &Harness<'_, App>, view: &str| harness.get_by_label(view).rect().area();
    let before = ["map view", "relief view"].map(|view| area(&harness, view));
    // The other window may cover the button.
    harness.get_by_label("Swap").focus();
    press(&mut harness, Modifiers::NONE, Key::Enter);
    harness.run_steps(4);
    let after = ["map view", "relief view"].map(|view| area(&harness, view));
    assert!((before[0] < before[1]) != (after[0] < after[1]), "{before:?} {after:?}");
}

#[test]
fn layouts_are_kept_under_a_name() {
    let folder = TestFolder::new("studio-layouts").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    let open = |harness: &mut Harness<'_, App>| {
        for label in ["View", "Layouts"] {
            harness.get_by_label(label).click();
            harness.run_steps(3);
        }
    };
    let keep = |harness: &mut Harness<'_, App>, name: &str| {
        open(harness);
        let field = harness.get_by_role_and_label(Role::TextInput, "Name of this layout");
        field.focus();
        field.type_text(name);
        harness.run_steps(2);
        harness.get_by_label("Keep").click();
        harness.run_steps(3);
    };
    press(&mut harness, Modifiers::COMMAND, Key::Num8);
    keep(&mut harness, "two views");
    let settings = Settings::read(Some(&folder));
    assert_eq!((settings.layouts.len(), settings.layouts[0].name.as_str()), (1, "two views"));
    open(&mut harness);
    harness.get_by_label("Initial layout").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("map view").is_none());
    open(&mut harness);
    harness.get_by_label("two views").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("map view").is_some());
    assert_eq!(Settings::read(Some(&folder)).layout, settings.layouts[0].layout);
    open(&mut harness);
    harness.get_by_label("Forget this layout two views").click();
    harness.run_steps(2);
    assert!(Settings::read(Some(&folder)).layouts.is_empty());
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
    let at = |x: f32, y: f32| map.min + map.size() * vec2(x, y);
    for place in [at(0.4, 0.4), at(0.5, 0.6), at(0.6, 0.5)] {
        click_at(&mut harness, place);
    }
    press(&mut harness, Modifiers::NONE, Key::Enter);
    harness.get_by_label("Only keep the drawing").click();
    harness.run_steps(3);
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
        harness.event(Event::PointerMoved(at(0.4, 0.4) + vec2(8.0 * step as f32, 0.0)));
        harness.run_steps(1);
    }
    harness.drop_at(at(0.4, 0.4) + vec2(40.0, 0.0));
    harness.run_steps(3);
    let after = points(&harness);
    assert!(after[0][0] > before[0][0] && after[1..] == before[1..], "{before:?} {after:?}");
    // The drag is one step.
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(points(&harness), before);
}

#[test]
fn land_and_a_mask_are_painted_on_the_map_and_each_stroke_is_undone_in_one_step() {
    let folder = TestFolder::new("studio-brush").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    press(&mut harness, Modifiers::COMMAND, Key::Num2);
    harness.get_by_label("Raise").click();
    harness.run_steps(2);
    let before = studio(&harness).document.text().to_owned();
    let land = studio(&harness).frame.clone().unwrap();
    let map = harness.get_by_label("map view").rect();
    let at = |x: f32, y: f32| map.min + map.size() * vec2(x, y);
    let line: Vec<Pos2> = (0..=12).map(|k| at(0.4 + 0.02 * k as f32, 0.5)).collect();
    drag_along(&mut harness, &line);
    let text = studio(&harness).document.text().to_owned();
    let has = |part: &str| text.contains(part);
    assert!(has("[nodes.paint]\nop = \"paint\"\nbackground = ") && has("height = \"paint\""), "{text}");
    assert_eq!(studio(&harness).selected, ["paint"]);
    let stroke = strokes(&harness, "paint")[0].clone();
    assert!(stroke.points.len() == 2 && stroke.points[0][0] < stroke.points[1][0], "{stroke:?}");
    // The map shows the stroke.
    until_done(&mut harness);
    let raised = studio(&harness).frame.clone().unwrap();
    let middle = [0, 1].map(|k| (stroke.points[0][k] + stroke.points[1][k]) / 2.0);
    let [low, high] = [&land, &raised].map(|frame| f64::from(frame.at(middle).unwrap()[1]));
    assert!(stroke.value > 0.0 && (high - low - stroke.value).abs() < 1e-2, "{low} {high} {stroke:?}");
    // A key makes the brush larger, and a dab lowers the land.
    harness.get_by_label("Lower").click();
    harness.run_steps(2);
    harness.event(Event::PointerMoved(at(0.5, 0.4)));
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::CloseBracket);
    click_at(&mut harness, at(0.5, 0.4));
    let dab = strokes(&harness, "paint")[1].clone();
    assert!(dab.points.len() == 1 && dab.value == -stroke.value && dab.radius > stroke.radius, "{dab:?}");
    // A mask is a separate node, which the map shows.
    harness.get_by_label("Paint").click();
    harness.run_steps(2);
    drag_along(&mut harness, &line);
    assert_eq!((strokes(&harness, "paint2").len(), studio(&harness).look.layer.as_str()), (1, "paint2"));
    until_done(&mut harness);
    let center = strokes(&harness, "paint2")[0].points[0];
    assert_eq!(studio(&harness).frame.as_ref().unwrap().at(center).unwrap()[0], 1.0);
    assert!(harness.render().is_ok());
    // Each stroke is one step.
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), text);
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(studio(&harness).document.text(), before);
}
