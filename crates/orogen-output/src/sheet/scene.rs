//! The display list of a sheet, from bottom to top: the same for every output format.

use super::geometry::{Point, Rect, Size};
use orogen_io::palette::color::Rgb;

/// Ink of text and frames.
pub const INK: Rgb = [38, 36, 34];

/// Page color of a sheet for which no color was chosen.
pub const WHITE: Rgb = [255; 3];

/// A part of an outline, continuing from the end of the previous one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Starts a new outline.
    Move(Point),
    /// A straight line.
    Line(Point),
    /// A cubic Bézier curve: two control points, then the end.
    Curve(Point, Point, Point),
}

/// An item of the display list.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A picture over a rectangle, rows from the top.
    Picture {
        /// The rectangle.
        area: Rect,
        /// Pixels per row.
        width: usize,
        /// Number of rows.
        height: usize,
        /// sRGB bytes, three per pixel.
        pixels: Vec<u8>,
    },
    /// Lines with round caps and joins, of one width. They are painted as one shape: crossings do not get ink twice.
    Lines {
        /// Open lines; a ring repeats its first point.
        lines: Vec<Vec<Point>>,
        /// Width in millimetres.
        width: f32,
        /// The color.
        ink: Rgb,
        /// Opacity, 0 to 1.
        cover: f32,
    },
    /// Areas within closed outlines, with the non-zero winding rule.
    Area {
        /// The outlines, closed implicitly.
        outline: Vec<Step>,
        /// The color.
        ink: Rgb,
        /// Opacity, 0 to 1.
        cover: f32,
    },
}

/// A page.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The size of the page.
    pub size: Size,
    /// The color of the page.
    pub page: Rgb,
    /// The title in the metadata of files.
    pub title: String,
    /// The items, from bottom to top.
    pub items: Vec<Item>,
}

impl Scene {
    /// A white page without items.
    #[must_use]
    pub fn new(size: Size, title: impl Into<String>) -> Scene {
        Scene { size, page: WHITE, title: title.into(), items: Vec::new() }
    }

    /// Adds lines, unless there are none.
    pub fn lines(&mut self, lines: Vec<Vec<Point>>, width: f32, ink: Rgb, cover: f32) {
        let lines: Vec<Vec<Point>> = lines.into_iter().filter(|line| line.len() > 1).collect();
        if !lines.is_empty() {
            self.items.push(Item::Lines { lines, width, ink, cover });
        }
    }

    /// Adds areas, unless there are none.
    pub fn area(&mut self, outline: Vec<Step>, ink: Rgb, cover: f32) {
        if !outline.is_empty() {
            self.items.push(Item::Area { outline, ink, cover });
        }
    }

    /// Adds a filled rectangle.
    pub fn block(&mut self, area: Rect, ink: Rgb) {
        self.area(polygon(area.corners()), ink, 1.0);
    }

    /// Adds the frame of a rectangle: a line around it.
    pub fn frame(&mut self, area: Rect, line: f32, ink: Rgb) {
        let ring = area.corners().into_iter().chain([area.corner()]).collect();
        self.lines(vec![ring], line, ink, 1.0);
    }
}

/// The outline of a polygon.
#[must_use]
pub fn polygon(corners: impl IntoIterator<Item = impl Into<Point>>) -> Vec<Step> {
    let step = |(k, place): (usize, _)| if k == 0 { Step::Move(place) } else { Step::Line(place) };
    corners.into_iter().map(Into::into).enumerate().map(step).collect()
}

/// A line through points.
#[must_use]
pub fn line(places: impl IntoIterator<Item = impl Into<Point>>) -> Vec<Point> {
    places.into_iter().map(Into::into).collect()
}
