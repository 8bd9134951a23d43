//! The bar at the top: menus, undo and redo, shown layer, language and colors.

use eframe::egui::{self, ComboBox, Ui};
use orogen::io::palette::named;

use super::action::Action;
use super::command::{self, Command, Menu};
use super::{layouts_menu, swatches};
use crate::catalogue::Language;
use crate::files;
use crate::preview::coloring::Coloring;
use crate::settings::layout::View;
use crate::settings::{Settings, Theme};
use crate::studio::Studio;

/// Shows the bar.
pub fn show(ui: &mut Ui, studio: Option<&Studio>, settings: &Settings, language: Language, actions: &mut Vec<Action>) {
    egui::MenuBar::new().ui(ui, |ui| {
        for menu in Menu::ALL {
            ui.menu_button(language.text(menu.name()), |ui| {
                for entry in command::all().filter(|entry| entry.menu == menu) {
                    let keys = entry.keys.map(|keys| ui.ctx().format_shortcut(&keys)).unwrap_or_default();
                    let mark = is_marked(entry.command, settings);
                    let mut button = egui::Button::selectable(mark, label(entry.command, studio, language));
                    if !keys.is_empty() {
                        // Dimmed on the color of the selection, it would not be readable.
                        let selected = ui.visuals().selection.stroke.color;
                        let keys = egui::RichText::new(keys);
                        button = button.shortcut_text(if mark { keys.color(selected) } else { keys });
                    }
                    let enabled = is_enabled(entry.command, studio);
                    if ui.add_enabled(enabled, button).clicked() {
                        actions.push(Action::Command(entry.command));
                        ui.close();
                    }
                }
                if menu == Menu::File && !settings.recent.is_empty() {
                    ui.separator();
                    ui.weak(language.text("menu.recent"));
                    for path in &settings.recent {
                        if ui.button(path.display().to_string()).clicked() {
                            actions.push(Action::Open(path.clone()));
                            ui.close();
                        }
                    }
                }
                if let (Menu::Edit, Some(studio)) = (menu, studio) {
                    ui.separator();
                    history(ui, studio, language, actions);
                }
                if menu == Menu::View {
                    ui.separator();
                    layouts_menu::show(ui, settings, language, actions);
                    preferences(ui, settings, language, actions);
                }
            });
        }
        if let Some(studio) = studio {
            ui.separator();
            shown(ui, studio, language, actions);
        }
    });
}

/// The name of a command; for undo and redo, with the name of the step.
fn label(command: Command, studio: Option<&Studio>, language: Language) -> String {
    let name = command.entry().map_or("", |entry| language.text(entry.name));
    let history = studio.map(|studio| studio.document.history());
    let what = match command {
        Command::Undo => history.and_then(|history| history.undo_label()),
        Command::Redo => history.and_then(|history| history.redo_label()),
        _ => None,
    };
    match what {
        Some(what) => format!("{name}: {}", language.text(what)),
        None => name.to_owned(),
    }
}

/// Whether the state that a command switches is on.
fn is_marked(command: Command, settings: &Settings) -> bool {
    let layout = &settings.layout;
    match command {
        Command::PanelBelow => layout.has_below,
        Command::Inspector => layout.has_inspector,
        Command::ViewAlone => layout.is_view_alone(),
        Command::Thumbnails => settings.thumbnails,
        Command::ShowRelief => layout.view == View::Relief,
        Command::ShowMap => layout.view == View::Map,
        Command::ShowBoth => layout.view == View::Both,
        Command::ShowWindows => layout.view == View::Windows,
        _ => false,
    }
}

/// Whether a command is available now.
#[must_use]
pub fn is_enabled(command: Command, studio: Option<&Studio>) -> bool {
    let Some(studio) = studio else { return command.entry().is_some_and(|entry| !entry.needs_document) };
    match command {
        Command::Undo => studio.document.history().undo_label().is_some(),
        Command::Redo => studio.document.history().redo_label().is_some(),
        Command::Delete | Command::Duplicate | Command::Rename | Command::Group => {
            !studio.selected.is_empty() && studio.document.is_valid()
        }
        Command::Ungroup => studio.selected_group().is_some() && studio.document.is_valid(),
        Command::AddNode | Command::NextSeed | Command::Export => studio.document.is_valid(),
        _ => true,
    }
}

