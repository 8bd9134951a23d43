//! Dialogs: choosing a file, the command palette, the list of shortcuts, unsaved changes, messages.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use eframe::egui::{self, Align2, Context, Key, RichText, ScrollArea, TextEdit, Vec2, vec2};

use super::action::Action;
use super::command::{self, Command};
use super::menu::is_enabled;
use super::purpose::Purpose;
use crate::catalogue::Language;
use crate::files;
use crate::platform;
use crate::studio::Studio;

/// A dialog for choosing a file.
#[derive(Debug)]
pub struct FileDialog {
    purpose: Purpose,
    folder: PathBuf,
    name: String,
    entries: Vec<files::Entry>,
    failure: Option<String>,
    is_new: bool,
    /// The file that the dialog started at. Saving to it replaces nothing else.
    own: Option<PathBuf>,
    /// An existing file that may be replaced.
    asks: Option<Overwrite>,
    /// The name of a new folder, while it is typed.
    new_folder: Option<String>,
}

impl FileDialog {
    /// A dialog that starts at a path.
    #[must_use]
    pub fn new(purpose: Purpose, at: Option<&Path>) -> FileDialog {
        let folder = at.and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
        let name = at.and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let mut dialog = FileDialog {
            purpose,
            folder: folder.map_or_else(files::working_folder, Path::to_path_buf),
            name: if purpose.saves() { name.unwrap_or_else(|| "untitled.toml".into()) } else { String::new() },
            entries: Vec::new(),
            failure: None,
            is_new: true,
            own: at.map(Path::to_path_buf),
            asks: None,
            new_folder: None,
        };
        dialog.look();
        dialog
    }

    /// The dialog with the question whether an existing file may be replaced.
    #[must_use]
    pub fn asking(purpose: Purpose, path: &Path) -> FileDialog {
        FileDialog { asks: Overwrite::of(path), ..FileDialog::new(purpose, Some(path)) }
    }

    fn look(&mut self) {
        match files::list(&self.folder) {
            Ok(entries) => {
                let is_shown = |entry: &files::Entry| {
                    let extension = entry.path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
                    entry.is_folder
                        || extension.is_some_and(|extension| self.purpose.extensions().contains(&extension.as_str()))
                };
                self.entries = entries.into_iter().filter(is_shown).collect();
                self.failure = None;
            }
            Err(error) => {
                self.entries.clear();
                self.failure = Some(error.to_string());
            }
        }
    }

    fn enter(&mut self, folder: PathBuf) {
        self.folder = folder;
        self.look();
    }

    /// Shows the dialog; false once it is closed.
    pub fn show(&mut self, context: &Context, language: Language, actions: &mut Vec<Action>) -> bool {
        if let Some(asks) = &self.asks {
            match asks.show(context, language) {
                Some(true) => {
                    actions.push(Action::of_file(self.purpose, asks.path.clone()));
                    return false;
                }
                Some(false) => self.asks = None,
                None => {}
            }
            return true;
        }
        let mut is_open = true;
        let mut chosen = None;
        window(context, language.text(self.purpose.title()), &mut is_open, vec2(520.0, 400.0), |ui| {
            ui.horizontal(|ui| {
                if self.purpose.saves() {
                    self.make_folder(ui, language);
                }
                let parent = self.folder.parent().map(Path::to_path_buf);
                if ui.add_enabled(parent.is_some(), egui::Button::new("..")).clicked()
                    && let Some(parent) = parent
                {
                    self.enter(parent);
                }
                ui.label(self.folder.display().to_string());
                if platform::IS_PAGE && !self.purpose.saves() && ui.button(language.text("file.upload")).clicked() {
                    actions.push(Action::Upload(self.purpose));
                }
            });
            if platform::IS_PAGE {
                ui.weak(language.text("file.kept"));
            }
            if let Some(failure) = &self.failure {
                ui.colored_label(ui.visuals().error_fg_color, language.message(failure));
            }
            let mut entered = None;
            ScrollArea::vertical().max_height(270.0).auto_shrink(false).show(ui, |ui| {
                for entry in &self.entries {
                    let name = entry.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                    let row = ui.selectable_label(
                        name == self.name,
                        if entry.is_folder { format!("{name}/") } else { name.clone() },
                    );
                    match (entry.is_folder, row.clicked(), row.double_clicked()) {
                        (true, true, _) => entered = Some(entry.path.clone()),
                        (false, _, true) => chosen = Some(entry.path.clone()),
                        (false, true, _) => self.name = name,
                        _ => {}
                    }
                }
            });
            if let Some(folder) = entered {
                self.enter(folder);
            }
            ui.horizontal(|ui| {
                let field = ui.add(
                    TextEdit::singleline(&mut self.name).desired_width(360.0).hint_text(language.text("file.name")),
                );
                field.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::TextInput, true, language.text("spoken.file_name"))
                });
                if std::mem::take(&mut self.is_new) {
                    field.request_focus();
                }
                let confirmed = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                let button =
                    ui.add_enabled(!self.name.trim().is_empty(), egui::Button::new(language.text("file.choose")));
                if (confirmed || button.clicked()) && !self.name.trim().is_empty() {
                    // A full path may be given instead of a name.
                    chosen = Some(self.folder.join(self.name.trim()));
                }
            });
        });
        if let Some(path) = chosen {
            if path.is_dir() && path.extension().is_none() {
                self.enter(path);
                return true;
            }
            let path = self.purpose.completed(path);
            if self.purpose.saves() && self.own.as_ref() != Some(&path) {
                self.asks = Overwrite::of(&path);
            }
            if self.asks.is_none() {
                actions.push(Action::of_file(self.purpose, path));
                return false;
            }
        }
        is_open && !context.input(|input| input.key_pressed(Key::Escape))
    }

    /// The button for a new folder, and the field for its name.
    fn make_folder(&mut self, ui: &mut egui::Ui, language: Language) {
        let button = ui.button(language.text("file.new_folder"));
        if button.clicked() {
            self.new_folder = Some(String::new());
        }
        let Some(name) = &mut self.new_folder else { return };
        let hint = language.text("file.folder_name");
        let field = ui.add(TextEdit::singleline(name).desired_width(120.0).hint_text(hint));
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::TextInput, true, language.text("spoken.folder_name"))
        });
        if button.clicked() {
            field.request_focus();
        }
        if !field.lost_focus() {
            return;
        }
        let is_confirmed = ui.input(|input| input.key_pressed(Key::Enter)) && !name.trim().is_empty();
        let folder = self.folder.join(name.trim());
        self.new_folder = None;
        if is_confirmed {
            match files::make_folder(&folder) {
                Ok(()) => self.enter(folder),
                Err(error) => self.failure = Some(error.to_string()),
            }
        }
    }
}

