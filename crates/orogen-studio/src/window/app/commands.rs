//! Carries out the commands of the menus and the keyboard.

use std::path::{Path, PathBuf};

use eframe::egui::Context;

use super::{App, Pending};
use crate::editing::edit::Edit;
use crate::editing::groups;
use crate::files;
use crate::platform;
use crate::settings::layout::{Below, View};
use crate::window::command::Command;
use crate::window::dialogs::CommandPalette;
use crate::window::export_dialog::ExportDialog;
use crate::window::menu;
use crate::window::purpose::Purpose;
use crate::window::tour::Tour;

impl App {
    /// Carries out a command, if it is available.
    pub(super) fn command(&mut self, command: Command, context: &Context) {
        if !menu::is_enabled(command, self.studio.as_ref()) {
            return;
        }
        match command {
            Command::New => self.leave(Pending::StartPage, context),
            Command::Empty => self.leave(Pending::Empty, context),
            Command::Open => {
                let at = self.studio.as_ref().and_then(|studio| studio.document.path()).map(Path::to_path_buf);
                self.choose_file(Purpose::Open, at.as_deref());
            }
            Command::Quit => self.leave(Pending::Quit, context),
            Command::CommandPalette => self.dialogs.palette = Some(CommandPalette::default()),
            Command::Tour => self.dialogs.tour = Some(Tour::default()),
            Command::Shortcuts => self.dialogs.has_shortcuts = true,
            Command::About => {
                let text = self.language.fill("about.text", &[("version", env!("CARGO_PKG_VERSION"))]);
                self.dialogs.message = Some((self.text("command.about").into(), text));
            }
            Command::ShowRelief => self.show_view(View::Relief),
            Command::ShowMap => self.show_view(View::Map),
            Command::ShowBoth => self.show_view(View::Both),
            Command::ShowWindows => self.show_view(View::Windows),
            Command::ShowGraph => self.show_below(Below::Graph),
            Command::ShowText => self.show_below(Below::Text),
            Command::ShowAnalysis => self.show_below(Below::Analysis),
            Command::ShowReal => self.show_below(Below::Real),
            Command::ShowVariants => self.show_below(Below::Variants),
            Command::WholeView => {
                self.panels.show_whole();
            }
            Command::PanelBelow => {
                self.settings.layout.has_below = !self.settings.layout.has_below;
                self.remember();
            }
            Command::Inspector => {
                self.settings.layout.has_inspector = !self.settings.layout.has_inspector;
                self.remember();
            }
            Command::ViewAlone => {
                let layout = &mut self.settings.layout;
                let is_alone = layout.is_view_alone();
                (layout.has_below, layout.has_inspector) = (is_alone, is_alone);
                self.remember();
            }
            Command::Thumbnails => {
                self.settings.thumbnails = !self.settings.thumbnails;
                self.remember();
                if let Some(studio) = &mut self.studio {
                    studio.has_thumbnails = self.settings.thumbnails;
                }
            }
            other => self.document_command(other),
        }
    }

    fn document_command(&mut self, command: Command) {
        let Some(studio) = &mut self.studio else { return };
        let selected = studio.selected.clone();
        match command {
            Command::Save => match studio.document.path().map(Path::to_path_buf) {
                Some(path) => drop(self.save(&path)),
                None => self.save_as(),
            },
            Command::SaveAs => self.save_as(),
            Command::SaveVersion => match studio.document.path().map(files::next_version) {
                Some(path) => drop(self.save(&path)),
                None => self.save_as(),
            },
            Command::Download => {
                platform::download(&format!("{}.toml", studio.document.title()), studio.document.text().as_bytes());
            }
            Command::Export => self.dialogs.export = ExportDialog::new(studio, &self.panels.relief.shown(studio)),
            Command::Undo => drop(studio.undo()),
            Command::Redo => drop(studio.redo()),
            Command::NextSeed => {
                let seed = studio.document.recipe().world.seed;
                let next = Edit::Seed(if seed >= i64::MAX as u64 { 0 } else { seed + 1 });
                let edited = studio.edit(&next);
                // Each seed is a separate step.
                studio.document.end_gesture();
                self.say_failure(edited);
            }
            Command::AddNode => {
                self.show_below(Below::Graph);
                self.panels.graph.open_search();
            }
            Command::Rename => {
                let group = groups::of_selection(studio.document.recipe(), &selected);
                if let Some(name) = group.as_ref().or(selected.first()) {
                    self.settings.layout.has_inspector = true;
                    self.panels.inspector.rename(name);
                }
            }
            Command::Delete | Command::Duplicate | Command::Group | Command::Ungroup => {
                let edit = match command {
                    Command::Delete => Edit::Delete(selected),
                    Command::Duplicate => Edit::Duplicate(selected),
                    Command::Ungroup => Edit::Ungroup(studio.selected_group().unwrap_or_default()),
                    _ => {
                        let outer = groups::common(selected.iter().map(String::as_str));
                        let name = groups::free(studio.document.recipe(), outer, "group");
                        Edit::Group { nodes: selected, name }
                    }
                };
                let edited = studio.edit(&edit);
                self.say_failure(edited);
            }
            _ => {}
        }
    }

    /// Shows a panel below the view.
    pub(super) fn show_below(&mut self, below: Below) {
        (self.settings.layout.below, self.settings.layout.has_below) = (below, true);
    }

    /// Shows the land in 3D, from above, or both.
    pub(super) fn show_view(&mut self, view: View) {
        self.settings.layout.view = view;
        self.remember();
    }

    /// Shows the map, if it is not shown.
    pub(super) fn show_map(&mut self) {
        if !self.settings.layout.view.has_map() {
            self.show_view(View::Map);
        }
    }

    pub(super) fn save_as(&mut self) {
        let Some(studio) = &self.studio else { return };
        let name = PathBuf::from(format!("{}.toml", studio.document.title()));
        let at = studio.document.path().map_or(name, Path::to_path_buf);
        self.choose_file(Purpose::Save, Some(&at));
    }
}
