//! Lines and areas of SVG documents.
//!
//! Elements with a `transform` and groups with one are read; nested `svg` elements count as groups. Definitions, hidden
//! elements, `use`, text, pictures and style sheets are ignored. Coordinates are in the document's user space: its
//! attributes `width`, `height` and `viewBox` have no effect.

use orogen_grid::polylines::outline::{Outline, Piece};
use roxmltree::{Document, Node};

use super::outlines::{Collector, DrawingKind};
use super::svg_path::{self, Numbers, Pen};
use super::xml;

const NAMESPACE: &str = "http://www.w3.org/2000/svg";

/// Elements whose content is not drawn at their position.
const NOT_DRAWN: [&str; 6] = ["defs", "clipPath", "mask", "pattern", "symbol", "marker"];

/// Reads a document.
pub(super) fn read(text: &str, collector: &mut Collector) -> Result<(), String> {
    // A short text can define entities that expand to gigabytes.
    if text.contains("<!ENTITY") {
        return Err("it defines XML entities, which are not read; save it as plain SVG".into());
    }
    let document = xml::parse(text, true)?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(format!("it is not SVG: its root is `{}`", root.tag_name().name()));
    }
    // Not recursive, because groups may be nested to any depth.
    let mut open = vec![(root, Affine::IDENTITY)];
    while let Some((node, outer)) = open.pop() {
        let located = |why: String| format!("{}: {why}", called(&document, &node));
        if is_hidden(&node) {
            continue;
        }
        let affine = match node.attribute("transform") {
            Some(text) => outer.then(Affine::parse(text).map_err(|why| located(format!("its `transform`: {why}")))?),
            None => outer,
        };
        shape(&node, &affine, collector).map_err(located)?;
        let children = node.children().rev().filter(Node::is_element);
        open.extend(children.map(|child| (child, affine)));
    }
    Ok(())
}

/// The name of an element in messages: its `id`, otherwise its number among the elements of its kind.
fn called(document: &Document, node: &Node) -> String {
    let name = node.tag_name().name();
    match node.attribute("id") {
        Some(id) => format!("the `{name}` with the id {id:?}"),
        None => {
            let alike = document.descendants().filter(|other| other.tag_name().name() == name);
            format!("`{name}` number {}", alike.take_while(|other| other != node).count() + 1)
        }
    }
}

fn is_hidden(node: &Node) -> bool {
    let is_foreign = node.tag_name().namespace().is_some_and(|namespace| namespace != NAMESPACE);
    let style = node.attribute("style").unwrap_or_default();
    let is_none = |declaration: &str| {
        declaration.split_once(':').is_some_and(|(key, value)| key.trim() == "display" && value.trim() == "none")
    };
    is_foreign
        || NOT_DRAWN.contains(&node.tag_name().name())
        || node.attribute("display").is_some_and(|display| display.trim() == "none")
        || style.split(';').any(is_none)
}

/// The attribute with the height of a ridge or summit in metres, also of a group of them.
const HEIGHT: &str = "data-height";

