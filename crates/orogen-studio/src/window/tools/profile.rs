//! The profile of the land along a line.

use eframe::egui::{self, Align2, Color32, FontId, PointerButton, Pos2, Rect, Response, Stroke, Ui, Vec2, pos2};

use super::Projection;
use crate::preview::frame::Frame;

/// A profile.
#[derive(Default)]
pub struct Profile {
    /// The ends of its line, in metres.
    ends: Option<[[f64; 2]; 2]>,
}

/// Number of parts of the line.
const STEPS: u32 = 200;

impl Profile {
    /// Whether there is a line.
    #[must_use]
    pub fn is_there(&self) -> bool {
        self.ends.is_some()
    }

    /// Draws the line by a drag.
    pub fn drag(&mut self, response: &Response, projection: &Projection) {
        if response.dragged_by(PointerButton::Primary)
            && let Some(here) = response.interact_pointer_pos().and_then(|at| projection.world(at))
        {
            match &mut self.ends {
                Some([_, end]) if !response.drag_started() => *end = here,
                ends => *ends = Some([here, here]),
            }
        }
    }

    /// Draws the line and a chart of the values along it.
    pub fn draw(&self, ui: &Ui, painter: &egui::Painter, projection: &Projection, frame: &Frame) {
        let Some([from, to]) = self.ends else { return };
        let at = |k: u32| {
            let share = f64::from(k) / f64::from(STEPS);
            [0, 1].map(|c| from[c] + (to[c] - from[c]) * share)
        };
        let line: Vec<[f64; 2]> = (0..=STEPS).map(at).collect();
        for part in projection.line(&line) {
            painter.line(part.clone(), Stroke::new(3.0, Color32::from_black_alpha(160)));
            painter.line(part, Stroke::new(1.5, Color32::from_rgb(255, 214, 90)));
        }
        let values: Vec<Option<f32>> = line.iter().map(|at| frame.at(*at).map(|[value, _]| value)).collect();
        let finite: Vec<f32> = values.iter().flatten().copied().filter(|value| value.is_finite()).collect();
        let low = finite.iter().copied().fold(f32::INFINITY, f32::min);
        let high = finite.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        if finite.len() < 2 {
            return;
        }
        let rect = projection.rect;
        let size = Vec2::new((rect.width() - 24.0).clamp(60.0, 420.0), 96.0);
        let chart = Rect::from_min_size(rect.right_bottom() - size - Vec2::splat(12.0), size);
        painter.rect_filled(chart, 4.0, ui.visuals().window_fill.gamma_multiply(0.92));
        let inner = chart.shrink2(Vec2::new(8.0, 16.0));
        let points: Vec<Pos2> = values
            .iter()
            .enumerate()
            .filter_map(|(k, value)| {
                let share = ((*value)? - low) / (high - low).max(1e-6);
                let right = inner.left() + inner.width() * k as f32 / STEPS as f32;
                Some(pos2(right, inner.bottom() - inner.height() * share))
            })
            .collect();
        painter.line(points, Stroke::new(1.5, ui.visuals().selection.bg_fill));
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let text = format!("{low:.1} – {high:.1} {}, {length:.0} m", frame.unit);
        let at = chart.left_top() + Vec2::new(8.0, 2.0);
        painter.text(at, Align2::LEFT_TOP, text, FontId::proportional(11.0), ui.visuals().text_color());
    }
}
