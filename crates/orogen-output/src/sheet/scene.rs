//! What is drawn on a sheet, as a list from the lowest to the uppermost: the same for every kind of file.

use orogen_io::palette::color::Rgb;

/// Words and frames.
pub const INK: Rgb = [38, 36, 34];

/// A position on the page in millimetres: from the left, from the top.
pub type Point = [f32; 2];

/// A part of an outline, from where the last one ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// Begins a new outline.
    Move(Point),
    /// A straight line.
    Line(Point),
    /// A cubic curve: two handles, then the end.
    Curve(Point, Point, Point),
}

/// One thing that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A picture, its rows from the top, over a rectangle.
    Picture {
        /// Left, top, width and height in millimetres.
        area: [f32; 4],
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
        /// sRGB bytes, three a pixel.
        pixels: Vec<u8>,
    },
    /// Lines with round ends and corners, of one width, as one: where they cross, ink is not laid twice.
    Lines {
        /// Each an open line; a ring names its first place again.
        lines: Vec<Vec<Point>>,
        /// In millimetres.
        width: f32,
        /// The colour.
        ink: Rgb,
        /// How much of what is below is covered, 0 to 1.
        cover: f32,
    },
    /// Areas within closed outlines; what runs clockwise and what runs counter-clockwise around a place cancel out.
    Area {
        /// The outlines, closed by themselves.
        outline: Vec<Step>,
        /// The colour.
        ink: Rgb,
        /// How much of what is below is covered, 0 to 1.
        cover: f32,
    },
}

/// A page.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Width and height in millimetres.
    pub size: [f32; 2],
    /// What it is called: files say so to whoever opens them.
    pub title: String,
    /// From the lowest to the uppermost.
    pub items: Vec<Item>,
}

impl Scene {
    /// Adds lines, if there are any.
    pub fn lines(&mut self, lines: Vec<Vec<Point>>, width: f32, ink: Rgb, cover: f32) {
        let lines: Vec<Vec<Point>> = lines.into_iter().filter(|line| line.len() > 1).collect();
        if !lines.is_empty() {
            self.items.push(Item::Lines { lines, width, ink, cover });
        }
    }

    /// Adds areas, if there are any.
    pub fn area(&mut self, outline: Vec<Step>, ink: Rgb, cover: f32) {
        if !outline.is_empty() {
            self.items.push(Item::Area { outline, ink, cover });
        }
    }

    /// Adds a filled rectangle.
    pub fn block(&mut self, [left, top, width, height]: [f32; 4], ink: Rgb) {
        let corners = [[left, top], [left + width, top], [left + width, top + height], [left, top + height]];
        self.area(polygon(&corners), ink, 1.0);
    }

    /// Adds the frame of a rectangle: a line around it.
    pub fn frame(&mut self, [left, top, width, height]: [f32; 4], line: f32, ink: Rgb) {
        let (right, bottom) = (left + width, top + height);
        let ring = vec![[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        self.lines(vec![ring], line, ink, 1.0);
    }
}

/// The outline of a polygon.
pub fn polygon(corners: &[Point]) -> Vec<Step> {
    corners.iter().enumerate().map(|(k, place)| if k == 0 { Step::Move(*place) } else { Step::Line(*place) }).collect()
}
