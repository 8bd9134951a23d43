//! The fields of a rendered picture.

use eframe::egui::Ui;
use orogen::jobs::RenderJob;

use super::option_rows::{Fields, OptionRows};
use super::rows;
use crate::catalogue::Language;
use crate::export::render::RenderExport;
use crate::export::request::Export;
use crate::window::relief_panel::ShownView;

/// Takes over the settings of the 3D view.
pub fn follow(own: &mut RenderExport, view: &ShownView) {
    let pair = |[a, b]: [f64; 2]| format!("{a},{b}");
    own.options.insert("camera", pair(view.camera));
    own.options.insert("sun", pair(view.sun));
    own.options.insert("exaggeration", view.exaggeration.to_string());
    own.options.retain(|name, _| !["look", "time"].contains(name));
}

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, view: &ShownView, language: Language) {
    let own = &mut export.render;
    rows::grid(ui, "render", |ui| {
        ui.label("");
        if ui.button(language.text("export.follow")).clicked() {
            follow(own, view);
        }
        ui.end_row();
        let fields = Fields { language, layers: Vec::new(), title: "" };
        OptionRows { fields: &fields, specs: RenderJob::OPTIONS, given: &mut own.options }.rows(ui);
        rows::samples(ui, &mut own.samples, language);
    });
}
