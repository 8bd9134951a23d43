//! A page with maps of a terrain and its statistics.

use super::chart::{Axis, BAND, Frame, GROUND, INK, LINE, MARK, PAPER, SOFT, Sheet, WATER, bold, plain, small};
use super::land::Land;
use super::measures::{Measures, SLOPE_CLASS};
use super::real::{FIGURES, SOURCE};
use crate::map::canvas::Canvas;
use crate::map::paint::Painter;
use crate::map::text::BuiltinFont;
use orogen_engine::layer::LayerKind;
use orogen_grid::analysis::geomorphons::FORMS;
use orogen_grid::analysis::hillshade::{Light, hillshade};
use orogen_grid::analysis::slope::extended;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::{resample, words};
use orogen_io::palette::palette::NO_DATA;
use orogen_noise::Points;

/// Maximum memory for drawing it, beside the heights, in bytes.
pub const MEMORY: u64 = 16 << 20;

/// Memory of the rows read at a time, for a window with heights on disk, in bytes.
#[must_use]
pub fn rows_memory(window: &Window) -> u64 {
    (window.width.max(window.height) as u64)
        .div_ceil(PICTURE as u64)
        .saturating_add(1)
        .saturating_mul(4 * window.width as u64)
}

const WIDTH: f64 = 1500.0;
const HEIGHT: f64 = 1490.0;
const MARGIN: f64 = 54.0;
/// Side of the two pictures, in pixels.
const PICTURE: f64 = 520.0;
const GAP: f64 = 34.0;

/// The title of the page.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Title {
    /// Its name.
    pub name: String,
    /// A line of small print: source and processing; empty by default.
    pub about: String,
}

impl Title {
    /// A name without small print.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Title {
        Title { name: name.into(), about: String::new() }
    }

    /// The same with this line of small print.
    #[must_use]
    pub fn with_about(self, about: impl Into<String>) -> Title {
        Title { about: about.into(), ..self }
    }
}

/// Draws the page of a terrain.
///
/// # Errors
/// If the disk fails, or the built-in font cannot be read.
pub fn draw(title: &Title, land: &Land, measures: &Measures) -> Result<Canvas> {
    let canvas = Canvas::new(WIDTH as usize, HEIGHT as usize, PAPER);
    let mut sheet = Sheet { canvas, font: BuiltinFont::new()? };
    let (window, sea_level) = (land.window(), land.sea_level());
    let wide = (WIDTH - 2.0 * MARGIN) as f32;
    let fitted = |font: &BuiltinFont, text: &str, style| words::shortened(text, wide, |text| font.width(text, style));
    let name = fitted(&sheet.font, &title.name, bold(34.0));
    let about = fitted(&sheet.font, &title.about, small());
    sheet.text(MARGIN, 74.0, 0.0, &name, bold(34.0));
    let size = [window.width, window.height].map(|samples| samples as f64 * window.cell / 1000.0);
    let [low, mean, high] = measures.heights;
    let facts = format!(
        "{} x {} samples of {:.1} m, {:.1} x {:.1} km; heights {low:.0} to {high:.0} m, {mean:.0} m on average",
        window.width, window.height, window.cell, size[0], size[1]
    );
    sheet.text(MARGIN, 102.0, 0.0, &facts, plain(16.0));
    sheet.text(MARGIN, 124.0, 0.0, &about, small());
    let top = 172.0;
    let shown = Shown::of(land)?;
    let second = MARGIN + PICTURE + GAP;
    relief(&mut sheet, &shown, sea_level, [MARGIN, top]);
    drainage(&mut sheet, &shown, sea_level, measures, [second, top]);
    let third = second + PICTURE + GAP + 44.0;
    let side = WIDTH - MARGIN - third;
    hypsometry(&mut sheet, measures, [third, top, side, 208.0]);
    slopes(&mut sheet, measures, [third, top + 292.0, side, 208.0]);
    let row = top + PICTURE + 96.0;
    spectrum(&mut sheet, measures, [MARGIN + 48.0, row, 360.0, 230.0]);
    rose(&mut sheet, measures, [640.0, row + 120.0], 112.0, row);
    forms(&mut sheet, measures, [900.0, row, WIDTH - MARGIN - 900.0]);
    table(&mut sheet, measures, row + 322.0);
    Ok(sheet.canvas)
}

