//! The diagram as a scene, for PNG, SVG and PDF.

use orogen::Result;
use orogen::graph_layout::layout::{Layout, Link, Spacing};
use orogen::io::palette::Rgb;
use orogen::output::map::text::Face;
use orogen::output::sheet::font_set::FontSet;
use orogen::output::sheet::scene::{INK, Scene, Step, polygon};
use orogen::output::sheet::{Point, Rect, Size};

use super::diagram::{Block, Diagram, Kind};

/// Margin of the page, and room for heading and legend.
const MARGIN: f32 = 8.0;
const HEADING: f32 = 12.0;
const FOOT: f32 = 9.0;
/// Text sizes, the em in millimetres.
const TITLE: f32 = 5.6;
const NAME: f32 = 3.3;
const SMALL: f32 = 2.7;
/// A box: height of its header and of its lines, inner margin, minimum width.
const HEAD: f32 = 6.2;
const ROW: f32 = 4.3;
const PAD: f32 = 2.6;
const LEAST: f32 = 24.0;
/// Distances between boxes, wires and columns.
const SPACING: Spacing = Spacing { gap: 6.0, wire_gap: 3.0, alley: 16.0 };
/// The distance from the top of a box to the start of outgoing wires.
const PORT: f32 = HEAD / 2.0;

const PAPER: Rgb = [251, 250, 248];
const BODY: Rgb = [255, 255, 255];
const SOFT: Rgb = [98, 96, 94];
const EDGE: Rgb = [150, 148, 146];
/// Opacity of boxes that no output depends on.
const FAINT: f32 = 0.35;

/// The color of a kind's header.
pub fn color(kind: Kind) -> Rgb {
    match kind {
        Kind::Field => [92, 148, 92],
        Kind::Filter => [70, 126, 178],
        Kind::Solver => [196, 122, 56],
        Kind::Output => [88, 84, 96],
    }
}

/// Draws a diagram under a heading.
///
/// # Errors
/// If the built-in font cannot be read.
pub fn draw(diagram: &Diagram, title: &str) -> Result<Scene> {
    let words = diagram.blocks.iter().flat_map(|block| block.rows.iter().chain([&block.name]));
    let letters = FontSet::for_texts(words.map(String::as_str).chain([title]))?;
    let sizes: Vec<Size> = diagram.blocks.iter().map(|block| size(block, &letters)).collect();
    let links: Vec<Link> = (diagram.wires.iter())
        .map(|wire| Link { from: (wire.from, PORT), to: (wire.to, wire.row.map_or(PORT, row_middle)) })
        .collect();
    let layout = Layout::new(&sizes, &links, SPACING);
    let key: f32 = Kind::ALL.iter().map(|kind| letters.width(kind.name(), Face::Regular, SMALL) + 12.0).sum();
    let heading = letters.width(title, Face::Bold, TITLE);
    let width = layout.size.width.max(key).max(heading) + 2.0 * MARGIN;
    let height = layout.size.height + 2.0 * MARGIN + HEADING + FOOT;
    let scene = Scene::new(Size::new(width, height), title);
    let mut page = Page { scene, letters: &letters };
    page.scene.block(Rect::new(0.0, 0.0, width, height), PAPER);
    page.words(title, Face::Bold, TITLE, INK, Point::new(MARGIN, MARGIN + TITLE * 0.8), 1.0);
    let origin = Point::new(MARGIN, MARGIN + HEADING);
    for (wire, way) in diagram.wires.iter().zip(&layout.ways) {
        let used = diagram.blocks[wire.to].used;
        let ink = color(diagram.blocks[wire.from].kind);
        page.scene.lines(vec![curve(way, origin)], 0.45, ink, if used { 0.9 } else { FAINT });
    }
    for ((block, size), place) in diagram.blocks.iter().zip(&sizes).zip(&layout.places) {
        page.block(block, *size, place.moved(origin.x, origin.y));
    }
    for (wire, way) in diagram.wires.iter().zip(&layout.ways) {
        let ink = color(diagram.blocks[wire.from].kind);
        if let ([first, ..], Some(layer)) = (way.as_slice(), wire.layer) {
            let lift = page.lift(diagram, wire.from, layer);
            let at = Point::new(first[0] + origin.x + 1.8, first[2] + origin.y - 0.9 - lift);
            page.words(layer, Face::Italic, SMALL * 0.85, ink, at, 1.0);
        }
        if let [.., last] = way.as_slice() {
            page.dot(Point::new(last[0] + origin.x, last[2] + origin.y), ink);
        }
    }
    let mut x = MARGIN;
    for kind in Kind::ALL {
        let y = height - MARGIN;
        page.scene.block(Rect::new(x, y - 2.6, 5.0, 3.0), color(kind));
        x += 6.4 + page.words(kind.name(), Face::Regular, SMALL, SOFT, Point::new(x + 6.4, y), 1.0) + 5.6;
    }
    Ok(page.scene)
}

fn row_middle(row: usize) -> f32 {
    HEAD + ROW * (row as f32 + 0.5) + 0.4
}

