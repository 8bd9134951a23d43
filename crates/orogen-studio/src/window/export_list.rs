//! The exports that are kept in the recipe, and made together.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Context, ProgressBar, ScrollArea, Ui};

use super::action::Action;
use super::dialogs::Overwrite;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::kept::{Kept, KeptExport};
use crate::export::request::Export;
use crate::export::running::Running;
use crate::preview::worker::Wake;
use crate::studio::Studio;

/// State of the list.
#[derive(Default)]
pub struct ExportList {
    /// What is left to be made.
    left: Vec<KeptExport>,
    /// The export that runs.
    running: Option<(KeptExport, Running)>,
    /// The results of exports.
    made: Vec<(KeptExport, Result<String, String>)>,
    /// The question whether the file of an export may be replaced.
    asks: Option<(KeptExport, Overwrite)>,
}

impl ExportList {
    /// Whether exports are being made.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.running.is_some() || self.asks.is_some() || !self.left.is_empty()
    }

    /// The height of the list below its title.
    #[must_use]
    pub fn height(studio: &Studio) -> f32 {
        (studio.document.kept().exports.len() as f32 * ROW).min(LIST)
    }

    /// Whether it is asked whether a file may be replaced.
    #[must_use]
    pub fn is_asking(&self) -> bool {
        self.asks.is_some()
    }

    /// Goes on with the exports, and asks before files are replaced. `form` has what an export does not say.
    pub fn go_on(&mut self, context: &Context, studio: &Studio, form: &Export, wake: &Wake, language: Language) {
        if let Some(result) = self.running.as_ref().and_then(|(_, running)| running.result())
            && let Some((export, _)) = self.running.take()
        {
            self.made.push((export, result.map_err(|error| error.to_string())));
        }
        if self.running.is_some() {
            return;
        }
        if let Some((export, asks)) = self.asks.take() {
            match asks.show(context, language) {
                None => self.asks = Some((export, asks)),
                Some(true) => self.start(export, studio, form, wake),
                Some(false) => {}
            }
            return;
        }
        if self.left.is_empty() {
            return;
        }
        let next = self.left.remove(0);
        let whole = Export::of_kept(&next, &folder(studio), form);
        match whole.and_then(|export| Overwrite::of(export.path())) {
            Some(asks) => self.asks = Some((next, asks)),
            None => self.start(next, studio, form, wake),
        }
        context.request_repaint();
    }

    fn start(&mut self, next: KeptExport, studio: &Studio, form: &Export, wake: &Wake) {
        let Some(export) = Export::of_kept(&next, &folder(studio), form) else {
            let unknown = format!("this version has no export of the kind `{}` as `{}`", next.kind, next.format);
            self.made.push((next, Err(unknown)));
            return;
        };
        let own = studio.document.path().map(Path::to_path_buf);
        match Running::start(export, studio.document.recipe().clone(), own, &studio.session(), wake.clone()) {
            Ok(running) => self.running = Some((next, running)),
            Err(error) => self.made.push((next, Err(error.to_string()))),
        }
    }

    /// Shows the list; `form` is the export in the fields. Returns an export that was chosen from the list.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        (studio, form): (&Studio, &Export),
        language: Language,
        actions: &mut Vec<Action>,
    ) -> Option<Export> {
        let kept = studio.document.kept();
        let mut chosen = None;
        ui.horizontal(|ui| {
            ui.strong(language.text("exports.title"));
            let can = studio.document.is_valid() && !self.is_busy();
            let add = ui.add_enabled(can, egui::Button::new(language.text("exports.add")));
            if add.on_hover_text(language.text("exports.add_help")).clicked() {
                let mut exports = kept.exports.clone();
                let new = form.to_kept(&folder(studio));
                // Another export to the same file replaces it.
                exports.retain(|export| export.file != new.file);
                exports.push(new);
                actions.push(keep(kept, exports));
            }
            let all = egui::Button::new(language.text("exports.make"));
            if ui.add_enabled(can && !kept.exports.is_empty(), all).clicked() {
                self.left.clone_from(&kept.exports);
                self.made.clear();
            }
            if let Some((_, running)) = &self.running
                && ui.button(language.text("export.cancel")).clicked()
            {
                running.cancel();
                self.left.clear();
            }
        });
        ScrollArea::vertical().id_salt("exports").max_height(LIST).show(ui, |ui| {
            for (k, export) in kept.exports.iter().enumerate() {
                ui.horizontal(|ui| {
                    let remove = ui.small_button("×").on_hover_text(language.text("exports.remove"));
                    let name = format!("{} {}", language.text("exports.remove"), export.file);
                    remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                    if remove.clicked() {
                        let others = kept.exports.iter().enumerate().filter(|(other, _)| *other != k);
                        actions.push(keep(kept, others.map(|(_, export)| export.clone()).collect()));
                    }
                    let row = ui.selectable_label(false, &export.file);
                    if row.on_hover_text(language.text("exports.edit")).clicked() {
                        chosen = Export::of_kept(export, &folder(studio), form);
                    }
                    self.state(ui, export, language);
                });
            }
        });
        chosen
    }

    /// What became of an export.
    fn state(&self, ui: &mut Ui, export: &KeptExport, language: Language) {
        if let Some((_, running)) = self.running.as_ref().filter(|(own, _)| own == export) {
            ui.add(ProgressBar::new(running.share()).desired_width(120.0).show_percentage());
        } else if self.left.contains(export) {
            ui.weak(language.text("exports.waits"));
        } else if let Some((_, result)) = self.made.iter().find(|(own, _)| own == export) {
            match result {
                Ok(words) => drop(ui.weak(language.text("exports.done")).on_hover_text(words)),
                Err(error) => drop(ui.colored_label(ui.visuals().error_fg_color, language.message(error))),
            }
        }
    }

    /// The results of the exports that were made.
    pub fn results(&self) -> impl Iterator<Item = &Result<String, String>> {
        self.made.iter().map(|(_, result)| result)
    }
}

/// Maximum height of the list, and the height of a row.
const LIST: f32 = 96.0;
const ROW: f32 = 24.0;

/// The folder of the recipe.
fn folder(studio: &Studio) -> PathBuf {
    studio.document.path().and_then(Path::parent).map(Path::to_path_buf).unwrap_or_default()
}

/// The action that keeps these exports.
fn keep(kept: &Kept, exports: Vec<KeptExport>) -> Action {
    Action::Edit(Edit::Keep(Kept { exports, ..kept.clone() }))
}
