//! Elements around a map: heading, coordinates along the sides, color bar, scale, north arrow, legend.

use super::font_set::FontSet;
use super::geometry::{Point, Rect};
use super::labels::Label;
use super::layout::{BLOCK_GAP, Block, MARGIN, ROW};
use super::options::PageColors;
use super::roads;
use super::scene::{Item, Scene, Step, line, polygon};
use super::symbols::{dot, triangle};
use super::ticks::{Count, grouped, step, ticks};
use crate::map::text::Face;
use orogen_grid::roads::RoadKind;
use orogen_grid::words;
use orogen_io::palette::color::{Encoder, Rgb, decode, linear, mix, oklab};
use orogen_io::palette::tint::Tint;

/// Size of small print, the em in millimetres.
pub const SMALL: f32 = 2.7;
const HEADING: f32 = 7.0;

/// A scene and fonts for drawing text on it.
pub struct Desk<'a> {
    /// The page.
    pub scene: Scene,
    /// Its fonts.
    pub letters: &'a FontSet,
    /// The colors of the page.
    pub colors: PageColors,
}

/// Horizontal alignment of a text relative to its anchor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Align {
    /// The text starts at the anchor.
    Start,
    /// The text is centered at the anchor.
    Middle,
    /// The text ends at the anchor.
    End,
}

