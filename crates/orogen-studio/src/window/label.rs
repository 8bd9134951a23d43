//! Short texts over pictures.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2, Rect, vec2};

use crate::catalogue::Language;
use crate::preview::frame::{Frame, Quality};

/// A text on a dark background.
pub fn label(painter: &Painter, at: Pos2, align: Align2, text: &str) {
    if !text.is_empty() {
        let galley = painter.layout_no_wrap(text.to_owned(), FontId::monospace(11.0), Color32::WHITE);
        let rect = align.anchor_size(at, galley.size());
        painter.rect_filled(rect.expand(4.0), 3.0, Color32::from_black_alpha(150));
        painter.galley(rect.min, galley, Color32::WHITE);
    }
}

/// Says that a picture is a draft, at the top of its view.
pub fn draft(painter: &Painter, rect: Rect, frame: &Frame, language: Language) {
    if frame.quality == Quality::Draft {
        let text = language.text("analysis.draft_long");
        let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(13.0), Color32::WHITE);
        let own = Align2::CENTER_TOP.anchor_size(rect.center_top() + vec2(0.0, 12.0), galley.size());
        painter.rect_filled(own.expand2(vec2(10.0, 5.0)), 6.0, Color32::from_black_alpha(170));
        painter.galley(own.min, galley, Color32::WHITE);
    }
}
