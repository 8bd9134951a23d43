//! The fields of a map of tiles.

use eframe::egui::{DragValue, Role, Ui, WidgetInfo};
use orogen::tilemap::TilemapJob;

use super::option_rows::{Fields, OptionRows};
use super::rows;
use crate::catalogue::Language;
use crate::export::request::Export;

/// Number of cells along the longer side.
const CELLS: std::ops::RangeInclusive<usize> = 1..=65_536;

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, language: Language) {
    let own = &mut export.tilemap;
    rows::grid(ui, "tilemap", |ui| {
        ui.label(language.text("export.cells"));
        let name = language.text("export.cells");
        ui.add(DragValue::new(&mut own.size).range(CELLS).speed(0.5))
            .widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, name));
        ui.end_row();
        let fields = Fields { language, layers: Vec::new(), title: "" };
        OptionRows { fields: &fields, specs: TilemapJob::OPTIONS, given: &mut own.options }.rows(ui);
    });
}
