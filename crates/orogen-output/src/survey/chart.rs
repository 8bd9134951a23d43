//! Charts on a page: lines, bars and axes.

use crate::map::canvas::{Canvas, Ink};
use crate::map::text::{BuiltinFont, Face, Style};

/// Color of the page.
pub const PAPER: Ink = [253, 253, 251];
/// Color of text.
pub const INK: Ink = [30, 30, 32];
/// Color of small print.
pub const SOFT: Ink = [105, 105, 108];
/// Color of thin lines.
pub const LINE: Ink = [206, 206, 204];
/// Color of the range of real terrain.
pub const BAND: Ink = [226, 232, 220];
/// Color of marks.
pub const MARK: Ink = [176, 58, 34];
/// Color of water.
pub const WATER: Ink = [36, 92, 160];
/// Color of ground.
pub const GROUND: Ink = [146, 120, 92];

/// A page with its font.
pub struct Sheet {
    /// The page.
    pub canvas: Canvas,
    /// The font.
    pub font: BuiltinFont,
}

/// An axis of a chart.
#[derive(Debug, Clone, Copy)]
pub struct Axis {
    /// The values at its ends.
    pub ends: [f64; 2],
    /// Whether the scale is logarithmic.
    pub logarithmic: bool,
}

impl Axis {
    /// A linear axis.
    pub fn linear(from: f64, to: f64) -> Axis {
        Axis { ends: [from, to], logarithmic: false }
    }

    /// A logarithmic axis.
    pub fn logarithmic(from: f64, to: f64) -> Axis {
        Axis { ends: [from, to], logarithmic: true }
    }

    /// The position of a value, 0 to 1.
    pub fn share(&self, value: f64) -> f64 {
        let [from, to] = self.ends;
        match self.logarithmic {
            true => libm::log(value / from) / libm::log(to / from),
            false => (value - from) / (to - from),
        }
    }

    /// Round values along it, few enough for labels.
    pub fn ticks(&self) -> Vec<f64> {
        let [from, to] = self.ends;
        if self.logarithmic {
            let (low, high) = (libm::log10(from).ceil() as i32, libm::log10(to).floor() as i32);
            let every = ((high - low) / 5 + 1).max(1) as usize;
            return (low..=high).step_by(every).map(|exponent| libm::pow(10.0, f64::from(exponent))).collect();
        }
        let rough = (to - from).abs() / 4.0;
        let power = libm::pow(10.0, libm::log10(rough).floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|n| n * power).find(|step| *step >= rough).unwrap_or(rough);
        let first = (from / step).ceil() as i64;
        (first..).map(|k| k as f64 * step).take_while(|tick| *tick <= to * (1.0 + 1e-9)).take(12).collect()
    }
}

/// A rectangle of the page in which values are drawn.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Left, top, width and height in pixels.
    pub area: [f64; 4],
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
}

impl Frame {
    /// The position of a pair of values, in pixels.
    pub fn at(&self, x: f64, y: f64) -> (f32, f32) {
        let [left, top, width, height] = self.area;
        ((left + width * self.x.share(x)) as f32, (top + height * (1.0 - self.y.share(y))) as f32)
    }
}

/// The label of a number.
fn label(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        big if big >= 1e6 => format!("10^{:.0}", libm::log10(big)),
        small if small < 1e-3 => format!("10^{:.0}", libm::log10(small)),
        _ => format!("{}", (value * 1e6).round() / 1e6),
    }
}

impl Sheet {
    /// Draws text at a column; `align` is 0 to start there, 1 to end there, 0.5 to center.
    pub fn text(&mut self, x: f64, y: f64, align: f64, text: &str, style: Style) {
        let width = f64::from(self.font.width(text, style));
        self.font.write(&mut self.canvas, (x - align * width) as f32, y.round() as i64, text, style);
    }

    /// Draws axes with ticks, a heading and the labels of the axes.
    pub fn axes(&mut self, frame: &Frame, heading: &str, shows: [&str; 2]) {
        let [left, top, width, height] = frame.area;
        let (right, bottom) = (left + width, top + height);
        self.text(left, top - 12.0, 0.0, heading, bold(16.0));
        for tick in frame.x.ticks() {
            let (x, _) = frame.at(tick, frame.y.ends[0]);
            self.line(&[(x, top as f32), (x, bottom as f32)], 1.0, LINE);
            self.text(f64::from(x), bottom + 16.0, 0.5, &label(tick), small());
        }
        for tick in frame.y.ticks() {
            let (_, y) = frame.at(frame.x.ends[0], tick);
            self.line(&[(left as f32, y), (right as f32, y)], 1.0, LINE);
            self.text(left - 6.0, f64::from(y) + 4.0, 1.0, &label(tick), small());
        }
        self.line(&[(left as f32, top as f32), (left as f32, bottom as f32), (right as f32, bottom as f32)], 1.2, SOFT);
        self.text(right, bottom + 32.0, 1.0, shows[0], small());
        self.text(right, top - 12.0, 1.0, shows[1], small());
    }

