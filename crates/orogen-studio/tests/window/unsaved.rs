//! Unsaved changes, existing files, and what is offered after a crash.

use std::path::Path;

use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use orogen::io::test_folder::TestFolder;
use orogen_studio::catalogue::Language;
use orogen_studio::recovery::Recovery;
use orogen_studio::window::app::App;

use super::{press, studio, until_done, window};

/// Replaces the content of a text field.
fn fill(harness: &mut Harness<'_, App>, label: &str, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, label).focus();
    harness.run_steps(2);
    press(harness, Modifiers::COMMAND, Key::A);
    harness.get_by_role_and_label(Role::TextInput, label).type_text(text);
    harness.run_steps(2);
}

fn click(harness: &mut Harness<'_, App>, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

#[test]
fn what_was_not_saved_is_offered_until_the_user_decides() {
    let folder = TestFolder::new("studio-offer").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    assert!(harness.query_by_label("Unsaved changes").is_none());
    press(&mut harness, Modifiers::COMMAND, Key::R);
    until_done(&mut harness);
    harness.run_steps(2);
    let text = studio(&harness).document.text().to_owned();
    // While this window lives, another one does not offer its text.
    let other = window(&folder, None, Language::English);
    assert!(other.query_by_label("Unsaved changes").is_none());
    drop((harness, other));
    // Closing the offer, or opening something else beside it, removes nothing.
    let mut harness = window(&folder, None, Language::English);
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("Unsaved changes").is_none());
    click(&mut harness, "preset hills");
    drop(harness);
    let mut harness = window(&folder, Some("hills"), Language::English);
    harness.render().unwrap();
    click(&mut harness, "Later");
    drop(harness);
    let mut harness = window(&folder, None, Language::English);
    click(&mut harness, "open classic");
    assert_eq!(studio(&harness).document.text(), text);
    assert!(studio(&harness).document.is_changed());
    drop(harness);
    // It was opened, but not saved.
    let mut harness = window(&folder, None, Language::English);
    click(&mut harness, "delete classic");
    assert!(harness.query_by_label("Unsaved changes").is_none());
    drop(harness);
    assert!(Recovery::new(Some(&folder)).left().is_empty());
}

#[test]
fn a_text_without_a_file_is_saved_when_the_window_is_closed() {
    let folder = TestFolder::new("studio-quit").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    press(&mut harness, Modifiers::COMMAND, Key::R);
    // Without a name it stays open.
    press(&mut harness, Modifiers::COMMAND, Key::Q);
    click(&mut harness, "Save");
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(!harness.state().is_closing() && studio(&harness).document.is_changed());
    // Saved later, for another reason, it stays open, too.
    let path = folder.join("mine.toml");
    press(&mut harness, Modifiers::COMMAND, Key::S);
    fill(&mut harness, "file name", &path.to_string_lossy());
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(path.is_file() && !harness.state().is_closing());
    drop(harness);
    let mut harness = window(&folder, Some("classic"), Language::English);
    press(&mut harness, Modifiers::COMMAND, Key::R);
    press(&mut harness, Modifiers::COMMAND, Key::Q);
    click(&mut harness, "Save");
    let path = folder.join("other.toml");
    fill(&mut harness, "file name", &path.to_string_lossy());
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(path.is_file() && harness.state().is_closing());
}

#[test]
fn an_existing_file_is_replaced_only_after_a_question() {
    let folder = TestFolder::new("studio-replace").unwrap();
    let mut harness = window(&folder, Some("classic"), Language::English);
    let path = folder.join("precious.toml");
    std::fs::write(&path, "precious = true\n").unwrap();
    let save_as = |harness: &mut Harness<'_, App>, path: &Path| {
        press(harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
        fill(harness, "file name", &path.to_string_lossy());
        press(harness, Modifiers::NONE, Key::Enter);
    };
    save_as(&mut harness, &path);
    assert!(harness.query_by_label("Replace?").is_some());
    assert!(harness.query_by_label("16 bytes, changed just now").is_some());
    press(&mut harness, Modifiers::NONE, Key::Escape);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "precious = true\n");
    // The dialog is still there, with the name.
    press(&mut harness, Modifiers::NONE, Key::Escape);
    save_as(&mut harness, &path);
    click(&mut harness, "Replace");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), studio(&harness).document.text());
    // Its own file is saved without a question.
    press(&mut harness, Modifiers::COMMAND, Key::R);
    save_as(&mut harness, &path);
    assert!(harness.query_by_label("Replace?").is_none() && !studio(&harness).document.is_changed());
    // In a new folder.
    press(&mut harness, Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
    click(&mut harness, "New folder");
    harness.get_by_role_and_label(Role::TextInput, "folder name").type_text("lands");
    harness.run_steps(2);
    press(&mut harness, Modifiers::NONE, Key::Enter);
    fill(&mut harness, "file name", "a");
    press(&mut harness, Modifiers::NONE, Key::Enter);
    assert!(folder.join("lands/a.toml").is_file());
}
