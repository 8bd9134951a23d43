//! A page of palettes: each as a bar, and applied to an island and the sea around it.

use super::canvas::{Canvas, Ink};
use super::shade::Shade;
use super::text::{BuiltinFont, Face, Style};
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::words;
use orogen_io::palette::color::Encoder;
use orogen_io::palette::fitted::Fitted;
use orogen_io::palette::palette::{Palette, Position};
use orogen_io::palette::tint::Tint;

/// A palette on the page.
#[derive(Debug, Clone)]
pub struct Swatch {
    /// The palette.
    pub palette: Palette,
    /// Description and author.
    pub about: String,
    /// Whether color-blind readers can distinguish its heights.
    pub safe: bool,
}

const PAPER: Ink = [253, 253, 251];
const INK: Ink = [30, 30, 32];
const SOFT: Ink = [105, 105, 108];
const LINE: Ink = [150, 150, 150];
const SAFE: Ink = [24, 110, 72];

const MARGIN: usize = 48;
const HEADER: usize = 92;
const COLUMNS: usize = 2;
const COLUMN: usize = 700;
const GUTTER: usize = 44;
const ROW: usize = 116;
const BAR: [usize; 2] = [470, 52];
const PICTURE: [usize; 2] = [214, 88];

/// Draws the page.
///
/// # Errors
/// If the built-in font cannot be read.
pub fn draw(swatches: &[Swatch]) -> Result<Canvas> {
    let rows = swatches.len().div_ceil(COLUMNS);
    let width = 2 * MARGIN + COLUMNS * COLUMN + (COLUMNS - 1) * GUTTER;
    let mut page = Page {
        canvas: Canvas::new(width, HEADER + rows * ROW + MARGIN, PAPER),
        font: BuiltinFont::new()?,
        encoder: Encoder::new(),
        ground: ground(),
    };
    let style = |face, size, ink| Style { face, size, ink };
    page.font.write(&mut page.canvas, MARGIN as f32, 54, "Palettes", style(Face::Bold, 30.0, INK));
    let x = (MARGIN + 146) as f32;
    let note = "each as a bar from lowest to highest, and on an island";
    let end = page.font.write(&mut page.canvas, x, 54, note, style(Face::Regular, 15.0, SOFT));
    page.dot(end as i64 + 30, 49);
    let told = "distinguishable by color-blind readers";
    page.font.write(&mut page.canvas, end + 42.0, 54, told, style(Face::Regular, 15.0, SOFT));
    for (k, swatch) in swatches.iter().enumerate() {
        // Down the first column, then down the second.
        let (column, row) = (k / rows.max(1), k % rows.max(1));
        page.swatch(swatch, MARGIN + column * (COLUMN + GUTTER), HEADER + row * ROW);
    }
    Ok(page.canvas)
}

struct Page {
    canvas: Canvas,
    font: BuiltinFont,
    encoder: Encoder,
    ground: Grid,
}

impl Page {
    fn swatch(&mut self, swatch: &Swatch, left: usize, top: usize) {
        let name = Style { face: Face::Bold, size: 17.0, ink: INK };
        let about = Style { face: Face::Regular, size: 13.0, ink: SOFT };
        let (x, y) = (left as i64, top as i64);
        let end = self.font.write(&mut self.canvas, left as f32, y + 15, &swatch.palette.name, name);
        if swatch.safe {
            self.dot(end as i64 + 12, y + 9);
        }
        let cut = shortened(&self.font, &swatch.about, about, BAR[0] as f32);
        self.font.write(&mut self.canvas, left as f32, y + 33, &cut, about);
        self.bar(&swatch.palette, x, y + 42);
        self.picture(&swatch.palette, x + (COLUMN - PICTURE[0]) as i64, y + 6);
    }

    /// The colors from the lowest position to the highest.
    fn bar(&mut self, palette: &Palette, left: i64, top: i64) {
        let places = |of: fn(Position) -> Option<f64>| palette.stops.iter().filter_map(move |stop| of(stop.at));
        let ends = |of: fn(Position) -> Option<f64>| {
            places(of).fold((f64::MAX, f64::MIN), |(low, high), at| (low.min(at), high.max(at)))
        };
        let values = ends(|at| if let Position::Value(value) = at { Some(value) } else { None });
        // A palette with values is shown over them, others over any range.
        let [low, high] = if values.0 < values.1 { [values.0, values.1] } else { [-1000.0, 1000.0] };
        let (width, height) = (BAR[0] as i64, BAR[1] as i64);
        let sea = if palette.has_sea() { 0.0 } else { low };
        let fitted = Fitted::new(palette, low as f32, high as f32, sea as f32);
        for i in 0..width {
            let at = low + (high - low) * (i as f64 + 0.5) / width as f64;
            let ink = self.encoder.bytes(fitted.at(at as f32));
            self.canvas.fill(left + i..left + i + 1, top..top + height, ink);
        }
        self.frame(left, top, width, height);
    }

