//! The page: headings, pictures and captions on a grid.

use orogen_grid::error::Result;
use orogen_grid::parallel;
use orogen_grid::progress::Progress;

use super::panel::{self, Pictures};
use super::row::{COLUMNS, Row, SIDE};
use crate::map::canvas::{Canvas, Ink};
use crate::map::text::{BuiltinFont, Face, Style};

/// All inks are gray, so that the page is written as grayscale, in half the bytes.
const PAPER: Ink = [253; 3];
const INK: Ink = [28; 3];
const SOFT: Ink = [97; 3];
const LINE: Ink = [194; 3];

/// Dimensions for pictures of [`SIDE`] samples; they scale with the pictures.
const MARGIN: f64 = 52.0;
const GUTTER: f64 = 22.0;
/// Distance between the two pictures of a noise.
const SEAM: f64 = 4.0;
const HEADER: f64 = 76.0;
const ROW_HEADING: f64 = 44.0;
const CAPTION: f64 = 48.0;
const ROW_GAP: f64 = 22.0;
const FOOTER: f64 = 20.0;

/// The layout of the page.
struct Layout<'a> {
    rows: &'a [Row],
    side: usize,
    scale: f64,
    font: BuiltinFont,
    canvas: Canvas,
}

/// The size of a page with pictures of `side` samples per side.
#[must_use]
pub fn size(rows: usize, side: usize) -> [usize; 2] {
    let at = |measure: f64| measure * scale(side);
    let width = 2.0 * at(MARGIN) + COLUMNS as f64 * side as f64 + (COLUMNS - 1) as f64 * at(GUTTER);
    let row = at(ROW_HEADING) + 2.0 * side as f64 + at(SEAM) + at(CAPTION) + at(ROW_GAP);
    let height = 2.0 * at(MARGIN) + at(HEADER) + rows as f64 * row + at(FOOTER);
    [width.ceil() as usize, height.ceil() as usize]
}

fn scale(side: usize) -> f64 {
    side as f64 / SIDE
}

/// Draws the page.
///
/// # Errors
/// If the font cannot be loaded, or the work is cancelled.
pub fn draw(rows: &[Row], side: usize, seed: u64, progress: &Progress) -> Result<Canvas> {
    let [width, height] = size(rows.len(), side);
    let canvas = Canvas::new(width, height, PAPER);
    let mut layout = Layout { rows, side, scale: scale(side), font: BuiltinFont::new()?, canvas };
    progress.expect(rows.iter().map(|row| row.noises.len() as f64).sum());
    let picture = |shown| {
        progress.check()?;
        let pictures = panel::draw(shown, side);
        progress.advance(1.0);
        Ok(pictures)
    };
    let pictures: Vec<Vec<Pictures>> = parallel::try_map(rows, |row| parallel::try_map(&row.noises, picture))?;
    let mut top = layout.header();
    let mut number = 1;
    for (row, pictures) in rows.iter().zip(&pictures) {
        layout.heading(row, top);
        let shown_at = top + layout.at(ROW_HEADING);
        for (column, (shown, pictures)) in row.noises.iter().zip(pictures).enumerate() {
            let left = layout.left(column);
            let caption_at = layout.pictures(pictures, left, shown_at);
            layout.caption([&number.to_string(), shown.name, shown.about], left, caption_at);
            number += 1;
        }
        top += layout.at(ROW_HEADING) + 2.0 * side as f64 + layout.at(SEAM) + layout.at(CAPTION) + layout.at(ROW_GAP);
    }
    layout.note(top, seed);
    layout.footer(seed);
    Ok(layout.canvas)
}

