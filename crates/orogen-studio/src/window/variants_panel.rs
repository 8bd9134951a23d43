//! A strip of variants: other seeds, or values of a parameter. A click applies one.

use eframe::egui::{
    self, Align2, Color32, ColorImage, ComboBox, FontId, Sense, TextureHandle, TextureOptions, Ui, Vec2, vec2,
};
use orogen::Result;

use super::action::Action;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::variants::{COUNT, Varied};
use crate::preview::picture::Picture;
use crate::preview::strip::Strip;
use crate::preview::worker::Wake;
use crate::studio::{Studio, surface};

/// A variant.
struct Variant {
    value: String,
    edit: Edit,
    /// The picture, once it is made, or the reason why it cannot be made.
    picture: Option<std::result::Result<TextureHandle, String>>,
}

/// State of the panel.
pub struct VariantsPanel {
    varied: Varied,
    strip: Strip,
    variants: Vec<Variant>,
    /// What the pictures depend on: the revision of the recipe, and the varied quantity.
    asked: Option<(u64, Varied)>,
}

impl VariantsPanel {
    /// A panel that varies the seed.
    #[must_use]
    pub fn new(wake: Wake) -> VariantsPanel {
        VariantsPanel { varied: Varied::Seed, strip: Strip::new(wake), variants: Vec::new(), asked: None }
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            let label = ui.label(language.text("variants.of"));
            let selected = studio.selected.first().map(String::as_str);
            let list = ComboBox::from_id_salt("varied")
                .width(260.0)
                .selected_text(name(&self.varied, language))
                .show_ui(ui, |ui| {
                    for varied in Varied::of(&studio.document, selected) {
                        let label = name(&varied, language);
                        if ui.selectable_label(varied == self.varied, label).clicked() {
                            self.varied = varied;
                        }
                    }
                });
            list.response.labelled_by(label.id);
            ui.weak(language.text("variants.help"));
        });
        if let Err(error) = self.refresh(studio) {
            ui.colored_label(ui.visuals().error_fg_color, language.message(&error.to_string()));
        }
        for (k, made) in self.strip.made() {
            let picture = made
                .map(|picture| texture(ui, k, &picture))
                .map_err(|error| language.message(&error.to_string()).into_owned());
            if let Some(variant) = self.variants.get_mut(k) {
                variant.picture = Some(picture);
            }
        }
        // All pictures are visible at once, if there is room.
        let room = ui.available_size();
        let side = (room.y - 36.0).min(room.x / COUNT as f32 - 10.0).clamp(60.0, 220.0);
        egui::ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
            ui.horizontal(|ui| {
                for variant in &self.variants {
                    if card(ui, variant, side, language) {
                        actions.push(Action::Edit(variant.edit.clone()));
                        actions.push(Action::EndGesture);
                    }
                }
            });
        });
    }

    /// Requests pictures if the text or the varied quantity has changed.
    fn refresh(&mut self, studio: &Studio) -> Result<()> {
        let now = (studio.document.recipe_revision(), self.varied.clone());
        if self.asked.as_ref() == Some(&now) || !studio.document.is_valid() {
            return Ok(());
        }
        self.asked = Some(now);
        self.variants.clear();
        let mut recipes = Vec::new();
        for (value, edit) in self.varied.edits(&studio.document) {
            let mut variant = studio.document.clone();
            // A value that contradicts another parameter is omitted.
            if variant.apply(&edit).is_ok() {
                recipes.push(variant.recipe().clone());
                self.variants.push(Variant { value, edit, picture: None });
            }
        }
        self.strip.ask(&studio.session(), recipes, surface(studio.document.recipe()))
    }
}

fn name(varied: &Varied, language: Language) -> String {
    match varied {
        Varied::Seed => language.text("inspector.seed").to_owned(),
        Varied::Parameter(name) => name.clone(),
        Varied::Param { node, key } => format!("{node}.{key}"),
    }
}

fn texture(ui: &Ui, k: usize, picture: &Picture) -> TextureHandle {
    let image = ColorImage::from_rgba_unmultiplied(picture.size, &picture.pixels);
    ui.ctx().load_texture(format!("variant {k}"), image, TextureOptions::LINEAR)
}

fn card(ui: &mut Ui, variant: &Variant, side: f32, language: Language) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(side, side + 18.0), Sense::click());
    let label = language.fill("spoken.variant", &[("value", &variant.value)]);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label.clone()));
    let painter = ui.painter_at(rect);
    let image = egui::Rect::from_min_size(rect.min, Vec2::splat(side));
    painter.rect_filled(image, 3.0, ui.visuals().extreme_bg_color);
    match &variant.picture {
        Some(Ok(texture)) => {
            // Worlds that are not square keep their aspect ratio.
            let size = texture.size_vec2();
            let fitted = egui::Rect::from_center_size(image.center(), size * (side / size.max_elem()));
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            painter.image(texture.id(), fitted, whole, Color32::WHITE);
        }
        Some(Err(why)) => drop(response.clone().on_hover_text(why)),
        None => {}
    }
    let at = egui::pos2(image.center().x, image.bottom() + 9.0);
    painter.text(at, Align2::CENTER_CENTER, &variant.value, FontId::proportional(12.0), ui.visuals().text_color());
    if response.hovered() {
        let stroke = egui::Stroke::new(2.0, ui.visuals().selection.bg_fill);
        painter.rect_stroke(image, 3.0, stroke, egui::StrokeKind::Inside);
    }
    response.clicked()
}
