//! The fields of a map of tiles.

use eframe::egui::{DragValue, Role, Ui, WidgetInfo};
use orogen::autotile::mask::Layout;
use orogen::tilemap::art::set::{SETS, Set};

use super::rows;
use crate::catalogue::Language;
use crate::export::request::Export;

/// Cells along the longer side.
const CELLS: std::ops::RangeInclusive<usize> = 1..=65_536;

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, language: Language) {
    let own = &mut export.tilemap;
    rows::grid(ui, "tilemap", |ui| {
        let file = (None, language.text("export.tileset_file").to_owned());
        let sets: Vec<(Option<&'static str>, String)> = SETS
            .iter()
            .map(|set| (Some(set.name), format!("{}  {}", set.name, set.about)))
            .chain(std::iter::once(file))
            .collect();
        let mut set = Set::named(&own.tileset).map(|set| set.name);
        if rows::choice(ui, language.text("export.tileset"), &mut set, &sets) {
            own.tileset = set.unwrap_or_default().to_owned();
            own.wang_set.clear();
        }
        if set.is_none() {
            rows::text(ui, language.text("export.tileset_path"), &mut own.tileset);
            rows::text(ui, language.text("export.wang_set"), &mut own.wang_set);
        }
        let automatic = (None, language.text("export.automatic").to_owned());
        let layouts: Vec<(Option<Layout>, String)> = std::iter::once(automatic)
            .chain(
                Layout::ALL.into_iter().map(|layout| (Some(layout), format!("{}  {}", layout.name(), layout.about()))),
            )
            .collect();
        rows::choice(ui, language.text("export.layout"), &mut own.layout, &layouts);
        ui.label(language.text("export.cells"));
        let name = language.text("export.cells");
        ui.add(DragValue::new(&mut own.size).range(CELLS).speed(0.5))
            .widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, name));
        ui.end_row();
        rows::switch(ui, language.text("export.infinite"), &mut own.is_infinite);
    });
}
