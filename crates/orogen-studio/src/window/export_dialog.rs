//! The export dialog.

use std::path::PathBuf;

use eframe::egui::{self, Context, Label, ProgressBar, RichText, ScrollArea, TextEdit, Ui, vec2};
use orogen::grid::words::number;

use super::action::Action;
use super::dialogs::{Overwrite, window};
use super::export_fields::{engine, layer, map, render, rows, tilemap};
use super::export_list::ExportList;
use super::relief_panel::ShownView;
use crate::catalogue::Language;
use crate::export::kind::Kind;
use crate::export::request::Export;
use crate::export::running::Running;
use crate::preview::region::Region;
use crate::preview::worker::Wake;
use crate::studio::Studio;

/// State of the dialog.
pub struct ExportDialog {
    export: Export,
    /// The file as it is typed.
    path: String,
    running: Option<Running>,
    /// The file of the last export.
    made: String,
    /// The result of the last export.
    outcome: Option<Result<String, String>>,
    /// The question whether existing files may be replaced.
    asks: Option<Overwrite>,
    /// The exports that the recipe keeps.
    list: ExportList,
}

/// Maximum height of the fields, and the height of the other parts.
const HEIGHT: f32 = 410.0;
const OTHER: f32 = 400.0;

impl ExportDialog {
    /// A dialog for the document of the studio. A render starts with the settings of the 3D view.
    #[must_use]
    pub fn new(studio: &Studio, view: &ShownView) -> Option<ExportDialog> {
        let document = &studio.document;
        let folder = document.path().and_then(std::path::Path::parent).map(PathBuf::from).unwrap_or_default();
        let mut export = Export::new(studio.look.region, document.title(), document.is_place(), &folder)?;
        render::follow(&mut export.render, view);
        let path = shown(&export);
        Some(ExportDialog {
            path,
            export,
            running: None,
            made: String::new(),
            outcome: None,
            asks: None,
            list: ExportList::default(),
        })
    }

    /// The export with its settings.
    #[must_use]
    pub fn export(&self) -> &Export {
        &self.export
    }

    /// Shows the dialog; false once it is closed.
    pub fn show(
        &mut self,
        context: &Context,
        (studio, view): (&Studio, &ShownView),
        wake: &Wake,
        language: Language,
        actions: &mut Vec<Action>,
    ) -> bool {
        if let Some(result) = self.running.as_ref().and_then(Running::result) {
            self.running = None;
            self.outcome = Some(result.map_err(|error| error.to_string()));
        }
        if self.running.is_none() {
            self.export.region = studio.look.region;
        }
        self.list.go_on(context, studio, &self.export, wake, language);
        if self.list.is_asking() {
            return true;
        }
        if let Some(answer) = self.asks.as_ref().and_then(|asks| asks.show(context, language)) {
            self.asks = None;
            if answer {
                self.start(studio, wake);
            }
            return true;
        }
        let mut is_open = true;
        window(context, language.text("export.title"), &mut is_open, vec2(520.0, 420.0), |ui| {
            let is_free = self.running.is_none() && !self.list.is_busy();
            ui.add_enabled_ui(is_free, |ui| {
                self.kinds(ui, language);
                ui.separator();
                let other = OTHER + ExportList::height(studio);
                let height = (context.content_rect().height() - other).clamp(60.0, HEIGHT);
                let area = ScrollArea::vertical().max_height(height).auto_shrink([false, true]);
                area.show(ui, |ui| self.fields(ui, studio, view, language));
                ui.add_space(4.0);
                rows::grid(ui, "file", |ui| self.file(ui, language));
            });
            ui.separator();
            self.ending(ui, studio, wake, language, actions);
            ui.separator();
            if let Some(chosen) = self.list.show(ui, (studio, &self.export), language, actions) {
                self.path = shown(&chosen);
                (self.export, self.outcome) = (chosen, None);
            }
        });
        let is_free = self.running.is_none() && self.asks.is_none() && !self.list.is_busy();
        is_open && !(is_free && context.input(|input| input.key_pressed(egui::Key::Escape)))
    }

