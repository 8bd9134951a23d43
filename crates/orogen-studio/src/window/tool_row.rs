//! The tools above a view.

use eframe::egui::{ScrollArea, Ui};

/// The height below which tools have one row, which can be scrolled.
const LOW: f32 = 200.0;

/// Shows tools in rows; each of a panel's rows has another name.
pub fn show(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    if ui.available_height() < LOW {
        ScrollArea::horizontal().id_salt(name).show(ui, |ui| ui.horizontal(add));
    } else {
        ui.horizontal_wrapped(add);
    }
}
