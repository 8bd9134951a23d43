//! Rasterization of a sheet.

use orogen_grid::parallel;

use super::geometry::{Point, Rect};
use super::scene::{Item, Scene, Step};
use crate::map::canvas::Canvas;
use orogen_io::palette::color::Rgb;

/// Segments per curve.
const PIECES: usize = 8;

/// Rows per band; bands are drawn in parallel.
const BAND: usize = 64;

/// Draws a scene at `dpi` pixels per inch.
///
/// Edges are antialiased: areas by pixel coverage, lines by distance. Bands of rows are drawn in parallel and
/// independently, so their number does not affect the result.
#[must_use]
pub fn draw(scene: &Scene, dpi: f64) -> Canvas {
    let scale = (dpi / 25.4) as f32;
    let [width, height] = pixels(scene, dpi);
    let shapes: Vec<Shape> = scene.items.iter().map(|item| Shape::of(item, scale, Point::default())).collect();
    let bands: Vec<Vec<Rgb>> = parallel::map(0..height.div_ceil(BAND), |k| {
        let top = k * BAND;
        let mut band = Band { top, width, rows: vec![scene.page; width * BAND.min(height - top)], cover: Vec::new() };
        shapes.iter().for_each(|shape| band.draw(shape));
        band.rows
    });
    Canvas::of(width, height, bands.concat())
}

/// Draws the items of a scene over rows of a picture, starting at row `top`, with `pixels` per millimetre. The scene's
/// upper left corner is at `corner`, in pixels.
pub fn draw_over(scene: &Scene, pixels: f32, corner: Point, top: usize, width: usize, bytes: &mut [u8]) {
    let rows: Vec<Rgb> = bytes.as_chunks::<3>().0.to_vec();
    if width == 0 || rows.len() < width {
        return;
    }
    let mut band = Band { top, width, rows, cover: Vec::new() };
    scene.items.iter().for_each(|item| band.draw(&Shape::of(item, pixels, corner)));
    bytes.as_chunks_mut::<3>().0.copy_from_slice(&band.rows);
}

/// The size of the page in pixels.
#[must_use]
pub fn pixels(scene: &Scene, dpi: f64) -> [usize; 2] {
    scene.size.pixels(dpi)
}

/// An item in pixels.
enum Shape<'a> {
    Picture { area: Rect, width: usize, height: usize, pixels: &'a [u8] },
    Lines { lines: Vec<Line>, half: f32, ink: Rgb, cover: f32 },
    Area { edges: Vec<[Point; 2]>, top: f32, bottom: f32, ink: Rgb, cover: f32 },
}

struct Line {
    places: Vec<Point>,
    top: f32,
    bottom: f32,
}

impl<'a> Shape<'a> {
    /// Converts an item to pixels, with `scale` pixels per millimetre and the page's upper left corner at `corner`, in
    /// pixels.
    fn of(item: &'a Item, scale: f32, corner: Point) -> Shape<'a> {
        match item {
            Item::Picture { area, width, height, pixels } => {
                let area = area.scaled(scale);
                let area = Rect { left: area.left + corner.x, top: area.top + corner.y, ..area };
                Shape::Picture { area, width: *width, height: *height, pixels }
            }
            Item::Lines { lines, width, ink, cover } => {
                let lines = lines.iter().map(|line| {
                    let places: Vec<Point> =
                        line.iter().map(|place| place.scaled(scale).moved(corner.x, corner.y)).collect();
                    let (top, bottom) = span(places.iter().map(|place| place.y));
                    Line { places, top, bottom }
                });
                Shape::Lines { lines: lines.collect(), half: width * scale / 2.0, ink: *ink, cover: *cover }
            }
            Item::Area { outline, ink, cover } => {
                let edges = edges(outline, |place| place.scaled(scale).moved(corner.x, corner.y));
                let (top, bottom) = span(edges.iter().flatten().map(|place| place.y));
                Shape::Area { edges, top, bottom, ink: *ink, cover: *cover }
            }
        }
    }
}

fn span(values: impl Iterator<Item = f32>) -> (f32, f32) {
    values.fold((f32::MAX, f32::MIN), |(low, high), value| (low.min(value), high.max(value)))
}

/// An outline as straight edges; every part is closed.
fn edges(outline: &[Step], at: impl Fn(Point) -> Point) -> Vec<[Point; 2]> {
    let mut edges = Vec::new();
    let (mut first, mut here) = (Point::default(), Point::default());
    for step in outline {
        match *step {
            Step::Move(place) => {
                edges.push([here, first]);
                (first, here) = (at(place), at(place));
            }
            Step::Line(place) => {
                edges.push([here, at(place)]);
                here = at(place);
            }
            Step::Curve(a, b, end) => {
                let [a, b, end] = [a, b, end].map(&at);
                let start = here;
                for k in 1..=PIECES {
                    let t = k as f32 / PIECES as f32;
                    let u = 1.0 - t;
                    let along = |start: f32, a: f32, b: f32, end: f32| {
                        u * u * u * start + 3.0 * u * u * t * a + 3.0 * u * t * t * b + t * t * t * end
                    };
                    let next = Point::new(along(start.x, a.x, b.x, end.x), along(start.y, a.y, b.y, end.y));
                    edges.push([here, next]);
                    here = next;
                }
            }
        }
    }
    edges.push([here, first]);
    edges.retain(|[a, b]| a.y != b.y && a.is_finite() && b.is_finite());
    edges
}

/// A band of rows of the page.
struct Band {
    top: usize,
    width: usize,
    rows: Vec<Rgb>,
    /// Coverage of each pixel by the current shape; all 0 between shapes.
    cover: Vec<f32>,
}

impl Band {
    fn height(&self) -> usize {
        self.rows.len() / self.width
    }