/// The terrain at the size of a picture.
struct Shown {
    grid: Grid,
    /// Pixels per sample of the terrain.
    scale: f64,
    /// Samples per row of the terrain.
    width: usize,
}

impl Shown {
    fn of(land: &Land) -> Result<Shown> {
        let window = land.window();
        let longer = window.width.max(window.height) as f64;
        let scale = PICTURE / longer;
        let size = [window.width, window.height].map(|side| ((side as f64 * scale).round() as usize).max(1));
        let small = Window::new(size[0], size[1], window.cell / scale);
        let mut grid = Grid::filled(small, 0.0f32);
        if scale >= 1.0 {
            let heights = land.ground(0..window.height)?;
            let own = Grid::from_data(Window::new(window.width, window.height, 1.0), heights.data().to_vec());
            // Pixel centers, in samples.
            let at = |count: usize| (0..count).map(|k| (k as f64 + 0.5) / scale - 0.5).collect::<Vec<f64>>();
            let (xs, ys) = (at(size[0]), at(size[1]));
            if let Some(own) = own {
                resample::read(&own, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, grid.data_mut());
            }
        } else {
            let span = |k: usize, side: usize| {
                let from = (k as f64 / scale) as usize;
                from..(((k + 1) as f64 / scale) as usize).clamp(from + 1, side.max(from + 1)).min(side)
            };
            for j in 0..size[1] {
                let heights = land.ground(span(j, window.height))?;
                for i in 0..size[0] {
                    let (mut sum, mut count) = (0.0, 0.0);
                    for y in 0..heights.height() {
                        for height in &heights.row(y)[span(i, window.width)] {
                            sum += f64::from(*height);
                            count += 1.0;
                        }
                    }
                    grid.row_mut(j)[i] = (sum / count) as f32;
                }
            }
        }
        Ok(Shown { grid, scale, width: window.width })
    }

    /// Draws a picture of this size on the sheet, centered in its square.
    fn put(&self, sheet: &mut Sheet, corner: [f64; 2], pixel: impl Fn(usize, usize) -> [u8; 3]) -> [f64; 2] {
        let [left, top] = self.corner(corner);
        for j in 0..self.grid.height() {
            for i in 0..self.grid.width() {
                sheet.canvas.set(left as i64 + i as i64, top as i64 + j as i64, pixel(i, j));
            }
        }
        [left, top]
    }

    fn corner(&self, [left, top]: [f64; 2]) -> [f64; 2] {
        // Tall pictures are centered, wide ones are aligned at the top.
        [left + ((PICTURE - self.grid.width() as f64) / 2.0).floor(), top]
    }

    /// The row below the picture.
    fn below(&self, top: f64) -> f64 {
        top + self.grid.height() as f64
    }
}

fn relief(sheet: &mut Sheet, shown: &Shown, sea_level: Option<f32>, corner: [f64; 2]) {
    let sea = sea_level.map_or(f64::NEG_INFINITY, f64::from);
    // Without a sea, colors start at the lowest ground.
    let lowest = shown.grid.data().iter().copied().filter(|h| h.is_finite()).fold(f32::MAX, f32::min);
    let painter = Painter::fit(&shown.grid, if sea.is_finite() { sea } else { f64::from(lowest) - 1.0 });
    let wide = extended(&shown.grid);
    let width = shown.grid.width();
    let mut rows = vec![0u8; 3 * width * shown.grid.height()];
    for (j, row) in rows.chunks_exact_mut(3 * width).enumerate() {
        painter.row([wide.row(j), wide.row(j + 1), wide.row(j + 2)], shown.grid.window().cell, row);
    }
    shown.put(sheet, corner, |i, j| std::array::from_fn(|c| rows[3 * (j * width + i) + c]));
    sheet.text(corner[0], corner[1] - 12.0, 0.0, "Relief", bold(16.0));
    scale_bar(sheet, shown, corner);
}

