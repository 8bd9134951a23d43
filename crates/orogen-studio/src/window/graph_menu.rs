//! The menu of a box of the graph.

use eframe::egui::Ui;
use orogen::declare::Input;

use super::action::Action;
use super::command::Command;
use super::graph_panel::Graph;
use super::menu;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::kept::{Frame, Kept};
use crate::editing::{adding, bypass};
use crate::studio::{Studio, surface};
use crate::view::scene::GraphBox;

/// A button with a text of the catalog. Returns whether it was clicked.
fn entry(ui: &mut Ui, text: &str, action: Option<Action>, actions: &mut Vec<Action>) -> bool {
    let is_clicked = ui.button(text).clicked();
    if is_clicked {
        actions.extend(action);
        ui.close();
    }
    is_clicked
}

impl Graph {
    /// Shows the menu of a box.
    pub(super) fn menu(
        &mut self,
        ui: &mut Ui,
        block: &GraphBox,
        (studio, language): (&Studio, Language),
        actions: &mut Vec<Action>,
    ) {
        match block.group_name() {
            Some(group) => {
                if entry(ui, language.text("graph.enter"), None, actions) {
                    self.enter(group);
                }
            }
            None => node(ui, block, (studio, language), actions),
        }
        if studio.document.is_valid() {
            let kept = studio.document.kept();
            let is_locked = block.nodes.iter().all(|name| kept.locked.contains(name));
            let others = kept.locked.iter().filter(|name| !block.nodes.contains(name)).cloned();
            let own = block.nodes.iter().filter(|_| !is_locked).cloned();
            let lock = Edit::Keep(Kept { locked: others.chain(own).collect(), ..kept.clone() });
            let text = language.text(if is_locked { "graph.unlock" } else { "graph.lock" });
            entry(ui, text, Some(Action::Edit(lock)), actions);
            let nodes = if studio.selected.is_empty() { block.nodes.clone() } else { studio.selected.clone() };
            let mut frames = kept.frames.clone();
            frames.push(Frame { title: language.text("graph.frame_title").to_owned(), nodes });
            let frame = Edit::Keep(Kept { frames, ..kept.clone() });
            entry(ui, language.text("graph.frame"), Some(Action::Edit(frame)), actions);
        }
        ui.separator();
        for command in [Command::Group, Command::Ungroup, Command::Duplicate, Command::Rename, Command::Delete] {
            let Some(declared) = command.entry() else { continue };
            if menu::is_enabled(command, Some(studio)) {
                entry(ui, language.text(declared.name), Some(Action::Command(command)), actions);
            }
        }
    }
}

/// The part of the menu that is about one node.
fn node(ui: &mut Ui, block: &GraphBox, (studio, language): (&Studio, Language), actions: &mut Vec<Action>) {
    let node = block.nodes.first();
    entry(ui, language.text("inspector.show"), node.map(|name| Action::Show(name.clone())), actions);
    if !studio.document.is_valid() {
        return;
    }
    let recipe = studio.document.recipe();
    let name = surface(recipe);
    let source = Input::Node(block.id.clone());
    let is_it = recipe.output_inputs().iter().any(|(output, input)| *output == name && *input == source);
    if !is_it {
        let edit = Edit::Output { name, source };
        entry(ui, language.text("graph.use_as_height"), Some(Action::Edit(edit)), actions);
    }
    let named = node.and_then(|name| recipe.nodes().iter().find(|named| named.name == *name));
    if let Some(edit) = named.and_then(bypass::toggled) {
        let text = if named.is_some_and(bypass::is_bypassed) { "graph.use_again" } else { "graph.bypass" };
        entry(ui, language.text(text), Some(Action::Edit(edit)), actions);
    }
    if let Some(edit) = node.and_then(|name| adding::baked(recipe, name)) {
        entry(ui, language.text("graph.bake"), Some(Action::Edit(edit)), actions);
    }
}
