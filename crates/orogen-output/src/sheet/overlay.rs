//! Drawing of the lines on the map, each in an ink that is visible on the ground below it.

use super::contour_lines::ContourLines;
use super::furniture::Desk;
use super::geometry::{Affine, Point, Rect};
use super::inks::Inks;
use super::linework::Linework;
use super::marks;
use super::names::{LeftOut, Room};
use super::options::SheetOptions;
use super::roads;
use super::scene::{Scene, Step};
use super::taken::Taken;
use super::ticks::grouped;
use orogen_grid::contour::line::Line;
use orogen_grid::roads::RoadKind;
use orogen_io::palette::color::{Light, decode};
use orogen_io::palette::tint::Tint;

/// Widths of the smallest and the largest river, in millimetres.
const RIVERS: [f32; 2] = [0.16, 0.95];

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
    /// Draws all lines on the map. Returns the names that could not be placed.
    pub fn draw(&self, desk: &mut Desk, map: Rect, options: &SheetOptions, below: &Below) -> LeftOut {
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
        let [columns, rows] = [(0, self.grid.width()), (1, self.grid.height())]
            .map(|(axis, count)| (count - 1) as f64 / (self.samples[axis].max(2) - 1) as f64);
        let roads: Vec<(RoadKind, Vec<Point>)> = match options.parts.roads {
            true => (options.roads.iter())
                .map(|road| (road.kind, road.points.iter().map(|[x, y]| spot([x * columns, y * rows])).collect()))
                .collect(),
            false => Vec::new(),
        };
        // Names and summits are drawn last, on top of the lines, but reserve their room first. Names may cross rivers
        // and shores, because harbours and towns at rivers have no other room.
        let mut over =
            Desk { scene: Scene::new(desk.scene.size, String::new()), letters: desk.letters, colors: desk.colors };
        let mut left_out = LeftOut::default();
        let named = self.draw_names(&mut over, map, options, &mut taken, &mut left_out);
        let names = taken.clone();
        rivers.iter().for_each(|(width, line)| taken.take_line(line, 0.35 + width / 2.0));
        lakes.iter().chain(&shore).for_each(|line| taken.take_line(line, 0.5));
        roads.iter().for_each(|(_, line)| taken.take_line(line, roads::REACH));
        let mut room = Room { names, all: &mut taken };
        self.draw_line_names(&mut over, map, options, &rivers, &mut room, &mut left_out);
        for summit in self.summits.iter().filter(|summit| !named.contains(summit)) {
            let text = grouped(f64::from(summit.height), 0);
            marks::summit(&mut over, &mut taken, self.summit_at(summit, map), &text);
        }
        let ink = |line: &Line, places: &[Point]| {
            let is_land = line.elevation > options.sea_level.unwrap_or(f64::NEG_INFINITY);
            Inks::over(below.color(map, line.elevation, places), is_land, &options.page_colors)
        };
        let contours: Vec<(&Line, Vec<Point>)> = self.contours.iter().map(|line| (line, path(line))).collect();
        let contours = ContourLines::new(self, contours, options, desk.letters, map, &mut taken, ink);
        contours.draw_lines(&mut desk.scene);
        // Thin rivers are drawn first, so that they end under the rivers that they flow into.
        let mut widths: Vec<f32> = rivers.iter().map(|river| river.0).collect();
        widths.sort_by(f32::total_cmp);
        widths.dedup();
        for width in widths {
            let same = rivers.iter().filter(|river| river.0 == width).map(|river| river.1.clone());
            desk.scene.lines(same.collect(), width, desk.colors.rivers(), 0.95);
        }
        let outline = lakes.iter().flat_map(|ring| super::scene::polygon(ring.iter().copied())).collect::<Vec<Step>>();
        desk.scene.area(outline, desk.colors.lakes(), 1.0);
        desk.scene.lines(lakes, 0.18, desk.colors.shores(), 1.0);
        desk.scene.lines(shore, 0.22, desk.colors.shores(), 0.9);
        roads::draw(&mut desk.scene, &roads);
        contours.draw_labels(desk);
        desk.scene.items.append(&mut over.scene.items);
        left_out
    }

    /// The width of a river with this many samples of drainage area, in millimetres: linear in the square root of the
    /// area, in visible steps.
    fn width(&self, drained: f64) -> f32 {
        let share = (drained / self.grid.data().len() as f64).sqrt() as f32;
        let width = RIVERS[0] + (RIVERS[1] - RIVERS[0]) * (share * 1.3).min(1.0);
        (width / 0.06).round() * 0.06
    }
}
