//! The wires of the graph: drawn, chosen with a click, and cut.

use eframe::egui::epaint::CubicBezierShape;
use eframe::egui::{Color32, Painter, Pos2, Rect, Stroke, Ui, pos2};
use orogen::declare::Input;

use super::action::Action;
use super::graph_box;
use super::graph_panel::Graph;
use super::graph_route::Route;
use super::wire_curve::{self, Piece};
use crate::editing::edit::Edit;
use crate::editing::reader::Reader;
use crate::editing::reroutes::Reroute;
use crate::studio::Studio;
use crate::view::scene::{End, Kind, Scene, Wire};

impl Graph {
    /// The wires on the screen.
    pub(super) fn routes(&self, scene: &Scene, rects: &[Rect], studio: &Studio) -> Vec<Route> {
        let route = |wire: &Wire| {
            let ends = self.ends(scene, rects, *wire)?;
            let from = scene.boxes.get(wire.from)?.outlets.get(wire.outlet)?.clone();
            let reader = reader_of(scene, *wire)?;
            let mut reroute = Reroute { from, reader, group: self.group.clone(), points: Vec::new() };
            self.reroutes.fill(&mut reroute, studio);
            let points = self.places_of_points(&reroute.points, ends);
            let pieces = wire_curve::pieces(ends[0], &points, ends[1], self.zoom);
            Some(Route { wire: *wire, reroute, ends, points, pieces })
        };
        scene.wires.iter().filter_map(route).collect()
    }

    /// Draws the wires.
    pub(super) fn draw_wires(&mut self, ui: &Ui, painter: &Painter, scene: &Scene, routes: &[Route], studio: &Studio) {
        let is_chosen = |route: &Route, chosen: &Option<Reader>| chosen.as_ref() == Some(&route.reroute.reader);
        if !studio.selected.is_empty() || !routes.iter().any(|route| is_chosen(route, &self.chosen)) {
            self.chosen = None;
        }
        if !studio.selected.is_empty() {
            self.reroutes.deselect();
        }
        for route in routes {
            let is_selected = |block: usize| {
                scene
                    .boxes
                    .get(block)
                    .is_some_and(|block| block.nodes.iter().any(|name| studio.selected.contains(name)))
            };
            let is_chosen = is_chosen(route, &self.chosen);
            let color = if is_chosen { ui.visuals().selection.stroke.color } else { ui.visuals().weak_text_color() };
            let is_strong = is_chosen || is_selected(route.wire.from) || is_selected(route.wire.to);
            draw(painter, &route.pieces, is_strong, color);
        }
    }

    /// Draws a wire.
    pub(super) fn draw_wire(&self, painter: &Painter, from: Pos2, to: Pos2, is_strong: bool, color: Color32) {
        draw(painter, &wire_curve::pieces(from, &[], to, self.zoom), is_strong, color);
    }

    /// Cuts the chosen wire. Returns whether there was one.
    pub(super) fn cut_wire(&mut self, studio: &Studio, actions: &mut Vec<Action>) -> bool {
        let Some(reader) = self.chosen.take() else { return false };
        actions.push(Action::Edit(match reader {
            Reader::Output(name) => Edit::Output { name, source: Input::None },
            Reader::Input { node, key } => {
                let named = studio.document.recipe().nodes().iter().find(|named| named.name == node);
                let is_required = named.is_some_and(|named| {
                    named.node.spec().inputs.iter().any(|input| input.name == key && input.required)
                });
                // An input that must be given becomes a number.
                let source = if is_required { Input::Value(0.0) } else { Input::None };
                Edit::Connect { node, input: key, source }
            }
        }));
        true
    }

    /// The ends of a wire on the screen.
    fn ends(&self, scene: &Scene, rects: &[Rect], wire: Wire) -> Option<[Pos2; 2]> {
        let (from, to) = (scene.boxes.get(wire.from)?, scene.boxes.get(wire.to)?);
        let (start, end) = (*rects.get(wire.from)?, *rects.get(wire.to)?);
        let start = graph_box::at(start, graph_box::outlet(from, wire.outlet), self.zoom, true);
        let end = match wire.end {
            End::Mask => pos2(end.center().x, end.top()),
            End::Port(k) => graph_box::at(end, graph_box::port(to, k), self.zoom, false),
        };
        Some([start, end])
    }
}

/// What reads through a wire.
fn reader_of(scene: &Scene, wire: Wire) -> Option<Reader> {
    let block = scene.boxes.get(wire.to)?;
    Some(match (block.kind, wire.end) {
        (Kind::Output, _) => Reader::Output(block.title.clone()),
        (_, End::Mask) => Reader::Input { node: block.id.clone(), key: "mask".to_owned() },
        (_, End::Port(k)) => {
            let port = block.ports.get(k)?;
            Reader::Input { node: port.node.clone(), key: port.key.clone() }
        }
    })
}

fn draw(painter: &Painter, pieces: &[Piece], is_strong: bool, color: Color32) {
    let stroke =
        Stroke::new(if is_strong { 2.2 } else { 1.3 }, if is_strong { color.gamma_multiply(1.6) } else { color });
    for piece in pieces {
        painter.add(CubicBezierShape::from_points_stroke(*piece, false, Color32::TRANSPARENT, stroke));
    }
}
