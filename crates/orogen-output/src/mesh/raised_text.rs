//! Letters that stand out from a wall.

use orogen_grid::triangles::falls;

use super::clip::{Clipped, clip};
use crate::map::canvas::Canvas;
use crate::map::text::{BuiltinFont, Face, Style};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;

/// Pixels of an em in which letters are drawn.
const EM: f32 = 40.0;

/// Maximum number of letters.
const MAX_LETTERS: usize = 200;

/// The largest size of letters, in millimetres per em, and their parts of the wall.
const MAX_SIZE: f64 = 12.0;
const OF_HEIGHT: f64 = 0.8;
const OF_LENGTH: f64 = 0.9;

/// The largest model in sizes of its letters: beyond it their outlines would not be exact.
const MAX_LENGTH: f64 = 800.0;

/// A line of letters as triangles: along the wall, up, and 1 in the third coordinate, which is that of the cut.
pub(super) struct RaisedText {
    /// The letters.
    pub front: Clipped,
    /// Their size in millimetres per em.
    pub size: f64,
}

impl RaisedText {
    /// A line of text in the middle of a wall of this length and height, in millimetres.
    ///
    /// # Errors
    /// If the font lacks a letter, or there are none or too many.
    pub fn new(text: &str, length: f64, height: f64) -> Result<RaisedText> {
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
        let size = MAX_SIZE.min(OF_HEIGHT * height).min(OF_LENGTH * length * f64::from(EM) / wide);
        if length > MAX_LENGTH * size {
            return Err(refuse(format!(
                "the letters of --text would have a size of {} mm on a model of {} mm; use a thicker --base or a shorter text",
                number((size * 100.0).round() / 100.0),
                number((length * 10.0).round() / 10.0)
            )));
        }
        // Room for what stands out of the line, and an empty border.
        let (left, baseline) = (EM / 2.0, 1.5 * EM);
        let mut canvas = Canvas::new((wide + f64::from(EM)) as usize + 1, (2.0 * EM) as usize, [255; 3]);
        font.write(&mut canvas, left, baseline as i64, text, style);
        let pixel = size / f64::from(EM);
        let (columns, rows) = (canvas.width(), canvas.height());
        // The middle of the capitals is that of the wall.
        let x = |column: usize| (0.5 * length + (column as f64 + 0.5 - f64::from(left) - 0.5 * wide) * pixel) as f32;
        let z = |row: usize| {
            (0.5 * height + (f64::from(baseline) - 0.36 * f64::from(EM) - row as f64 - 0.5) * pixel) as f32
        };
        let ink = |column: usize, row: usize| {
            canvas.get(column as i64, row as i64).map_or(0.0, |[grey, ..]| 1.0 - f32::from(grey) / 255.0)
        };
        let corners: Vec<[f32; 3]> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| [x(column), z(row), ink(column, row)])
            .collect();
        let mut triangles = Vec::with_capacity(2 * rows * columns);
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let at = (row * columns + column) as u32;
                let [nw, ne, sw, se] = [at, at + 1, at + columns as u32, at + columns as u32 + 1];
                let inks = [nw, ne, sw, se].map(|corner| corners[corner as usize][2]);
                if inks.iter().any(|ink| *ink > 0.5) {
                    let pair = if falls(inks) { [[nw, sw, se], [nw, se, ne]] } else { [[nw, sw, ne], [ne, sw, se]] };
                    triangles.extend(pair);
                }
            }
        }
        Ok(RaisedText { front: clip(&corners, &triangles, &[], 0.5), size })
    }
}

fn refuse(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}
