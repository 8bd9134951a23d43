//! Drawing of the lines on the map, each in an ink that is visible on the ground below it.

use super::font_set::FontSet;
use super::furniture::Desk;
use super::geometry::{Affine, Point, Rect};
use super::inks::{BLUE, Inks, LAKES, SHORE, THICK, THIN};
use super::labels::{Label, LabelStyle, Taken, gaps, place};
use super::lines::is_thick;
use super::linework::Linework;
use super::marks;
use super::options::SheetOptions;
use super::scene::{Scene, Step};
use super::ticks::grouped;
use crate::map::text::Face;
use orogen_grid::contour::line::Line;
use orogen_io::palette::color::{Light, Rgb, decode};
use orogen_io::palette::tint::Tint;

/// Widths of the smallest and the largest river, in millimetres.
const RIVERS: [f32; 2] = [0.16, 0.95];

/// Style of contour labels; `size` is the em in millimetres.
const LABEL: LabelStyle = LabelStyle { size: 2.1, apart: 7.0, every: 95.0 };

/// The background of the lines: colors by height, or a picture.
pub enum Below<'a> {
    /// The tint of the heights.
    Tint(&'a Tint),
    /// A picture over the map's area: its pixels per row, and its sRGB bytes.
    Picture(usize, &'a [u8]),
}

impl Below<'_> {
    /// The mean color under a contour line, in linear light.
    fn color(&self, map: Rect, elevation: f64, line: &[Point]) -> Light {
        match self {
            Below::Tint(tint) => tint.at(elevation as f32),
            Below::Picture(columns, pixels) => {
                let rows = (pixels.len() / 3 / columns).max(1);
                let at = |share: f32, count: usize| ((share * count as f32).max(0.0) as usize).min(count - 1);
                let mut sum: Light = [0.0; 3];
                for place in line {
                    let [across, down] = [(place.x - map.left) / map.width, (place.y - map.top) / map.height];
                    let first = 3 * (at(down, rows) * columns + at(across, *columns));
                    sum.iter_mut().zip(&pixels[first..first + 3]).for_each(|(sum, byte)| *sum += decode(*byte));
                }
                sum.map(|part| part / line.len().max(1) as f32)
            }
        }
    }
}

