//! The dialog for editing a color ramp; the view is updated meanwhile.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{
    self, Color32, ComboBox, Context, DragValue, Key, Rect, Sense, Stroke, TextEdit, Ui, Vec2, pos2, vec2,
};
use orogen::io::palette::{Palette, named, own, read};
use orogen::{Error, ErrorKind, Result};

use super::action::Action;
use super::dialogs::window;
use super::purpose::Purpose;
use super::swatches;
use crate::catalogue::Language;
use crate::files;
use crate::preview::coloring::Coloring;
use crate::preview::ramp::Ramp;

/// State of the dialog.
#[derive(Debug)]
pub struct RampEditor {
    ramp: Ramp,
    selected: usize,
}

/// Number of colors in the picture of a ramp.
const STEPS: usize = 256;

impl RampEditor {
    /// A dialog for a palette. It gets the name of a variant, unless it is already an edited palette.
    ///
    /// # Errors
    /// If the palette is not a ramp.
    pub fn new(palette: &Palette, is_edited: bool) -> Result<RampEditor> {
        let refused = || {
            let message = format!(
                "`{}` cannot be edited: a ramp has at least two colors, in ascending order, whose positions are all values, all shares, or all relative to the sea",
                palette.name
            );
            Error::new(ErrorKind::File, message)
        };
        let mut ramp = Ramp::of(palette).ok_or_else(refused)?;
        if !is_edited {
            ramp.rename(&format!("{}-2", palette.name));
        }
        Ok(RampEditor { ramp, selected: 0 })
    }

    /// A dialog for a palette in a file.
    ///
    /// # Errors
    /// If the file cannot be read, or does not contain a ramp.
    pub fn open(path: &Path) -> Result<RampEditor> {
        RampEditor::new(&read(path)?, true)
    }

    /// The edited palette as coloring of the view.
    #[must_use]
    pub fn coloring(&self) -> Coloring {
        Coloring::Edited(Arc::new(self.ramp.palette().clone()))
    }

    /// The suggested file name.
    #[must_use]
    pub fn file_name(&self) -> String {
        format!("{}.toml", self.ramp.palette().name)
    }