/// A scale bar of a round length, below the picture.
fn scale_bar(sheet: &mut Sheet, shown: &Shown, [left, top]: [f64; 2]) {
    let metres = shown.grid.window().cell;
    let most = 0.3 * PICTURE * metres;
    let power = libm::pow(10.0, libm::log10(most).floor());
    let length = [5.0, 2.0, 1.0].into_iter().map(|n| n * power).find(|length| *length <= most).unwrap_or(power);
    let (pixels, y) = (length / metres, (shown.below(top) + 14.0) as f32);
    sheet.line(&[(left as f32, y), ((left + pixels) as f32, y)], 3.0, INK);
    let text = if length >= 1000.0 { format!("{} km", length / 1000.0) } else { format!("{length} m") };
    sheet.text(left + pixels + 8.0, f64::from(y) + 5.0, 0.0, &text, small());
}

fn drainage(sheet: &mut Sheet, shown: &Shown, sea_level: Option<f32>, measures: &Measures, corner: [f64; 2]) {
    let shade = hillshade(&extended(&shown.grid), &Light::new(315.0, 45.0, 1.0));
    let sea = sea_level.unwrap_or(f32::NEG_INFINITY);
    let [left, top] = shown.put(sheet, corner, |i, j| {
        let height = shown.grid[(i, j)];
        if !height.is_finite() {
            return NO_DATA;
        }
        if height <= sea {
            return [205, 220, 234];
        }
        let grey = 128.0 + 122.0 * f64::from(shade[(i, j)].clamp(0.0, 1.0));
        [grey as u8, grey as u8, (grey - 4.0) as u8]
    });
    let highest = f32::from(measures.water.order.max(1));
    for reach in &measures.water.reaches {
        let place = |c: &u32| {
            let (i, j) = (*c as usize % shown.width, *c as usize / shown.width);
            ((left + (i as f64 + 0.5) * shown.scale) as f32, (top + (j as f64 + 0.5) * shown.scale) as f32)
        };
        let points: Vec<(f32, f32)> = reach.cells.iter().map(place).collect();
        let order = f32::from(reach.order);
        sheet.line(&points, 0.55 + 2.3 * (order - 1.0) / highest.max(2.0), WATER);
    }
    sheet.text(corner[0], corner[1] - 12.0, 0.0, "Drainage", bold(16.0));
    let text = format!(
        "Strahler orders 1 to {}, {:.2} km of river per km\u{b2}",
        measures.water.order, measures.water.density
    );
    sheet.text(corner[0], shown.below(corner[1]) + 18.0, 0.0, &text, small());
}

fn hypsometry(sheet: &mut Sheet, measures: &Measures, area: [f64; 4]) {
    let low = measures.heights[0];
    let frame = Frame { area, x: Axis::linear(0.0, 100.0), y: Axis::linear(low, measures.heights[2].max(low + 1.0)) };
    sheet.axes(&frame, "Hypsometric curve", ["share of the land above this height, %", "m"]);
    let steps = measures.hypsometry.len().saturating_sub(1).max(1) as f64;
    let points: Vec<(f32, f32)> = measures
        .hypsometry
        .iter()
        .enumerate()
        .map(|(k, share)| {
            frame.at(100.0 * share, (measures.base + measures.relief * k as f64 / steps).min(frame.y.ends[1]))
        })
        .collect();
    sheet.line(&points, 2.2, MARK);
}

fn slopes(sheet: &mut Sheet, measures: &Measures, area: [f64; 4]) {
    let last = measures.slopes.iter().rposition(|share| *share > 5e-4).unwrap_or(0);
    let most = measures.slopes.iter().copied().fold(0.01, f64::max) * 105.0;
    let end = (((last + 2) as f64 * SLOPE_CLASS) / 10.0).ceil() * 10.0;
    let frame = Frame { area, x: Axis::linear(0.0, end), y: Axis::linear(0.0, most) };
    sheet.axes(&frame, "Slopes", ["degrees", "% of the land"]);
    for (k, share) in measures.slopes.iter().take(last + 1).enumerate() {
        let (x0, y0) = frame.at(k as f64 * SLOPE_CLASS, 100.0 * share);
        let (x1, y1) = frame.at((k + 1) as f64 * SLOPE_CLASS, 0.0);
        sheet.block([f64::from(x0) + 0.6, f64::from(x1) - 0.6], [f64::from(y0), f64::from(y1)], GROUND);
    }
    let (x, top) = frame.at(measures.slope_mean, most);
    sheet.line(&[(x, top), (x, frame.at(0.0, 0.0).1)], 1.6, MARK);
    sheet.text(f64::from(x) + 5.0, f64::from(top) + 12.0, 0.0, &format!("mean {:.1}", measures.slope_mean), small());
}