impl Desk<'_> {
    /// Draws a text at an anchor on its baseline; returns its width.
    pub fn text(&mut self, text: &str, face: Face, size: f32, ink: Rgb, at: Point, align: Align) -> f32 {
        let width = self.letters.width(text, face, size);
        let shift = match align {
            Align::Start => 0.0,
            Align::Middle => width / 2.0,
            Align::End => width,
        };
        let outline = self.letters.write(text, face, size, at.moved(-shift, 0.0), 0.0);
        self.scene.area(outline, ink, 1.0);
        width
    }

    /// Draws a label along its path: the path runs through the middle of the letters instead of along their baseline.
    pub fn along(&mut self, label: &Label, face: Face, ink: Rgb) {
        let outline = self.outline_along(label, face);
        self.scene.area(outline, ink, 1.0);
    }

    /// The outline of a label along its path.
    #[must_use]
    pub fn outline_along(&self, label: &Label, face: Face) -> Vec<Step> {
        let width = self.letters.width(&label.text, face, label.size) * label.spacing;
        let length: f32 = label.path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let start = (length - width) / 2.0;
        self.letters.each(&label.text, face, label.size, |along| {
            let (at, angle) = label.at(start + along * label.spacing);
            let sink = label.size * 0.34;
            (at.moved(sink * libm::sinf(angle), sink * libm::cosf(angle)), angle)
        })
    }

    /// Draws small print.
    pub fn small(&mut self, text: &str, at: Point, align: Align) -> f32 {
        self.text(text, Face::Regular, SMALL, self.colors.soft(), at, align)
    }

    /// The part of a text that fits in a width.
    fn shortened(&self, text: &str, face: Face, size: f32, width: f32) -> String {
        words::shortened(text, width, |text| self.letters.width(text, face, size))
    }

    /// The heading and two lines under it.
    pub fn heading(&mut self, title: &str, lines: [&str; 2]) {
        let width = self.scene.size.width - 2.0 * MARGIN;
        // A long title is set smaller, and shortened only if that is not enough.
        let natural = self.letters.width(title, Face::Bold, HEADING).max(1e-3);
        let size = HEADING * (width / natural).clamp(0.55, 1.0);
        let title = self.shortened(title, Face::Bold, size, width);
        self.text(&title, Face::Bold, size, self.colors.ink, Point::new(MARGIN, MARGIN + 5.2), Align::Start);
        for (k, line) in lines.iter().enumerate() {
            let line = self.shortened(line, Face::Regular, SMALL, width);
            self.small(&line, Point::new(MARGIN, MARGIN + 9.9 + 3.7 * k as f32), Align::Start);
        }
    }

    /// Coordinates along the left and the bottom of the map, ticks along all four sides. `spans` are the values at the
    /// map's left and right, top and bottom.
    pub fn axes(&mut self, map: Rect, spans: [[f64; 2]; 2], counts: [Count; 2]) {
        let Rect { left, top, width, height } = map;
        let (right, bottom) = (map.right(), map.bottom());
        let mark = 1.3;
        let mut marks: Vec<Vec<Point>> = Vec::new();
        let at = |span: [f64; 2], value: f64| ((value - span[0]) / (span[1] - span[0])) as f32;
        let across = ticks(spans[0], (width / 26.0).max(1.0) as usize, counts[0]);
        let mut free = f32::MIN;
        for (value, name) in across {
            let x = left + width * at(spans[0], value);
            marks.push(line([[x, bottom], [x, bottom + mark]]));
            marks.push(line([[x, top], [x, top - mark]]));
            let half = self.letters.width(&name, Face::Regular, SMALL) / 2.0;
            if x - half > free && x + half < self.scene.size.width - 1.0 {
                self.small(&name, Point::new(x, bottom + mark + 2.9), Align::Middle);
                free = x + half + 1.5;
            }
        }
        for (value, name) in ticks(spans[1], (height / 18.0).max(1.0) as usize, counts[1]) {
            let y = top + height * at(spans[1], value);
            marks.push(line([[left, y], [left - mark, y]]));
            marks.push(line([[right, y], [right + mark, y]]));
            self.small(&name, Point::new(left - mark - 0.9, y + 0.95), Align::End);
        }
        self.scene.lines(marks, 0.2, self.colors.ink, 1.0);
    }

    /// A color bar with heights; `width` includes its unit.
    pub fn colors(&mut self, at: Point, width: f32, tint: &Tint, [low, high]: [f64; 2]) {
        const STEPS: usize = 600;
        let encoder = Encoder::new();
        let flat = high <= low;
        let (low, high) = if flat { (low - 0.5, low + 0.5) } else { (low, high) };
        let pixels = (0..STEPS).flat_map(|k| {
            let height = low + (high - low) * (k as f64 + 0.5) / STEPS as f64;
            encoder.bytes(tint.at(height as f32))
        });
        let area = Rect::new(at.x, at.y, width - 10.0, 3.6);
        self.scene.items.push(Item::Picture { area, width: STEPS, height: 1, pixels: pixels.collect() });
        self.scene.frame(area, 0.15, self.colors.ink);
        let mut marks: Vec<Vec<Point>> = Vec::new();
        let mut free = f32::MIN;
        let step = step(high - low, 6);
        for (value, _) in ticks([low, high], 6, Count::Latitude) {
            let x = at.x + area.width * ((value - low) / (high - low)) as f32;
            marks.push(line([[x, at.y + 3.6], [x, at.y + 4.5]]));
            let decimals = (-libm::log10(step * 1.000_001).floor()).clamp(0.0, 6.0) as usize;
            let name = grouped(value, decimals);
            let half = self.letters.width(&name, Face::Regular, SMALL) / 2.0;
            if x - half > free {
                self.small(&name, Point::new(x, at.y + 7.4), Align::Middle);
                free = x + half + 1.0;
            }
        }
        self.scene.lines(marks, 0.2, self.colors.ink, 1.0);
        self.small("m", Point::new(at.x + area.width + 2.0, at.y + 2.8), Align::Start);
    }

    /// A scale bar of a round length.
    pub fn scale(&mut self, Point { x: left, y: top }: Point, metres_a_millimetre: f64) {
        let most = f64::from(SCALE - 14.0);
        let length = {
            let rough = most * metres_a_millimetre;
            let power = libm::pow(10.0, libm::log10(rough).floor());
            [5.0, 2.0, 1.0].into_iter().map(|n| n * power).find(|length| *length <= rough).unwrap_or(power)
        };
        let width = (length / metres_a_millimetre) as f32;
        let (kilometres, unit) = if length >= 1000.0 { (1000.0, "km") } else { (1.0, "m") };
        for k in 0..4 {
            let part = Rect::new(left + width * k as f32 / 4.0, top + 1.0, width / 4.0, 1.4);
            self.scene.block(part, if k % 2 == 0 { self.colors.ink } else { self.colors.page });
        }
        self.scene.frame(Rect::new(left, top + 1.0, width, 1.4), 0.18, self.colors.ink);
        for share in [0.0, 0.5, 1.0] {
            let value = length / kilometres * share;
            let decimals =
                if value.fract() == 0.0 { 0 } else { (2.0 - libm::log10(value).floor()).clamp(1.0, 4.0) as usize };
            let text = grouped(value, decimals);
            let text = text.strip_suffix(".0").map_or(text.clone(), str::to_string);
            let text = text.trim_end_matches('0').trim_end_matches('.').to_string();
            let text = if value.fract() == 0.0 { grouped(value, 0) } else { text };
            let name = if share == 1.0 { format!("{text} {unit}") } else { text };
            let x = left + width * share as f32;
            let align = if share == 0.0 { Align::Start } else { Align::Middle };
            self.small(&name, Point::new(x, top + 5.9), align);
        }
    }

    /// A north arrow, which points to the top of the page.
    pub fn north(&mut self, Point { x: left, y: top }: Point) {
        let (x, foot) = (left + NORTH / 2.0, top + 8.2);
        self.scene.area(polygon([[x, top + 0.2], [x + 2.1, foot], [x, foot - 1.5]]), self.colors.ink, 1.0);
        let light = [[x, top + 0.2], [x - 2.1, foot], [x, foot - 1.5], [x, top + 0.2]];
        self.scene.area(polygon(light), self.colors.page, 1.0);
        self.scene.lines(vec![line(light)], 0.18, self.colors.ink, 1.0);
        self.text("N", Face::Bold, 2.9, self.colors.ink, Point::new(x + 2.8, top + 2.6), Align::Start);
    }

    /// The legend, in `rows` rows.
    pub fn legend(&mut self, at: Point, entries: &[Entry], rows: usize) {
        let widths = columns(entries, self.letters, rows);
        for (k, entry) in entries.iter().enumerate() {
            let (column, row) = (k / rows, k % rows);
            let x = at.x + widths[..column].iter().sum::<f32>();
            let y = at.y + 1.6 + LINE * row as f32;
            match entry.sign {
                Sign::Line(width, ink) => {
                    let wave = (0..=16).map(|k| k as f32 / 16.0);
                    let wave = wave.map(|t| [x + SIGN * t, y - 0.7 * libm::sinf(6.0 * t)]);
                    self.scene.lines(vec![line(wave)], width, ink, 1.0);
                }
                Sign::Water(fill, shore) => {
                    let ring: Vec<Point> = (0..=32)
                        .map(|k| k as f32 / 32.0 * std::f32::consts::TAU)
                        .map(|a| {
                            let r = 1.0 + 0.18 * libm::cosf(2.0 * a + 0.6) + 0.1 * libm::sinf(3.0 * a);
                            Point::new(x + SIGN / 2.0 + 2.9 * r * libm::cosf(a), y + 1.35 * r * libm::sinf(a))
                        })
                        .collect();
                    self.scene.area(polygon(ring.iter().copied()), fill, 1.0);
                    self.scene.lines(vec![ring], 0.2, shore, 1.0);
                }
                Sign::Swatch(ref colors) => {
                    let area = Rect::new(x, y - 1.5, SIGN, 3.0);
                    let pixels = swatch(colors);
                    self.scene.items.push(Item::Picture { area, width: pixels.len() / 3, height: 1, pixels });
                    self.scene.frame(area, 0.15, self.colors.ink);
                }
                Sign::Grid => {
                    let down = [0.3, 0.7].map(|share| x + SIGN * share).map(|x| line([[x, y - 1.5], [x, y + 1.5]]));
                    let across = line([[x, y], [x + SIGN, y]]);
                    self.scene.lines(down.into_iter().chain([across]).collect(), 0.14, self.colors.ink, 0.8);
                }
                Sign::Road(kind) => {
                    let way = [x, x + SIGN / 2.0, x + SIGN].map(|x| Point::new(x, y));
                    roads::draw(&mut self.scene, &[(kind, way.to_vec())]);
                }
                Sign::Place => self.scene.area(dot(Point::new(x + SIGN / 2.0, y)), self.colors.ink, 1.0),
                Sign::Summit => self.scene.area(triangle(Point::new(x + SIGN / 2.0, y)), self.colors.ink, 1.0),
            }
            self.small(&entry.text, Point::new(x + SIGN + 1.8, y + 0.95), Align::Start);
        }
    }
}

