//! Labels along contour lines, each in a gap of its line.

use super::geometry::Point;
use super::taken::Taken;

/// A label along a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// Height of the letters, in millimetres.
    pub size: f32,
    /// Factor of the distance between letters.
    pub spacing: f32,
    /// Points along its center line, at most a letter's width apart, in reading order.
    pub path: Vec<Point>,
}

impl Label {
    /// The position at a distance along the label, and the rotation there in radians counter-clockwise.
    pub fn at(&self, along: f32) -> (Point, f32) {
        let mut left = along;
        let last = self.path.len().saturating_sub(2);
        for (k, pair) in self.path.windows(2).enumerate() {
            let way = pair[0].to(pair[1]);
            let length = way.length();
            if left <= length || k == last {
                let share = if length > 0.0 { left / length } else { 0.0 };
                return (pair[0].toward(pair[1], share), libm::atan2f(-way.y, way.x));
            }
            left -= length;
        }
        (self.path.first().copied().unwrap_or_default(), 0.0)
    }
}

/// The style of labels.
#[derive(Debug, Clone, Copy)]
pub struct LabelStyle {
    /// Height of the letters, in millimetres.
    pub size: f32,
    /// Factor of the distance between letters.
    pub spacing: f32,
    /// Room on both sides of the center line of the letters, relative to their height.
    pub reach: f32,
    /// Maximum angle between two quarters of a text, in radians.
    pub turn: f32,
    /// Minimum distance between the ends of a text, relative to its length.
    pub straight: f32,
    /// Minimum distance between two labels, in millimetres.
    pub apart: f32,
    /// Distance between two labels of one line, in millimetres.
    pub every: f32,
}

/// Finds positions for a line's labels. `line` has higher ground to its left, so a text along it points uphill. Where
/// such a text would be upside down it is reversed, if there is no better position. `width` includes the spacing
/// between letters.
///
/// A label is placed where `is_clear` returns true for all points of its path. The area of the labels is marked as
/// occupied.
pub fn place(
    line: &[Point],
    text: &str,
    width: f32,
    style: LabelStyle,
    taken: &mut Taken,
    is_clear: impl Fn(Point, f32) -> bool,
) -> Vec<Label> {
    let along = Along::new(line);
    let (need, step) = (width + style.size, style.size * 0.6);
    let count = ((along.length() - need) / step).floor();
    if count.is_nan() || count < 1.0 {
        return Vec::new();
    }
    let mut candidates: Vec<(f32, usize)> =
        (0..=count as usize).filter_map(|k| Some((along.score(k as f32 * step, need, style)?, k))).collect();
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let wanted = ((along.length() / style.every).ceil() as usize).max(1);
    let mut labels: Vec<Label> = Vec::new();
    let mut middles: Vec<f32> = Vec::new();
    for (_, k) in candidates {
        if labels.len() == wanted {
            break;
        }
        let start = k as f32 * step;
        let middle = start + need / 2.0;
        if middles.iter().any(|other| (other - middle).abs() < style.every * 0.6) {
            continue;
        }
        let mut path = along.part(start, start + need, style.size * 0.25);
        let reach = style.size * style.reach;
        if !path.iter().all(|place| taken.is_free(*place, reach) && is_clear(*place, reach)) {
            continue;
        }
        if path.last().zip(path.first()).is_some_and(|(last, first)| last.x < first.x) {
            path.reverse();
        }
        path.iter().for_each(|place| taken.take(*place, reach + style.apart / 2.0));
        middles.push(middle);
        labels.push(Label { text: text.to_string(), size: style.size, spacing: style.spacing, path });
    }
    labels
}

/// A line parametrised by distance.
struct Along<'a> {
    line: &'a [Point],
    /// The distance of each point from the first.
    distances: Vec<f32>,
}

