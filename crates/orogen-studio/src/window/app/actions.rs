//! What each action of the panels and dialogs does.

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::Context;
use eframe::egui::PanelState;

use super::{App, Pending};
use crate::platform;
use crate::settings::layout::Below;
use crate::window::action::Action;
use crate::window::ramp_editor::RampEditor;
use crate::window::theme;

impl App {
    /// Carries out an action.
    pub(super) fn act(&mut self, action: Action, context: &Context) {
        match action {
            Action::Command(command) => self.command(command, context),
            Action::OpenPreset(name) => self.leave(Pending::Preset(name), context),
            Action::Open(path) => self.leave(Pending::Open(path), context),
            Action::OpenUnsaved(unsaved) => self.leave(Pending::Unsaved(unsaved), context),
            Action::DropUnsaved(unsaved) => {
                self.recovery.discard(&unsaved);
                self.no_longer_offer(&unsaved);
            }
            Action::Save(path) => {
                if self.save(&path)
                    && let Some(pending) = self.after_save.take()
                {
                    self.go(pending, context);
                }
            }
            Action::Upload(purpose) => {
                let wake = Arc::clone(&self.wake);
                let chosen = platform::choose(purpose.extensions(), move || wake());
                self.dialogs.upload = chosen.map(|chosen| (purpose, chosen));
            }
            Action::Language(language) => {
                self.language = language;
                self.settings.language = Some(language);
                self.use_language(context);
                self.remember();
            }
            Action::Theme(theme) => {
                self.settings.theme = theme;
                theme::set(context, theme);
                self.remember();
            }
            Action::SystemDialogs(are_used) => {
                self.settings.has_system_dialogs = are_used;
                self.remember();
            }
            // It is remembered with what is remembered next, and when the window closes.
            Action::Layout(layout) => self.settings.layout = layout,
            Action::KeepLayout(name) => {
                self.settings.keep_layout(&name);
                self.remember();
            }
            Action::DropLayout(name) => {
                self.settings.layouts.retain(|kept| kept.name != name);
                self.remember();
            }
            Action::UseLayout(layout) => {
                self.settings.layout = layout;
                // Panels that were shown before have the sizes of before.
                context.data_mut(|data| data.remove_by_type::<PanelState>());
                self.remember();
            }
            Action::KeepView(view) => {
                self.settings.views.push(view);
                self.show_kept_views();
            }
            Action::DropView(nth) => {
                let mut nth_of = 0..;
                self.settings.views.retain(|_| nth_of.next() != Some(nth));
                self.show_kept_views();
            }
            Action::Draw(op) => {
                self.show_map();
                self.panels.tools.draw_op(op);
            }
            Action::Brush(effect) => {
                self.show_map();
                self.panels.tools.take_brush(effect);
            }
            Action::Enter(group) => {
                self.show_below(Below::Graph);
                self.panels.graph.enter(&group);
            }
            Action::Copy(text) => context.copy_text(text),
            Action::EditColors => self.edit_colors(),
            Action::OpenPalette(path) => self.use_palette(RampEditor::open(&path)),
            Action::SavePalette(path) => {
                let saved = self.dialogs.ramp.as_ref().map_or(Ok(()), |ramp| ramp.save(&path));
                self.say_failure(saved);
            }
            Action::Choose(purpose) => {
                let name = self.dialogs.ramp.as_ref().map(|ramp| PathBuf::from(ramp.file_name()));
                self.choose_file(purpose, name.as_deref());
            }
            Action::GoToLine(line) => {
                self.show_below(Below::Text);
                self.panels.text.go_to(line);
            }
            other => {
                let Some(studio) = &mut self.studio else { return };
                match other {
                    Action::Edit(edit) => {
                        let edited = studio.edit(&edit);
                        self.say_failure(edited);
                    }
                    Action::Type(text) => studio.type_text(text),
                    Action::EndGesture => studio.document.end_gesture(),
                    Action::Select(names) => studio.selected = names,
                    Action::Show(layer) => studio.look.layer = layer,
                    Action::Color(coloring) => studio.look.coloring = coloring,
                    Action::GoTo(step) => drop(studio.go_to(step)),
                    Action::Sun(sun) => studio.look.sun = sun,
                    Action::Contours(interval) => studio.look.contours = interval,
                    Action::Rivers(are_shown) => studio.look.rivers = are_shown,
                    Action::Refine(windows) => studio.refine(windows),
                    Action::Finest(finest) => studio.look.finest = finest,
                    Action::Region(region) => studio.look.region = region,
                    _ => {}
                }
            }
        }
    }
}