    /// Whether the band overlaps these heights.
    fn reaches(&self, top: f32, bottom: f32) -> bool {
        bottom >= self.top as f32 && top <= (self.top + self.height()) as f32
    }

    fn draw(&mut self, shape: &Shape) {
        match shape {
            Shape::Picture { area, width, height, pixels } => self.picture(*area, [*width, *height], pixels),
            Shape::Lines { lines, half, ink, cover } => {
                let reach = half + 1.0;
                let near: Vec<&Line> =
                    lines.iter().filter(|line| self.reaches(line.top - reach, line.bottom + reach)).collect();
                if near.is_empty() {
                    return;
                }
                self.cover.resize(self.rows.len(), 0.0);
                let mut rows = [usize::MAX, 0];
                for line in near {
                    for pair in line.places.windows(2) {
                        self.stretch(pair[0], pair[1], *half, &mut rows);
                    }
                }
                self.lay(rows, *ink, *cover);
            }
            Shape::Area { edges, top, bottom, ink, cover } => {
                if !edges.is_empty() && self.reaches(*top, *bottom) {
                    self.area(edges, *ink, *cover);
                }
            }
        }
    }

    /// A picture, with nearest-neighbor sampling.
    fn picture(&mut self, area: Rect, size: [usize; 2], pixels: &[u8]) {
        let columns: Vec<Option<usize>> = (0..self.width)
            .map(|i| {
                let at = (i as f32 + 0.5 - area.left) / area.width;
                (0.0..1.0).contains(&at).then(|| ((at * size[0] as f32) as usize).min(size[0] - 1))
            })
            .collect();
        for j in 0..self.height() {
            let at = ((self.top + j) as f32 + 0.5 - area.top) / area.height;
            if !(0.0..1.0).contains(&at) {
                continue;
            }
            let row = ((at * size[1] as f32) as usize).min(size[1] - 1) * size[0];
            let out = &mut self.rows[j * self.width..(j + 1) * self.width];
            for (out, column) in out.iter_mut().zip(&columns) {
                if let Some(bytes) = column.and_then(|column| pixels.get(3 * (row + column)..3 * (row + column) + 3)) {
                    out.copy_from_slice(bytes);
                }
            }
        }
    }

    /// A segment of a line: coverage by the distance to each pixel's center.
    fn stretch(&mut self, a: Point, b: Point, half: f32, rows: &mut [usize; 2]) {
        let reach = half + 1.0;
        let way = a.to(b);
        let length = way.square().max(1e-12);
        // A line thinner than a pixel covers at most its width.
        let most = (2.0 * half).min(1.0);
        let (from, to) = within(a.y.min(b.y) - reach, a.y.max(b.y) + reach, self.top, self.height());
        let (left, right) = within(a.x.min(b.x) - reach, a.x.max(b.x) + reach, 0, self.width);
        for j in from..to {
            let py = (self.top + j) as f32 + 0.5 - a.y;
            let row = &mut self.cover[j * self.width..(j + 1) * self.width];
            for (i, cover) in row.iter_mut().enumerate().take(right).skip(left) {
                let px = i as f32 + 0.5 - a.x;
                let along = ((px * way.x + py * way.y) / length).clamp(0.0, 1.0);
                let (ex, ey) = (px - along * way.x, py - along * way.y);
                let share = (half + 0.5 - (ex * ex + ey * ey).sqrt()).min(most);
                if share > *cover {
                    *cover = share;
                }
            }
        }
        if from < to {
            *rows = [rows[0].min(from), rows[1].max(to)];
        }
    }

