//! The fields of a map sheet.

use eframe::egui::Ui;
use orogen::jobs::{MapJob, SheetFormat};

use super::option_rows::{Fields, OptionRows};
use super::rows;
use crate::catalogue::Language;
use crate::export::map::MapExport;
use crate::export::request::Export;
use crate::studio::Studio;

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, studio: &Studio, language: Language) {
    let own = &mut export.map;
    let mut is_other = false;
    let fields = Fields { language, layers: MapExport::layers(studio.document.recipe()), title: &own.own_title };
    let mut options = OptionRows { fields: &fields, specs: MapJob::OPTIONS, given: &mut own.options };
    rows::grid(ui, "map", |ui| {
        let formats: Vec<(SheetFormat, String)> =
            SheetFormat::ALL.into_iter().map(|format| (format, format!(".{}", format.name()))).collect();
        is_other = rows::choice(ui, language.text("export.format"), &mut own.format, &formats);
        rows::samples(ui, &mut own.samples, language);
        options.rows(ui);
    });
    options.parts(ui);
    if is_other {
        export.set_extension();
    }
}
