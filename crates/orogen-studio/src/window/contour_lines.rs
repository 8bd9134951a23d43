//! Contour lines on the map.

use std::sync::Arc;

use eframe::egui::epaint::TextShape;
use eframe::egui::{Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2};

use crate::preview::contours::Contours;
use crate::preview::frame::{Frame, Key};
use crate::view::map_view::MapView;

/// The last drawing, which is reused while neither the picture nor the view changes.
#[derive(Default)]
pub struct ContourLines {
    drawn: Option<((Key, MapView, Rect), Vec<Shape>)>,
}

/// Distance between two labels of a line, and minimum distance between labels of different lines, in points of the
/// view.
const BETWEEN: f32 = 420.0;
const APART: f32 = 70.0;

/// Minimum distance between two vertices of a line, in points of the view.
const STEP: f32 = 1.2;

const COLOR: Color32 = Color32::from_rgb(70, 48, 30);

impl ContourLines {
    /// Draws the contours of a picture.
    pub fn draw(&mut self, painter: &Painter, rect: Rect, frame: &Frame, view: &MapView) {
        let Some(contours) = &frame.contours else { return };
        let key = (frame.key(), *view, rect);
        let shapes = match &self.drawn {
            Some((own, shapes)) if *own == key => shapes.clone(),
            _ => shapes(painter, rect, contours, view),
        };
        painter.extend(shapes.iter().cloned());
        self.drawn = Some((key, shapes));
    }
}

fn shapes(painter: &Painter, rect: Rect, contours: &Arc<Contours>, view: &MapView) -> Vec<Shape> {
    let size = [rect.width(), rect.height()];
    let near = rect.expand(40.0);
    let (mut lines, mut labels, mut places) = (Vec::new(), Vec::new(), Vec::<Pos2>::new());
    for line in &contours.lines {
        let is_index = contours.is_index(line);
        let stroke = if is_index {
            Stroke::new(1.4, COLOR.gamma_multiply(0.85))
        } else {
            Stroke::new(0.8, COLOR.gamma_multiply(0.6))
        };
        let mut part: Vec<Pos2> = Vec::new();
        // The first label comes after half of the distance.
        let mut way = BETWEEN / 2.0;
        for point in line.path() {
            let [x, y] = view.screen(point, size);
            let at = rect.min + Vec2::new(x, y);
            if !near.contains(at) {
                if part.len() > 1 {
                    lines.push(Shape::line(std::mem::take(&mut part), stroke));
                }
                part.clear();
                continue;
            }
            let Some(last) = part.last().copied() else {
                part.push(at);
                continue;
            };
            let step = last.distance(at);
            if step < STEP {
                continue;
            }
            way += step;
            part.push(at);
            if is_index && way > BETWEEN && places.iter().all(|place| place.distance(at) > APART) {
                way = 0.0;
                places.push(at);
                // The direction is taken over several points, so that small corners do not rotate the label.
                let before = part[part.len().saturating_sub(8)];
                labels.push(label(painter, at, at - before, line.elevation));
            }
        }
        if part.len() > 1 {
            lines.push(Shape::line(part, stroke));
        }
    }
    lines.extend(labels.into_iter().flatten());
    lines
}

/// The height at a position, along a direction, with a light edge. It is never upside down.
fn label(painter: &Painter, at: Pos2, along: Vec2, elevation: f64) -> Vec<Shape> {
    let text = orogen::grid::words::number(elevation);
    let angle = libm::atan2f(along.y, along.x);
    let angle = match angle.abs() > std::f32::consts::FRAC_PI_2 {
        true => angle - std::f32::consts::PI * angle.signum(),
        false => angle,
    };
    let font = FontId::proportional(10.5);
    let make = |color: Color32, by: Vec2| {
        let galley = painter.layout_no_wrap(text.clone(), font.clone(), color);
        let half = galley.size() / 2.0;
        let (sine, cosine) = (libm::sinf(angle), libm::cosf(angle));
        let corner = at - Vec2::new(half.x * cosine - half.y * sine, half.x * sine + half.y * cosine) + by;
        Shape::Text(TextShape::new(corner, galley, color).with_angle(angle))
    };
    let edge = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
    let light = Color32::from_rgba_unmultiplied(250, 246, 232, 170);
    let mut shapes: Vec<Shape> = edge.into_iter().map(|(x, y)| make(light, Vec2::new(x, y))).collect();
    shapes.push(make(COLOR, Vec2::ZERO));
    shapes
}
