//! Names on a map: of places, summits, rivers and other water.

use super::furniture::Desk;
use super::geometry::{Point, Rect};
use super::labels::{Label, LabelStyle, place};
use super::lines::Summit;
use super::linework::Linework;
use super::marks;
use super::options::{PlaceKind, PlaceName, SheetOptions};
use super::taken::Taken;
use super::ticks::grouped;
use crate::map::text::Face;
use orogen_io::palette::color::Rgb;

/// Style of names along lines.
const ALONG: LabelStyle =
    LabelStyle { size: 2.7, spacing: 1.12, reach: 0.5, turn: 0.7, straight: 0.8, apart: 3.0, every: 130.0 };

/// Distances from the edge of a river to the middle of its name, in millimetres, the preferred one first.
const BESIDE: [f32; 2] = [1.9, 2.6];

/// Width from which other names do not cross a river, in millimetres.
const WIDE: f32 = 0.4;

/// Maximum distance of a named point from its river or from a summit found in the heights, in millimetres.
const RIVER: f32 = 8.0;
const SUMMIT: f32 = 3.0;

/// Lengths of the river around its named point in which its name may be placed, in millimetres, the preferred one
/// first.
const NEAR: [f32; 2] = [35.0, 90.0];

/// Distance between points along the middle of a name, and half of the length over which it is smoothed, in
/// millimetres.
const STEP: f32 = 0.5;
const SMOOTHED: f32 = 4.0;

/// Names that are not on the map.
#[derive(Debug, Default)]
pub struct LeftOut {
    /// Names without room.
    pub crowded: Vec<String>,
    /// Names of rivers at points without a river.
    pub without_river: Vec<String>,
}

impl Linework {
    /// Draws the names of places, summits and lakes. Returns the summits found in the heights that got a name.
    pub(super) fn draw_names(
        &self,
        desk: &mut Desk,
        map: Rect,
        options: &SheetOptions,
        taken: &mut Taken,
        left_out: &mut LeftOut,
    ) -> Vec<Summit> {
        let mut named = Vec::new();
        for place in &options.names {
            let at = on_map(map, place.at);
            let is_drawn = match place.kind {
                PlaceKind::Place => marks::place_name(desk, taken, at, &place.name),
                PlaceKind::Water => marks::water_name(desk, taken, at, &place.name),
                PlaceKind::Summit => {
                    let found = self.summits.iter().find(|summit| self.summit_at(summit, map).distance(at) < SUMMIT);
                    named.extend(found.copied());
                    let height = self.height(place, found).map(|height| grouped(height, 0));
                    let at = found.map_or(at, |summit| self.summit_at(summit, map));
                    marks::named_summit(desk, taken, at, &place.name, height.as_deref())
                }
                PlaceKind::River => true,
            };
            if !is_drawn {
                left_out.crowded.push(place.name.clone());
            }
        }
        named
    }

    /// The position of a summit on the map.
    pub(super) fn summit_at(&self, summit: &Summit, map: Rect) -> Point {
        let share = |at: usize, samples: usize| at as f32 / (samples - 1) as f32;
        map.at(share(summit.x, self.samples[0]), share(summit.y, self.samples[1]))
    }

    /// The height of a named summit: the given one, that of the summit found there, or that of the ground.
    fn height(&self, place: &PlaceName, found: Option<&Summit>) -> Option<f64> {
        let ground = || {
            let nearest = |share: f64, count: usize| ((share * (count - 1) as f64).round() as usize).min(count - 1);
            f64::from(self.grid[(nearest(place.at[0], self.grid.width()), nearest(place.at[1], self.grid.height()))])
        };
        place
            .height
            .or(found.map(|summit| f64::from(summit.height)))
            .or_else(|| Some(ground()).filter(|h| h.is_finite()))
    }