/// The question whether an existing file or folder may be replaced.
#[derive(Debug)]
pub struct Overwrite {
    /// The file or folder.
    pub path: PathBuf,
    about: files::About,
}

impl Overwrite {
    /// The question for a path; `None` if there is nothing to replace.
    #[must_use]
    pub fn of(path: &Path) -> Option<Overwrite> {
        files::about(path).map(|about| Overwrite { path: path.to_path_buf(), about })
    }

    /// Asks; the answer once there is one.
    #[must_use]
    pub fn show(&self, context: &Context, language: Language) -> Option<bool> {
        let mut answer = None;
        let mut is_open = true;
        window(context, language.text("overwrite.title"), &mut is_open, vec2(400.0, 90.0), |ui| {
            let name = self.path.file_name().unwrap_or(self.path.as_os_str()).to_string_lossy();
            ui.strong(name);
            let size = match self.about.is_folder {
                true => language.fill("overwrite.entries", &[("count", &self.about.size.to_string())]),
                false => orogen::grid::words::bytes(self.about.size),
            };
            ui.label(
                language.fill("overwrite.about", &[("size", &size), ("when", &ago(self.about.changed, language))]),
            );
            ui.label(language.text(if self.about.is_folder { "overwrite.folder" } else { "overwrite.file" }));
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                if ui.button(language.text("overwrite.replace")).clicked() {
                    answer = Some(true);
                }
                if ui.button(language.text("overwrite.keep")).clicked() {
                    answer = Some(false);
                }
            });
        });
        let is_closed = !is_open || context.input(|input| input.key_pressed(Key::Escape));
        if is_closed { Some(false) } else { answer }
    }
}

/// How long ago something happened, in words.
#[must_use]
pub fn ago(when: Option<SystemTime>, language: Language) -> String {
    // A clock that was set back gives a time in the future.
    let Some(seconds) = when.map(|when| platform::since(when).as_secs()) else { return String::new() };
    let (key, count) = match seconds {
        0..60 => ("ago.now", 0),
        60..3600 => ("ago.minutes", seconds / 60),
        3600..172_800 => ("ago.hours", seconds / 3600),
        _ => ("ago.days", seconds / 86_400),
    };
    language.fill(key, &[("count", &count.to_string())])
}

/// The command palette.
#[derive(Debug, Default)]
pub struct CommandPalette {
    text: String,
    is_old: bool,
}