    /// Draws a line through points, with antialiasing.
    pub fn line(&mut self, points: &[(f32, f32)], width: f32, ink: Ink) {
        let reach = width / 2.0 + 1.0;
        let finite: Vec<(f32, f32)> = points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        let fold = |of: fn(&(f32, f32)) -> f32| {
            finite.iter().map(of).fold((f32::MAX, f32::MIN), |(low, high), v| (low.min(v), high.max(v)))
        };
        let ((west, east), (north, south)) = (fold(|p| p.0), fold(|p| p.1));
        if finite.len() < 2 || east - west > 1e5 || south - north > 1e5 {
            return;
        }
        let (left, top) = ((west - reach).floor() as i64, (north - reach).floor() as i64);
        let (columns, rows) = ((east + reach) as i64 - left + 1, (south + reach) as i64 - top + 1);
        // The coverage of all segments together, so that joints do not get ink twice.
        let mut cover = vec![0.0f32; (columns.max(0) * rows.max(0)) as usize];
        for pair in finite.windows(2) {
            let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
            let (dx, dy) = (bx - ax, by - ay);
            let length = (dx * dx + dy * dy).max(1e-12);
            for y in (ay.min(by) - reach).floor() as i64..=(ay.max(by) + reach) as i64 {
                for x in (ax.min(bx) - reach).floor() as i64..=(ax.max(bx) + reach) as i64 {
                    let (px, py) = (x as f32 + 0.5 - ax, y as f32 + 0.5 - ay);
                    let along = ((px * dx + py * dy) / length).clamp(0.0, 1.0);
                    let (ex, ey) = (px - along * dx, py - along * dy);
                    let share = (width / 2.0 + 0.5 - (ex * ex + ey * ey).sqrt()).clamp(0.0, width.min(1.0));
                    if let Some(cover) = cover.get_mut(((y - top) * columns + x - left) as usize) {
                        *cover = cover.max(share);
                    }
                }
            }
        }
        for (k, share) in cover.into_iter().enumerate().filter(|(_, share)| *share > 0.0) {
            self.canvas.cover(left + k as i64 % columns, top + k as i64 / columns, ink, share);
        }
    }

    /// Fills a rectangle of whole pixels.
    pub fn block(&mut self, x: [f64; 2], y: [f64; 2], ink: Ink) {
        let [x0, x1, y0, y1] = [x[0], x[1], y[0], y[1]].map(|v| v.round() as i64);
        self.canvas.fill(x0.min(x1)..x1.max(x0), y0.min(y1)..y1.max(y0), ink);
    }
}

/// The style of small print.
pub fn small() -> Style {
    Style { face: Face::Regular, size: 13.0, ink: SOFT }
}

/// The style of running text.
pub fn plain(size: f32) -> Style {
    Style { face: Face::Regular, size, ink: INK }
}

/// The style of headings.
pub fn bold(size: f32) -> Style {
    Style { face: Face::Bold, size, ink: INK }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        for (axis, expect) in [
            (Axis::linear(0.0, 1.0), vec![0.0, 0.5, 1.0]),
            (Axis::linear(0.0, 60.0), vec![0.0, 20.0, 40.0, 60.0]),
            (Axis::linear(712.0, 2544.0), vec![1000.0, 1500.0, 2000.0, 2500.0]),
            (Axis::logarithmic(60.0, 12_000.0), vec![100.0, 1000.0, 10_000.0]),
        ] {
            let ticks = axis.ticks();
            assert!(
                ticks.len() == expect.len() && ticks.iter().zip(&expect).all(|(a, b)| (a - b).abs() < 1e-6),
                "{ticks:?}"
            );
        }
        assert!((Axis::logarithmic(1.0, 100.0).share(10.0) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_line_is_as_wide_as_asked() {
        let mut sheet = Sheet { canvas: Canvas::new(40, 20, [255; 3]), font: BuiltinFont::new().unwrap() };
        sheet.line(&[(5.0, 10.0), (35.0, 10.0)], 4.0, [0; 3]);
        let dark = (0..20).map(|y| 255 - i32::from(sheet.canvas.get(20, y).unwrap()[0])).sum::<i32>();
        assert!((dark - 4 * 255).abs() < 8, "{dark}");
        sheet.line(&[(f32::NAN, 0.0), (3.0, 3.0)], 2.0, [0; 3]);
        sheet.line(&[(-1e9, 0.0), (1e9, 3.0)], 2.0, [0; 3]);
    }
}