fn size(block: &Block, letters: &FontSet) -> Size {
    let op = if block.op.is_empty() { 0.0 } else { letters.width(block.op, Face::Italic, SMALL) + 4.0 };
    let head = letters.width(&block.name, Face::Bold, NAME) + op;
    let rows = block.rows.iter().map(|row| letters.width(row, Face::Regular, SMALL)).fold(0.0, f32::max);
    let below = if block.rows.is_empty() { 0.0 } else { ROW * block.rows.len() as f32 + 1.2 };
    Size { width: (head.max(rows) + 2.0 * PAD).max(LEAST), height: HEAD + below }
}

/// The path of a wire: horizontal past boxes, and between columns a curve with horizontal ends.
fn curve(way: &[[f32; 3]], Point { x, y }: Point) -> Vec<Point> {
    const STEPS: usize = 24;
    let mut line = Vec::new();
    for pair in way.windows(2) {
        let ([left, from, above], [to, _, below]) = (pair[0], pair[1]);
        line.push(Point::new(left + x, above + y));
        line.extend((0..=STEPS).map(|k| {
            // A cubic Bezier curve with horizontal handles, half of the distance long.
            let t = k as f32 / STEPS as f32;
            let across = 1.5 * t * (1.0 - t) + t * t * t;
            let down = t * t * (3.0 - 2.0 * t);
            Point::new(from + (to - from) * across + x, above + (below - above) * down + y)
        }));
    }
    line
}

struct Page<'a> {
    scene: Scene,
    letters: &'a FontSet,
}

impl Page<'_> {
    /// Draws text at a position; returns its width.
    fn words(&mut self, text: &str, face: Face, size: f32, ink: Rgb, at: Point, cover: f32) -> f32 {
        let outline = self.letters.write(text, face, size, at, 0.0);
        self.scene.area(outline, ink, cover);
        self.letters.width(text, face, size)
    }

    /// The offset of a layer's label from the previous one, because several layers may be read from one box.
    fn lift(&self, diagram: &Diagram, from: usize, layer: &str) -> f32 {
        let mut names: Vec<&str> =
            diagram.wires.iter().filter(|wire| wire.from == from).filter_map(|wire| wire.layer).collect();
        names.sort_unstable();
        names.dedup();
        names.iter().position(|name| *name == layer).unwrap_or(0) as f32 * 2.4
    }

    fn block(&mut self, block: &Block, size: Size, Point { x: left, y: top }: Point) {
        let cover = if block.used { 1.0 } else { FAINT };
        let area = Rect::new(left, top, size.width, size.height);
        self.scene.area(rounded(area), BODY, 1.0);
        self.scene.area(rounded(Rect { height: HEAD, ..area }), color(block.kind), cover);
        if !block.rows.is_empty() {
            let square = [
                [left, top + HEAD - 1.2],
                [left + size.width, top + HEAD - 1.2],
                [left + size.width, top + HEAD],
                [left, top + HEAD],
            ];
            self.scene.area(polygon(square), color(block.kind), cover);
        }
        let [white, pale] = [[255; 3], [238, 238, 234]];
        self.words(&block.name, Face::Bold, NAME, white, Point::new(left + PAD, top + HEAD / 2.0 + NAME * 0.36), 1.0);
        let width = self.letters.width(block.op, Face::Italic, SMALL);
        let at = Point::new(left + size.width - PAD - width, top + HEAD / 2.0 + SMALL * 0.36);
        self.words(block.op, Face::Italic, SMALL, pale, at, 1.0);
        for (k, row) in block.rows.iter().enumerate() {
            let at = Point::new(left + PAD, top + row_middle(k) + SMALL * 0.36);
            self.words(row, Face::Regular, SMALL, SOFT, at, cover);
        }
        let outline = rounded(area).into_iter().filter_map(|step| match step {
            Step::Move(place) | Step::Line(place) => Some(place),
            Step::Curve(..) => None,
        });
        let mut ring: Vec<Point> = outline.collect();
        ring.extend(ring.first().copied());
        self.scene.lines(vec![ring], 0.2, EDGE, 0.8 * cover);
    }

    /// The dot at the end of a wire.
    fn dot(&mut self, at: Point, ink: Rgb) {
        let corners = (0..16)
            .map(|k| std::f32::consts::TAU * k as f32 / 16.0)
            .map(|angle| at.moved(0.9 * libm::cosf(angle), 0.9 * libm::sinf(angle)));
        self.scene.area(polygon(corners), ink, 1.0);
    }
}

/// The outline of a rectangle with rounded corners, made of straight lines.
fn rounded(area: Rect) -> Vec<Step> {
    const RADIUS: f32 = 1.4;
    const STEPS: usize = 5;
    let corners = [
        (Point::new(area.right() - RADIUS, area.top + RADIUS), -0.25),
        (Point::new(area.right() - RADIUS, area.bottom() - RADIUS), 0.0),
        (Point::new(area.left + RADIUS, area.bottom() - RADIUS), 0.25),
        (Point::new(area.left + RADIUS, area.top + RADIUS), 0.5),
    ];
    polygon(corners.iter().flat_map(|(middle, turn)| {
        (0..=STEPS).map(move |k| {
            let angle = std::f32::consts::TAU * (turn + 0.25 * k as f32 / STEPS as f32);
            middle.moved(RADIUS * libm::cosf(angle), RADIUS * libm::sinf(angle))
        })
    }))
}
