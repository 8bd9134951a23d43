//! Profiles of the land through its highest sample, from west to east and from north to south, for free space on a
//! sheet.

use super::furniture::{Align, Desk, SMALL};
use super::geometry::{Point, Rect};
use super::options::SheetOptions;
use super::scene::{Item, line, polygon};
use super::ticks::{Count, grouped, ticks};
use crate::map::text::Face;
use orogen_grid::grid::Grid;
use orogen_io::palette::color::{Encoder, Rgb};
use orogen_io::palette::tint::Tint;

/// Room for the heading, for the heights on the left, on the right, and for the distances below, in millimetres.
const HEADING: f32 = 5.5;
const LEFT: f32 = 12.5;
const RIGHT: f32 = 5.0;
const BELOW: f32 = 6.0;

/// Distance between points of the line, in millimetres.
const STEP: f32 = 0.15;

/// Maximum exaggeration of heights.
const MOST: f64 = 50.0;

/// Share of the height of a profile that the land takes, and the share below the land.
const LAND: f64 = 0.80;
const FOOT: f64 = 0.12;

/// Ink of rock: below the sea, and everywhere if the map shows another layer than the heights.
const LAND_INK: Rgb = [196, 192, 186];

/// Direction of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From A in the west to B in the east.
    Eastward,
    /// From C in the north to D in the south.
    Southward,
}

impl Direction {
    /// The labels of the ends.
    fn names(self) -> [&'static str; 2] {
        match self {
            Direction::Eastward => ["A", "B"],
            Direction::Southward => ["C", "D"],
        }
    }
}

/// The heights along a row or a column.
pub struct Profile {
    direction: Direction,
    /// The area of the drawing, without labels.
    area: Rect,
    /// Position of the profile's line on the map, down or across, 0 to 1.
    at: f32,
    /// The lowest height on the line.
    lowest: f32,
    /// Evenly spaced heights, from start to end.
    heights: Vec<f32>,
    /// Length in metres, from start to end.
    length: f64,
    /// The heights at the bottom and the top of the drawing.
    span: [f64; 2],
    exaggeration: f64,
    sea_level: Option<f64>,
}

/// A row of samples at `count` evenly spaced positions from its first sample to its last. If positions are denser than
/// samples, heights are interpolated linearly. If they are sparser, each takes the highest sample around it, so that
/// summits are kept.
fn along(row: &[f32], count: usize) -> Vec<f32> {
    let step = (row.len() - 1) as f64 / (count - 1).max(1) as f64;
    let last = row.len() - 1;
    (0..count)
        .map(|k| {
            let at = k as f64 * step;
            if step <= 1.0 {
                let (from, share) = ((at as usize).min(last), at.fract() as f32);
                let [a, b] = [row[from], row[(from + 1).min(last)]];
                return if share == 0.0 { a } else { a + (b - a) * share };
            }
            let (from, to) = ((at - step / 2.0).ceil().max(0.0) as usize, (at + step / 2.0).floor() as usize);
            row[from.min(last)..=to.clamp(from.min(last), last)].iter().copied().fold(f32::NAN, f32::max)
        })
        .collect()
}

impl Profile {
    /// The profile through the highest sample. `None` if no height is known, or the land is too flat or too steep for a
    /// useful profile.
    pub fn new(heights: &Grid, options: &SheetOptions, direction: Direction, room: Rect) -> Option<Profile> {
        let window = heights.window();
        let finite = heights.data().iter().enumerate().filter(|(_, height)| height.is_finite());
        let (at, highest) = finite.fold(None, |best: Option<(usize, f32)>, (at, height)| match best {
            Some((_, most)) if most >= *height => best,
            _ => Some((at, *height)),
        })?;
        let (i, j) = (at % window.width, at / window.width);
        let (line, nth, across): (Vec<f32>, usize, usize) = match direction {
            Direction::Eastward => (heights.row(j).to_vec(), j, window.height),
            Direction::Southward => ((0..window.height).map(|j| heights[(i, j)]).collect(), i, window.width),
        };
        let area = Rect {
            left: room.left + LEFT,
            top: room.top + HEADING,
            width: room.width - LEFT - RIGHT,
            height: room.height - HEADING - BELOW,
        };
        let count = ((area.width / STEP) as usize).clamp(2, 10_000);
        let length = (line.len() - 1) as f64 * window.cell;
        let heights = along(&line, count);
        let sea_level = options.sea_level.filter(|_| options.palette.has_sea());
        let known = heights.iter().copied().filter(|height| height.is_finite());
        let lowest = known.fold(f32::MAX, f32::min);
        // The sea is drawn if it covers ground on the line.
        let sea_level = sea_level.filter(|sea| f64::from(lowest) < *sea);
        let low = f64::from(lowest);
        let highest = f64::from(highest);
        // Metres per millimetre across, and the height of the relief at that scale.
        let scale = length / f64::from(area.width);
        let natural = (highest - low) / scale;
        let exaggeration = (f64::from(area.height) * LAND / natural).min(MOST);
        // Two digits, rounded down, so that the land fits.
        let digits = libm::pow(10.0, 1.0 - libm::log10(exaggeration).floor());
        let exaggeration = (exaggeration * digits).floor() / digits;
        let rise = f64::from(area.height) * scale / exaggeration;
        if !(natural * exaggeration > 1.0 && rise.is_finite()) {
            return None;
        }
        let foot = low - FOOT * rise;
        let span = [foot, foot + rise];
        let at = nth as f32 / (across - 1).max(1) as f32;
        Some(Profile { direction, area, at, lowest, heights, length, span, exaggeration, sea_level })
    }