    /// Writes the palette to a file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        let text = own::write(self.ramp.palette())
            .ok_or_else(|| Error::new(ErrorKind::Internal, "the palette cannot be written"))?;
        files::write(path, &text)
    }

    /// Shows the dialog; false once it is closed.
    pub fn show(&mut self, context: &Context, language: Language, actions: &mut Vec<Action>) -> bool {
        let before = self.ramp.clone();
        let mut is_open = true;
        window(context, language.text("colors.title"), &mut is_open, vec2(440.0, 170.0), |ui| {
            ui.horizontal(|ui| self.start(ui, language, actions));
            self.bar(ui, language);
            ui.horizontal(|ui| self.stop(ui, language));
            ui.weak(language.text("colors.help"));
        });
        if self.ramp != before {
            actions.push(Action::Color(self.coloring()));
        }
        is_open && !context.input(|input| input.key_pressed(Key::Escape))
    }

    /// Shows the name, a choice of another palette to start from, and files.
    fn start(&mut self, ui: &mut Ui, language: Language, actions: &mut Vec<Action>) {
        let mut name = self.ramp.palette().name.clone();
        let field = ui.add(TextEdit::singleline(&mut name).desired_width(120.0));
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::TextInput, true, language.text("spoken.palette_name"))
        });
        if field.changed() {
            self.ramp.rename(&name);
        }
        let start = ComboBox::from_id_salt("start from")
            .selected_text(language.text("colors.start"))
            .height(360.0)
            .show_ui(ui, |ui| {
                for palette in named::all() {
                    if swatches::entry(ui, false, palette, language).clicked()
                        && let Ok(other) = RampEditor::new(&palette.palette(), false)
                    {
                        *self = other;
                    }
                }
            });
        start
            .response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, language.text("colors.start")));
        if ui.button(language.text("colors.reverse")).clicked() {
            self.ramp.reverse();
        }
        if ui.button(language.text("colors.open")).clicked() {
            actions.push(Action::Choose(Purpose::OpenPalette));
        }
        if ui.button(language.text("colors.save")).clicked() {
            actions.push(Action::Choose(Purpose::SavePalette));
        }
    }

    /// The ramp with handles at its colors.
    fn bar(&mut self, ui: &mut Ui, language: Language) {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 54.0), Sense::click());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, language.text("spoken.color_ramp")));
        let painter = ui.painter_at(rect);
        let inner = Rect::from_min_max(rect.min + vec2(8.0, 2.0), rect.max - vec2(8.0, 20.0));
        let colors = self.ramp.colors(STEPS);
        for (k, [red, green, blue]) in colors.iter().enumerate() {
            let x = |k: usize| inner.left() + inner.width() * k as f32 / STEPS as f32;
            let part = Rect::from_min_max(pos2(x(k), inner.top()), pos2(x(k + 1) + 0.5, inner.bottom()));
            painter.rect_filled(part, 0.0, Color32::from_rgb(*red, *green, *blue));
        }
        let [low, high] = self.ramp.ends();
        let span = (high - low).max(f64::MIN_POSITIVE);
        let x_of = |at: f64| inner.left() + ((at - low) / span) as f32 * inner.width();
        let at_of = |x: f32| low + f64::from(((x - inner.left()) / inner.width()).clamp(0.0, 1.0)) * span;
        let mut removed = None;
        for (k, (at, [red, green, blue])) in self.ramp.stops().into_iter().enumerate() {
            let place = pos2(x_of(at), inner.bottom() + 9.0);
            let around = Rect::from_center_size(place, Vec2::splat(14.0));
            let handle = ui.interact(around, response.id.with(k), Sense::click_and_drag());
            let spoken = language.fill("spoken.color", &[("number", &(k + 1).to_string())]);
            handle.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, spoken.clone()));
            if handle.clicked() || handle.drag_started() {
                self.selected = k;
            }
            if handle.dragged()
                && let Some(pointer) = handle.interact_pointer_pos()
            {
                self.ramp.set_position(k, rounded(at_of(pointer.x), span));
            }
            if handle.secondary_clicked() || handle.double_clicked() {
                removed = Some(k);
            }
            let ring = if k == self.selected { ui.visuals().strong_text_color() } else { Color32::from_gray(120) };
            painter.line_segment([pos2(place.x, inner.bottom()), place], Stroke::new(1.0, ring));
            painter.circle(place, 6.0, Color32::from_rgb(red, green, blue), Stroke::new(2.0, ring));
        }
        if let Some(k) = removed {
            self.ramp.remove(k);
            self.selected = self.selected.min(self.ramp.stops().len() - 1);
        } else if response.double_clicked()
            && let Some(pointer) = response.interact_pointer_pos()
            && let Some(k) = self.ramp.add(rounded(at_of(pointer.x), span))
        {
            self.selected = k;
        }
    }

    /// The selected color and its position.
    fn stop(&mut self, ui: &mut Ui, language: Language) {
        let stops = self.ramp.stops();
        let Some((at, color)) = stops.get(self.selected).copied() else { return };
        let mut edited = color;
        if ui.color_edit_button_srgb(&mut edited).changed() {
            self.ramp.set_color(self.selected, edited);
        }
        let [low, high] = self.ramp.ends();
        let mut position = at;
        ui.label(language.text("colors.position"));
        let field = ui.add(DragValue::new(&mut position).speed((high - low).abs() * 0.002).max_decimals(4));
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Slider, true, language.text("spoken.color_position"))
        });
        if field.changed() {
            self.ramp.set_position(self.selected, position);
        }
        let is_inner = self.selected > 0 && self.selected + 1 < stops.len();
        if ui.add_enabled(is_inner, egui::Button::new(language.text("colors.remove"))).clicked() {
            self.ramp.remove(self.selected);
        }
    }
}

/// A position with as many digits as are visible.
fn rounded(at: f64, span: f64) -> f64 {
    let step = libm::pow(10.0, libm::log10(span / 500.0).floor());
    let text = format!("{:.12}", (at / step).round() * step);
    text.parse().unwrap_or(at)
}