    /// The shaded island.
    fn picture(&mut self, palette: &Palette, left: i64, top: i64) {
        let (grid, degrees) = (&self.ground, palette.stops.iter().all(|stop| matches!(stop.at, Position::Value(_))));
        let tint = Tint::of(palette, grid, 0.0);
        let shade = Shade::fit(grid, 0.0);
        let (width, height) = (grid.width() - 2, grid.height() - 2);
        let mut pixels = vec![[0u8; 3]; width * height];
        let top_height = grid.data().iter().copied().fold(f32::MIN, f32::max);
        for (j, row) in pixels.chunks_exact_mut(width).enumerate() {
            let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
            gradients_between(rows, grid.window().cell, |i, gradient| {
                let height = rows[1][i + 1];
                // Palettes in a fixed unit are shown over its range.
                let shown = if degrees { height / top_height * 90.0 } else { height };
                let (color, light) = (tint.at(shown), shade.on(gradient));
                let share = if tint.is_sea(height) { 0.35 } else { 1.0 };
                let lit = std::array::from_fn(|c| color[c] * (1.0 + (light[c] - 1.0) * share));
                row[i] = self.encoder.bytes(lit);
            });
        }
        for (k, ink) in pixels.into_iter().enumerate() {
            self.canvas.set(left + (k % width) as i64, top + (k / width) as i64, ink);
        }
        self.frame(left, top, width as i64, height as i64);
    }

    fn frame(&mut self, left: i64, top: i64, width: i64, height: i64) {
        self.canvas.fill(left - 1..left + width + 1, top - 1..top, LINE);
        self.canvas.fill(left - 1..left + width + 1, top + height..top + height + 1, LINE);
        self.canvas.fill(left - 1..left, top..top + height, LINE);
        self.canvas.fill(left + width..left + width + 1, top..top + height, LINE);
    }

    fn dot(&mut self, x: i64, y: i64) {
        for (j, i) in (-6..=6).flat_map(|j| (-6..=6).map(move |i| (j, i))) {
            let share = 5.0 - ((i * i + j * j) as f32).sqrt() + 0.5;
            self.canvas.cover(x + i, y + j, SAFE, share);
        }
    }
}

/// The part of a text that fits.
fn shortened(font: &BuiltinFont, text: &str, style: Style, width: f32) -> String {
    words::shortened(text, width, |text| font.width(text, style))
}

/// An island with two summits, with a border of one sample.
fn ground() -> Grid {
    let window = Window::new(PICTURE[0] + 2, PICTURE[1] + 2, 40.0);
    let mut grid = Grid::filled(window, 0.0);
    for j in 0..window.height {
        for (i, height) in grid.row_mut(j).iter_mut().enumerate() {
            let (x, y) = (i as f64 / PICTURE[1] as f64, j as f64 / PICTURE[1] as f64);
            let hill = |cx: f64, cy: f64, r: f64| libm::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (r * r));
            let ribs = 0.5 + 0.5 * libm::sin(9.0 * libm::atan2(y - 0.48, x - 0.95) + 4.0 * libm::sin(5.0 * x));
            let waves = libm::sin(7.0 * x + 3.0 * y) * libm::sin(5.0 * y - 2.0 * x);
            let land = 1.15 * hill(0.95, 0.48, 0.42) + 0.62 * hill(1.62, 0.6, 0.34) - 0.28;
            *height = (1800.0 * (land * (1.0 - 0.16 * ribs) + 0.03 * waves)) as f32;
        }
    }
    grid
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_io::palette::named;

    #[test]
    fn every_palette_has_its_place() {
        let swatches: Vec<Swatch> = named::all()
            .iter()
            .map(|named| Swatch { palette: named.palette(), about: named.about.to_string(), safe: named.safe })
            .collect();
        let page = draw(&swatches).unwrap();
        assert_eq!(page.height(), HEADER + swatches.len().div_ceil(2) * ROW + MARGIN);
        // The gray bar starts with black and ends with white.
        let k = swatches.iter().position(|swatch| swatch.palette.name == "grey").unwrap();
        let rows = swatches.len().div_ceil(2);
        let (x, y) = (MARGIN + k / rows * (COLUMN + GUTTER), HEADER + k % rows * ROW + 60);
        let at = |x: usize| page.get(x as i64, y as i64).unwrap()[0];
        assert!(at(x) < 5 && at(x + BAR[0] - 1) > 250, "{} {}", at(x), at(x + BAR[0] - 1));
        assert_eq!(draw(&[]).unwrap().height(), HEADER + MARGIN);
    }
}
