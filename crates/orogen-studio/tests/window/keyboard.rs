//! The window without a mouse: Tab goes to every control.

use std::collections::BTreeSet;

use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::window::app::App;

use super::{press, until_done, window};

/// Roles of controls. A canvas is used by the mouse; what it does has commands and fields, too.
const ROLES: [Role; 8] = [
    Role::Button,
    Role::CheckBox,
    Role::ComboBox,
    Role::Link,
    Role::MultilineTextInput,
    Role::Slider,
    Role::SpinButton,
    Role::TextInput,
];

/// Names of the usable controls; only the one with the focus, if asked for.
fn controls(harness: &Harness<'_, App>, is_focused: bool) -> BTreeSet<String> {
    let all = ROLES.into_iter().flat_map(|role| harness.query_all_by_role(role));
    let usable = all.filter(|node| {
        let node = node.accesskit_node();
        !node.is_disabled() && (!is_focused || node.is_focused())
    });
    usable.filter_map(|node| node.accesskit_node().label()).map(|label| label.to_string()).collect()
}

/// Checks that Tab goes to every control. A text field of several lines keeps Tab, so the walk begins after it.
fn all_are_reached(harness: &mut Harness<'_, App>, place: &str) {
    let expected = controls(harness, false);
    let mut reached = BTreeSet::new();
    for _ in 0..2 * expected.len() + 20 {
        press(harness, Modifiers::NONE, Key::Tab);
        reached.extend(controls(harness, true));
    }
    let missed: Vec<&String> = expected.difference(&reached).collect();
    assert!(expected.len() > 5 && missed.is_empty(), "{place}: Tab does not go to {missed:?}");
}

#[test]
fn tab_goes_to_every_control() {
    let folder = TestFolder::new("studio-tab").unwrap();
    let mut harness = window(&folder, None, Language::English);
    harness.run_steps(3);
    all_are_reached(&mut harness, "start page");
    let mut harness = window(&folder, Some("classic"), Language::English);
    until_done(&mut harness);
    for (key, place) in [(Key::Num1, "relief and graph"), (Key::Num2, "map"), (Key::Num6, "variants")] {
        press(&mut harness, Modifiers::COMMAND, key);
        all_are_reached(&mut harness, place);
    }
    press(&mut harness, Modifiers::COMMAND, Key::Num3);
    harness.get_by_label("node noise").click();
    harness.run_steps(3);
    all_are_reached(&mut harness, "a node");
    for (key, place) in [(Key::O, "open"), (Key::E, "export")] {
        press(&mut harness, Modifiers::COMMAND, key);
        all_are_reached(&mut harness, place);
        press(&mut harness, Modifiers::NONE, Key::Escape);
    }
}
