//! Reroutes of the graph: points through which a wire runs. They are added, moved and removed.

use eframe::egui::{
    self, EventFilter, Id, Key, Painter, PointerButton, Pos2, Rect, Response, Sense, Ui, UiBuilder, Vec2,
};

use super::action::Action;
use super::graph_panel::Graph;
use super::graph_route::{Moved, Route, near};
use super::wire_curve;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::reroutes::{MAX_POINTS, Reroute};
use crate::studio::Studio;

/// The radius of a point, and the side of the square in which it is clicked, in points at normal size.
const RADIUS: f32 = 4.5;
const SIDE: f32 = 16.0;

/// The way of a point with one press of an arrow key, in points at normal size.
const STEP: f32 = 10.0;

const ARROWS: [(Key, Vec2); 4] = [
    (Key::ArrowLeft, Vec2::LEFT),
    (Key::ArrowRight, Vec2::RIGHT),
    (Key::ArrowUp, Vec2::UP),
    (Key::ArrowDown, Vec2::DOWN),
];

/// The edit that removes a point of a wire.
fn without(reroute: &Reroute, point: usize) -> Edit {
    let others = reroute.points.iter().enumerate().filter(|(k, _)| *k != point);
    Edit::Reroute(Reroute { points: others.map(|(_, point)| *point).collect(), ..reroute.clone() })
}

impl Graph {
    /// Handles a click on the background, which chooses the wire there, adds a point to it or opens its menu. Returns
    /// whether it was a double click or a right click on a wire.
    fn click_wire(&mut self, background: &Response, routes: &[Route], actions: &mut Vec<Action>) -> bool {
        let pointer = background.interact_pointer_pos();
        if !background.clicked() && !background.secondary_clicked() {
            return false;
        }
        let found = pointer.and_then(|at| Some((near(routes, at)?, at)));
        self.chosen = found.map(|(route, _)| route.reroute.reader.clone());
        (self.reroutes.menu, self.reroutes.selected) = (None, None);
        let Some((route, at)) = found else { return false };
        if background.secondary_clicked() {
            self.reroutes.menu = Some((route.reroute.clone(), at));
            actions.push(Action::Select(Vec::new()));
            return true;
        }
        if background.double_clicked() {
            self.add_point(route, at, actions);
            return true;
        }
        false
    }

    /// Adds a point to a wire, where it is nearest to a position.
    fn add_point(&mut self, route: &Route, at: Pos2, actions: &mut Vec<Action>) {
        let mut reroute = route.reroute.clone();
        let Some((piece, on, _)) = wire_curve::nearest(&route.pieces, at) else { return };
        if reroute.points.len() >= MAX_POINTS {
            return;
        }
        let at = self.in_graph(route.ends, on);
        reroute.points.insert(piece.min(reroute.points.len()), wire_curve::kept(at, self.normal(route.ends)));
        self.reroutes.selected = Some((reroute.clone(), piece));
        self.chosen = None;
        actions.push(Action::Edit(Edit::Reroute(reroute)));
    }

    /// The ends of a wire at normal size, from its start.
    fn normal(&self, [start, end]: [Pos2; 2]) -> [Pos2; 2] {
        [Pos2::ZERO, ((end - start) / self.zoom).to_pos2()]
    }

    /// A position at normal size, from the start of a wire.
    fn in_graph(&self, [start, _]: [Pos2; 2], at: Pos2) -> Pos2 {
        ((at - start) / self.zoom).to_pos2()
    }

    /// The positions of the points of a wire on the screen.
    pub(super) fn places_of_points(&self, points: &[[f64; 3]], ends: [Pos2; 2]) -> Vec<Pos2> {
        let normal = self.normal(ends);
        points.iter().map(|point| ends[0] + wire_curve::place(*point, normal).to_vec2() * self.zoom).collect()
    }

