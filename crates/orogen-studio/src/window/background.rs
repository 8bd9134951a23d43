//! The background of a panel, which leaves out what a picture covers.

use eframe::egui::{self, Color32, Frame, Rect, Ui};

/// The background of the panel of the view. It is not drawn below the picture of the land: where a CPU draws, it would
/// take as much time as the picture.
pub struct Background {
    shape: egui::layers::ShapeIdx,
    rect: Rect,
}

impl Background {
    /// Reserves its place below all that follows.
    #[must_use]
    pub fn new(ui: &Ui) -> Background {
        Background { shape: ui.painter().add(egui::Shape::Noop), rect: ui.clip_rect() }
    }

    /// Draws it around a covered rectangle.
    pub fn draw(self, ui: &Ui, covered: Rect) {
        let (all, fill) = (self.rect, ui.visuals().panel_fill);
        // The edges are drawn below the picture, which may begin between two pixels.
        let hole = covered.shrink(2.0);
        let sides = if hole.is_positive() {
            vec![
                Rect::from_min_max(all.min, egui::pos2(all.right(), hole.top())),
                Rect::from_min_max(egui::pos2(all.left(), hole.bottom()), all.max),
                Rect::from_min_max(egui::pos2(all.left(), hole.top()), hole.left_bottom()),
                Rect::from_min_max(hole.right_top(), egui::pos2(all.right(), hole.bottom())),
            ]
        } else {
            vec![all]
        };
        let sides = sides.into_iter().map(|side| egui::Shape::rect_filled(side, 0.0, fill));
        ui.painter().set(self.shape, egui::Shape::Vec(sides.collect()));
    }
}

/// The frame of a panel whose background is drawn on its own.
pub fn clear(ui: &Ui) -> Frame {
    Frame::central_panel(ui.style()).fill(Color32::TRANSPARENT)
}
