//! The dialog of exports: any format of the registry, with its options.

use std::path::PathBuf;

use eframe::egui::{self, ComboBox, Context, ProgressBar, RichText, ScrollArea, TextEdit, Ui, vec2};
use orogen::export::options::{OptionSpec, ValueKind};
use orogen::export::registry;

use super::action::Action;
use super::dialogs::window;
use crate::catalogue::Language;
use crate::export::{Export, Running};
use crate::preview::worker::Wake;
use crate::studio::Studio;

/// State of the dialog.
pub struct ExportDialog {
    export: Export,
    path: String,
    running: Option<Running>,
    /// What the last export has led to.
    outcome: Option<Result<String, String>>,
}

/// Sizes that are offered; 0 is the world's own.
const SIZES: [usize; 8] = [0, 256, 512, 1024, 1025, 2048, 4096, 8192];

impl ExportDialog {
    /// A dialog for the document of the studio.
    #[must_use]
    pub fn new(studio: &Studio) -> Option<ExportDialog> {
        let format = registry::named("tif").or(registry::all().first().copied())?;
        let mut export = Export::new(format, studio.look.region);
        let folder = studio.document.path().and_then(std::path::Path::parent).map(PathBuf::from);
        export.path = folder.unwrap_or_default().join(format!("{}.{}", studio.document.title(), format.name));
        Some(ExportDialog { path: export.path.to_string_lossy().into_owned(), export, running: None, outcome: None })
    }

    /// Shows the dialog; false once it is closed.
    pub fn show(
        &mut self,
        context: &Context,
        studio: &Studio,
        wake: &Wake,
        language: Language,
        actions: &mut Vec<Action>,
    ) -> bool {
        if let Some(result) = self.running.as_ref().and_then(Running::result) {
            self.running = None;
            self.outcome = Some(result.map_err(|error| error.to_string()));
        }
        let mut is_open = true;
        window(context, language.text("export.title"), &mut is_open, vec2(460.0, 420.0), |ui| {
            ui.add_enabled_ui(self.running.is_none(), |ui| self.fields(ui, studio, language));
            ui.separator();
            let command = self.export.command_line(&source(studio));
            ui.add(egui::Label::new(RichText::new(&command).monospace().small()).wrap());
            ui.horizontal(|ui| {
                if ui.button(language.text("export.copy")).clicked() {
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
                        if ui.button(RichText::new(language.text("export.start")).strong()).clicked() {
                            self.start(studio, wake);
                        }
                    }
                }
            });
            match &self.outcome {
                Some(Ok(words)) => {
                    drop(ui.label(language.fill("export.done", &[("file", &self.path), ("what", words)])))
                }
                Some(Err(error)) => drop(ui.colored_label(ui.visuals().error_fg_color, error)),
                None => {}
            }
        });
        is_open && !(self.running.is_none() && context.input(|input| input.key_pressed(egui::Key::Escape)))
    }

    fn start(&mut self, studio: &Studio, wake: &Wake) {
        let own = studio.document.path().map(PathBuf::from);
        let recipe = studio.document.recipe().clone();
        self.outcome = None;
        match Running::start(self.export.clone(), recipe, own, studio.session(), wake.clone()) {
            Ok(running) => self.running = Some(running),
            Err(error) => self.outcome = Some(Err(error.to_string())),
        }
    }

    fn fields(&mut self, ui: &mut Ui, studio: &Studio, language: Language) {
        egui::Grid::new("export").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| {
            ui.label(language.text("export.format"));
            ComboBox::from_id_salt("format")
                .width(300.0)
                .selected_text(shown(self.export.format))
                .height(360.0)
                .show_ui(ui, |ui| {
                    for format in registry::all() {
                        if ui.selectable_label(format.name == self.export.format.name, shown(format)).clicked() {
                            self.export.set_format(format);
                            self.path = self.export.path.to_string_lossy().into_owned();
                        }
                    }
                });
            ui.end_row();
            ui.label(language.text("menu.layer"));
            ComboBox::from_id_salt("layer of export")
                .width(300.0)
                .selected_text(&self.export.layer)
                .height(360.0)
                .show_ui(ui, |ui| {
                    for layer in studio.layers() {
                        if ui.selectable_label(layer == self.export.layer, &layer).clicked() {
                            self.export.layer = layer;
                        }
                    }
                });
            ui.end_row();
            ui.label(language.text("export.size"));
            let size = |samples: usize| match samples {
                0 => language.text("export.own_size").to_owned(),
                samples => samples.to_string(),
            };
            ComboBox::from_id_salt("size").selected_text(size(self.export.size.unwrap_or(0))).show_ui(ui, |ui| {
                for samples in SIZES {
                    if ui.selectable_label(self.export.size.unwrap_or(0) == samples, size(samples)).clicked() {
                        self.export.size = (samples > 0).then_some(samples);
                    }
                }
            });
            ui.end_row();
            ui.label(language.text("export.file"));
            let field = ui.add(TextEdit::singleline(&mut self.path).desired_width(300.0));
            field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "file of export"));
            if field.changed() {
                self.export.path = PathBuf::from(&self.path);
            }
            ui.end_row();
        });
        if self.export.format.options.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.strong(language.text("export.options"));
        ScrollArea::vertical().max_height(180.0).show(ui, |ui| {
            egui::Grid::new("options").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
                for spec in self.export.format.options {
                    ui.label(spec.name).on_hover_text(spec.about);
                    option(ui, spec, &mut self.export.options);
                    ui.end_row();
                }
            });
        });
    }
}

fn shown(format: &orogen::export::format::Format) -> String {
    format!(".{}  {}", format.name, format.about)
}

/// What a command line calls the document.
fn source(studio: &Studio) -> String {
    let document = &studio.document;
    document.path().map_or_else(|| document.title().to_owned(), |path| path.to_string_lossy().into_owned())
}

/// A field for an option; an empty one is not given.
fn option(ui: &mut Ui, spec: &'static OptionSpec, options: &mut std::collections::BTreeMap<&'static str, String>) {
    match spec.value_kind {
        ValueKind::Nothing => {
            let mut given = options.contains_key(spec.name);
            if ui.checkbox(&mut given, "").changed() {
                match given {
                    true => drop(options.insert(spec.name, String::new())),
                    false => drop(options.remove(spec.name)),
                }
            }
        }
        ValueKind::Word(words) => {
            let own = options.get(spec.name).cloned().unwrap_or_default();
            ComboBox::from_id_salt(spec.name).selected_text(&own).show_ui(ui, |ui| {
                if ui.selectable_label(own.is_empty(), "–").clicked() {
                    options.remove(spec.name);
                }
                for word in words {
                    if ui.selectable_label(own == *word, *word).clicked() {
                        options.insert(spec.name, (*word).to_owned());
                    }
                }
            });
        }
        _ => {
            let mut text = options.get(spec.name).cloned().unwrap_or_default();
            if ui.add(TextEdit::singleline(&mut text).desired_width(140.0).hint_text(spec.value)).changed() {
                match text.is_empty() {
                    true => drop(options.remove(spec.name)),
                    false => drop(options.insert(spec.name, text)),
                }
            }
        }
    }
}