    /// Draws the profile, and its line on the map. Without a tint, the land is gray.
    pub fn draw(&self, desk: &mut Desk, map: Rect, tint: Option<&Tint>, dpi: f64) {
        let Rect { left, top, width, height } = self.area;
        let (right, bottom) = (self.area.right(), self.area.bottom());
        let up = |metres: f64| bottom - height * ((metres - self.span[0]) / (self.span[1] - self.span[0])) as f32;
        self.ground(desk, tint, dpi);
        let mut marks: Vec<Vec<Point>> = Vec::new();
        let mut lines: Vec<Vec<Point>> = Vec::new();
        let decimals = if self.span[1] - self.span[0] < 20.0 { 1 } else { 0 };
        // Heights are labeled in metres, also when they are large.
        for (value, _) in ticks(self.span, (height / 6.5).max(2.0) as usize, Count::Latitude) {
            let (y, name) = (up(value), format!("{} m", grouped(value, decimals)));
            marks.push(line([[left, y], [left - 1.3, y]]));
            lines.push(line([[left, y], [right, y]]));
            desk.small(&name, Point::new(left - 2.2, y + 0.95), Align::End);
        }
        desk.scene.lines(lines, 0.1, desk.colors.ink, 0.25);
        for (value, name) in ticks([0.0, self.length], (width / 16.0).max(1.0) as usize, Count::Metres) {
            let x = left + width * (value / self.length) as f32;
            marks.push(line([[x, bottom], [x, bottom + 1.3]]));
            let half = desk.letters.width(&name, Face::Regular, SMALL) / 2.0;
            if x + half < desk.scene.size.width - 1.0 {
                desk.small(&name, Point::new(x, bottom + 4.2), Align::Middle);
            }
        }
        desk.scene.lines(marks, 0.2, desk.colors.ink, 1.0);
        let place = |(k, height): (usize, &f32)| {
            let x = left + width * k as f32 / (self.heights.len() - 1) as f32;
            height.is_finite().then(|| Point::new(x, up(f64::from(*height))))
        };
        // One line for each part without missing heights.
        let places: Vec<Option<Point>> = self.heights.iter().enumerate().map(place).collect();
        let stretches = places.split(Option::is_none).map(|stretch| stretch.iter().copied().flatten().collect());
        desk.scene.lines(stretches.collect(), 0.22, desk.colors.ink, 1.0);
        desk.scene.lines(vec![line([[left, top], [left, bottom], [right, bottom]])], 0.2, desk.colors.ink, 1.0);
        let [start, end] = self.direction.names();
        let words = format!(
            "Profile {start}–{end}, vertical exaggeration {} ×",
            grouped(self.exaggeration, if self.exaggeration.fract() == 0.0 { 0 } else { 1 })
        );
        desk.small(&words, Point::new(left, top - 2.4), Align::Start);
        for (name, x, align) in [(start, left, Align::Start), (end, right, Align::End)] {
            let x = if align == Align::Start { x + 0.8 } else { x - 0.8 };
            desk.text(name, Face::Bold, SMALL, desk.colors.soft(), Point::new(x, top + 2.6), align);
        }
        self.mark(desk, map);
    }

