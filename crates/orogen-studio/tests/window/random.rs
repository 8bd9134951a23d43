//! Random commands, clicks, keys and words, with undo in between: nothing panics, and all of it can be undone.

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use orogen::grid::random::Random;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::window::app::App;
use orogen_studio::window::command::{self, Command};
use std::time::{Duration, Instant};

use super::window;

/// Commands that write files, or end the window, and the list from which any command is chosen.
const LEFT_OUT: [Command; 7] = [
    Command::Save,
    Command::SaveAs,
    Command::SaveVersion,
    Command::Export,
    Command::Open,
    Command::Quit,
    Command::CommandPalette,
];

/// Commands that change the recipe.
const CHANGES: [Command; 7] = [
    Command::NextSeed,
    Command::AddNode,
    Command::Duplicate,
    Command::Delete,
    Command::Group,
    Command::Ungroup,
    Command::Redo,
];

/// One of several things.
fn any<T: Copy>(random: &mut Random, all: &[T]) -> Option<T> {
    if all.is_empty() { None } else { Some(all[random.below(all.len())]) }
}

/// Whether a control with this name writes a file, or leads to one that does.
fn writes(name: &str) -> bool {
    ["Save", "Export", "Open", "Quit", "Copy", "folder", "File", "Delete them", "Load"]
        .iter()
        .any(|word| name.contains(word))
}

/// Clicks on a wire of the graph or one of its points, or drags it.
fn use_wire(harness: &mut Harness<'static, App>, random: &mut Random) {
    let all: Vec<_> = harness.query_all_by_label_contains("wire ").map(|node| node.rect().center()).collect();
    let Some(at) = any(random, &all) else { return };
    let button = |button: PointerButton, pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.event(Event::PointerMoved(at));
    harness.step();
    let events = &mut harness.input_mut().events;
    match random.below(4) {
        0 => events.extend([true, false].map(|pressed| button(PointerButton::Secondary, at, pressed))),
        1 => {
            let to = at + vec2(random.below(300) as f32 - 150.0, random.below(200) as f32 - 100.0);
            events.push(button(PointerButton::Primary, at, true));
            harness.step();
            harness.event(Event::PointerMoved(to));
            harness.step();
            harness.event(button(PointerButton::Primary, to, false));
        }
        _ => events.extend([true, false, true, false].map(|pressed| button(PointerButton::Primary, at, pressed))),
    }
}

/// Does something that a user could do.
fn act(harness: &mut Harness<'static, App>, random: &mut Random) {
    match random.below(15) {
        at @ 0..=3 => {
            // Half of them change the recipe.
            let is_chosen = |command: &Command| match at {
                0 | 1 => !LEFT_OUT.contains(command),
                _ => CHANGES.contains(command),
            };
            let keys: Vec<_> = command::ALL
                .iter()
                .filter(|entry| is_chosen(&entry.command))
                .flat_map(|entry| entry.shortcuts())
                .collect();
            if let Some(keys) = any(random, &keys) {
                harness.key_press_modifiers(keys.modifiers, keys.logical_key);
            }
        }
        4 => harness.key_press_modifiers(Modifiers::COMMAND, Key::Z),
        5 => {
            let key =
                any(random, &[Key::Escape, Key::Enter, Key::Delete, Key::Tab, Key::ArrowDown, Key::Home, Key::F2]);
            key.into_iter().for_each(|key| harness.key_press(key));
        }
        6 => {
            let word = any(random, &["a", "0.5", "-1e9", "fbm", "名", "\n", "[nodes.", "= height * 2"]);
            harness.event(Event::Text(word.unwrap_or_default().to_owned()));
        }
        7 => {
            let size = harness.ctx.content_rect().size();
            let at = vec2(random.below(size.x as usize) as f32, random.below(size.y as usize) as f32).to_pos2();
            harness.event(Event::PointerMoved(at));
            harness.event(Event::MouseWheel {
                unit: eframe::egui::MouseWheelUnit::Point,
                delta: vec2(0.0, random.below(200) as f32 - 100.0),
                phase: eframe::egui::TouchPhase::Move,
                modifiers: Modifiers::NONE,
                source: eframe::egui::MouseWheelSource::Unknown,
            });
        }
        8 => use_wire(harness, random),
        _ => {
            let role = any(
                random,
                &[
                    Role::Button,
                    Role::Button,
                    Role::CheckBox,
                    Role::ComboBox,
                    Role::Slider,
                    Role::SpinButton,
                    Role::TextInput,
                    Role::MultilineTextInput,
                    Role::Unknown,
                ],
            );
            let Some(role) = role else { return };
            let all: Vec<_> = harness
                .query_all_by_role(role)
                .filter(|node| !writes(&node.accesskit_node().label().unwrap_or_default()))
                .collect();
            if !all.is_empty() {
                all[random.below(all.len())].click();
            }
        }
    }
    harness.step();
    // No file is chosen: what is done at random must not reach any outside the test's folder.
    while harness.query_by_role_and_label(Role::TextInput, "file name").is_some()
        || harness.state().export_dialog().is_some()
    {
        harness.key_press(Key::Escape);
        harness.step();
    }
    assert_eq!(harness.state().studio().and_then(|studio| studio.document.path()), None);
}

fn play(seed: u64, lasts: Duration) {
    let folder = TestFolder::new("studio-random").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    let mut random = Random::new(seed, 0);
    let begun = Instant::now();
    let mut steps = 0;
    while begun.elapsed() < lasts && !harness.state().is_closing() {
        act(&mut harness, &mut random);
        steps += 1;
    }
    assert!(!harness.state().is_closing(), "step {steps}");
}

/// The short form, which measures no time: some hundred steps.
#[test]
fn random_commands_do_no_harm() {
    let folder = TestFolder::new("studio-random").unwrap();
    let mut changes = 0;
    for seed in [1, 2, 3] {
        let mut harness = window(&folder, Some("classic"), Language::English);
        let mut random = Random::new(seed, 0);
        for _ in 0..400 {
            act(&mut harness, &mut random);
        }
        assert!(!harness.state().is_closing());
        changes += harness.state().studio().map_or(0, |studio| studio.document.revision());
    }
    assert!(changes > 30, "{changes}");
}

#[test]
#[ignore = "long: thirty minutes of random commands"]
fn thirty_minutes_of_random_commands_do_no_harm() {
    for seed in 1..=60 {
        play(seed, Duration::from_secs(30));
    }
}
