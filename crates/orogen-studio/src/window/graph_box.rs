//! The appearance of a box of the graph, and the positions of its inputs and outputs.

use eframe::egui::text::{LayoutJob, TextWrapping};
use eframe::egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, TextureHandle, Vec2, Visuals, pos2, vec2,
};
use orogen::declare::spec::Locality;

use crate::catalogue::Language;
use crate::view::scene::{GraphBox, Kind};

/// The width of a box at normal size.
pub const WIDTH: f32 = 150.0;
const TITLE: f32 = 34.0;
const ROW: f32 = 15.0;
/// The side of the small picture.
const PICTURE: f32 = 56.0;
const GAP: f32 = 5.0;

/// The scales below which a box has no name, and nothing but its name.
const NAMED: f32 = 0.22;
const READABLE: f32 = 0.5;

/// The smallest size of a name.
const LEAST: f32 = 8.0;

/// The color of a kind of box.
fn color(kind: Kind) -> Color32 {
    match kind {
        Kind::Node(Locality::Field) => Color32::from_rgb(74, 120, 176),
        Kind::Node(Locality::Filter) => Color32::from_rgb(84, 140, 92),
        Kind::Node(Locality::Levelled) => Color32::from_rgb(150, 96, 150),
        Kind::Node(Locality::Solver) => Color32::from_rgb(186, 112, 62),
        Kind::Group => Color32::from_rgb(96, 104, 118),
        Kind::Outside => Color32::from_rgb(120, 120, 120),
        Kind::Output => Color32::from_rgb(60, 110, 108),
    }
}

/// The size of a box at normal size.
#[must_use]
pub fn size(block: &GraphBox, has_pictures: bool) -> Vec2 {
    let rows = rows(block) as f32;
    let picture = if has_pictures { PICTURE + 2.0 * GAP } else { 0.0 };
    let below = match block.kind {
        Kind::Outside => ROW * rows + GAP,
        Kind::Output => 0.0,
        // In a node, inputs are next to the picture; in a group, they are above it.
        Kind::Node(_) => (ROW * rows.max(1.0) + GAP).max(picture),
        Kind::Group => ROW * rows.max(1.0) + GAP + picture,
    };
    vec2(WIDTH, TITLE + below)
}

/// Number of inputs and outputs below each other.
fn rows(block: &GraphBox) -> usize {
    // Other boxes have their output next to the title.
    block.ports.len() + if block.kind == Kind::Group { block.outlets.len() } else { 0 }
}

/// The vertical position of an input in a box at normal size.
#[must_use]
pub fn port(block: &GraphBox, k: usize) -> f32 {
    if block.kind == Kind::Output {
        return TITLE * 0.5;
    }
    let above = if block.kind == Kind::Group { block.outlets.len() } else { 0 };
    TITLE + ROW * ((above + k) as f32 + 0.5)
}

/// The vertical position of an output in a box at normal size.
#[must_use]
pub fn outlet(block: &GraphBox, k: usize) -> f32 {
    match block.kind {
        Kind::Group => TITLE + ROW * (k as f32 + 0.5),
        Kind::Node(_) | Kind::Outside | Kind::Output => TITLE * 0.5,
    }
}

/// The input nearest to a vertical position in a box at normal size.
#[must_use]
pub fn port_near(block: &GraphBox, y: f32) -> Option<usize> {
    (0..block.ports.len()).min_by(|a, b| (port(block, *a) - y).abs().total_cmp(&(port(block, *b) - y).abs()))
}

/// The display state of a box.
pub struct Shown<'a> {
    /// Whether it is selected.
    pub is_selected: bool,
    /// Whether it is bypassed: its title is dim.
    pub is_bypassed: bool,
    /// Whether it is locked.
    pub is_locked: bool,
    /// Whether the view shows its layer.
    pub is_in_view: bool,
    /// Its small picture.
    pub picture: Option<&'a TextureHandle>,
    /// The scale of the graph; 1 is normal.
    pub zoom: f32,
    /// The language of ops and inputs.
    pub language: Language,
}

