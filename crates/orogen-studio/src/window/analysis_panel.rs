//! Statistics of the shown layer: histogram, hypsometric curve, range.

use eframe::egui::{self, Align2, Color32, FontId, Rect, RichText, Sense, Stroke, Ui, Vec2, pos2};

use crate::catalogue::Language;
use crate::preview::frame::{Frame, Quality};
use crate::preview::statistics::BARS;
use crate::studio::Studio;

/// Shows the panel.
pub fn show(ui: &mut Ui, studio: &Studio, language: Language) {
    let Some(frame) = &studio.frame else {
        ui.weak(language.text("analysis.none"));
        return;
    };
    ui.horizontal_top(|ui| {
        figures(ui, frame, language);
        ui.separator();
        let width = (ui.available_width() / 2.0 - 12.0).max(120.0);
        chart(ui, width, language.text("analysis.histogram"), frame, |painter, rect, color| {
            let bars = &frame.statistics.histogram;
            let highest = bars.iter().copied().fold(0.0, f32::max).max(1e-9);
            for (k, share) in bars.iter().enumerate() {
                let x = |k: usize| rect.left() + rect.width() * k as f32 / BARS as f32;
                let top = rect.bottom() - rect.height() * share / highest;
                painter.rect_filled(
                    Rect::from_min_max(pos2(x(k), top), pos2(x(k + 1) - 1.0, rect.bottom())),
                    0.0,
                    color,
                );
            }
        });
        chart(ui, width, language.text("analysis.curve"), frame, |painter, rect, color| {
            let curve = &frame.statistics.curve;
            let points = curve.iter().enumerate().map(|(k, share)| {
                let x = rect.left() + rect.width() * k as f32 / BARS as f32;
                pos2(x, rect.bottom() - rect.height() * *share as f32)
            });
            painter.line(points.collect(), Stroke::new(2.0, color));
        });
    });
}

fn figures(ui: &mut Ui, frame: &Frame, language: Language) {
    let figures = &frame.statistics;
    let unit = if frame.unit.is_empty() { String::new() } else { format!(" {}", language.named(frame.unit)) };
    let quality = match frame.quality {
        Quality::Draft => "analysis.draft",
        Quality::Coarse => "analysis.coarse",
        Quality::Fine => "analysis.fine",
    };
    let window = frame.window();
    egui::Grid::new("figures").num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
        for (name, value) in [
            ("analysis.highest", format!("{}{unit}", short(f64::from(figures.range[1])))),
            ("analysis.mean", format!("{}{unit}", short(figures.mean))),
            ("analysis.lowest", format!("{}{unit}", short(f64::from(figures.range[0])))),
            ("analysis.land", format!("{:.1} %", figures.land * 100.0)),
            ("analysis.samples", format!("{} × {}", window.width, window.height)),
            ("analysis.cell", format!("{} m", short(window.cell))),
            ("analysis.quality", language.text(quality).to_owned()),
        ] {
            ui.weak(language.text(name));
            ui.label(RichText::new(value).monospace());
            ui.end_row();
        }
    });
}

/// A number with four digits.
#[must_use]
pub fn short(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let digits = match value.abs() {
        size if size >= 1000.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 0.1 || size == 0.0 => 2,
        _ => 5,
    };
    format!("{value:.digits$}")
}

fn chart(ui: &mut Ui, width: f32, title: &str, frame: &Frame, draw: impl FnOnce(&egui::Painter, Rect, Color32)) {
    ui.vertical(|ui| {
        ui.weak(title);
        let size = Vec2::new(width, (ui.available_height() - 6.0).clamp(60.0, 400.0));
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
        let inner = Rect::from_min_max(rect.min + Vec2::splat(6.0), rect.max - Vec2::new(6.0, 18.0));
        draw(&painter, inner, ui.visuals().selection.bg_fill);
        let font = FontId::proportional(10.0);
        let color = ui.visuals().weak_text_color();
        let [low, high] = frame.statistics.range.map(|end| short(f64::from(end)));
        painter.text(rect.left_bottom() + Vec2::new(6.0, -3.0), Align2::LEFT_BOTTOM, low, font.clone(), color);
        painter.text(rect.right_bottom() + Vec2::new(-6.0, -3.0), Align2::RIGHT_BOTTOM, high, font, color);
    });
}