/// A legend entry.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The symbol.
    pub sign: Sign,
    /// The description.
    pub text: String,
}

/// A symbol of the legend.
#[derive(Debug, Clone, PartialEq)]
pub enum Sign {
    /// A line with its width in millimetres.
    Line(f32, Rgb),
    /// A lake: its water and its shore.
    Water(Rgb, Rgb),
    /// A road, a bridge or a tunnel.
    Road(RoadKind),
    /// Lines of a coordinate grid.
    Grid,
    /// A place with a name.
    Place,
    /// A summit.
    Summit,
    /// A patch of one color, or of several along a gradient.
    Swatch(Vec<Rgb>),
}

/// The pixels of a swatch, from its first color to its last.
fn swatch(colors: &[Rgb]) -> Vec<u8> {
    const PIXELS: usize = 64;
    let encoder = Encoder::new();
    let last = colors.len().saturating_sub(1);
    let light = |k: usize| colors.get(k.min(last)).map_or([0.5; 3], |color| color.map(decode));
    let pixel = |k: usize| {
        let at = k as f32 / (PIXELS - 1) as f32 * last as f32;
        encoder.bytes(linear(mix(oklab(light(at as usize)), oklab(light(at as usize + 1)), at.fract())))
    };
    (0..PIXELS).flat_map(pixel).collect()
}

