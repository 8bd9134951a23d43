//! The menu of layouts of the window: the initial one, and those that were kept under a name.

use eframe::egui::{self, Id, TextEdit, Ui};

use super::action::Action;
use crate::catalogue::Language;
use crate::settings::Settings;
use crate::settings::layout::Layout;

/// Maximum number of characters of a name.
const LONGEST: usize = 40;

/// Shows the menu.
pub fn show(ui: &mut Ui, settings: &Settings, language: Language, actions: &mut Vec<Action>) {
    ui.menu_button(language.text("layouts.menu"), |ui| {
        if ui.button(language.text("layouts.initial")).clicked() {
            actions.push(Action::UseLayout(Layout::default()));
            ui.close();
        }
        for kept in &settings.layouts {
            ui.horizontal(|ui| {
                if ui.selectable_label(kept.layout == settings.layout, &kept.name).clicked() {
                    actions.push(Action::UseLayout(kept.layout));
                    ui.close();
                }
                let forget = language.text("layouts.drop");
                let remove = ui.small_button("×").on_hover_text(forget);
                remove.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Button, true, format!("{forget} {}", kept.name))
                });
                if remove.clicked() {
                    actions.push(Action::DropLayout(kept.name.clone()));
                }
            });
        }
        ui.separator();
        keep(ui, language, actions);
    });
}

/// A field for the name under which the present layout is kept.
fn keep(ui: &mut Ui, language: Language, actions: &mut Vec<Action>) {
    let id = Id::unique("name of the layout");
    let mut name = ui.data_mut(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let hint = language.text("layouts.name");
    ui.horizontal(|ui| {
        let field = ui.add(TextEdit::singleline(&mut name).hint_text(hint).char_limit(LONGEST).desired_width(140.0));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, hint));
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        let is_named = !name.trim().is_empty();
        let keep = ui.add_enabled(is_named, egui::Button::new(language.text("layouts.keep")));
        if is_named && (keep.clicked() || is_entered) {
            actions.push(Action::KeepLayout(name.trim().to_owned()));
            name.clear();
            ui.close();
        }
    });
    ui.data_mut(|data| data.insert_temp(id, name));
}
