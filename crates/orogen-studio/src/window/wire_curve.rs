//! The curve of a wire of the graph: from an outlet, through its points, to an input.

use eframe::egui::epaint::CubicBezierShape;
use eframe::egui::{Color32, Pos2, Stroke, Vec2, vec2};

use crate::editing::reroutes::MAX_OFFSET;

/// Maximum length of the handles at the ends, in points.
const BEND: f32 = 120.0;

/// Number of straight lines of a piece, for its distance from a click.
const LINES: usize = 24;

/// The control points of a piece of a curve.
pub type Piece = [Pos2; 4];

/// The pieces of a curve: one more than there are points. It leaves and arrives horizontally, and has no corners.
#[must_use]
pub fn pieces(from: Pos2, points: &[Pos2], to: Pos2, zoom: f32) -> Vec<Piece> {
    if points.is_empty() {
        let bend = vec2(((to.x - from.x).abs() * 0.5).clamp(20.0 * zoom, BEND), 0.0);
        return vec![[from, from + bend, to - bend, to]];
    }
    let stops: Vec<Pos2> = [from].into_iter().chain(points.iter().copied()).chain([to]).collect();
    let inner = stops.windows(3).map(|near| direction(near[0], near[1], near[2]));
    let directions: Vec<Vec2> = [Vec2::RIGHT].into_iter().chain(inner).chain([Vec2::RIGHT]).collect();
    let last = stops.len() - 2;
    let piece = |(k, ends): (usize, &[Pos2])| {
        let length = ends[0].distance(ends[1]);
        let handle = |is_end: bool| if is_end { (length * 0.5).min(BEND) } else { length / 3.0 };
        [ends[0], ends[0] + directions[k] * handle(k == 0), ends[1] - directions[k + 1] * handle(k == last), ends[1]]
    };
    stops.windows(2).enumerate().map(piece).collect()
}

/// The direction of a curve at a point between two others. The nearer one counts for more.
fn direction(before: Pos2, at: Pos2, after: Pos2) -> Vec2 {
    let (arriving, leaving) = (at - before, after - at);
    let sum = arriving.normalized() * leaving.length() + leaving.normalized() * arriving.length();
    // A curve that turns back does so around the point.
    if sum.length() > 1e-3 { sum.normalized() } else { arriving.normalized().rot90() }
}

/// A position on a piece; `share` is from 0 to 1.
#[must_use]
pub fn sample(piece: &Piece, share: f32) -> Pos2 {
    CubicBezierShape::from_points_stroke(*piece, false, Color32::TRANSPARENT, Stroke::NONE).sample(share)
}

/// The piece of a curve that is nearest to a position, its point there, and the distance.
#[must_use]
pub fn nearest(pieces: &[Piece], at: Pos2) -> Option<(usize, Pos2, f32)> {
    let of_piece = |(k, piece): (usize, &Piece)| {
        let samples: Vec<Pos2> = (0..=LINES).map(|i| sample(piece, i as f32 / LINES as f32)).collect();
        let found = samples.windows(2).map(|ends| on_line(at, ends[0], ends[1]));
        let found = found.map(|point| (k, point, at.distance(point)));
        found.min_by(|a, b| a.2.total_cmp(&b.2))
    };
    pieces.iter().enumerate().filter_map(of_piece).min_by(|a, b| a.2.total_cmp(&b.2))
}

/// The piece of a curve with the longest way between its ends, and its middle.
#[must_use]
pub fn middle(pieces: &[Piece]) -> Option<(usize, Pos2)> {
    let length = |piece: &Piece| piece[0].distance(piece[3]);
    let longest = pieces.iter().enumerate().max_by(|a, b| length(a.1).total_cmp(&length(b.1)))?;
    Some((longest.0, sample(longest.1, 0.5)))
}

/// The point of a line that is nearest to a position.
fn on_line(at: Pos2, from: Pos2, to: Pos2) -> Pos2 {
    let along = to - from;
    from + along * ((at - from).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0)
}

/// The position of a kept point of a wire between two ends.
#[must_use]
pub fn place([share, right, down]: [f64; 3], [start, end]: [Pos2; 2]) -> Pos2 {
    start + (end - start) * share as f32 + vec2(right as f32, down as f32)
}

/// The form in which the position of a point of a wire between two ends is kept.
#[must_use]
pub fn kept(at: Pos2, [start, end]: [Pos2; 2]) -> [f64; 3] {
    let along = end - start;
    let share = ((at - start).dot(along) / along.length_sq().max(1e-6)).clamp(0.0, 1.0);
    let share = (f64::from(share) * 1e3).round() / 1e3;
    let offset = at - place([share, 0.0, 0.0], [start, end]);
    let tenth = |value: f32| ((f64::from(value) * 10.0).round() / 10.0).clamp(-MAX_OFFSET, MAX_OFFSET);
    [share, tenth(offset.x), tenth(offset.y)]
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn a_curve_goes_through_its_points_without_corners() {
        let [from, to] = [pos2(0.0, 0.0), pos2(300.0, 40.0)];
        let points = [pos2(80.0, 120.0), pos2(90.0, 130.0), pos2(260.0, -60.0)];
        let pieces = pieces(from, &points, to, 1.0);
        assert_eq!(pieces.len(), 4);
        assert_eq!((pieces[0][0], pieces[3][3]), (from, to));
        for (k, pair) in pieces.windows(2).enumerate() {
            assert_eq!((pair[0][3], pair[1][0]), (points[k], points[k]));
            let [arriving, leaving] = [points[k] - pair[0][2], pair[1][1] - points[k]].map(Vec2::normalized);
            assert!(arriving.dot(leaving) > 0.999, "{k}: {arriving:?} {leaving:?}");
        }
        assert!(pieces[0][1].y == from.y && pieces[3][2].y == to.y, "its ends are level");
        // Each point lies on the piece before it or after it.
        for (k, point) in points.iter().enumerate() {
            let (piece, on, distance) = nearest(&pieces, *point).unwrap();
            assert!(distance < 0.01 && on.distance(*point) < 0.01 && (k..=k + 1).contains(&piece));
        }
    }

    #[test]
    fn points_at_one_place_and_ways_back_are_curves_too() {
        let at = pos2(10.0, 10.0);
        for points in [vec![at, at], vec![pos2(60.0, 10.0)], vec![pos2(60.0, 10.0), at, pos2(60.0, 10.0)]] {
            let pieces = pieces(at, &points, at, 0.2);
            assert!(pieces.iter().flatten().all(|point| point.is_finite()), "{pieces:?}");
            assert!(nearest(&pieces, at).is_some() && middle(&pieces).is_some());
        }
    }

    #[test]
    fn a_kept_point_is_where_it_was_and_moves_with_both_ends() {
        let ends = [pos2(10.0, 20.0), pos2(200.0, -30.0)];
        for at in [pos2(80.0, 90.0), pos2(-50.0, 0.0), pos2(400.0, 10.0), ends[0]] {
            let point = kept(at, ends);
            assert!(place(point, ends).distance(at) < 0.1, "{point:?}");
            let by = vec2(70.0, -12.0);
            assert!(place(point, ends.map(|end| end + by)).distance(at + by) < 0.1);
            assert!(kept(at, [at, at]) == [0.0; 3]);
        }
    }
}
