//! A comparison of the visible land with real land.

use std::sync::Arc;

use eframe::egui::{Color32, RichText, ScrollArea, Sense, Stroke, Ui, Vec2, pos2, vec2};
use orogen::output::survey::Measures;
use orogen::output::survey::real::{FIGURES, Figure, SOURCE};

use crate::catalogue::Language;
use crate::preview::frame::Quality;
use crate::preview::survey::Survey;
use crate::preview::worker::Wake;
use crate::studio::Studio;

/// State of the panel.
pub struct RealismPanel {
    survey: Survey,
}

/// Width of a column of statistics, and of the bar of each.
const COLUMN: f32 = 470.0;
const BAR: f32 = 130.0;

/// Values beyond this many times the distance from the median to the 10 % or 90 % quantile are drawn at the end of the
/// bar.
const FURTHEST: f64 = 3.0;

impl RealismPanel {
    /// A panel without statistics.
    #[must_use]
    pub fn new(wake: Wake) -> RealismPanel {
        RealismPanel { survey: Survey::new(wake) }
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language) {
        // Drafts and coarse pictures are not worth measuring.
        if let Some(frame) = studio.frame.as_ref().filter(|frame| frame.quality == Quality::Fine) {
            self.survey.ask(&studio.session(), frame);
        }
        let is_busy = self.survey.is_busy();
        ui.horizontal(|ui| {
            ui.weak(language.text("real.about")).on_hover_text(SOURCE);
            if is_busy {
                ui.spinner();
            }
        });
        match self.survey.outcome() {
            None => drop(ui.weak(language.text("real.waiting"))),
            Some(Ok(None)) => drop(ui.label(language.text("real.too_little"))),
            Some(Err(error)) => {
                drop(ui.colored_label(ui.visuals().error_fg_color, language.message(&error.to_string())))
            }
            Some(Ok(Some(measures))) => {
                let measures = Arc::new(measures.clone());
                ScrollArea::both().auto_shrink(false).show(ui, |ui| table(ui, &measures, language));
            }
        }
    }
}

/// All statistics, in as many columns as fit.
fn table(ui: &mut Ui, measures: &Measures, language: Language) {
    let columns = ((ui.available_width() / COLUMN) as usize).clamp(1, 3);
    let rows = FIGURES.len().div_ceil(columns);
    ui.horizontal_top(|ui| {
        for (k, figures) in FIGURES.chunks(rows).enumerate() {
            ui.vertical(|ui| {
                eframe::egui::Grid::new(("figures", k)).num_columns(4).spacing([10.0, 3.0]).show(ui, |ui| {
                    for figure in figures {
                        row(ui, figure, measures, language);
                        ui.end_row();
                    }
                });
            });
            ui.add_space(16.0);
        }
    });
}

fn row(ui: &mut Ui, figure: &Figure, measures: &Measures, language: Language) {
    ui.label(name(figure.key, language).unwrap_or(figure.name));
    let Some(value) = figure.value(measures) else {
        ui.weak("–");
        ui.weak("");
        ui.weak(language.text("real.none"));
        return;
    };
    ui.label(RichText::new(format!("{} {}", figure.text(value), figure.unit)).monospace());
    let place = figure.place(value);
    let color = color(place);
    let [low, middle, high] = figure.real.map(|value| figure.text(value));
    let (rect, bar) = ui.allocate_exact_size(vec2(BAR, 14.0), Sense::hover());
    bar.on_hover_text(language.fill("real.range", &[("low", &low), ("middle", &middle), ("high", &high)]));
    let painter = ui.painter();
    let x = |place: f64| rect.center().x + (place.clamp(-FURTHEST, FURTHEST) / FURTHEST) as f32 * (BAR / 2.0 - 5.0);
    painter.line_segment(
        [pos2(rect.left(), rect.center().y), pos2(rect.right(), rect.center().y)],
        Stroke::new(1.0, Color32::from_gray(110)),
    );
    let usual = eframe::egui::Rect::from_center_size(rect.center(), Vec2::new(x(1.0) - x(-1.0), 6.0));
    painter.rect_filled(usual, 2.0, Color32::from_gray(110));
    painter.vline(x(0.0), usual.y_range(), Stroke::new(1.0, ui.visuals().text_color()));
    painter.circle(pos2(x(place), rect.center().y), 4.5, color, Stroke::new(1.0, Color32::BLACK));
    let verdict = match place {
        place if place < -2.0 => "real.far_below",
        place if place < -1.0 => "real.below",
        place if place <= 1.0 => "real.as_real",
        place if place <= 2.0 => "real.above",
        _ => "real.far_above",
    };
    ui.colored_label(color, language.text(verdict));
}

/// Green within the usual range, yellow outside, red far outside.
fn color(place: f64) -> Color32 {
    match place.abs() {
        distance if distance <= 1.0 => Color32::from_rgb(110, 190, 110),
        distance if distance <= 2.0 => Color32::from_rgb(220, 180, 80),
        _ => Color32::from_rgb(225, 110, 95),
    }
}

/// The name of a statistic in the language of the interface.
fn name(key: &str, language: Language) -> Option<&'static str> {
    NAMES.iter().find(|(of, _)| *of == key).map(|(_, text)| language.text(text))
}

/// The texts of the statistics by key.
const NAMES: [(&str, &str); 24] = [
    ("relief", "figure.relief"),
    ("hypsometric_integral", "figure.hypsometric_integral"),
    ("slope_mean", "figure.slope_mean"),
    ("slope_p90", "figure.slope_p90"),
    ("slope_spread", "figure.slope_spread"),
    ("slope_patches", "figure.slope_patches"),
    ("ruggedness", "figure.ruggedness"),
    ("curvature", "figure.curvature"),
    ("curvature_skew", "figure.curvature_skew"),
    ("spectrum", "figure.spectrum"),
    ("hurst", "figure.hurst"),
    ("grid_bias", "figure.grid_bias"),
    ("depressions", "figure.depressions"),
    ("depression_depth", "figure.depression_depth"),
    ("area_exponent", "figure.area_exponent"),
    ("hack", "figure.hack"),
    ("concavity", "figure.concavity"),
    ("bifurcation", "figure.bifurcation"),
    ("length_ratio", "figure.length_ratio"),
    ("drainage_density", "figure.drainage_density"),
    ("wetness", "figure.wetness"),
    ("valleys", "figure.valleys"),
    ("ridges", "figure.ridges"),
    ("slopes", "figure.slopes"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_has_a_name_in_every_language() {
        for figure in FIGURES {
            assert!(Language::ALL.into_iter().all(|language| name(figure.key, language).is_some()), "{}", figure.key);
            assert_eq!(name(figure.key, Language::English), Some(figure.name));
        }
        assert_eq!(NAMES.len(), FIGURES.len());
    }
}
