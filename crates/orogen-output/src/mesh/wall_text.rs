//! Letters on a wall, raised or engraved.

use std::ops::RangeInclusive;

use orogen_grid::triangles::falls;

use super::clip::{Clipped, Parted, clip, part};
use crate::map::canvas::Canvas;
use crate::map::text::{BuiltinFont, Face, Style};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;

/// Resolution in which letters are drawn, in pixels per em.
const EM: f32 = 40.0;

/// Maximum number of letters.
const MAX_LETTERS: usize = 200;

/// The largest size of letters, in millimetres per em, and their parts of the wall.
const MAX_SIZE: f64 = 12.0;
const OF_HEIGHT: f64 = 0.8;
const OF_LENGTH: f64 = 0.9;

/// The longest model, in multiples of its letter size; beyond it the outlines would not be exact.
const MAX_LENGTH: f64 = 800.0;

/// A straight wall, in millimetres from the window's south-western corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StraightWall {
    pub west: f32,
    pub east: f32,
    /// The minimum height of its upper edge.
    pub height: f32,
}

/// A line of letters as triangles. Coordinates are along the wall, up, and the coverage by ink, 0 to 1; letters are
/// where the coverage is above [`EDGE`].
pub(super) struct WallText {
    corners: Vec<[f32; 3]>,
    /// Number of vertices along the wall and up. They are stored row by row from the top; vertices at the border have
    /// no ink.
    pub lattice: [usize; 2],
    /// Size of the letters in millimetres per em.
    pub size: f64,
}

/// The coverage at the outline of a letter.
const EDGE: f32 = 0.5;

impl WallText {
    /// A line of text in the middle of the wall where it is largest, for a model of this length in millimetres. With
    /// `is_within`, all letters fit within the height of the wall, otherwise only the capitals.
    ///
    /// # Errors
    /// If the font lacks a letter, there are no letters or too many, or no wall has room for them.
    pub fn new(text: &str, walls: &[StraightWall], model: f64, is_within: bool) -> Result<WallText> {
        let text = text.trim();
        let font = BuiltinFont::new()?;
        if let Some(letter) = font.lacking(text) {
            return Err(refuse(format!("the built-in font has no letter for `{}` of --text", letter.escape_debug())));
        }
        if text.is_empty() || text.chars().count() > MAX_LETTERS {
            return Err(refuse(format!("--text must have 1 to {MAX_LETTERS} letters")));
        }
        let style = Style { face: Face::Bold, size: EM, ink: [0; 3] };
        let wide = f64::from(font.width(text, style));
        // Room for strokes that overhang the line, and an empty border.
        let (left, baseline) = (EM / 2.0, 1.5 * EM);
        let mut canvas = Canvas::new((wide + f64::from(EM)) as usize + 1, (2.0 * EM) as usize, [255; 3]);
        font.write(&mut canvas, left, baseline as i64, text, style);
        let ink = |column: usize, row: usize| {
            canvas.get(column as i64, row as i64).map_or(0.0, |[grey, ..]| 1.0 - f32::from(grey) / 255.0)
        };
        let [columns, rows] = inked(canvas.width(), canvas.height(), ink);
        // The capitals are centered on the wall; this much of an em is above and below their middle.
        let middle = f64::from(baseline) - 0.36 * f64::from(EM) - 0.5;
        let of_height = match is_within {
            true => {
                let most = (middle - *rows.start() as f64).max(*rows.end() as f64 - middle);
                OF_HEIGHT.min(0.45 * f64::from(EM) / most)
            }
            false => OF_HEIGHT,
        };
        let fitted = |wall: &StraightWall| {
            let [length, height] = [wall.east - wall.west, wall.height].map(f64::from);
            MAX_SIZE.min(of_height * height).min(OF_LENGTH * length * f64::from(EM) / wide)
        };
        // The first of equal ones.
        let Some(wall) = walls.iter().rev().max_by(|a, b| fitted(a).total_cmp(&fitted(b))) else {
            return Err(refuse(
                "there is no straight side for the letters of --text: the land above the cut does not reach the southern side of the window"
                    .into(),
            ));
        };
        let size = fitted(wall);
        if model > MAX_LENGTH * size {
            return Err(refuse(format!(
                "the letters of --text would have a size of {} mm on a model of {} mm; use a thicker --base or a shorter text",
                number((size * 100.0).round() / 100.0),
                number((model * 10.0).round() / 10.0)
            )));
        }
        let center = 0.5 * (f64::from(wall.west) + f64::from(wall.east));
        let pixel = size / f64::from(EM);
        let x = |column: usize| (center + (column as f64 + 0.5 - f64::from(left) - 0.5 * wide) * pixel) as f32;
        let z = |row: usize| (0.5 * f64::from(wall.height) + (middle - row as f64) * pixel) as f32;
        let lattice = [columns.clone().count(), rows.clone().count()];
        let corners = rows
            .flat_map(|row| columns.clone().map(move |column| (column, row)))
            .map(|(column, row)| [x(column), z(row), ink(column, row)])
            .collect();
        Ok(WallText { corners, lattice, size })
    }

    /// The triangles of the lattice, counter-clockwise seen from the south.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let [columns, rows] = self.lattice;
        let mut triangles = Vec::with_capacity(2 * rows * columns);
        for row in 0..rows.saturating_sub(1) {
            for column in 0..columns - 1 {
                let at = (row * columns + column) as u32;
                let [nw, ne, sw, se] = [at, at + 1, at + columns as u32, at + columns as u32 + 1];
                let inks = [nw, ne, sw, se].map(|corner| self.corners[corner as usize][2]);
                let pair = if falls(inks) { [[nw, sw, se], [nw, se, ne]] } else { [[nw, sw, ne], [ne, sw, se]] };
                triangles.extend(pair);
            }
        }
        triangles
    }

    /// Only the letters.
    pub fn letters(&self) -> Clipped {
        clip(&self.corners, &self.triangles(), &[], EDGE)
    }

    /// The letters, and the wall around them.
    pub fn parted(&self) -> Parted {
        part(&self.corners, &self.triangles(), EDGE)
    }
}

/// The columns and rows with ink, and two more on each side.
fn inked(width: usize, height: usize, ink: impl Fn(usize, usize) -> f32) -> [RangeInclusive<usize>; 2] {
    let around = |count: usize, has_ink: &dyn Fn(usize) -> bool| {
        let first = (0..count).find(|at| has_ink(*at)).unwrap_or_default();
        let last = (0..count).rfind(|at| has_ink(*at)).unwrap_or_default();
        first.saturating_sub(2)..=(last + 2).min(count.saturating_sub(1))
    };
    [
        around(width, &|column| (0..height).any(|row| ink(column, row) > 0.0)),
        around(height, &|row| (0..width).any(|column| ink(column, row) > 0.0)),
    ]
}

fn refuse(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}
