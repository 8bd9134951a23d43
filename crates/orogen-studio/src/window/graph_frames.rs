//! Frames around boxes of the graph: a title on a colored ground, which moves its boxes.

use eframe::egui::{
    self, Align2, Color32, Painter, PointerButton, Rect, Sense, Stroke, StrokeKind, TextEdit, Ui, pos2, vec2,
};

use super::action::Action;
use super::graph_box;
use super::graph_panel::Graph;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::kept::Kept;
use crate::studio::Studio;
use crate::view::scene::{Kind, Scene};

/// The distance between boxes and their frame, and the height of its title, in points at normal size.
const MARGIN: f32 = 16.0;
const TITLE: f32 = 26.0;

impl Graph {
    /// Shows the frames of the recipe.
    pub(super) fn show_frames(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        (scene, rects): (&Scene, &[Rect]),
        (studio, language): (&Studio, Language),
        actions: &mut Vec<Action>,
    ) {
        let kept = studio.document.kept();
        for (k, frame) in kept.frames.iter().enumerate() {
            let is_in = |at: &usize| {
                scene.boxes.get(*at).is_some_and(|block| {
                    !matches!(block.kind, Kind::Outside | Kind::Output)
                        && block.nodes.iter().any(|name| frame.nodes.contains(name))
                })
            };
            let inside: Vec<usize> = (0..scene.boxes.len()).filter(is_in).collect();
            let around = inside.iter().filter_map(|at| rects.get(*at)).fold(Rect::NOTHING, |all, own| all.union(*own));
            if !around.is_finite() {
                continue;
            }
            let around = around.expand(MARGIN * self.zoom);
            let title =
                Rect::from_min_max(around.min - vec2(0.0, TITLE * self.zoom), pos2(around.right(), around.top()));
            let whole = title.union(around);
            let color = ui.visuals().selection.bg_fill;
            painter.rect_filled(whole, 6.0 * self.zoom, color.gamma_multiply(0.18));
            painter.rect_stroke(
                whole,
                6.0 * self.zoom,
                Stroke::new(1.0, color.gamma_multiply(0.6)),
                StrokeKind::Inside,
            );
            let font = graph_box::font((14.0 * self.zoom).max(9.0));
            let ink: Color32 = ui.visuals().strong_text_color();
            painter.with_clip_rect(title.intersect(painter.clip_rect())).text(
                title.left_center() + vec2(8.0 * self.zoom, 0.0),
                Align2::LEFT_CENTER,
                &frame.title,
                font,
                ink,
            );
            let handle = ui.interact(
                title.intersect(painter.clip_rect()),
                ui.scope_id().with(("frame", k)),
                Sense::click_and_drag(),
            );
            let label = language.fill("spoken.frame", &[("name", &frame.title)]);
            handle.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if handle.dragged_by(PointerButton::Primary) {
                self.drag(inside.iter().filter_map(|at| scene.boxes.get(*at)), handle.drag_delta());
            }
            if handle.clicked() {
                actions.push(Action::Select(frame.nodes.clone()));
            }
            handle.context_menu(|ui| menu(ui, (kept, k), language, actions));
        }
    }
}

/// The menu of a frame: its title, and its end.
fn menu(ui: &mut Ui, (kept, k): (&Kept, usize), language: Language, actions: &mut Vec<Action>) {
    let Some(frame) = kept.frames.get(k) else { return };
    let mut title = frame.title.clone();
    let field = ui.add(TextEdit::singleline(&mut title).desired_width(180.0));
    field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, language.text("spoken.frame_title")));
    if field.changed() {
        actions.push(Action::Edit(Edit::FrameTitle { frame: k, title }));
    }
    if ui.button(language.text("graph.no_frame")).clicked() {
        let others = kept.frames.iter().enumerate().filter(|(at, _)| *at != k);
        let frames = others.map(|(_, frame)| frame.clone()).collect();
        actions.push(Action::Edit(Edit::Keep(Kept { frames, ..kept.clone() })));
        ui.close();
    }
}
