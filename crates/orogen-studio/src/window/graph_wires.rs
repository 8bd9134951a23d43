//! The wires of the graph: drawn, chosen with a click, and cut.

use eframe::egui::epaint::CubicBezierShape;
use eframe::egui::{Color32, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};
use orogen::declare::Input;

use super::action::Action;
use super::graph_box;
use super::graph_panel::Graph;
use crate::editing::edit::{Edit, Reader};
use crate::studio::Studio;
use crate::view::scene::{End, Kind, Scene, Wire};

/// The distance from a wire within which a click chooses it, in points.
const NEAR: f32 = 7.0;

/// Number of straight pieces of a wire, for its distance from a click.
const PIECES: usize = 24;

impl Graph {
    /// Draws the wires.
    pub(super) fn draw_wires(&mut self, ui: &Ui, painter: &Painter, scene: &Scene, rects: &[Rect], studio: &Studio) {
        if !studio.selected.is_empty() || !scene.wires.iter().any(|wire| reader_of(scene, *wire) == self.chosen) {
            self.chosen = None;
        }
        for wire in &scene.wires {
            let Some([start, end]) = self.ends(scene, rects, *wire) else { continue };
            let is_selected = |block: usize| {
                scene
                    .boxes
                    .get(block)
                    .is_some_and(|block| block.nodes.iter().any(|name| studio.selected.contains(name)))
            };
            let is_chosen = self.chosen.is_some() && reader_of(scene, *wire) == self.chosen;
            let color = if is_chosen { ui.visuals().selection.stroke.color } else { ui.visuals().weak_text_color() };
            let is_strong = is_chosen || is_selected(wire.from) || is_selected(wire.to);
            self.draw_wire(painter, start, end, is_strong, color);
        }
    }

    /// Draws a wire.
    pub(super) fn draw_wire(&self, painter: &Painter, from: Pos2, to: Pos2, is_strong: bool, color: Color32) {
        let stroke =
            Stroke::new(if is_strong { 2.2 } else { 1.3 }, if is_strong { color.gamma_multiply(1.6) } else { color });
        let points = self.curve(from, to);
        painter.add(CubicBezierShape::from_points_stroke(points, false, Color32::TRANSPARENT, stroke));
    }

    /// Chooses the wire at a position, or none.
    pub(super) fn choose_wire(&mut self, scene: &Scene, rects: &[Rect], at: Pos2) {
        let distance = |wire: &Wire| {
            let [start, end] = self.ends(scene, rects, *wire)?;
            let curve =
                CubicBezierShape::from_points_stroke(self.curve(start, end), false, Color32::TRANSPARENT, Stroke::NONE);
            let points: Vec<Pos2> = (0..=PIECES).map(|k| curve.sample(k as f32 / PIECES as f32)).collect();
            let distances = points.windows(2).map(|ends| from_line(at, ends[0], ends[1]));
            distances.min_by(f32::total_cmp)
        };
        let near = scene.wires.iter().filter_map(|wire| Some((distance(wire)?, wire)));
        let near = near.filter(|(distance, _)| *distance < NEAR).min_by(|a, b| a.0.total_cmp(&b.0));
        self.chosen = near.and_then(|(_, wire)| reader_of(scene, *wire));
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

    fn curve(&self, from: Pos2, to: Pos2) -> [Pos2; 4] {
        let bend = ((to.x - from.x).abs() * 0.5).clamp(20.0 * self.zoom, 120.0);
        [from, from + vec2(bend, 0.0), to - vec2(bend, 0.0), to]
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

/// The distance of a point from a piece of a line.
fn from_line(at: Pos2, from: Pos2, to: Pos2) -> f32 {
    let along = to - from;
    let share = ((at - from).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
    at.distance(from + along * share)
}