impl Layout<'_> {
    fn at(&self, measure: f64) -> f64 {
        measure * self.scale
    }

    fn left(&self, column: usize) -> f64 {
        (self.at(MARGIN) + column as f64 * (self.side as f64 + self.at(GUTTER))).round()
    }

    fn style(&self, face: Face, size: f64, ink: Ink) -> Style {
        Style { face, size: self.at(size) as f32, ink }
    }

    /// Draws text at `x` and returns its end.
    fn write(&mut self, text: &str, [x, baseline]: [f64; 2], style: Style) -> f64 {
        f64::from(self.font.write(&mut self.canvas, x as f32, baseline.round() as i64, text, style))
    }

    fn rule(&mut self, y: f64, thickness: f64) {
        let columns = self.at(MARGIN).round() as i64..self.canvas.width() as i64 - self.at(MARGIN).round() as i64;
        let rows = y.round() as i64..y.round() as i64 + (self.at(thickness).round() as i64).max(1);
        self.canvas.fill(columns, rows, if thickness > 1.0 { INK } else { LINE });
    }

    /// Draws the header; returns the top of the rows.
    fn header(&mut self) -> f64 {
        let (left, top) = (self.at(MARGIN), self.at(MARGIN));
        let noises: usize = self.rows.iter().map(|row| row.noises.len()).sum();
        let title = self.style(Face::Bold, 30.0, INK);
        self.write("Noise", [left, top + self.at(22.0)], title);
        let words = format!("{noises} noises and aggregates, each as heights (above) and as hillshade (below)");
        let style = self.style(Face::Regular, 15.0, SOFT);
        self.write(&words, [left, top + self.at(48.0)], style);
        top + self.at(HEADER)
    }

    fn heading(&mut self, row: &Row, top: f64) {
        self.rule(top, 1.0);
        let baseline = top + self.at(25.0);
        let (bold, soft) = (self.style(Face::Bold, 16.0, INK), self.style(Face::Italic, 14.0, SOFT));
        let end = self.write(row.title, [self.at(MARGIN), baseline], bold);
        self.write(row.about, [end + self.at(12.0), baseline], soft);
    }

    /// Draws the two pictures of a noise and returns the baseline of its caption.
    fn pictures(&mut self, pictures: &Pictures, left: f64, top: f64) -> f64 {
        let below = (top + self.side as f64 + self.at(SEAM)).round();
        for (greys, top) in [(&pictures.heights, top.round()), (&pictures.shade, below)] {
            for (j, row) in greys.chunks_exact(self.side).enumerate() {
                for (i, &grey) in row.iter().enumerate() {
                    self.canvas.set(left as i64 + i as i64, top as i64 + j as i64, [grey; 3]);
                }
            }
        }
        below + self.side as f64
    }

    fn caption(&mut self, [number, name, about]: [&str; 3], left: f64, top: f64) {
        let (bold, soft) = (self.style(Face::Bold, 14.0, INK), self.style(Face::Regular, 13.0, SOFT));
        let baseline = top + self.at(20.0);
        let end = self.write(number, [left, baseline], self.style(Face::Italic, 14.0, SOFT));
        let left = end.max(left + self.at(9.0)) + self.at(6.0);
        self.write(name, [left, baseline], bold);
        self.write(about, [left, baseline + self.at(18.0)], soft);
    }

    /// The explanation in the free space of the last row; `bottom` is the end of that row.
    fn note(&mut self, bottom: f64, seed: u64) {
        let free = self.rows.last().map_or(COLUMNS, |row| row.noises.len());
        if free >= COLUMNS {
            return;
        }
        let left = self.left(free);
        let width = self.canvas.width() as f64 - self.at(MARGIN) - left;
        let mut baseline =
            bottom - self.at(ROW_GAP) - self.at(CAPTION) - 2.0 * self.side as f64 - self.at(SEAM) + self.at(14.0);
        self.write("How to read it", [left, baseline], self.style(Face::Bold, 14.0, INK));
        baseline += self.at(26.0);
        let style = self.style(Face::Regular, 13.0, INK);
        let words = [
            "Heights: black is low and white is high, over the range of each noise.".to_string(),
            "Hillshade: the same ground in light from the north-west, half way up the sky. What is white stands an eighth \
             of the picture’s width above what is black."
                .to_string(),
            format!("Each picture is {SIDE} wide; wavelengths and distances are in the same unit. The seed is {seed}."),
            "fBm is fractional Brownian motion: a sum of octaves of noise, each finer and weaker than the one before.".to_string(),
        ];
        for paragraph in words {
            for line in self.font.wrap(&paragraph, style, width as f32) {
                self.write(&line, [left, baseline], style);
                baseline += self.at(18.0);
            }
            baseline += self.at(8.0);
        }
    }

    fn footer(&mut self, seed: u64) {
        let baseline = self.canvas.height() as f64 - self.at(MARGIN) * 0.75;
        let words = format!("Orogen {}: orogen compare --seed {seed} --size {}", env!("CARGO_PKG_VERSION"), self.side);
        let style = self.style(Face::Regular, 12.0, SOFT);
        self.write(&words, [self.at(MARGIN), baseline], style);
    }
}
