//! Rows of fields: a name, and a choice.

use eframe::egui::{ComboBox, Role, Ui, WidgetInfo};

use crate::catalogue::Language;

/// Width of fields.
pub const WIDTH: f32 = 300.0;

/// Offered numbers of samples; 0 stands for the world's own.
const SAMPLES: [usize; 9] = [0, 256, 512, 1024, 1025, 2048, 4096, 8192, 16_384];

/// A grid of rows.
pub fn grid(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    eframe::egui::Grid::new(name).num_columns(2).spacing([12.0, 6.0]).show(ui, add);
}

/// A choice among items. Returns whether the selection has changed.
pub fn choice<T: PartialEq + Clone>(ui: &mut Ui, name: &str, value: &mut T, items: &[(T, String)]) -> bool {
    ui.label(name);
    let is_changed = list(ui, name, value, items);
    ui.end_row();
    is_changed
}

/// A list of items. Returns whether the selection has changed.
pub fn list<T: PartialEq + Clone>(ui: &mut Ui, name: &str, value: &mut T, items: &[(T, String)]) -> bool {
    let shown = items.iter().find(|(item, _)| item == value).map_or("", |(_, text)| text.as_str());
    let mut is_changed = false;
    let list = ComboBox::from_id_salt(("export", name)).width(WIDTH).height(360.0).truncate().selected_text(shown);
    let response = list.show_ui(ui, |ui| {
        for (item, text) in items {
            if ui.selectable_label(item == value, text).clicked() && item != value {
                *value = item.clone();
                is_changed = true;
            }
        }
    });
    response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, name));
    is_changed
}

/// A choice among owned names. Returns whether the selection has changed.
pub fn names(ui: &mut Ui, name: &str, value: &mut String, names: Vec<String>, language: Language) -> bool {
    let items: Vec<(String, String)> =
        names.into_iter().map(|name| (name.clone(), language.named(&name).to_owned())).collect();
    choice(ui, name, value, &items)
}

/// The number of samples along the longer side.
pub fn samples(ui: &mut Ui, value: &mut Option<usize>, language: Language) {
    let items: Vec<(Option<usize>, String)> = SAMPLES
        .into_iter()
        .map(|samples| match samples {
            0 => (None, language.text("export.own_size").to_owned()),
            samples => (Some(samples), samples.to_string()),
        })
        .collect();
    choice(ui, language.text("export.size"), value, &items);
}