    /// Draws the names along lines, and the names of rivers at points. `rivers` are the drawn stretches with their
    /// widths.
    pub(super) fn draw_line_names(
        &self,
        desk: &mut Desk,
        map: Rect,
        options: &SheetOptions,
        rivers: &[(f32, Vec<Point>)],
        room: &mut Room,
        left_out: &mut LeftOut,
    ) {
        rivers.iter().filter(|river| river.0 > WIDE).for_each(|(width, line)| room.names.take_line(line, width / 2.0));
        for line in &options.line_names {
            let points: Vec<Point> = line.points.iter().map(|at| on_map(map, *at)).collect();
            let points = longest_within(&points, map);
            let ink = if line.is_water { desk.colors.rivers() } else { desk.colors.ink };
            if !name_along(desk, room, &points, 0.6, &line.name, ink) {
                left_out.crowded.push(line.name.clone());
            }
        }
        for place in options.names.iter().filter(|place| place.kind == PlaceKind::River) {
            let at = on_map(map, place.at);
            let Some((width, course)) = course(rivers, at) else {
                left_out.without_river.push(place.name.clone());
                continue;
            };
            let ink = desk.colors.rivers();
            let is_drawn = NEAR.iter().any(|reach| {
                let part = part_near(&course, at, *reach);
                name_along(desk, room, &part, width, &place.name, ink)
            });
            if !is_drawn {
                left_out.crowded.push(place.name.clone());
            }
        }
    }
}

fn on_map(map: Rect, at: [f64; 2]) -> Point {
    map.at(at[0] as f32, at[1] as f32)
}

/// The room for names along lines.
pub struct Room<'a> {
    /// Areas without names and wide rivers.
    pub names: Taken,
    /// Areas without anything else.
    pub all: &'a mut Taken,
}

/// Draws a name along one side of a line of this width, if there is room: first in empty areas, then across other
/// lines.
fn name_along(desk: &mut Desk, room: &mut Room, line: &[Point], width: f32, name: &str, ink: Rgb) -> bool {
    let even = smoothed(line);
    let wide = desk.letters.width(name, Face::Italic, ALONG.size) * ALONG.spacing;
    // Above the line first.
    let is_eastward = even.first().zip(even.last()).is_some_and(|(first, last)| last.x >= first.x);
    let sides = if is_eastward { [-1.0, 1.0] } else { [1.0, -1.0] };
    let own = around(line, width / 2.0);
    let find = |taken: &mut Taken| {
        let beside = BESIDE.into_iter().flat_map(|beside| sides.map(|side| side * (beside + width / 2.0)));
        let is_clear = |place: Point, reach: f32| own.is_free(place, reach);
        let mut labels = beside.map(|by| place(&moved(&even, by), name, wide, ALONG, taken, is_clear));
        labels.find(|labels| !labels.is_empty())
    };
    let found: Option<Vec<Label>> = find(&mut *room.all).or_else(|| find(&mut room.names));
    for label in found.iter().flatten() {
        let outline = desk.outline_along(label, Face::Italic);
        marks::edged_text(desk, outline, ink);
        for taken in [&mut room.names, &mut *room.all] {
            label.path.iter().for_each(|place| taken.take(*place, ALONG.size));
        }
    }
    found.is_some()
}

/// The room around a line, without the line.
fn around(line: &[Point], reach: f32) -> Taken {
    /// More than the height of any text along the line.
    const FREE: f32 = 12.0;
    let corner = line.iter().fold(Point::new(f32::MAX, f32::MAX), |a, b| Point::new(a.x.min(b.x), a.y.min(b.y)));
    let far = line.iter().fold(corner, |a, b| Point::new(a.x.max(b.x), a.y.max(b.y)));
    let size = corner.to(far);
    let mut own = Taken::none(Rect::new(corner.x, corner.y, size.x, size.y).inset(-FREE));
    own.take_line(line, reach);
    own
}