fn shape(node: &Node, affine: &Affine, collector: &mut Collector) -> Result<(), String> {
    use DrawingKind::{Areas, Lines, Ridges};
    collector.height = node.ancestors().find_map(|node| node.attribute(HEIGHT)?.trim().parse().ok());
    let name = node.tag_name().name();
    let (kinds, outlines): (&[DrawingKind], Vec<Outline>) = match name {
        "path" => {
            let outlines = svg_path::parse(node.attribute("d").unwrap_or_default());
            (&[Lines, Areas], outlines.map_err(|why| format!("its `d`: {why}"))?)
        }
        "polyline" | "polygon" => {
            let points = svg_path::points(node.attribute("points").unwrap_or_default());
            let points: Vec<[f64; 3]> =
                points.map_err(|why| format!("its `points`: {why}"))?.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
            let kinds = if name == "polygon" { [Areas] } else { [Lines] };
            let outlines = if points.is_empty() { Vec::new() } else { vec![Outline::of_points(&points)] };
            return collector.take(&kinds, outlines.iter().map(|outline| affine.map(outline)).collect());
        }
        "line" => {
            let [x1, y1, x2, y2] = lengths(node, ["x1", "y1", "x2", "y2"])?;
            (&[Lines], vec![Outline::of_points(&[[x1, y1, 0.0], [x2, y2, 0.0]])])
        }
        "rect" => (&[Areas], rectangle(node)?),
        "circle" if collector.kind() == Ridges => {
            let [cx, cy] = lengths(node, ["cx", "cy"])?;
            (&[Ridges], vec![Outline::of_points(&[[cx, cy, 0.0]])])
        }
        "circle" => {
            let [cx, cy, r] = lengths(node, ["cx", "cy", "r"])?;
            (&[Areas], ellipse([cx, cy], [r, r]))
        }
        "ellipse" => {
            let [cx, cy, rx, ry] = lengths(node, ["cx", "cy", "rx", "ry"])?;
            (&[Areas], ellipse([cx, cy], [rx, ry]))
        }
        _ => return Ok(()),
    };
    collector.take(kinds, outlines.iter().map(|outline| affine.map(outline)).collect())
}

/// Attributes in user units; a missing one is 0.
fn lengths<const N: usize>(node: &Node, names: [&str; N]) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (value, name) in values.iter_mut().zip(names) {
        *value = length(node, name)?.unwrap_or(0.0);
    }
    Ok(values)
}

fn length(node: &Node, name: &str) -> Result<Option<f64>, String> {
    let Some(text) = node.attribute(name).map(str::trim).filter(|text| !text.is_empty() && *text != "auto") else {
        return Ok(None);
    };
    let mut numbers = Numbers::new(text);
    match (numbers.number(), numbers.rest()) {
        (Ok(number), b"" | b"px") => Ok(Some(number)),
        _ => Err(format!("its `{name}` is {text:?}; only numbers in user units are read")),
    }
}

fn rectangle(node: &Node) -> Result<Vec<Outline>, String> {
    let [x, y, width, height] = lengths(node, ["x", "y", "width", "height"])?;
    if !(width > 0.0 && height > 0.0) {
        return Ok(Vec::new());
    }
    // If only one radius is given, it applies to both axes.
    let [rx, ry] = match [length(node, "rx")?, length(node, "ry")?] {
        [Some(rx), Some(ry)] => [rx, ry],
        [Some(radius), None] | [None, Some(radius)] => [radius, radius],
        [None, None] => [0.0, 0.0],
    };
    let (rx, ry) = (rx.clamp(0.0, 0.5 * width), ry.clamp(0.0, 0.5 * height));
    let (right, bottom) = (x + width, y + height);
    let mut pen = Pen::default();
    if rx > 0.0 && ry > 0.0 {
        let corner = |pen: &mut Pen, to| pen.arc_to([rx, ry], 0.0, [false, true], to);
        pen.move_to([x + rx, y]);
        pen.line_to([right - rx, y]);
        corner(&mut pen, [right, y + ry]);
        pen.line_to([right, bottom - ry]);
        corner(&mut pen, [right - rx, bottom]);
        pen.line_to([x + rx, bottom]);
        corner(&mut pen, [x, bottom - ry]);
        pen.line_to([x, y + ry]);
        corner(&mut pen, [x + rx, y]);
    } else {
        pen.move_to([x, y]);
        [[right, y], [right, bottom], [x, bottom]].into_iter().for_each(|point| pen.line_to(point));
    }
    pen.close();
    Ok(pen.finish())
}

fn ellipse([cx, cy]: [f64; 2], [rx, ry]: [f64; 2]) -> Vec<Outline> {
    if !(rx > 0.0 && ry > 0.0) {
        return Vec::new();
    }
    let mut pen = Pen::default();
    pen.move_to([cx + rx, cy]);
    for x in [cx - rx, cx + rx] {
        pen.arc_to([rx, ry], 0.0, [false, true], [x, cy]);
    }
    pen.close();
    pen.finish()
}

