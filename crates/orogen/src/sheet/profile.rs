//! The land cut from west to east, drawn from the side: what a sheet of paper has room for beside its map.

use super::furniture::{Align, Desk, SMALL, SOFT};
use super::options::Options;
use super::scene::{INK, Item, Place, polygon};
use super::ticks::{Count, grouped, ticks};
use crate::grid::Grid;
use crate::map::text::Face;
use crate::palette::color::{Encoder, Rgb};
use crate::palette::tint::Tint;

/// Room for its heading, for the heights at its left, what stands right of it, and the distances below it, in millimetres.
const HEADING: f32 = 5.5;
const LEFT: f32 = 12.5;
const RIGHT: f32 = 5.0;
const BELOW: f32 = 6.0;

/// Millimetres from one place of the line to the next.
const STEP: f32 = 0.15;

/// How many times heights count at most.
const MOST: f64 = 50.0;

/// The share of its height that the land takes, and the share below it.
const LAND: f64 = 0.80;
const FOOT: f64 = 0.12;

/// The land cut open, where the map shows another layer than the heights.
const LAND_INK: Rgb = [196, 192, 186];

/// The sea cut open.
const SEA: Rgb = [150, 192, 222];

/// A cut through the land along a row.
pub struct Profile {
    /// Where it is drawn, without its numbers.
    area: [f32; 4],
    /// How far down the map its row lies, 0 to 1.
    row: f32,
    /// The highest height on it, in metres.
    highest: f64,
    /// The lowest height along it.
    lowest: f32,
    /// Heights, evenly apart from west to east.
    heights: Vec<f32>,
    /// Metres from its west end to its east end.
    length: f64,
    /// The heights at its foot and at its top.
    span: [f64; 2],
    exaggeration: f64,
    sea_level: Option<f64>,
}

impl Profile {
    /// The cut through the highest sample. None where no height is known, or the land is too flat or too steep to be told from a line.
    pub fn new(heights: &Grid, options: &Options, [left, top, width, height]: [f32; 4]) -> Option<Profile> {
        let window = heights.window();
        let finite = heights.data().iter().enumerate().filter(|(_, height)| height.is_finite());
        let (at, highest) = finite.fold(None, |best: Option<(usize, f32)>, (at, height)| match best {
            Some((_, most)) if most >= *height => best,
            _ => Some((at, *height)),
        })?;
        let j = at / window.width;
        let area = [left + LEFT, top + HEADING, width - LEFT - RIGHT, height - HEADING - BELOW];
        let count = ((area[2] / STEP) as usize).clamp(2, 10_000);
        let row = heights.row(j);
        // The highest of what falls on one place, so that the summit is on it.
        let share = |k: usize| (k as f64 * (window.width - 1) as f64 / (count - 1) as f64).round() as usize;
        let heights: Vec<f32> = (0..count)
            .map(|k| {
                let (from, to) = (share(k), share((k + 1).min(count - 1)).max(share(k) + 1).min(window.width));
                row[from.min(to - 1)..to].iter().copied().fold(f32::NAN, f32::max)
            })
            .collect();
        let sea_level = options.sea_level.filter(|_| options.palette.has_sea());
        let known = heights.iter().copied().filter(|height| height.is_finite());
        let lowest = known.fold(f32::MAX, f32::min);
        // The sea is shown where it covers ground.
        let sea_level = sea_level.filter(|sea| f64::from(lowest) < *sea);
        let low = f64::from(lowest);
        let highest = f64::from(highest);
        let length = (window.width - 1) as f64 * window.cell;
        // Metres a millimetre across, and what the heights would take up at that scale.
        let scale = length / f64::from(area[2]);
        let natural = (highest - low) / scale;
        let exaggeration = (f64::from(area[3]) * LAND / natural).min(MOST);
        // Two digits, not rounded up: the land has to fit.
        let digits = libm::pow(10.0, 1.0 - libm::log10(exaggeration).floor());
        let exaggeration = (exaggeration * digits).floor() / digits;
        let rise = f64::from(area[3]) * scale / exaggeration;
        if !(natural * exaggeration > 1.0 && rise.is_finite()) {
            return None;
        }
        let foot = low - FOOT * rise;
        let span = [foot, foot + rise];
        let row = j as f32 / (window.height - 1).max(1) as f32;
        Some(Profile { area, row, highest, lowest, heights, length, span, exaggeration, sea_level })
    }