/// The longest part of a line within a rectangle.
fn longest_within(line: &[Point], area: Rect) -> Vec<Point> {
    let mut parts: Vec<Vec<Point>> = vec![Vec::new()];
    for pair in line.windows(2) {
        let way = pair[0].to(pair[1]);
        // Shares of the segment between which it is inside (Liang and Barsky 1984).
        let mut inside = [0.0f32, 1.0];
        for (at, way, ends) in
            [(pair[0].x, way.x, [area.left, area.right()]), (pair[0].y, way.y, [area.top, area.bottom()])]
        {
            let shares = ends.map(|end| (end - at) / way);
            let is_within = (ends[0]..=ends[1]).contains(&at);
            inside = match (way == 0.0, is_within) {
                (true, true) => inside,
                (true, false) => [1.0, 0.0],
                _ => [inside[0].max(shares[0].min(shares[1])), inside[1].min(shares[0].max(shares[1]))],
            };
        }
        let [from, to] = inside.map(|share| pair[0].toward(pair[1], share));
        if inside[0] <= inside[1] && from.is_finite() && to.is_finite() {
            match parts.last_mut() {
                Some(part) if !part.is_empty() && inside[0] == 0.0 => part.push(to),
                _ => parts.push(vec![from, to]),
            }
        }
        if inside[1] < 1.0 {
            parts.push(Vec::new());
        }
    }
    let length = |part: &Vec<Point>| part.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f32>();
    parts.into_iter().max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or_default()
}

/// A line with points at even distances, without bends that are shorter than a few letters.
fn smoothed(line: &[Point]) -> Vec<Point> {
    let mut even: Vec<Point> = line.first().copied().into_iter().collect();
    let mut left = STEP;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        let mut along = left;
        while along <= length {
            even.push(pair[0].toward(pair[1], along / length));
            along += STEP;
        }
        left = along - length;
    }
    let reach = (SMOOTHED / STEP) as usize;
    (0..even.len())
        .map(|k| {
            // Symmetric, so that the ends do not move.
            let reach = reach.min(k).min(even.len() - 1 - k);
            let near = &even[k - reach..=k + reach];
            let mean = |side: fn(&Point) -> f32| near.iter().map(side).sum::<f32>() / near.len() as f32;
            Point::new(mean(|place| place.x), mean(|place| place.y))
        })
        .collect()
}

/// A line moved by a distance to its right on the page, or to its left if the distance is negative.
fn moved(line: &[Point], by: f32) -> Vec<Point> {
    let last = line.len().saturating_sub(1);
    let aside = |k: usize| {
        let way = line[k.saturating_sub(2)].to(line[(k + 2).min(last)]);
        let length = way.length().max(1e-6);
        line[k].moved(-way.y / length * by, way.x / length * by)
    };
    if line.len() < 2 { Vec::new() } else { (0..line.len()).map(aside).collect() }
}

