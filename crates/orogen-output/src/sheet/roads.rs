//! Roads of a sheet: red with a white casing, bridges between black lines, tunnels dashed.

use super::geometry::Point;
use super::scene::Scene;
use orogen_grid::roads::RoadKind;
use orogen_io::palette::color::Rgb;

/// A part of a road.
#[derive(Debug, Clone, PartialEq)]
pub struct MapRoad {
    /// What it is.
    pub kind: RoadKind,
    /// Columns and rows of the heights of the sheet.
    pub points: Vec<[f64; 2]>,
}

const RED: Rgb = [196, 52, 40];
const CASING: Rgb = [255; 3];
const PARAPET: Rgb = [38, 36, 34];

/// Widths of the road, its casing, and the black lines of bridges, in millimetres.
const WIDTH: f32 = 0.5;
const CASED: f32 = 0.95;
const PARAPETS: f32 = 1.35;
/// Dashes of tunnels and the gaps between them, in millimetres.
const DASH: [f32; 2] = [0.9, 0.7];
/// Points nearer to each other are left out, in millimetres.
const NEAR: f32 = 0.12;

/// Distance from the middle of a road at which labels are free of it, in millimetres.
pub(super) const REACH: f32 = 0.6;

/// Draws roads on a page.
pub(super) fn draw(scene: &mut Scene, roads: &[(RoadKind, Vec<Point>)]) {
    let of = |kind: RoadKind| -> Vec<Vec<Point>> {
        roads.iter().filter(|(own, _)| *own == kind).map(|(_, line)| thinned(line)).collect()
    };
    let dashes: Vec<Vec<Point>> = of(RoadKind::Tunnel).iter().flat_map(|line| dashed(line)).collect();
    scene.lines(dashes.clone(), CASED, CASING, 0.6);
    scene.lines(dashes, WIDTH, RED, 1.0);
    let (ground, bridges) = (of(RoadKind::Road), of(RoadKind::Bridge));
    scene.lines(ground.clone(), CASED, CASING, 0.9);
    scene.lines(bridges.clone(), PARAPETS, PARAPET, 1.0);
    scene.lines(bridges.clone(), CASED, CASING, 1.0);
    scene.lines(ground.into_iter().chain(bridges).collect(), WIDTH, RED, 1.0);
}

/// The kinds among roads, with their names for the legend.
pub(super) fn kinds(roads: &[MapRoad]) -> impl Iterator<Item = (RoadKind, &'static str)> {
    let all = [(RoadKind::Road, "Road"), (RoadKind::Bridge, "Bridge"), (RoadKind::Tunnel, "Tunnel")];
    all.into_iter().filter(|(kind, _)| roads.iter().any(|road| road.kind == *kind))
}

/// A line without points that are very near to each other.
fn thinned(line: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (k, point) in line.iter().enumerate() {
        let is_far = |last: &Point| libm::hypotf(point.x - last.x, point.y - last.y) >= NEAR;
        if kept.last().is_none_or(is_far) {
            kept.push(*point);
        } else if k + 1 == line.len() && kept.len() > 1 {
            kept.pop();
            kept.push(*point);
        }
    }
    kept
}

/// The dashes along a line, at least one.
fn dashed(line: &[Point]) -> Vec<Vec<Point>> {
    let mut dashes = vec![line.first().copied().into_iter().collect::<Vec<Point>>()];
    let (mut is_dash, mut left) = (true, DASH[0]);
    for pair in line.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = libm::hypotf(to.x - from.x, to.y - from.y);
            if length <= left {
                left -= length;
                break;
            }
            let share = left / length;
            from = Point::new(from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share);
            match (is_dash, dashes.last_mut()) {
                (true, Some(dash)) => dash.push(from),
                _ => dashes.push(vec![from]),
            }
            is_dash = !is_dash;
            left = DASH[usize::from(!is_dash)];
        }
        if let (true, Some(dash)) = (is_dash, dashes.last_mut()) {
            dash.push(to);
        }
    }
    dashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_follow_the_line() {
        let line = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]].map(|[x, y]| Point::new(x, y));
        let dashes = dashed(&line);
        let ends: Vec<[f32; 4]> =
            dashes.iter().map(|dash| [dash[0], dash[dash.len() - 1]]).map(|[a, b]| [a.x, a.y, b.x, b.y]).collect();
        assert_eq!(ends.len(), 3);
        assert!(ends[0] == [0.0, 0.0, 0.9, 0.0] && (ends[1][0] - 1.6).abs() < 1e-6 && (ends[1][3] - 0.5).abs() < 1e-6);
        assert_eq!(thinned(&line), line);
        assert_eq!(thinned(&[line[0], Point::new(0.05, 0.0), line[1], Point::new(2.0, 0.01)]).len(), 2);
    }
}