impl<'a> Along<'a> {
    fn new(line: &'a [Point]) -> Along<'a> {
        let mut sum = 0.0;
        let mut distances = vec![0.0];
        for pair in line.windows(2) {
            sum += pair[0].distance(pair[1]);
            distances.push(sum);
        }
        Along { line, distances }
    }

    fn length(&self) -> f32 {
        self.distances.last().copied().unwrap_or(0.0)
    }

    fn at(&self, distance: f32) -> Point {
        let after = self.distances.partition_point(|d| *d < distance).clamp(1, self.line.len() - 1);
        let (from, to) = (self.distances[after - 1], self.distances[after]);
        let share = if to > from { ((distance - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        self.line[after - 1].toward(self.line[after], share)
    }

    fn part(&self, from: f32, to: f32, step: f32) -> Vec<Point> {
        let count = ((to - from) / step).ceil().max(1.0) as usize;
        // Bends shorter than a letter would rotate neighboring letters by different angles.
        let places: Vec<Point> = (0..=count).map(|k| self.at(from + (to - from) * k as f32 / count as f32)).collect();
        let reach = (count / 6).max(1);
        (0..=count)
            .map(|k| {
                let near = &places[k.saturating_sub(reach)..(k + reach + 1).min(count + 1)];
                let mean = |side: fn(&Point) -> f32| near.iter().map(side).sum::<f32>() / near.len() as f32;
                Point::new(mean(|place| place.x), mean(|place| place.y))
            })
            .collect()
    }

    /// The cost of a position for a text, from 0: for bends and for upside-down text; `None` if it bends too much to be
    /// legible.
    fn score(&self, start: f32, need: f32, style: LabelStyle) -> Option<f32> {
        let places = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| self.at(start + need * share));
        let way = places[0].to(places[4]);
        let straight = way.length() / need;
        let turns = places.windows(3).map(|three| {
            let [a, b] = [0, 1].map(|k| three[k].to(three[k + 1]).direction());
            let turn = (b - a).abs();
            turn.min(2.0 * std::f32::consts::PI - turn)
        });
        let turn = turns.fold(0.0f32, f32::max);
        if straight < style.straight || turn > style.turn {
            return None;
        }
        let tilt = (way.y / need).abs();
        let overhead = if way.x < 0.0 { 0.5 } else { 0.0 };
        Some((1.0 - straight) * 4.0 + turn + tilt * 0.35 + overhead)
    }
}

/// The lines without the parts under labels: gaps as wide as the text plus `margin`.
pub fn gaps(lines: &[Vec<Point>], labels: &[&Label], margin: f32) -> Vec<Vec<Point>> {
    if labels.is_empty() {
        return lines.to_vec();
    }
    // Labels are indexed by squares, so that each point is tested against only a few.
    let near = 12.0f32;
    let key = |place: Point| ((place.x / near).floor() as i32, (place.y / near).floor() as i32);
    let mut known: std::collections::BTreeMap<(i32, i32), Vec<(Point, f32)>> = std::collections::BTreeMap::new();
    for label in labels {
        let reach = label.size * 0.5 + margin;
        for place in &label.path {
            known.entry(key(*place)).or_default().push((*place, reach * reach));
        }
    }
    let hidden = |place: Point| {
        let (i, j) = key(place);
        (j - 1..=j + 1).flat_map(|j| (i - 1..=i + 1).map(move |i| (i, j))).any(|square| {
            known.get(&square).is_some_and(|places| places.iter().any(|(p, reach)| place.to(*p).square() < *reach))
        })
    };
    let mut left = Vec::new();
    for line in lines {
        let mut part: Vec<Point> = Vec::new();
        for place in line {
            if hidden(*place) {
                left.push(std::mem::take(&mut part));
            } else {
                part.push(*place);
            }
        }
        left.push(part);
    }
    left.retain(|part| part.len() > 1);
    left
}

#[cfg(test)]
mod tests {
    use super::super::geometry::Rect;
    use super::super::scene::line;
    use super::*;

    const SETTING: LabelStyle =
        LabelStyle { size: 2.0, spacing: 1.0, reach: 0.62, turn: 0.5, straight: 0.9, apart: 8.0, every: 60.0 };

    fn wave() -> Vec<Point> {
        (0..=400).map(|k| k as f32 * 0.25).map(|x| Point::new(x, 50.0 + 10.0 * libm::sinf(x / 12.0))).collect()
    }

    #[test]
    fn labels_lie_on_their_line_upright_and_apart() {
        for backwards in [false, true] {
            let mut line = wave();
            if backwards {
                line.reverse();
            }
            let mut taken = Taken::none(Rect::new(0.0, 0.0, 100.0, 100.0));
            let labels = place(&line, "1200", 5.0, SETTING, &mut taken, |_, _| true);
            assert_eq!(labels.len(), 2);
            for label in &labels {
                let (start, angle) = label.at(0.5);
                assert!(angle.abs() < 1.5, "{angle}");
                assert!((start.y - 50.0 - 10.0 * libm::sinf(start.x / 12.0)).abs() < 0.5, "{start:?}");
                assert!(label.path.last().unwrap().x > label.path[0].x);
            }
            // The area of the label and the area outside the page are occupied now.
            assert!(!taken.is_free(labels[0].at(2.0).0, 0.5) && !taken.is_free(Point::new(99.9, 5.0), 0.5));
            assert!(taken.is_free(Point::new(50.0, 5.0), 0.5));
            let left = gaps(&[line.clone()], &labels.iter().collect::<Vec<_>>(), 0.5);
            assert_eq!(left.len(), 3);
            let length = |lines: &[Vec<Point>]| lines.iter().map(|line| Along::new(line).length()).sum::<f32>();
            let gone = length(&[line]) - length(&left);
            assert!((gone - 2.0 * (5.0 + 2.0 + 2.0 * 1.5)).abs() < 2.5, "{gone}");
        }
    }

    #[test]
    fn no_label_where_there_is_no_room() {
        let mut taken = Taken::none(Rect::new(0.0, 0.0, 100.0, 100.0));
        taken.take_line(&line([[0.0, 50.0], [100.0, 50.0]]), 12.0);
        assert!(place(&wave(), "1200", 5.0, SETTING, &mut taken, |_, _| true).is_empty());
        let mut taken = Taken::none(Rect::new(0.0, 0.0, 100.0, 100.0));
        assert!(place(&line([[5.0, 5.0], [7.0, 5.0]]), "1200", 5.0, SETTING, &mut taken, |_, _| true).is_empty());
        // A tight coil has no straight part.
        let coil: Vec<Point> = (0..400)
            .map(|k| k as f32 * 0.1)
            .map(|a| Point::new(50.0 + 1.5 * libm::cosf(a), 50.0 + 1.5 * libm::sinf(a)))
            .collect();
        assert!(place(&coil, "1200", 5.0, SETTING, &mut taken, |_, _| true).is_empty());
        assert!(place(&[], "1", 1.0, SETTING, &mut taken, |_, _| true).is_empty());
    }
}