fn spectrum(sheet: &mut Sheet, measures: &Measures, area: [f64; 4]) {
    let waves = measures.bands.iter().map(|band| band.wavelength);
    let powers = measures.bands.iter().map(|band| band.power);
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)))
    };
    let ((short, long), (least, most)) = (span(&mut { waves }), span(&mut { powers }));
    if !(least > 0.0 && most > least && long > short) {
        return sheet.text(area[0], area[1] - 12.0, 0.0, "Power spectrum: too few samples", bold(16.0));
    }
    let frame = Frame { area, x: Axis::logarithmic(short, long), y: Axis::logarithmic(least / 2.0, most * 2.0) };
    sheet.axes(&frame, "Power spectrum", ["wavelength, m", "m\u{b2} \u{b7} m\u{b2}"]);
    let text = |name: &str, value: Option<f64>| value.map_or(String::new(), |value| format!("{name} {value:.2}"));
    let [left, top, ..] = area;
    // A blank background keeps grid lines from crossing the text; the spectrum is drawn over it.
    sheet.block([left + 11.0, left + 120.0], [top + 12.0, top + 47.0], PAPER);
    sheet.text(left + 14.0, top + 24.0, 0.0, &text("exponent", measures.spectrum), small());
    sheet.text(left + 14.0, top + 42.0, 0.0, &text("Hurst", measures.hurst), small());
    let points: Vec<(f32, f32)> = measures.bands.iter().map(|band| frame.at(band.wavelength, band.power)).collect();
    sheet.line(&points, 2.2, MARK);
}

fn rose(sheet: &mut Sheet, measures: &Measures, [x, y]: [f64; 2], radius: f64, row: f64) {
    sheet.text(x - radius, row - 12.0, 0.0, "Aspects", bold(16.0));
    let most = measures.aspects.iter().copied().fold(1e-9, f64::max);
    let turn = |degrees: f64, r: f64| {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        ((x + r * sin) as f32, (y - r * cos) as f32)
    };
    for ring in [0.5, 1.0] {
        let points: Vec<(f32, f32)> = (0..=72).map(|k| turn(f64::from(k) * 5.0, radius * ring)).collect();
        sheet.line(&points, 1.0, LINE);
    }
    for (k, share) in measures.aspects.iter().enumerate() {
        let length = radius * share / most;
        // A petal of ten degrees, filled with lines.
        let rays: Vec<(f32, f32)> = (-10..=10)
            .flat_map(|step| {
                let degrees = k as f64 * 10.0 + f64::from(step) * 0.42;
                [turn(degrees, 0.0), turn(degrees, length), turn(degrees + 0.21, length), turn(degrees + 0.21, 0.0)]
            })
            .collect();
        sheet.line(&rays, 1.3, GROUND);
    }
    for (degrees, name) in [(0.0, "N"), (90.0, "E"), (180.0, "S"), (270.0, "W")] {
        let (px, py) = turn(degrees, radius + 13.0);
        sheet.text(f64::from(px), f64::from(py) + 5.0, 0.5, name, small());
    }
    sheet.text(
        x,
        y + radius + 34.0,
        0.5,
        &format!("outer ring: {:.1} % of the slopes per 10\u{b0}", 100.0 * most),
        small(),
    );
}

