//! The dialog that offers texts that were not saved when a window ended.

use eframe::egui::{self, Context, RichText, ScrollArea, TextureHandle, Ui, vec2};

use super::action::Action;
use super::dialogs::{self, ago};
use super::start_page::load;
use crate::catalogue::Language;
use crate::preview::frame::Frame;
use crate::recovery::Unsaved;

/// State of the dialog.
#[derive(Default)]
pub struct RecoveryDialog {
    offers: Vec<Offer>,
}

/// A text with the picture of its land.
struct Offer {
    unsaved: Unsaved,
    picture: Option<TextureHandle>,
    /// Whether the picture was read.
    is_seen: bool,
}

/// Side of a picture, in points and in samples.
const SIDE: f32 = 72.0;
const SAMPLES: usize = 144;

impl RecoveryDialog {
    /// A dialog that offers texts.
    #[must_use]
    pub fn new(left: Vec<Unsaved>) -> RecoveryDialog {
        let offer = |unsaved| Offer { unsaved, picture: None, is_seen: false };
        RecoveryDialog { offers: left.into_iter().map(offer).collect() }
    }

    /// The text that was changed last.
    #[must_use]
    pub fn latest(&self) -> Option<&Unsaved> {
        self.offers.first().map(|offer| &offer.unsaved)
    }

    /// No longer offers a text.
    pub fn remove(&mut self, unsaved: &Unsaved) {
        self.offers.retain(|offer| offer.unsaved != *unsaved);
    }

    /// Shows the dialog while there is something to offer; false once it is closed. Closing it removes nothing: the
    /// texts are offered again at the next start.
    pub fn show(&mut self, context: &Context, language: Language, actions: &mut Vec<Action>) -> bool {
        if self.offers.is_empty() {
            return false;
        }
        let (mut is_open, mut stays) = (true, true);
        dialogs::window(context, language.text("recovery.title"), &mut is_open, vec2(460.0, 120.0), |ui| {
            ui.label(language.text("recovery.text"));
            ui.add_space(6.0);
            ScrollArea::vertical().max_height(320.0).auto_shrink([false, true]).show(ui, |ui| {
                for offer in &mut self.offers {
                    ui.horizontal(|ui| offer.show(ui, language, actions));
                    ui.separator();
                }
            });
            stays = !ui.button(language.text("recovery.later")).clicked();
        });
        is_open && stays && !context.input(|input| input.key_pressed(egui::Key::Escape))
    }
}

impl Offer {
    fn show(&mut self, ui: &mut Ui, language: Language, actions: &mut Vec<Action>) {
        if !std::mem::replace(&mut self.is_seen, true) {
            self.picture = self.unsaved.picture().and_then(|bytes| load(ui, &self.unsaved.title, &bytes));
        }
        let (rect, _) = ui.allocate_exact_size(vec2(SIDE, SIDE), egui::Sense::hover());
        match &self.picture {
            Some(picture) => egui::Image::new(picture).maintain_aspect_ratio(true).paint_at(ui, rect),
            None => drop(ui.painter().rect_filled(rect, 3.0, ui.visuals().extreme_bg_color)),
        }
        ui.vertical(|ui| {
            let unsaved = &self.unsaved;
            ui.label(RichText::new(&unsaved.title).strong());
            if let Some(path) = &unsaved.path {
                ui.add(egui::Label::new(RichText::new(path.display().to_string()).small()).truncate());
            }
            ui.weak(ago(unsaved.changed, language));
            ui.horizontal(|ui| {
                let open = ui.button(language.text("recovery.open"));
                open.widget_info(|| {
                    egui::WidgetInfo::labeled(
                        egui::Role::Button,
                        true,
                        language.fill("spoken.open", &[("name", &unsaved.title)]),
                    )
                });
                if open.clicked() {
                    actions.push(Action::OpenUnsaved(unsaved.clone()));
                }
                let drop = ui.button(language.text("recovery.drop"));
                drop.widget_info(|| {
                    egui::WidgetInfo::labeled(
                        egui::Role::Button,
                        true,
                        language.fill("spoken.delete", &[("name", &unsaved.title)]),
                    )
                });
                if drop.clicked() {
                    actions.push(Action::DropUnsaved(unsaved.clone()));
                }
            });
        });
    }
}

/// A small picture of a frame, as PNG.
#[must_use]
pub fn picture(frame: &Frame) -> Option<Vec<u8>> {
    let window = frame.window();
    let step = window.width.max(window.height).div_ceil(SAMPLES).max(1);
    let (columns, rows) = (window.width.div_ceil(step), window.height.div_ceil(step));
    let starts = (0..rows).flat_map(|row| (0..columns).map(move |column| 4 * (row * window.width + column) * step));
    let pixels: Vec<u8> = starts.filter_map(|at| frame.shaded.get(at..at + 4)).flatten().copied().collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, u32::try_from(columns).ok()?, u32::try_from(rows).ok()?);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().ok()?.write_image_data(&pixels).ok()?;
    Some(bytes)
}