    /// Marks both ends of the profile on the map: arrows inside the map's frame, with labels.
    fn mark(&self, desk: &mut Desk, map: Rect) {
        let [start, end] = self.direction.names();
        for (name, end, inward) in [(start, 0.0, 1.0), (end, 1.0, -1.0)] {
            let wide = desk.letters.width(name, Face::Bold, SMALL);
            // The arrow's tip, both ends of its base, and the center of the label.
            let (tip, feet, middle) = match self.direction {
                Direction::Eastward => {
                    let at = map.at(end, self.at);
                    let middle = at.moved((2.6 + wide / 2.0) * inward, 0.0);
                    (at.moved(2.0 * inward, 0.0), [at.moved(0.0, -1.2), at.moved(0.0, 1.2)], middle)
                }
                Direction::Southward => {
                    let at = map.at(self.at, end);
                    let feet = [at.moved(-1.2, 0.0), at.moved(1.2, 0.0)];
                    (at.moved(0.0, 2.0 * inward), feet, at.moved(0.0, 4.0 * inward))
                }
            };
            // A bright patch for visibility on dark ground.
            let (across, down) = (wide / 2.0 + 0.3, 1.5);
            let corners = [[-across, -down], [across, -down], [across, down], [-across, down]];
            let patch = corners.map(|[dx, dy]| middle.moved(dx, dy));
            desk.scene.area(polygon(patch), desk.colors.page, 0.6);
            desk.scene.area(polygon([feet[0], tip, feet[1]]), desk.colors.ink, 1.0);
            desk.text(name, Face::Bold, SMALL, desk.colors.ink, middle.moved(0.0, 0.95), Align::Middle);
        }
    }

    /// The land under the line in the map's colors or in gray, and the sea above it.
    fn ground(&self, desk: &mut Desk, tint: Option<&Tint>, dpi: f64) {
        let Rect { width, height, .. } = self.area;
        let side = |millimetres: f32| ((f64::from(millimetres) * dpi / 25.4).round() as usize).clamp(2, 8000);
        let [columns, rows] = [side(width), side(height)];
        let encoder = Encoder::new();
        let rise = (self.span[1] - self.span[0]) / rows as f64;
        let mut pixels = Vec::with_capacity(3 * columns * rows);
        for j in 0..rows {
            let metres = self.span[1] - (j as f64 + 0.5) * rise;
            // Below the lowest ground on the line, the color of that ground is used. Rock below the sea is not blue.
            let is_land = self.sea_level.is_none_or(|sea| metres > sea);
            let color = match tint {
                Some(tint) if is_land => encoder.bytes(tint.at((metres as f32).max(self.lowest))),
                _ => LAND_INK,
            };
            for i in 0..columns {
                let at = (i as f64 + 0.5) / columns as f64 * (self.heights.len() - 1) as f64;
                let (k, share) = (at as usize, at.fract() as f32);
                let [a, b] = [self.heights[k], self.heights[(k + 1).min(self.heights.len() - 1)]];
                let ground = f64::from(a + (b - a) * share);
                let cover = |level: f64| ((level - metres) / rise + 0.5).clamp(0.0, 1.0) as f32;
                let mut pixel = desk.colors.page.map(f32::from);
                let mut lay = |ink: Rgb, cover: f32| {
                    pixel.iter_mut().zip(ink).for_each(|(pixel, ink)| *pixel += (f32::from(ink) - *pixel) * cover);
                };
                let land = if ground.is_finite() { cover(ground) } else { 0.0 };
                if let Some(sea) = self.sea_level.filter(|sea| ground < *sea) {
                    lay(desk.colors.sea(), cover(sea) * (1.0 - land));
                }
                lay(color, land * 0.85);
                pixels.extend(pixel.map(|part| part.round() as u8));
            }
        }
        desk.scene.items.push(Item::Picture { area: self.area, width: columns, height: rows, pixels });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_more_places_than_samples_has_no_steps() {
        let row = [0.0, 10.0, 4.0, f32::NAN, 8.0];
        let line = along(&row, 41);
        assert_eq!((line[0], line[10], line[20], line[40]), (0.0, 10.0, 4.0, 8.0));
        assert!((line[5] - 5.0).abs() < 1e-5 && (line[15] - 7.0).abs() < 1e-5, "{line:?}");
        assert!(line[1..10].windows(2).all(|pair| pair[1] > pair[0]));
        assert!(line[21..40].iter().all(|height| height.is_nan()));
        assert_eq!(along(&row[..1], 2), [0.0, 0.0]);
    }

    #[test]
    fn a_line_of_fewer_places_than_samples_keeps_its_summits() {
        for at in 0..1000 {
            let mut row = vec![1.0; 1000];
            row[at] = 9.0;
            let line = along(&row, 300);
            assert!(line.contains(&9.0) && line.len() == 300, "{at}");
        }
    }
}