    /// An area: every edge adds its signed coverage to the pixels on its right.
    fn area(&mut self, edges: &[[Point; 2]], ink: Rgb, cover: f32) {
        // An extra column absorbs coverage beyond the page.
        let stride = self.width + 2;
        let (left, right) = span(edges.iter().flatten().map(|place| place.x));
        let (from, to) = within(left - 1.0, right + 2.0, 0, self.width);
        let (top, bottom) = span(edges.iter().flatten().map(|place| place.y));
        let (first, last) = within(top - 1.0, bottom + 1.0, self.top, self.height());
        if from >= to || first >= last {
            return;
        }
        let mut change = vec![0.0f32; stride * (last - first)];
        let origin = (self.top + first) as f32;
        for [a, b] in edges {
            let (sign, a, b) = if a.y < b.y { (1.0, a, b) } else { (-1.0, b, a) };
            let slope = (b.x - a.x) / (b.y - a.y);
            let (y0, y1) = ((a.y - origin).max(0.0), (b.y - origin).min((last - first) as f32));
            let mut y = y0;
            while y < y1 {
                let row = y as usize;
                let end = y1.min((row + 1) as f32);
                let x_at = |y: f32| (a.x + (y + origin - a.y) * slope).clamp(0.0, self.width as f32);
                let (x0, x1) = (x_at(y), x_at(end));
                accumulate(&mut change[row * stride..(row + 1) * stride], sign * (end - y), x0.min(x1), x0.max(x1));
                y = if end > y { end } else { (row + 1) as f32 };
            }
        }
        for (j, change) in change.chunks_exact(stride).enumerate() {
            let mut sum: f32 = change[..from].iter().sum();
            let row = (first + j) * self.width;
            for (i, change) in change.iter().enumerate().take(to).skip(from) {
                sum += change;
                let share = sum.abs().min(1.0) * cover;
                if share > 1e-3 {
                    over(&mut self.rows[row + i], ink, share);
                }
            }
        }
    }