const SIGN: f32 = 8.0;
/// Height of a legend line.
const LINE: f32 = 4.6;
/// Lines of the legend in a row of blocks.
pub const LEGEND_ROWS: usize = 2;
/// Widths of blocks.
pub const COLORS: f32 = 88.0;
const SCALE: f32 = 62.0;
const NORTH: f32 = 6.0;

fn columns(entries: &[Entry], letters: &FontSet, rows: usize) -> Vec<f32> {
    let width = |entry: &Entry| SIGN + 1.8 + letters.width(&entry.text, Face::Regular, SMALL) + 5.0;
    entries.chunks(rows.max(1)).map(|pair| pair.iter().map(width).fold(0.0, f32::max)).collect()
}

/// The block of the color bar; in a column it takes the full width.
#[must_use]
pub fn colors_block() -> Block {
    Block { widths: [COLORS, 0.0], height: ROW }
}

/// The block of the scale bar.
#[must_use]
pub fn scale_block() -> Block {
    Block { widths: [SCALE - BLOCK_GAP; 2], height: ROW - 3.0 }
}

/// The block of the north arrow.
#[must_use]
pub fn north_block() -> Block {
    Block { widths: [NORTH + 4.0; 2], height: ROW }
}

/// The block of the legend.
#[must_use]
pub fn legend_block(entries: &[Entry], letters: &FontSet) -> Block {
    let width = |rows: usize| columns(entries, letters, rows).iter().sum::<f32>().max(1.0) - 5.0;
    Block { widths: [width(LEGEND_ROWS), width(entries.len())], height: LINE * entries.len() as f32 + 1.0 }
}