fn forms(sheet: &mut Sheet, measures: &Measures, [left, top, width]: [f64; 3]) {
    sheet.text(left, top - 12.0, 0.0, "Landforms (geomorphons)", bold(16.0));
    let most = measures.forms.iter().copied().fold(1e-9, f64::max);
    for (k, (name, share)) in FORMS.iter().zip(&measures.forms).enumerate() {
        let y = top + 6.0 + 23.5 * k as f64;
        sheet.text(left + 74.0, y + 12.0, 1.0, name, plain(14.0));
        let length = (width - 150.0) * share / most;
        sheet.block([left + 84.0, left + 84.0 + length.max(1.0)], [y, y + 16.0], GROUND);
        sheet.text(left + 92.0 + length, y + 12.0, 0.0, &format!("{:.1} %", 100.0 * share), small());
    }
}

fn table(sheet: &mut Sheet, measures: &Measures, top: f64) {
    sheet.text(MARGIN, top, 0.0, "Compared with real land", bold(16.0));
    let note = format!("band: 10th to 90th percentile of {SOURCE}");
    sheet.text(WIDTH - MARGIN, top, 1.0, &note, small());
    let rows = FIGURES.len().div_ceil(2);
    let column = (WIDTH - 2.0 * MARGIN - 50.0) / 2.0;
    for (k, figure) in FIGURES.iter().enumerate() {
        let left = MARGIN + (k / rows) as f64 * (column + 50.0);
        let y = top + 34.0 + 25.0 * (k % rows) as f64;
        sheet.line(&[(left as f32, y as f32 + 7.5), ((left + column) as f32, y as f32 + 7.5)], 1.0, LINE);
        sheet.text(left, y, 0.0, figure.name, plain(15.0));
        let value = figure.value(measures);
        let text = value.map_or("-".to_string(), |value| figure.text(value));
        sheet.text(left + 252.0, y, 1.0, &text, bold(15.0));
        sheet.text(left + 260.0, y, 0.0, figure.unit, small());
        // The range of real terrain in the middle, with equal space on both sides; the numbers of its ends are outside
        // of that space, where there are no marks.
        let track = track(left, column);
        sheet.block([track.at(-1.0), track.at(1.0)], [y - 12.0, y + 3.0], BAND);
        let middle = track.at(0.0) as f32;
        sheet.line(&[(middle, y as f32 - 12.0), (middle, y as f32 + 3.0)], 1.2, SOFT);
        if let Some(value) = value {
            let x = track.at(figure.place(value)) as f32;
            sheet.line(&[(x, y as f32 - 14.0), (x, y as f32 + 5.0)], 3.4, MARK);
        }
        let [low, _, high] = figure.real.map(|value| figure.text(value));
        sheet.text(track.begin - 8.0, y - 1.0, 1.0, &low, small());
        sheet.text(left + column, y - 1.0, 1.0, &high, small());
    }
}

/// The track of a table row, on which a value is marked relative to real terrain.
struct Track {
    begin: f64,
    end: f64,
}

/// Maximum distance of marks from the center, in half widths of the range; values further out are drawn at the end.
const FARTHEST: f64 = 2.4;

/// The track of a row from `left`, `width` pixels wide.
fn track(left: f64, width: f64) -> Track {
    Track { begin: left + 390.0, end: left + width - 58.0 }
}

impl Track {
    /// The position of a value: -1 and 1 are the ends of the range.
    fn at(&self, place: f64) -> f64 {
        self.begin + (self.end - self.begin) * (0.5 + place.clamp(-FARTHEST, FARTHEST) / (2.0 * FARTHEST + 0.2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_mark_of_the_table_stands_on_a_number() {
        let font = BuiltinFont::new().unwrap();
        let width = |text: &str| f64::from(font.width(text, small()));
        let column = (WIDTH - 2.0 * MARGIN - 50.0) / 2.0;
        let track = track(0.0, column);
        // Marks are 3.4 wide.
        let marks = [-100.0, 100.0].map(|place| track.at(place));
        assert!(marks[0] - 1.7 > track.begin - 4.0 && marks[1] + 1.7 <= track.end, "{marks:?}");
        assert!(track.at(-1.0) > marks[0] && track.at(1.0) < marks[1]);
        for figure in FIGURES {
            let [low, _, high] = figure.real.map(|value| width(&figure.text(value)));
            assert!(260.0 + width(figure.unit) + 4.0 < track.begin - 8.0 - low, "{}", figure.name);
            assert!(track.end + 4.0 < column - high, "{}", figure.name);
        }
    }
}