    /// Blends ink by the coverage of a shape, and clears the coverage.
    fn lay(&mut self, [from, to]: [usize; 2], ink: Rgb, cover: f32) {
        for k in from.min(to) * self.width..to * self.width {
            let share = std::mem::take(&mut self.cover[k]);
            if share > 0.0 {
                over(&mut self.rows[k], ink, share * cover);
            }
        }
    }
}

/// Adds an edge between two columns of one row, with a height within the row: changes of coverage from pixel to pixel.
fn accumulate(row: &mut [f32], height: f32, x0: f32, x1: f32) {
    let first = x0 as usize;
    let last = x1 as usize;
    if first == last {
        // The share of the pixel to the right of the edge's center.
        let middle = (x0 + x1) / 2.0 - first as f32;
        row[first] += height * (1.0 - middle);
        row[first + 1] += height * middle;
        return;
    }
    let per_pixel = height / (x1 - x0);
    let mut before = 0.0;
    for (k, change) in row[first..=last].iter_mut().enumerate() {
        let (start, end) = (x0.max((first + k) as f32), x1.min((first + k + 1) as f32));
        let part = per_pixel * (end - start);
        let middle = (start + end) / 2.0 - (first + k) as f32;
        *change += before + part * (1.0 - middle);
        before = part * middle;
    }
    row[last + 1] += before;
}

/// The indices of whole pixels between two positions, from `start`, at most `count`.
fn within(low: f32, high: f32, start: usize, count: usize) -> (usize, usize) {
    let clamp = |at: f32| (at - start as f32).clamp(0.0, count as f32);
    (clamp(low.floor()) as usize, clamp(high.ceil()) as usize)
}

/// Blends bytes instead of linear light, like [`Canvas`].
fn over(pixel: &mut Rgb, ink: Rgb, share: f32) {
    for (under, ink) in pixel.iter_mut().zip(ink) {
        *under = (f32::from(*under) * (1.0 - share) + f32::from(ink) * share + 0.5) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::super::geometry::Size;
    use super::super::scene::{line, polygon};
    use super::*;

    fn drawn(items: Vec<Item>) -> Canvas {
        // 100 x 100 pixels of one millimetre each.
        draw(&Scene { items, ..Scene::new(Size::new(100.0, 100.0), String::new()) }, 25.4)
    }

    fn dark(canvas: &Canvas) -> f64 {
        let all = (0..100).flat_map(|y| (0..100).map(move |x| (x, y)));
        all.map(|(x, y)| f64::from(255 - canvas.get(x, y).unwrap()[0]) / 255.0).sum()
    }

    fn area(outline: Vec<Step>) -> Item {
        Item::Area { outline, ink: [0; 3], cover: 1.0 }
    }

    #[test]
    fn an_area_covers_what_it_is() {
        // A square across the borders of bands, at fractions of pixels.
        let square = polygon([[10.25, 20.5], [70.75, 20.5], [70.75, 80.25], [10.25, 80.25]]);
        let canvas = drawn(vec![area(square.clone())]);
        assert!((dark(&canvas) - 60.5 * 59.75).abs() < 1.0, "{}", dark(&canvas));
        assert_eq!([canvas.get(40, 50), canvas.get(5, 50)], [Some([0; 3]), Some([255; 3])]);
        let edge = canvas.get(10, 50).unwrap()[0];
        assert!((i32::from(edge) - 64).abs() <= 1, "{edge}");
        // The orientation of a single ring makes no difference; an inner ring with the opposite orientation is a hole.
        let mut holed: Vec<Step> = square;
        holed.extend(polygon([[30.0, 40.0], [30.0, 60.0], [50.0, 60.0], [50.0, 40.0]]));
        assert!((dark(&drawn(vec![area(holed)])) - (60.5 * 59.75 - 400.0)).abs() < 1.0);
        // A disc of four curves.
        let k = 0.552_284_8 * 30.0;
        let disc = vec![
            Step::Move(Point::new(80.0, 50.0)),
            Step::Curve(Point::new(80.0, 50.0 + k), Point::new(50.0 + k, 80.0), Point::new(50.0, 80.0)),
            Step::Curve(Point::new(50.0 - k, 80.0), Point::new(20.0, 50.0 + k), Point::new(20.0, 50.0)),
            Step::Curve(Point::new(20.0, 50.0 - k), Point::new(50.0 - k, 20.0), Point::new(50.0, 20.0)),
            Step::Curve(Point::new(50.0 + k, 20.0), Point::new(80.0, 50.0 - k), Point::new(80.0, 50.0)),
        ];
        assert!((dark(&drawn(vec![area(disc)])) / (900.0 * std::f64::consts::PI) - 1.0).abs() < 0.01);
    }

    #[test]
    fn what_leaves_the_page_is_cut() {
        let large = polygon([[-50.0, -50.0], [150.0, -50.0], [150.0, 150.0], [-50.0, 150.0]]);
        assert_eq!(dark(&drawn(vec![area(large)])), 1e4);
        let right = polygon([[90.0, 10.0], [1e6, 10.0], [1e6, 20.0], [90.0, 20.0]]);
        assert_eq!(dark(&drawn(vec![area(right)])), 100.0);
        let none = polygon([[f32::NAN, 1.0], [5.0, f32::INFINITY], [5.0, 5.0]]);
        drawn(vec![
            area(none),
            Item::Lines { lines: vec![line([[1e9, 0.0], [-1e9, 5.0]])], width: 1.0, ink: [0; 3], cover: 1.0 },
        ]);
    }

    #[test]
    fn a_line_is_as_wide_as_asked_and_crosses_itself_unseen() {
        let item = |places: &[[f32; 2]], width, cover| Item::Lines {
            lines: vec![line(places.iter().copied())],
            width,
            ink: [0; 3],
            cover,
        };
        let across = [[10.0, 50.3], [90.0, 50.3]];
        for width in [0.3f32, 1.0, 4.0] {
            let column: f64 = {
                let canvas = drawn(vec![item(&across, width, 1.0)]);
                (0..100).map(|y| f64::from(255 - canvas.get(50, y).unwrap()[0]) / 255.0).sum()
            };
            assert!((column - f64::from(width)).abs() < 0.25, "{width}: {column}");
        }
        let twice = [[10.0, 50.0], [90.0, 50.0], [50.0, 50.0], [50.0, 10.0], [50.0, 90.0]];
        let canvas = drawn(vec![item(&twice, 6.0, 0.5)]);
        assert_eq!([canvas.get(50, 50), canvas.get(30, 50)], [Some([128; 3]); 2]);
    }

    #[test]
    fn a_picture_fills_its_rectangle() {
        let pixels: Vec<u8> = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]].concat();
        let item = Item::Picture { area: Rect::new(10.0, 20.0, 40.0, 60.0), width: 2, height: 2, pixels };
        let canvas = drawn(vec![item]);
        let at = |x, y| canvas.get(x, y).unwrap();
        assert_eq!(
            [at(10, 20), at(49, 49), at(29, 50), at(30, 79)],
            [[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]]
        );
        assert_eq!([at(9, 20), at(50, 20), at(10, 19), at(10, 80)], [[255; 3]; 4]);
    }
}
