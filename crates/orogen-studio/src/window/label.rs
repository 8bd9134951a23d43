//! Short texts over pictures.

use eframe::egui::{Align2, Color32, FontId, Painter, Pos2};

/// A text on a dark background.
pub fn label(painter: &Painter, at: Pos2, align: Align2, text: &str) {
    if !text.is_empty() {
        let galley = painter.layout_no_wrap(text.to_owned(), FontId::monospace(11.0), Color32::WHITE);
        let rect = align.anchor_size(at, galley.size());
        painter.rect_filled(rect.expand(4.0), 3.0, Color32::from_black_alpha(150));
        painter.galley(rect.min, galley, Color32::WHITE);
    }
}