/// Draws a box.
pub fn draw(painter: &Painter, visuals: &Visuals, block: &GraphBox, rect: Rect, shown: &Shown) {
    let zoom = shown.zoom;
    let round = 5.0 * zoom;
    if block.kind == Kind::Group {
        // A second sheet behind the box indicates that it contains more.
        let behind = rect.translate(vec2(4.0, 4.0) * zoom);
        painter.rect_filled(behind, round, visuals.window_fill.gamma_multiply(0.8));
        painter.rect_stroke(behind, round, Stroke::new(1.0, visuals.window_stroke.color), StrokeKind::Outside);
    }
    painter.rect_filled(rect, round, visuals.window_fill);
    let title = Rect::from_min_max(rect.min, pos2(rect.right(), rect.top() + TITLE * zoom));
    let own = if shown.is_bypassed { color(block.kind).gamma_multiply(0.35) } else { color(block.kind) };
    painter.rect_filled(title, round, own);
    let border = match shown.is_selected {
        true => Stroke::new(2.5, visuals.selection.stroke.color),
        false => Stroke::new(1.0, visuals.window_stroke.color),
    };
    painter.rect_stroke(rect, round, border, StrokeKind::Outside);
    if let Some(picture) = shown.picture {
        let [width, height] = picture.size().map(|side| side as f32);
        let fitted = vec2(width, height) * (PICTURE / width.max(height));
        let corner = rect.max - Vec2::splat(GAP * zoom);
        let place = Rect::from_min_max(corner - fitted * zoom, corner);
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.image(picture.id(), place, whole, Color32::WHITE);
    }
    if shown.is_in_view {
        let place = title.right_top() + vec2(-10.0, 10.0) * zoom;
        painter.circle_filled(place, 4.0 * zoom, Color32::from_rgb(255, 214, 90));
    }
    if shown.is_locked {
        let body = Rect::from_min_size(title.right_top() + vec2(-24.0, 16.0) * zoom, vec2(13.0, 10.0) * zoom);
        let pen = Stroke::new(2.0 * zoom, Color32::WHITE);
        painter.rect_stroke(
            Rect::from_min_max(body.min + vec2(3.0, -6.0) * zoom, body.max - vec2(3.0, 0.0) * zoom),
            3.0 * zoom,
            pen,
            StrokeKind::Inside,
        );
        painter.rect_filled(body, 1.5 * zoom, Color32::WHITE);
    }
    if zoom > NAMED {
        words(painter, visuals, block, rect, shown);
    }
    for k in 0..block.ports.len() {
        painter.circle_filled(at(rect, port(block, k), zoom, false), 3.5 * zoom, visuals.weak_text_color());
    }
    for k in 0..block.outlets.len() {
        painter.circle_filled(at(rect, outlet(block, k), zoom, true), 5.0 * zoom, visuals.strong_text_color());
    }
}

fn words(painter: &Painter, visuals: &Visuals, block: &GraphBox, rect: Rect, shown: &Shown) {
    let zoom = shown.zoom;
    let inside = painter.with_clip_rect(rect.intersect(painter.clip_rect()));
    let small = font(10.5 * zoom);
    let is_small = zoom < READABLE;
    let (name, below) = (if is_small { (3.0, 2.0) } else { (7.0, 4.0) }, (7.0, 19.0));
    let write = |(x, y): (f32, f32), text: &str, font: FontId, color: Color32| {
        let mut job = LayoutJob::simple_singleline(text.to_owned(), font, color);
        // The end of a long name is left out, where it can be seen that it is.
        job.wrap = TextWrapping::truncate_at_width((WIDTH - 2.0 * x) * zoom);
        let galley = inside.fonts_mut(|fonts| fonts.layout_job(job));
        inside.galley(rect.min + vec2(x, y) * zoom, galley, color);
    };
    write(name, &block.title, font((13.0 * zoom).max(LEAST)), Color32::WHITE);
    if is_small {
        return;
    }
    let count = block.nodes.len().to_string();
    let subtitle = if block.kind == Kind::Group { &count } else { shown.language.named(&block.subtitle) };
    if block.kind != Kind::Outside {
        write(below, subtitle, small.clone(), Color32::from_white_alpha(190));
    }
    // Labels of inputs end where the picture begins.
    let has_picture = shown.picture.is_some() && matches!(block.kind, Kind::Node(_));
    let room = if has_picture { WIDTH - PICTURE - 2.0 * GAP } else { WIDTH };
    for (k, input) in block.ports.iter().enumerate() {
        let place = at(rect, port(block, k), zoom, false) + vec2(8.0 * zoom, 0.0);
        let label = shown.language.named(&input.label).to_owned();
        let mut job = LayoutJob::simple_singleline(label, small.clone(), visuals.text_color());
        job.wrap = TextWrapping::truncate_at_width((room - 8.0) * zoom);
        let galley = inside.fonts_mut(|fonts| fonts.layout_job(job));
        let corner = Align2::LEFT_CENTER.anchor_size(place, galley.size()).min;
        inside.galley(corner, galley, visuals.text_color());
    }
    if block.kind == Kind::Group {
        for (k, name) in block.outlets.iter().enumerate() {
            let place = at(rect, outlet(block, k), zoom, true) - vec2(9.0 * zoom, 0.0);
            inside.text(place, Align2::RIGHT_CENTER, block.inside(name), small.clone(), visuals.text_color());
        }
    }
}

/// A font of nearly this size. At sizes without steps, each scale of the graph would have letters of its own in memory.
#[must_use]
pub fn font(size: f32) -> FontId {
    FontId::proportional((size * 2.0).round() / 2.0)
}

/// A position at a side of a box.
#[must_use]
pub fn at(rect: Rect, y: f32, zoom: f32, is_right: bool) -> Pos2 {
    pos2(if is_right { rect.right() } else { rect.left() }, rect.top() + y * zoom)
}
