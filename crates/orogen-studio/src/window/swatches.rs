//! Entries of lists of palettes: a strip of the colors, and the name.

use std::collections::HashMap;
use std::sync::LazyLock;

use eframe::egui::{self, Color32, Response, Ui, pos2, vec2};
use orogen::io::palette::named::{self, Named};

use crate::catalogue::Language;
use crate::preview::ramp::Ramp;

/// Number of colors of a strip, and the size of one in points.
const COLORS: usize = 24;
const SIZE: egui::Vec2 = vec2(3.0, 12.0);

/// The colors of all palettes, from the lowest to the highest value.
static STRIPS: LazyLock<HashMap<&'static str, Vec<Color32>>> =
    LazyLock::new(|| named::all().iter().map(|palette| (palette.name, strip(palette))).collect());

fn strip(named: &Named) -> Vec<Color32> {
    // All built-in palettes are ramps, which a test checks.
    let ramp = Ramp::of(&named.palette());
    let colors = ramp.map(|ramp| ramp.colors(COLORS)).unwrap_or_default();
    colors.into_iter().map(|[red, green, blue]| Color32::from_rgb(red, green, blue)).collect()
}

/// An entry for a palette, with its description as a hint.
pub fn entry(ui: &mut Ui, is_own: bool, palette: &Named, language: Language) -> Response {
    let row = ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(SIZE.x * COLORS as f32, SIZE.y), egui::Sense::hover());
        for (k, color) in STRIPS.get(palette.name).into_iter().flatten().enumerate() {
            let left = rect.left() + SIZE.x * k as f32;
            let part = egui::Rect::from_min_max(pos2(left, rect.top()), pos2(left + SIZE.x, rect.bottom()));
            ui.painter().rect_filled(part, 0.0, *color);
        }
        ui.selectable_label(is_own, language.named(palette.name))
    });
    row.inner.on_hover_text(language.hint(palette.name, palette.about))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_palette_has_a_strip_of_different_colors() {
        for palette in named::all() {
            let strip = &STRIPS[palette.name];
            assert_eq!(strip.len(), COLORS);
            assert_ne!(strip.first(), strip.get(COLORS / 2), "{}", palette.name);
        }
    }
}
