//! The fields of a layer or a mesh.

use eframe::egui::Ui;
use orogen::export::format::Format;
use orogen::export::registry;

use super::option_rows::{Fields, OptionRows};
use super::rows;
use crate::catalogue::Language;
use crate::export::layer::{layer_options, layers};
use crate::export::request::Export;
use crate::studio::Studio;

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, studio: &Studio, language: Language) {
    let own = &mut export.layer;
    let mut is_other = false;
    rows::grid(ui, "layer", |ui| {
        let item = |format: &Format| (format.name, format!(".{}  {}", format.name, language.told(format.about)));
        let items: Vec<(&'static str, String)> = registry::all().iter().map(|format| item(format)).collect();
        let mut name = own.format.name;
        if rows::choice(ui, language.text("export.format"), &mut name, &items)
            && let Some(format) = registry::named(name)
        {
            own.set_format(format, relief(studio));
            is_other = true;
        }
        let mut layer = own.layer.clone();
        let all = layers(own.format, studio.document.recipe());
        if rows::names(ui, language.text("menu.layer"), &mut layer, all, language) {
            own.set_layer(&layer);
        }
        rows::samples(ui, &mut own.size, language);
    });
    let known = layer_options(&own.layer);
    if !own.format.options.is_empty() || !known.is_empty() {
        ui.add_space(4.0);
        ui.strong(language.text("export.options"));
        rows::grid(ui, "options", |ui| {
            let fields = Fields { language, layers: Vec::new(), title: "" };
            OptionRows { fields: &fields, specs: own.format.options, given: &mut own.options }.rows(ui);
            OptionRows { fields: &fields, specs: known, given: &mut own.layer_options }.rows(ui);
        });
    }
    if is_other {
        export.set_extension();
    }
}

/// The difference between the highest and the lowest height in the picture.
fn relief(studio: &Studio) -> Option<f64> {
    let [low, high] = studio.frame.as_ref()?.range();
    (low <= high).then_some(high - low)
}
