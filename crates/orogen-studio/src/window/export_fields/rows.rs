//! Rows of fields: a name, and what is chosen.

use std::ops::RangeInclusive;

use eframe::egui::emath::Numeric;
use eframe::egui::{ComboBox, DragValue, Role, TextEdit, Ui, WidgetInfo};
use orogen::export::options::{OptionSpec, ValueKind};

use crate::catalogue::Language;
use crate::export::layer::Given;

/// Width of fields.
const WIDTH: f32 = 300.0;

/// Numbers of samples that are offered; 0 is the world's own.
const SAMPLES: [usize; 9] = [0, 256, 512, 1024, 1025, 2048, 4096, 8192, 16_384];

/// A grid of rows.
pub fn grid(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui)) {
    eframe::egui::Grid::new(name).num_columns(2).spacing([12.0, 6.0]).show(ui, add);
}

/// A choice among items. Returns whether another one was chosen.
pub fn choice<T: PartialEq + Clone>(ui: &mut Ui, name: &str, value: &mut T, items: &[(T, String)]) -> bool {
    ui.label(name);
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
    ui.end_row();
    is_changed
}

/// A choice among names, where the first item, `none`, is no choice.
pub fn optional_name(
    ui: &mut Ui,
    name: &str,
    value: &mut Option<&'static str>,
    none: &str,
    names: impl Iterator<Item = &'static str>,
) {
    let items: Vec<(Option<&'static str>, String)> =
        std::iter::once((None, none.to_owned())).chain(names.map(|name| (Some(name), name.to_owned()))).collect();
    choice(ui, name, value, &items);
}

/// A choice among names that are owned. Returns whether another one was chosen.
pub fn names(ui: &mut Ui, name: &str, value: &mut String, names: Vec<String>) -> bool {
    let items: Vec<(String, String)> = names.into_iter().map(|name| (name.clone(), name)).collect();
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

/// A number.
pub fn number(ui: &mut Ui, name: &str, value: &mut f64, range: RangeInclusive<f64>, suffix: &str) {
    ui.label(name);
    let speed = ((range.end() - range.start()) / 500.0).clamp(0.01, 1.0);
    ui.add(DragValue::new(value).range(range).speed(speed).max_decimals(3).suffix(suffix));
    ui.end_row();
}

/// Two numbers, such as a direction.
pub fn pair(ui: &mut Ui, name: &str, values: &mut [f64; 2], ranges: [RangeInclusive<f64>; 2], language: Language) {
    ui.label(name);
    ui.horizontal(|ui| {
        let words = ["export.azimuth", "export.elevation"];
        for ((value, range), word) in values.iter_mut().zip(ranges).zip(words) {
            ui.add(DragValue::new(value).range(range).speed(0.5).max_decimals(1).suffix("°"))
                .on_hover_text(language.text(word));
        }
    });
    ui.end_row();
}

/// A number that is chosen by itself unless it is given; `usual` is its first value, and the last texts stand before and after it.
pub fn optional(
    ui: &mut Ui,
    name: &str,
    value: &mut Option<f64>,
    (usual, range): (f64, RangeInclusive<f64>),
    [prefix, suffix]: [&str; 2],
    language: Language,
) {
    ui.label(name);
    ui.horizontal(|ui| {
        let mut is_given = value.is_some();
        if ui.checkbox(&mut is_given, "").changed() {
            *value = is_given.then_some(usual);
        }
        match value {
            Some(value) => drop(ui.add(DragValue::new(value).range(range).prefix(prefix).suffix(suffix))),
            None => drop(ui.weak(language.text("export.automatic"))),
        }
    });
    ui.end_row();
}

/// Two ends that are chosen by themselves unless they are given.
pub fn optional_ends<T: Numeric>(
    ui: &mut Ui,
    name: &str,
    value: &mut Option<[T; 2]>,
    usual: [T; 2],
    language: Language,
) {
    ui.label(name);
    ui.horizontal(|ui| {
        let mut is_given = value.is_some();
        if ui.checkbox(&mut is_given, "").changed() {
            *value = is_given.then_some(usual);
        }
        match value {
            Some(ends) => ends.iter_mut().for_each(|end| drop(ui.add(DragValue::new(end)))),
            None => drop(ui.weak(language.text("export.automatic"))),
        }
    });
    ui.end_row();
}

/// A text.
pub fn text(ui: &mut Ui, name: &str, value: &mut String) {
    ui.label(name);
    let field = ui.add(TextEdit::singleline(value).desired_width(WIDTH));
    field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, name));
    ui.end_row();
}

/// A color.
pub fn color(ui: &mut Ui, name: &str, value: &mut [u8; 3]) {
    ui.label(name);
    ui.color_edit_button_srgb(value);
    ui.end_row();
}

/// A color that is chosen by itself unless it is given; `usual` is its first value.
pub fn optional_color(ui: &mut Ui, name: &str, value: &mut Option<[u8; 3]>, usual: [u8; 3], language: Language) {
    ui.label(name);
    ui.horizontal(|ui| {
        let mut is_given = value.is_some();
        if ui.checkbox(&mut is_given, "").changed() {
            *value = is_given.then_some(usual);
        }
        match value {
            Some(color) => drop(ui.color_edit_button_srgb(color)),
            None => drop(ui.weak(language.text("export.automatic"))),
        }
    });
    ui.end_row();
}

/// A switch.
pub fn switch(ui: &mut Ui, name: &str, value: &mut bool) {
    ui.label(name);
    ui.checkbox(value, "");
    ui.end_row();
}

/// The fields of declared options; one that is empty is not given.
pub fn options(ui: &mut Ui, specs: &'static [OptionSpec], given: &mut Given) {
    for spec in specs {
        ui.label(spec.name).on_hover_text(spec.about);
        option(ui, spec, given);
        ui.end_row();
    }
}

fn option(ui: &mut Ui, spec: &'static OptionSpec, given: &mut Given) {
    match spec.value_kind {
        ValueKind::Nothing => {
            let mut is_given = given.contains_key(spec.name);
            if ui.checkbox(&mut is_given, "").on_hover_text(spec.about).changed() {
                match is_given {
                    true => drop(given.insert(spec.name, String::new())),
                    false => drop(given.remove(spec.name)),
                }
            }
        }
        ValueKind::Word(words) => {
            let own = given.get(spec.name).cloned().unwrap_or_default();
            let list = ComboBox::from_id_salt(("option", spec.name)).selected_text(&own);
            let response = list.show_ui(ui, |ui| {
                if ui.selectable_label(own.is_empty(), "–").clicked() {
                    given.remove(spec.name);
                }
                for word in words {
                    if ui.selectable_label(own == *word, *word).clicked() {
                        given.insert(spec.name, (*word).to_owned());
                    }
                }
            });
            response.response.on_hover_text(spec.about);
        }
        _ => {
            let mut text = given.get(spec.name).cloned().unwrap_or_default();
            let field = TextEdit::singleline(&mut text).desired_width(140.0).hint_text(spec.value);
            if ui.add(field).on_hover_text(spec.about).changed() {
                match text.is_empty() {
                    true => drop(given.remove(spec.name)),
                    false => drop(given.insert(spec.name, text)),
                }
            }
        }
    }
}