    /// Draws it, and where it runs on the map. Without a tint, the land is grey.
    pub fn draw(&self, desk: &mut Desk, map: [f32; 4], tint: Option<&Tint>, dpi: f64) {
        let [left, top, width, height] = self.area;
        let (right, bottom) = (left + width, top + height);
        let up = |metres: f64| bottom - height * ((metres - self.span[0]) / (self.span[1] - self.span[0])) as f32;
        self.ground(desk, tint, dpi);
        let mut marks: Vec<Vec<Place>> = Vec::new();
        let mut lines: Vec<Vec<Place>> = Vec::new();
        let decimals = if self.span[1] - self.span[0] < 20.0 { 1 } else { 0 };
        // Heights are metres however large they are.
        for (value, _) in ticks(self.span, (height / 9.0).max(2.0) as usize, Count::Latitude) {
            let (y, name) = (up(value), format!("{} m", grouped(value, decimals)));
            marks.push(vec![[left, y], [left - 1.3, y]]);
            lines.push(vec![[left, y], [right, y]]);
            desk.small(&name, [left - 2.2, y + 0.95], Align::End);
        }
        desk.scene.lines(lines, 0.1, INK, 0.25);
        for (value, name) in ticks([0.0, self.length], (width / 21.0).max(1.0) as usize, Count::Metres) {
            let x = left + width * (value / self.length) as f32;
            marks.push(vec![[x, bottom], [x, bottom + 1.3]]);
            let half = desk.letters.width(&name, Face::Regular, SMALL) / 2.0;
            if x + half < desk.scene.size[0] - 1.0 {
                desk.small(&name, [x, bottom + 4.2], Align::Middle);
            }
        }
        desk.scene.lines(marks, 0.2, INK, 1.0);
        let place = |(k, height): (usize, &f32)| {
            let x = left + width * k as f32 / (self.heights.len() - 1) as f32;
            height.is_finite().then(|| [x, up(f64::from(*height))])
        };
        // A line for each stretch without holes.
        let places: Vec<Option<Place>> = self.heights.iter().enumerate().map(place).collect();
        let stretches = places.split(Option::is_none).map(|stretch| stretch.iter().copied().flatten().collect());
        desk.scene.lines(stretches.collect(), 0.22, INK, 1.0);
        desk.scene.lines(vec![vec![[left, top], [left, bottom], [right, bottom]]], 0.2, INK, 1.0);
        let words = format!(
            "Profile A to B, through {} m; heights {} ×",
            grouped(self.highest, 0),
            grouped(self.exaggeration, if self.exaggeration.fract() == 0.0 { 0 } else { 1 })
        );
        desk.small(&words, [left, top - 2.4], Align::Start);
        for (name, x, align) in [("A", left, Align::Start), ("B", right, Align::End)] {
            let x = if align == Align::Start { x + 0.8 } else { x - 0.8 };
            desk.text(name, Face::Bold, SMALL, SOFT, [x, top + 2.6], align);
        }
        let y = map[1] + map[3] * self.row;
        for (name, x, away) in [("A", map[0], 1.0), ("B", map[0] + map[2], -1.0)] {
            let arrow = polygon(&[[x, y - 1.2], [x + 2.0 * away, y], [x, y + 1.2]]);
            let align = if away > 0.0 { Align::Start } else { Align::End };
            let text_at = [x + 2.6 * away, y + 0.95];
            let wide = desk.letters.width(name, Face::Bold, SMALL);
            // A bright patch, so that dark ground does not swallow the letter.
            let patch = if away > 0.0 { text_at[0] - 0.3 } else { text_at[0] - wide - 0.3 };
            let corners =
                [[patch, y - 1.5], [patch + wide + 0.6, y - 1.5], [patch + wide + 0.6, y + 1.5], [patch, y + 1.5]];
            desk.scene.area(polygon(&corners), [255; 3], 0.6);
            desk.scene.area(arrow, INK, 1.0);
            desk.text(name, Face::Bold, SMALL, INK, text_at, align);
        }
    }

    /// The land under the line in the map's colours or in grey, and the sea over it.
    fn ground(&self, desk: &mut Desk, tint: Option<&Tint>, dpi: f64) {
        let [_, _, width, height] = self.area;
        let side = |millimetres: f32| ((f64::from(millimetres) * dpi / 25.4).round() as usize).clamp(2, 8000);
        let [columns, rows] = [side(width), side(height)];
        let encoder = Encoder::new();
        let rise = (self.span[1] - self.span[0]) / rows as f64;
        let mut pixels = Vec::with_capacity(3 * columns * rows);
        for j in 0..rows {
            let metres = self.span[1] - (j as f64 + 0.5) * rise;
            // What lies below all ground on the line has the colour of the lowest.
            let color = tint.map_or(LAND_INK, |tint| encoder.bytes(tint.at((metres as f32).max(self.lowest))));
            for i in 0..columns {
                let at = (i as f64 + 0.5) / columns as f64 * (self.heights.len() - 1) as f64;
                let (k, share) = (at as usize, at.fract() as f32);
                let [a, b] = [self.heights[k], self.heights[(k + 1).min(self.heights.len() - 1)]];
                let ground = f64::from(a + (b - a) * share);
                let cover = |level: f64| ((level - metres) / rise + 0.5).clamp(0.0, 1.0) as f32;
                let mut pixel = [255.0f32; 3];
                let mut lay = |ink: Rgb, cover: f32| {
                    pixel.iter_mut().zip(ink).for_each(|(pixel, ink)| *pixel += (f32::from(ink) - *pixel) * cover);
                };
                if let Some(sea) = self.sea_level.filter(|sea| ground < *sea) {
                    lay(SEA, cover(sea));
                }
                if ground.is_finite() {
                    lay(color, cover(ground) * 0.85);
                }
                pixels.extend(pixel.map(|part| part.round() as u8));
            }
        }
        desk.scene.items.push(Item::Picture { area: self.area, width: columns, height: rows, pixels });
    }
}