    /// Shows the points of the wires, and makes wires and points reachable without a mouse. Returns whether a wire was
    /// double-clicked or right-clicked.
    pub(super) fn show_reroutes(
        &mut self,
        ui: &mut Ui,
        (painter, background): (&Painter, &Response),
        routes: &[Route],
        (studio, language): (&Studio, Language),
        actions: &mut Vec<Action>,
    ) -> bool {
        let is_on_wire = self.click_wire(background, routes, actions);
        let is_delete = ui.input(|input| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace));
        // The mouse reaches wires through the background: these items are for the keyboard and for screen readers.
        let mut keys = ui.new_child(UiBuilder::new());
        keys.set_clip_rect(Rect::NOTHING);
        for route in routes {
            let end = route.reroute.end();
            let names = [("from", route.reroute.from.as_str()), ("to", end.as_str())];
            let Some((_, middle)) = wire_curve::middle(&route.pieces) else { continue };
            let id = ui.scope_id().with(("wire", names, &route.reroute.group));
            let item = keys.interact(Rect::from_center_size(middle, Vec2::splat(SIDE)), id, Sense::click());
            let label = language.fill("spoken.wire", &names);
            item.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if item.has_focus() {
                if is_delete {
                    self.chosen = Some(route.reroute.reader.clone());
                    self.cut_wire(studio, actions);
                }
                painter.circle_stroke(middle, SIDE * 0.5, ui.visuals().selection.stroke);
            }
            if item.clicked() {
                self.add_point(route, middle, actions);
            }
            for point in 0..route.points.len() {
                self.show_point(ui, painter, (route, point), id, is_delete, language, actions);
            }
        }
        self.finish_move(ui, studio, actions);
        self.wire_menu(background, routes, (studio, language), actions);
        is_on_wire
    }

    #[allow(clippy::too_many_arguments, reason = "all of it is of this one point")]
    fn show_point(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        (route, point): (&Route, usize),
        wire: Id,
        is_delete: bool,
        language: Language,
        actions: &mut Vec<Action>,
    ) {
        let Some(at) = route.points.get(point).copied() else { return };
        let side = SIDE * self.zoom.max(0.6);
        let square = Rect::from_center_size(at, Vec2::splat(side)).intersect(painter.clip_rect());
        let item = ui.interact(square, wire.with(point), Sense::click_and_drag());
        let (number, end) = ((point + 1).to_string(), route.reroute.end());
        let names = [("number", number.as_str()), ("from", route.reroute.from.as_str()), ("to", end.as_str())];
        let label = language.fill("spoken.reroute", &names);
        item.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
        let has_focus = item.has_focus();
        if item.secondary_clicked() || item.double_clicked() || is_delete && has_focus {
            self.reroutes.selected = None;
            actions.push(Action::Edit(without(&route.reroute, point)));
            return;
        }
        if is_delete && item.hovered() {
            // The graph removes the selected point.
            self.reroutes.selected = Some((route.reroute.clone(), point));
        }
        if item.clicked() || item.drag_started_by(PointerButton::Primary) {
            self.reroutes.selected = Some((route.reroute.clone(), point));
            self.chosen = None;
            actions.push(Action::Select(Vec::new()));
        }
        let mut by = if item.dragged_by(PointerButton::Primary) { item.drag_delta() / self.zoom } else { Vec2::ZERO };
        if has_focus {
            let arrows = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(item.id, arrows));
            by += ui.input(|input| {
                let steps = ARROWS.map(|(key, way)| way * STEP * input.num_presses(key) as f32);
                steps.into_iter().fold(Vec2::ZERO, |sum, step| sum + step)
            });
        }
        if by != Vec2::ZERO {
            self.move_point(route, point, by);
        }
        let visuals = ui.visuals();
        let is_marked = has_focus || self.reroutes.is_selected(route, point);
        let color = match (is_marked, item.hovered()) {
            (true, _) => visuals.selection.stroke.color,
            (false, true) => visuals.strong_text_color(),
            (false, false) => visuals.text_color(),
        };
        let radius = (RADIUS * self.zoom).clamp(2.0, 9.0) + if item.hovered() || is_marked { 1.0 } else { 0.0 };
        painter.circle_filled(at, radius, color);
        if has_focus {
            painter.circle_stroke(at, radius + 3.0, visuals.selection.stroke);
        }
        item.on_hover_text(language.text("graph.point_help"));
    }

    fn move_point(&mut self, route: &Route, point: usize, by: Vec2) {
        let is_it = |moved: &Moved| moved.point == point && moved.reroute.is_same_wire(&route.reroute);
        let known = self.reroutes.moved.take().filter(is_it);
        let begun = || {
            let at = route.points.get(point).map_or(Pos2::ZERO, |at| self.in_graph(route.ends, *at));
            Moved { reroute: route.reroute.clone(), point, at }
        };
        let mut moved = known.unwrap_or_else(begun);
        moved.at += by;
        if let Some(kept) = moved.reroute.points.get_mut(point) {
            *kept = wire_curve::kept(moved.at, self.normal(route.ends));
        }
        self.reroutes.moved = Some(moved);
    }

    /// Writes the position of a moved point when its gesture ends; Escape gives it up.
    fn finish_move(&mut self, ui: &Ui, studio: &Studio, actions: &mut Vec<Action>) {
        let Some(moved) = &self.reroutes.moved else { return };
        let (is_held, is_given_up) = ui.input(|input| {
            let is_held = input.pointer.any_down() || ARROWS.iter().any(|(key, _)| input.key_down(*key));
            (is_held, input.key_pressed(Key::Escape))
        });
        if is_held && !is_given_up {
            return;
        }
        let known = studio.document.kept().reroutes.contains(&moved.reroute);
        if !is_given_up && !known {
            actions.push(Action::Edit(Edit::Reroute(moved.reroute.clone())));
        }
        self.reroutes.moved = None;
    }

    /// Removes the selected point. Returns whether there was one.
    pub(super) fn remove_point(&mut self, studio: &Studio, actions: &mut Vec<Action>) -> bool {
        let Some((mut wire, point)) = self.reroutes.selected.take() else { return false };
        self.reroutes.fill(&mut wire, studio);
        actions.push(Action::Edit(without(&wire, point)));
        true
    }

    /// The menu of the wire that was clicked.
    fn wire_menu(
        &mut self,
        background: &Response,
        routes: &[Route],
        (studio, language): (&Studio, Language),
        actions: &mut Vec<Action>,
    ) {
        let Some((wire, at)) = self.reroutes.menu.clone() else { return };
        let Some(route) = routes.iter().find(|route| route.reroute.is_same_wire(&wire)) else { return };
        background.context_menu(|ui| {
            let mut entry = |text: &'static str| {
                let is_clicked = ui.button(language.text(text)).clicked();
                if is_clicked {
                    ui.close();
                }
                is_clicked
            };
            if route.points.len() < MAX_POINTS && entry("graph.add_point") {
                self.add_point(route, at, actions);
            }
            if !route.points.is_empty() && entry("graph.remove_points") {
                let straight = Reroute { points: Vec::new(), ..route.reroute.clone() };
                actions.push(Action::Edit(Edit::Reroute(straight)));
            }
            if entry("graph.cut") {
                self.chosen = Some(route.reroute.reader.clone());
                self.cut_wire(studio, actions);
            }
        });
    }
}