impl Linework {
    /// Draws all lines on the map. Returns the names that have no room.
    pub fn draw(&self, desk: &mut Desk, map: Rect, options: &SheetOptions, below: &Below) -> Vec<String> {
        let across = map.width / (self.grid.width() - 1) as f32;
        let down = map.height / (self.grid.height() - 1) as f32;
        let on_map = Affine::scaling(map.corner(), across, down);
        let spot = |[x, y]: [f64; 2]| on_map.apply(Point::new(x as f32, y as f32));
        let cell = self.grid.window().cell;
        let path = |line: &Line| line.path().map(|[x, y]| spot([x / cell, y / cell])).collect::<Vec<Point>>();
        let mut taken = Taken::none(map.inset(1.0));
        let rivers: Vec<(f32, Vec<Point>)> = match options.parts.rivers {
            true => self
                .water
                .rivers
                .iter()
                .map(|river| (self.width(river.drained), river.points.iter().map(|p| spot(*p)).collect()))
                .collect(),
            false => Vec::new(),
        };
        let lakes: Vec<Vec<Point>> = match options.parts.lakes {
            true => self.water.lakes.iter().map(|ring| ring.iter().map(|p| spot(*p)).collect()).collect(),
            false => Vec::new(),
        };
        let shore: Vec<Vec<Point>> = self.shore.iter().map(path).collect();
        // Names and summits are drawn last, on top of the lines, but reserve their room first; names may cross rivers and shores, because harbours and towns
        // at rivers have no other room.
        let mut over = Desk {
            scene: Scene { size: desk.scene.size, title: String::new(), items: Vec::new() },
            letters: desk.letters,
        };
        let mut left_out = Vec::new();
        for place in &options.names {
            let at = map.at(place.at[0] as f32, place.at[1] as f32);
            if !marks::place_name(&mut over.scene, desk.letters, &mut taken, at, &place.name) {
                left_out.push(place.name.clone());
            }
        }
        rivers.iter().for_each(|(width, line)| taken.take_line(line, 0.35 + width / 2.0));
        lakes.iter().chain(&shore).for_each(|line| taken.take_line(line, 0.5));
        for summit in &self.summits {
            let share = |at: usize, samples: usize| at as f32 / (samples - 1) as f32;
            let place = map.at(share(summit.x, self.samples[0]), share(summit.y, self.samples[1]));
            let text = grouped(f64::from(summit.height), 0);
            marks::summit(&mut over.scene, desk.letters, &mut taken, place, &text);
        }
        let sea = options.sea_level.unwrap_or(f64::NEG_INFINITY);
        let interval = self.interval.unwrap_or(1.0);
        // Grouped by ink and width, in the order of first use.
        let ink =
            |line: &Line, places: &[Point]| Inks::over(below.color(map, line.elevation, places), line.elevation > sea);
        let mut kinds: Vec<(Rgb, f32, f32, Vec<Vec<Point>>)> = Vec::new();
        let mut thick: Vec<(&Line, Vec<Point>)> = Vec::new();
        let mut sort = |line: &Line, places: Vec<Point>| {
            let inks = ink(line, &places);
            let (width, cover) = if is_thick(line, interval) { (THICK, inks.cover + 0.18) } else { (THIN, inks.cover) };
            match kinds.iter_mut().find(|kind| (kind.0, kind.1) == (inks.line, width)) {
                Some(kind) => kind.3.push(places),
                None => kinds.push((inks.line, width, cover, vec![places])),
            }
        };
        for line in &self.contours {
            match is_thick(line, interval) {
                true => thick.push((line, path(line))),
                false => sort(line, path(line)),
            }
        }
        let labels = if options.parts.labels { self.labels(desk.letters, &thick, &mut taken, ink) } else { Vec::new() };
        thick.into_iter().for_each(|(line, places)| sort(line, places));
        let words: Vec<Label> = labels.iter().map(|(_, label)| label.clone()).collect();
        for (ink, width, cover, lines) in kinds {
            desk.scene.lines(gaps(&lines, &words, LABEL.size * 0.5, 0.25), width, ink, cover);
        }
        // Thin rivers first, so that they end under the rivers that they flow into.
        let mut widths: Vec<f32> = rivers.iter().map(|river| river.0).collect();
        widths.sort_by(f32::total_cmp);
        widths.dedup();
        for width in widths {
            let same = rivers.iter().filter(|river| river.0 == width).map(|river| river.1.clone());
            desk.scene.lines(same.collect(), width, BLUE, 0.95);
        }
        let outline = lakes.iter().flat_map(|ring| super::scene::polygon(ring.iter().copied())).collect::<Vec<Step>>();
        desk.scene.area(outline, LAKES, 1.0);
        desk.scene.lines(lakes, 0.18, SHORE, 1.0);
        desk.scene.lines(shore, 0.22, SHORE, 0.9);
        for (inks, label) in &labels {
            let width = desk.letters.width(&label.text, Face::Bold, LABEL.size);
            let length: f32 = label.path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
            let start = (length - width) / 2.0;
            let outline = desk.letters.each(&label.text, Face::Bold, LABEL.size, |along| {
                let (at, angle) = label.at(start + along);
                // The line runs through the middle of the letters instead of their baseline.
                let sink = LABEL.size * 0.34;
                (at.moved(sink * libm::sinf(angle), sink * libm::cosf(angle)), angle)
            });
            desk.scene.area(outline, inks.words, 1.0);
        }
        desk.scene.items.append(&mut over.scene.items);
        left_out
    }

    /// Labels of the index contours, the longest lines first, with their inks.
    fn labels(
        &self,
        letters: &FontSet,
        thick: &[(&Line, Vec<Point>)],
        taken: &mut Taken,
        ink: impl Fn(&Line, &[Point]) -> Inks,
    ) -> Vec<(Inks, Label)> {
        let mut order: Vec<&(&Line, Vec<Point>)> = thick.iter().collect();
        order.sort_by(|a, b| b.0.length().total_cmp(&a.0.length()));
        let mut labels = Vec::new();
        for (line, places) in order {
            let text = grouped(line.elevation, if line.elevation.fract() == 0.0 { 0 } else { 1 });
            let width = letters.width(&text, Face::Bold, LABEL.size);
            let inks = ink(line, places);
            labels.extend(place(places, &text, width, LABEL, taken).into_iter().map(|label| (inks, label)));
        }
        labels
    }

    /// The width of a river with this many samples of drainage area, in millimetres: linear in the square root of the
    /// area, in visible steps.
    fn width(&self, drained: f64) -> f32 {
        let share = (drained / self.grid.data().len() as f64).sqrt() as f32;
        let width = RIVERS[0] + (RIVERS[1] - RIVERS[0]) * (share * 1.3).min(1.0);
        (width / 0.06).round() * 0.06
    }
}