/// The course of the river nearest to a point, downstream, and its largest width; `None` if no river is near.
///
/// It consists of the nearest stretch, the stretches downstream of it, and upstream the widest one at each confluence.
fn course(rivers: &[(f32, Vec<Point>)], at: Point) -> Option<(f32, Vec<Point>)> {
    /// Maximum distance between the ends of stretches, in millimetres.
    const JOINED: f32 = 0.6;
    let distance = |nth: &usize| distance_to(&rivers[*nth].1, at);
    let nearest = (0..rivers.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    if distance(&nearest) > RIVER {
        return None;
    }
    let mut stretches = std::collections::VecDeque::from([nearest]);
    loop {
        let (first, last) = (stretches.front()?, stretches.back()?);
        let (start, end) = (rivers[*first].1.first()?, rivers[*last].1.last()?);
        let is_next = |nth: &usize| {
            rivers[*nth].1.first().is_some_and(|point| point.distance(*end) < JOINED) && !stretches.contains(nth)
        };
        let is_before = |nth: &usize| {
            rivers[*nth].1.last().is_some_and(|point| point.distance(*start) < JOINED) && !stretches.contains(nth)
        };
        let next = (0..rivers.len()).find(is_next);
        let before = (0..rivers.len()).filter(is_before).max_by(|a, b| rivers[*a].0.total_cmp(&rivers[*b].0));
        stretches.extend(next);
        if let Some(before) = before.filter(|before| Some(*before) != next) {
            stretches.push_front(before);
        } else if next.is_none() {
            break;
        }
    }
    let width = stretches.iter().map(|nth| rivers[*nth].0).fold(0.0, f32::max);
    Some((width, stretches.iter().flat_map(|nth| rivers[*nth].1.iter().copied()).collect()))
}

/// The distance from a line to a point.
fn distance_to(line: &[Point], at: Point) -> f32 {
    let distance = |pair: &[Point]| {
        let (way, to) = (pair[0].to(pair[1]), pair[0].to(at));
        let share = ((to.x * way.x + to.y * way.y) / way.square().max(1e-12)).clamp(0.0, 1.0);
        pair[0].toward(pair[1], share).distance(at)
    };
    line.windows(2).map(distance).fold(f32::MAX, f32::min)
}

/// The part of a line within a distance along the line from its point nearest to a place.
fn part_near(line: &[Point], at: Point, reach: f32) -> Vec<Point> {
    let Some(nearest) = (0..line.len()).min_by(|a, b| line[*a].distance(at).total_cmp(&line[*b].distance(at))) else {
        return Vec::new();
    };
    let until = |points: &mut dyn Iterator<Item = usize>| {
        let (mut left, mut end) = (reach, nearest);
        for k in points {
            left -= line[k].distance(line[end]);
            if left < 0.0 {
                break;
            }
            end = k;
        }
        end
    };
    let (first, last) = (until(&mut (0..nearest).rev()), until(&mut (nearest + 1..line.len())));
    line[first..=last].to_vec()
}

#[cfg(test)]
mod tests {
    use super::super::scene::line;
    use super::*;

    #[test]
    fn a_course_joins_the_widest_stretches() {
        let rivers = vec![
            (0.3, line([[0.0, 0.0], [10.0, 10.0]])),
            (0.6, line([[20.0, 0.0], [10.0, 10.0]])),
            (0.9, line([[10.0, 10.0], [10.0, 40.0]])),
            (0.2, line([[90.0, 0.0], [90.0, 40.0]])),
        ];
        let (width, points) = course(&rivers, Point::new(12.0, 11.0)).unwrap();
        assert_eq!((width, points[0], points[points.len() - 1]), (0.9, Point::new(20.0, 0.0), Point::new(10.0, 40.0)));
        // The course of a tributary continues in the river that it joins.
        let (_, points) = course(&rivers, Point::new(0.0, 1.0)).unwrap();
        assert_eq!((points[0], points[points.len() - 1]), (Point::new(0.0, 0.0), Point::new(10.0, 40.0)));
        assert_eq!(course(&rivers, Point::new(60.0, 20.0)), None);
    }

    #[test]
    fn lines_are_cut_at_the_map() {
        let area = Rect::new(0.0, 0.0, 100.0, 50.0);
        let cut = |points: &[[f32; 2]]| longest_within(&line(points.iter().copied()), area);
        assert_eq!(cut(&[[-10.0, 20.0], [110.0, 20.0]]), line([[0.0, 20.0], [100.0, 20.0]]));
        // Inside twice: the longer part is taken.
        let twice = [[10.0, 10.0], [10.0, 90.0], [60.0, 90.0], [60.0, 5.0], [40.0, 5.0]];
        assert_eq!(cut(&twice), line([[60.0, 50.0], [60.0, 5.0], [40.0, 5.0]]));
        assert!(cut(&[[-10.0, 60.0], [110.0, 60.0]]).is_empty() && cut(&[[5.0, 5.0]]).is_empty());
        assert!(cut(&[[f32::INFINITY, 5.0], [f32::NAN, 7.0], [-1e30, 1e30]]).is_empty());
    }

    #[test]
    fn lines_are_moved_to_a_side_and_cut_around_a_point() {
        let straight = line((0..=20).map(|x| [x as f32, 5.0]));
        assert_eq!(moved(&straight, -2.0)[7], Point::new(7.0, 3.0), "to the left of a line to the right is above it");
        let even = smoothed(&straight);
        assert_eq!((even.len(), even[40]), (41, Point::new(20.0, 5.0)));
        let part = part_near(&straight, Point::new(10.2, 0.0), 4.0);
        assert_eq!((part[0].x, part[part.len() - 1].x), (6.0, 14.0));
    }
}
