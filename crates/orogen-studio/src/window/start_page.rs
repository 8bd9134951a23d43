//! The start page: presets with pictures, and recent files.

use eframe::egui::{self, Color32, ColorImage, RichText, Sense, TextureHandle, TextureOptions, Ui, Vec2, vec2};
use orogen::presets;
use orogen::recipe::Preset;

use super::action::Action;
use super::command::Command;
use crate::catalogue::Language;
use crate::settings::Settings;

/// State of the page.
#[derive(Default)]
pub struct StartPage {
    pictures: Vec<(&'static str, TextureHandle)>,
    /// The description of each preset.
    abouts: Vec<String>,
}

/// A picture of each preset.
const PICTURES: &[(&str, &[u8])] = include!("preset_pictures.rs");

const SIDE: f32 = 150.0;

impl StartPage {
    /// Shows the page.
    pub fn show(&mut self, ui: &mut Ui, settings: &Settings, language: Language, actions: &mut Vec<Action>) {
        if self.pictures.is_empty() {
            self.pictures = PICTURES.iter().filter_map(|(name, bytes)| Some((*name, load(ui, name, bytes)?))).collect();
            let about = |preset: &Preset| preset.recipe().map(|recipe| recipe.about).unwrap_or_default();
            self.abouts = presets::all().iter().map(about).collect();
        }
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.add_space(12.0);
            ui.horizontal(|ui| {
                ui.label(RichText::new("Orogen").size(28.0).strong());
                ui.add_space(12.0);
                for command in [Command::Open, Command::Empty, Command::Tour] {
                    if let Some(entry) = command.entry()
                        && ui.button(language.text(entry.name)).clicked()
                    {
                        actions.push(Action::Command(command));
                    }
                }
            });
            ui.label(language.text("start.about"));
            if !settings.recent.is_empty() {
                ui.add_space(10.0);
                ui.strong(language.text("menu.recent"));
                for path in settings.recent.iter().take(5) {
                    if ui.link(path.display().to_string()).clicked() {
                        actions.push(Action::Open(path.clone()));
                    }
                }
            }
            ui.add_space(10.0);
            ui.strong(language.text("start.presets"));
            ui.add_space(4.0);
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(10.0, 10.0);
                for (preset, about) in presets::all().iter().zip(&self.abouts) {
                    let picture =
                        self.pictures.iter().find(|(name, _)| *name == preset.name).map(|(_, picture)| picture);
                    let name = language.named(preset.name);
                    let spoken = language.fill("spoken.preset", &[("name", name)]);
                    if card(ui, [name, &spoken, &language.hint(preset.name, about)], picture) {
                        actions.push(Action::OpenPreset(preset.name));
                    }
                }
            });
        });
    }
}

/// A picture with a name, its name for screen readers, and its description.
fn card(ui: &mut Ui, [name, spoken, about]: [&str; 3], picture: Option<&TextureHandle>) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(SIDE, SIDE + 22.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, spoken));
    let response = response.on_hover_text(about);
    let painter = ui.painter_at(rect);
    let image = egui::Rect::from_min_size(rect.min, Vec2::splat(SIDE));
    painter.rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
    if let Some(picture) = picture {
        let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        painter.image(picture.id(), image, whole, Color32::WHITE);
    }
    let text = egui::pos2(image.center().x, image.bottom() + 11.0);
    painter.text(text, egui::Align2::CENTER_CENTER, name, egui::FontId::proportional(13.0), ui.visuals().text_color());
    if response.hovered() {
        let stroke = egui::Stroke::new(2.0, ui.visuals().selection.bg_fill);
        painter.rect_stroke(rect, 4.0, stroke, egui::StrokeKind::Inside);
    }
    response.clicked()
}

/// Loads a PNG picture into a texture; `None` if it is damaged.
#[must_use]
pub fn load(ui: &Ui, name: &str, bytes: &[u8]) -> Option<TextureHandle> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().ok()?;
    let mut data = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut data).ok()?;
    let size = [info.width as usize, info.height as usize];
    let image = match info.color_type {
        png::ColorType::Rgb => ColorImage::from_rgb(size, &data),
        png::ColorType::Rgba => ColorImage::from_rgba_unmultiplied(size, &data),
        _ => return None,
    };
    Some(ui.ctx().load_texture(name, image, TextureOptions::LINEAR))
}