/// An affine transform: x' = a x + c y + e, y' = b x + d y + f.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Affine([f64; 6]);

impl Affine {
    const IDENTITY: Affine = Affine([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);

    fn apply(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b, c, d, e, f] = self.0;
        [a * x + c * y + e, b * x + d * y + f]
    }

    fn map(&self, outline: &Outline) -> Outline {
        if *self == Affine::IDENTITY {
            return outline.clone();
        }
        let point = |[x, y, z]: [f64; 3]| {
            let [x, y] = self.apply([x, y]);
            [x, y, z]
        };
        let piece = |piece: &Piece| match *piece {
            Piece::Straight(end) => Piece::Straight(point(end)),
            Piece::Curve(control, end) => Piece::Curve(control.map(|at| self.apply(at)), point(end)),
        };
        Outline {
            start: point(outline.start),
            pieces: outline.pieces.iter().map(piece).collect(),
            closed: outline.closed,
        }
    }

    /// Composition: the inner transform first, then this one.
    fn then(self, inner: Affine) -> Affine {
        let [a, b, c, d, e, f] = inner.0;
        let linear = Affine([self.0[0], self.0[1], self.0[2], self.0[3], 0.0, 0.0]);
        let ([a, b], [c, d], [e, f]) = (linear.apply([a, b]), linear.apply([c, d]), self.apply([e, f]));
        Affine([a, b, c, d, e, f])
    }

    /// A list of transforms, the outermost first.
    fn parse(text: &str) -> Result<Affine, String> {
        let mut rest = text.trim();
        let mut all = Affine::IDENTITY;
        while !rest.is_empty() && rest != "none" {
            let unknown = || format!("{:?} is no transform", rest.chars().take(20).collect::<String>());
            let (name, after) = rest.split_once('(').ok_or_else(unknown)?;
            let (arguments, after) = after.split_once(')').ok_or_else(unknown)?;
            let mut numbers = Numbers::new(arguments);
            numbers.skip_spaces();
            let mut values = Vec::new();
            while !numbers.is_at_end() && values.len() < 7 {
                values.push(numbers.number()?);
            }
            let one = match (name.trim(), values.as_slice()) {
                ("matrix", &[a, b, c, d, e, f]) => Affine([a, b, c, d, e, f]),
                ("translate", &[x]) => Affine([1.0, 0.0, 0.0, 1.0, x, 0.0]),
                ("translate", &[x, y]) => Affine([1.0, 0.0, 0.0, 1.0, x, y]),
                ("scale", &[s]) => Affine([s, 0.0, 0.0, s, 0.0, 0.0]),
                ("scale", &[x, y]) => Affine([x, 0.0, 0.0, y, 0.0, 0.0]),
                ("rotate", &[angle]) => Affine::rotation(angle),
                ("rotate", &[angle, x, y]) => Affine([1.0, 0.0, 0.0, 1.0, x, y])
                    .then(Affine::rotation(angle))
                    .then(Affine([1.0, 0.0, 0.0, 1.0, -x, -y])),
                ("skewX", &[angle]) => Affine([1.0, 0.0, libm::tan(angle.to_radians()), 1.0, 0.0, 0.0]),
                ("skewY", &[angle]) => Affine([1.0, libm::tan(angle.to_radians()), 0.0, 1.0, 0.0, 0.0]),
                _ => return Err(unknown()),
            };
            all = all.then(one);
            rest = after.trim_start_matches(|c: char| c.is_ascii_whitespace() || c == ',');
        }
        Ok(all)
    }

    fn rotation(angle: f64) -> Affine {
        let (sin, cos) = libm::sincos(angle.to_radians());
        Affine([cos, sin, -sin, cos, 0.0, 0.0])
    }
}