impl CommandPalette {
    /// Shows the palette; false once it is closed.
    pub fn show(
        &mut self,
        context: &Context,
        studio: Option<&Studio>,
        language: Language,
        actions: &mut Vec<Action>,
    ) -> bool {
        let mut is_open = true;
        let mut chosen: Option<Command> = None;
        window(context, language.text("command.command_palette"), &mut is_open, vec2(380.0, 320.0), |ui| {
            let field = ui.add(
                TextEdit::singleline(&mut self.text)
                    .desired_width(f32::INFINITY)
                    .hint_text(language.text("palette.search")),
            );
            if !std::mem::replace(&mut self.is_old, true) {
                field.request_focus();
            }
            let words = self.text.to_lowercase();
            let is_found = |entry: &&command::Entry| {
                let english = Language::English.text(entry.name).to_lowercase();
                let own = language.text(entry.name).to_lowercase();
                words.split_whitespace().all(|word| own.contains(word) || english.contains(word))
            };
            let found: Vec<&command::Entry> =
                command::all().filter(is_found).filter(|entry| is_enabled(entry.command, studio)).collect();
            if field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
                chosen = found.first().map(|entry| entry.command);
            }
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                for entry in found {
                    let keys = entry.keys.map(|keys| ui.ctx().format_shortcut(&keys)).unwrap_or_default();
                    let mut button = egui::Button::new(language.text(entry.name)).frame(false);
                    if !keys.is_empty() {
                        button = button.shortcut_text(keys);
                    }
                    if ui.add_sized([ui.available_width(), 20.0], button).clicked() {
                        chosen = Some(entry.command);
                    }
                }
            });
        });
        if let Some(command) = chosen {
            actions.push(Action::Command(command));
            return false;
        }
        is_open && !context.input(|input| input.key_pressed(Key::Escape))
    }
}

/// The list of shortcuts; false once it is closed.
#[must_use]
pub fn shortcuts(context: &Context, language: Language) -> bool {
    let mut is_open = true;
    window(context, language.text("command.shortcuts"), &mut is_open, vec2(420.0, 460.0), |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            egui::Grid::new("shortcuts").num_columns(2).striped(true).spacing([24.0, 4.0]).show(ui, |ui| {
                for entry in command::all().filter(|entry| entry.keys.is_some()) {
                    ui.label(language.text(entry.name));
                    ui.monospace(entry.keys.map(|keys| ui.ctx().format_shortcut(&keys)).unwrap_or_default());
                    ui.end_row();
                }
                for (name, keys) in [
                    ("keys.orbit", "keys.orbit_keys"),
                    ("keys.pan", "keys.pan_keys"),
                    ("keys.zoom", "keys.zoom_keys"),
                    ("keys.fly", "keys.fly_keys"),
                    ("keys.brush", "keys.brush_keys"),
                    ("keys.preview", "keys.preview_keys"),
                    ("keys.connect", "keys.connect_keys"),
                    ("keys.select", "keys.select_keys"),
                    ("keys.pan_graph", "keys.pan_graph_keys"),
                    ("keys.delete", "keys.delete_keys"),
                    ("keys.complete", "keys.complete_keys"),
                ] {
                    ui.label(language.text(name));
                    ui.label(language.text(keys));
                    ui.end_row();
                }
            });
        });
    });
    is_open && !context.input(|input| input.key_pressed(Key::Escape))
}

/// The user's decision about unsaved changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Decision {
    /// Save them.
    Save,
    /// Discard them.
    Drop,
    /// Cancel the action.
    Cancel,
}

/// Asks what to do with unsaved changes.
#[must_use]
pub fn unsaved(context: &Context, title: &str, language: Language) -> Option<Decision> {
    let mut answer = None;
    let mut is_open = true;
    window(context, language.text("unsaved.title"), &mut is_open, vec2(360.0, 90.0), |ui| {
        ui.label(language.fill("unsaved.text", &[("name", title)]));
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            for (name, choice) in [
                ("unsaved.save", Decision::Save),
                ("unsaved.drop", Decision::Drop),
                ("unsaved.cancel", Decision::Cancel),
            ] {
                if ui.button(language.text(name)).clicked() {
                    answer = Some(choice);
                }
            }
        });
    });
    if !is_open || context.input(|input| input.key_pressed(Key::Escape)) {
        answer = Some(Decision::Cancel);
    }
    answer
}

/// Shows a message of several lines; false once it is closed.
#[must_use]
pub fn message(context: &Context, title: &str, text: &str) -> bool {
    let mut is_open = true;
    let mut stays = true;
    window(context, title, &mut is_open, vec2(460.0, 160.0), |ui| {
        ScrollArea::vertical().max_height(240.0).show(ui, |ui| ui.label(text));
        ui.add_space(6.0);
        stays = !ui.button(RichText::new("OK")).clicked();
    });
    is_open && stays && !context.input(|input| input.key_pressed(Key::Escape))
}

/// The part of the screen above a window.
const ABOVE: f32 = 0.12;

/// A window in the middle of the screen. Its top stays in place when its content grows, so that what is pressed does
/// not move away from the pointer.
pub fn window(context: &Context, title: &str, is_open: &mut bool, size: Vec2, add: impl FnOnce(&mut egui::Ui)) {
    let above = (context.content_rect().height() * ABOVE).round();
    egui::Window::new(title)
        .open(is_open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_TOP, vec2(0.0, above))
        .default_size(size)
        .show(context, |ui| {
            ui.set_min_width(size.x);
            add(ui);
        });
}