    fn kinds(&mut self, ui: &mut Ui, language: Language) {
        ui.horizontal_wrapped(|ui| {
            for (kind, key) in Kind::ALL {
                if ui.selectable_label(self.export.kind == kind, language.text(key)).clicked() {
                    self.export.set_kind(kind);
                    self.path = shown(&self.export);
                    self.outcome = None;
                }
            }
        });
    }

    fn fields(&mut self, ui: &mut Ui, studio: &Studio, view: &ShownView, language: Language) {
        let before = self.export.path().to_path_buf();
        let export = &mut self.export;
        match export.kind {
            Kind::Layer => layer::show(ui, export, studio, language),
            Kind::Engine => engine::show(ui, export, studio, language),
            Kind::Map => map::show(ui, export, studio, language),
            Kind::Render => render::show(ui, export, view, language),
            Kind::Tilemap => tilemap::show(ui, export, language),
        }
        if self.export.path() != before {
            self.path = shown(&self.export);
        }
    }

    fn file(&mut self, ui: &mut Ui, language: Language) {
        ui.label(language.text("export.land"));
        ui.label(match self.export.region {
            Region::Whole => language.text("export.land_whole").to_owned(),
            Region::Square { side, .. } => language.fill("export.land_part", &[("side", &number(side.round()))]),
        });
        ui.end_row();
        let name = if self.export.kind.is_folder() { "export.folder" } else { "export.file" };
        ui.label(language.text(name));
        let field = ui.add(TextEdit::singleline(&mut self.path).desired_width(380.0));
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::TextInput, true, language.text("spoken.export_file"))
        });
        if field.changed() {
            self.export.set_path(&self.path);
        }
        ui.end_row();
    }

    /// The command line, the buttons, and the result of the export.
    fn ending(&mut self, ui: &mut Ui, studio: &Studio, wake: &Wake, language: Language, actions: &mut Vec<Action>) {
        let document = &studio.document;
        let argument = document.argument();
        let recipe = argument.clone().unwrap_or_else(|| format!("{}.toml", document.title()));
        let command = self.export.command_line(&recipe, &document.recipe().world).to_string();
        ui.add(Label::new(RichText::new(&command).monospace().small()).wrap());
        if argument.is_none() {
            ui.colored_label(ui.visuals().warn_fg_color, language.text("export.unsaved"));
        }
        ui.horizontal(|ui| {
            if ui.add_enabled(argument.is_some(), egui::Button::new(language.text("export.copy"))).clicked() {
                actions.push(Action::Copy(command));
            }
            match &self.running {
                Some(running) => {
                    if ui.button(language.text("export.cancel")).clicked() {
                        running.cancel();
                    }
                    ui.add(ProgressBar::new(running.share()).desired_width(200.0).show_percentage());
                }
                None => {
                    let can = self.asks.is_none() && !self.list.is_busy();
                    let start = egui::Button::new(RichText::new(language.text("export.start")).strong());
                    if ui.add_enabled(can, start).clicked() {
                        self.asks = Overwrite::of(self.export.path());
                        if self.asks.is_none() {
                            self.start(studio, wake);
                        }
                    }
                }
            }
        });
        match &self.outcome {
            Some(Ok(words)) => {
                let text = language.fill("export.done", &[("file", &self.made), ("what", words)]);
                ScrollArea::vertical().id_salt("outcome").max_height(150.0).show(ui, |ui| ui.label(text));
            }
            Some(Err(error)) => drop(ui.colored_label(ui.visuals().error_fg_color, language.message(error))),
            None => {}
        }
    }

    fn start(&mut self, studio: &Studio, wake: &Wake) {
        let own = studio.document.path().map(PathBuf::from);
        let recipe = studio.document.recipe().clone();
        self.outcome = None;
        self.made.clone_from(&self.path);
        match Running::start(self.export.clone(), recipe, own, &studio.session(), wake.clone()) {
            Ok(running) => self.running = Some(running),
            Err(error) => self.outcome = Some(Err(error.to_string())),
        }
    }

    /// The exports that the recipe keeps.
    #[must_use]
    pub fn list(&self) -> &ExportList {
        &self.list
    }

    /// The result of the last export; `None` while it runs.
    #[must_use]
    pub fn outcome(&self) -> Option<&Result<String, String>> {
        self.outcome.as_ref()
    }
}

fn shown(export: &Export) -> String {
    export.path().to_string_lossy().into_owned()
}