/// The steps of the history, newest first; a click goes to one.
fn history(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    ui.menu_button(language.text("menu.history"), |ui| {
        egui::ScrollArea::vertical().max_height(400.0).show(ui, |ui| {
            let history = studio.document.history();
            for (step, label) in history.labels().enumerate().collect::<Vec<_>>().into_iter().rev() {
                let label = language.text(if label.is_empty() { "menu.opened" } else { label });
                if ui.selectable_label(step == history.at(), format!("{step}   {label}")).clicked() {
                    actions.push(Action::GoTo(step));
                    ui.close();
                }
            }
        });
    });
}

fn preferences(ui: &mut Ui, settings: &Settings, language: Language, actions: &mut Vec<Action>) {
    ui.menu_button(language.text("menu.language"), |ui| {
        for other in Language::ALL {
            if ui.selectable_label(other == language, other.name()).clicked() {
                actions.push(Action::Language(other));
                ui.close();
            }
        }
    });
    ui.menu_button(language.text("menu.theme"), |ui| {
        for (theme, name) in
            [(Theme::Dark, "theme.dark"), (Theme::Light, "theme.light"), (Theme::System, "theme.system")]
        {
            if ui.selectable_label(theme == settings.theme, language.text(name)).clicked() {
                actions.push(Action::Theme(theme));
                ui.close();
            }
        }
    });
    if files::has_file_dialogs() {
        let are_used = settings.has_system_dialogs;
        if ui.add(egui::Button::selectable(are_used, language.text("menu.system_dialogs"))).clicked() {
            actions.push(Action::SystemDialogs(!are_used));
            ui.close();
        }
    }
}

/// Controls for the shown layer and its palette.
fn shown(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    let label = ui.label(language.text("menu.layer"));
    let layers = ComboBox::from_id_salt("layer")
        .selected_text(language.named(&studio.look.layer))
        .height(400.0)
        .show_ui(ui, |ui| {
            for layer in studio.layers() {
                if ui.selectable_label(layer == studio.look.layer, language.named(&layer)).clicked() {
                    actions.push(Action::Show(layer));
                }
            }
        });
    layers.response.labelled_by(label.id);
    let own = &studio.look.coloring;
    let shown = match own {
        Coloring::Own => language.text("menu.own_palette"),
        Coloring::Named(name) => language.named(name),
        Coloring::Edited(palette) => &palette.name,
        Coloring::Surfaces => language.text("colors.surfaces"),
        Coloring::Biomes => language.text("colors.biomes"),
        Coloring::Classes => language.text("colors.classes"),
    };
    let colors = ComboBox::from_id_salt("palette").selected_text(shown).height(400.0).show_ui(ui, |ui| {
        for (coloring, name) in [
            (Coloring::Own, "menu.own_palette"),
            (Coloring::Surfaces, "colors.surfaces"),
            (Coloring::Biomes, "colors.biomes"),
            (Coloring::Classes, "colors.classes"),
        ] {
            if coloring.suits(studio.document.recipe())
                && ui.selectable_label(*own == coloring, language.text(name)).clicked()
            {
                actions.push(Action::Color(coloring));
            }
        }
        ui.separator();
        for palette in named::all() {
            let is_own = matches!(own, Coloring::Named(name) if name == palette.name);
            if swatches::entry(ui, is_own, palette, language).clicked() {
                actions.push(Action::Color(Coloring::Named(palette.name.to_owned())));
                ui.close();
            }
        }
    });
    let name = language.text("menu.colors");
    colors.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, name));
    colors.response.on_hover_text(name);
    if ui.button(language.text("colors.edit")).on_hover_text(language.text("colors.edit_help")).clicked() {
        actions.push(Action::EditColors);
    }
}
