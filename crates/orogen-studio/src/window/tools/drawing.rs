//! Lines and areas that are drawn with clicks.

use eframe::egui::{self, Color32, Key, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2};

use super::Projection;
use super::drawn::Drawn;
use crate::catalogue::Language;
use crate::editing::drawing;
use crate::editing::edit::Edit;
use crate::studio::Studio;
use crate::window::action::Action;

/// A drawing.
#[derive(Default)]
pub struct Drawing {
    /// Its op and its points so far.
    op: &'static str,
    points: Vec<[f64; 2]>,
    /// The finished drawing, while it is asked what it does.
    drawn: Option<Drawn>,
}

impl Drawing {
    /// Discards the points.
    pub fn clear(&mut self) {
        self.points.clear();
    }

    /// Adds a point with each click; a double click or Enter ends the drawing, Escape discards it. Returns whether it
    /// is finished.
    pub fn click(&mut self, ui: &Ui, response: &Response, projection: &Projection, op: &'static str) -> bool {
        self.op = op;
        let ends = response.double_clicked() || ui.input(|input| input.key_pressed(Key::Enter));
        if response.clicked()
            && !response.double_clicked()
            && let Some(at) = response.interact_pointer_pos().and_then(|at| projection.world(at))
        {
            self.points.push(at.map(f64::round));
        }
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.points.clear();
        }
        let fewest = if op == drawing::OPS[0] { 2 } else { 3 };
        let is_finished = ends && self.points.len() >= fewest;
        if is_finished {
            let last = self.points.last().and_then(|at| projection.screen(*at));
            let at = last.unwrap_or(projection.rect.center()) + Vec2::new(12.0, 12.0);
            self.drawn = Some(Drawn::new(op, std::mem::take(&mut self.points), response.id, at));
        }
        is_finished
    }

    /// Asks what a finished drawing does.
    pub fn ask(
        &mut self,
        ui: &Ui,
        response: &Response,
        (studio, language): (&Studio, Language),
        actions: &mut Vec<Action>,
    ) {
        if self.drawn.as_ref().is_some_and(|drawn| drawn.is_answered(ui, response, studio, language, actions)) {
            self.drawn = None;
        }
    }

    /// Draws the current drawing, and the selected one.
    pub fn draw(&self, painter: &egui::Painter, projection: &Projection, studio: &Studio) {
        if !self.points.is_empty() {
            draw(painter, projection, &self.points, self.op != drawing::OPS[0] && self.points.len() > 2);
        }
        if let Some(drawn) = &self.drawn {
            draw(painter, projection, drawn.points(), drawn.op() != drawing::OPS[0]);
        }
        if let Some((name, points)) = selected(studio) {
            let nodes = studio.document.recipe().nodes();
            let is_area = nodes.iter().any(|named| named.name == name && named.node.spec().op != drawing::OPS[0]);
            draw(painter, projection, &points, is_area);
        }
    }
}

/// Number of parts of a side, which follows the ground in 3D.
const PARTS: u32 = 24;

fn draw(painter: &egui::Painter, projection: &Projection, points: &[[f64; 2]], is_closed: bool) {
    let first = points.first().filter(|_| is_closed);
    let ends: Vec<[f64; 2]> = points.iter().chain(first).copied().collect();
    let between = |k: u32, [a, b]: [[f64; 2]; 2]| {
        let share = f64::from(k) / f64::from(PARTS);
        [0, 1].map(|c| a[c] + (b[c] - a[c]) * share)
    };
    let sides = ends.windows(2).flat_map(|side| (0..PARTS).map(move |k| between(k, [side[0], side[1]])));
    let line: Vec<[f64; 2]> = sides.chain(ends.last().copied()).collect();
    for part in projection.line(&line) {
        painter.line(part.clone(), Stroke::new(4.0, Color32::from_black_alpha(150)));
        painter.line(part, Stroke::new(2.0, Color32::from_rgb(255, 240, 120)));
    }
    for point in points.iter().filter_map(|point| projection.screen(*point)) {
        painter.circle(point, 4.5, Color32::WHITE, Stroke::new(1.5, Color32::BLACK));
    }
}

/// Handles at the points of the selected drawing. Returns whether one is being dragged.
pub fn handles(
    ui: &Ui,
    projection: &Projection,
    (studio, language): (&Studio, Language),
    actions: &mut Vec<Action>,
) -> bool {
    let Some((name, mut points)) = selected(studio) else { return false };
    let mut is_moving = false;
    for k in 0..points.len() {
        let Some(at) = projection.screen(points[k]) else { continue };
        let around = Rect::from_center_size(at, Vec2::splat(14.0)).intersect(projection.rect);
        if !around.is_positive() {
            continue;
        }
        let handle = ui.interact(around, ui.scope_id().with((name, k)), Sense::drag());
        let spoken = language.fill("spoken.point", &[("number", &(k + 1).to_string()), ("name", name)]);
        handle.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, &spoken));
        if handle.dragged()
            && let Some(at) = handle.interact_pointer_pos().and_then(|at: Pos2| projection.world(at))
        {
            points[k] = at.map(f64::round);
            actions.push(Action::Edit(Edit::Param {
                node: name.to_owned(),
                key: drawing::POINTS.to_owned(),
                value: drawing::value(&points),
            }));
            is_moving = true;
        }
        if handle.drag_stopped() {
            actions.push(Action::EndGesture);
        }
    }
    is_moving
}

/// The selected drawing: the name of its node, and its points.
fn selected(studio: &Studio) -> Option<(&str, Vec<[f64; 2]>)> {
    let name = studio.selected.first()?;
    let named = studio.document.recipe().nodes().iter().find(|named| named.name == *name)?;
    Some((&named.name, drawing::points_of(&named.node)?))
}
