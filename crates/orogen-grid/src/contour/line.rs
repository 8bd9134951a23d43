//! A contour line.

use serde::{Deserialize, Serialize};

/// A contour line.
///
/// With north up, higher ground is to the left in the direction of the line: rings are counter-clockwise around summits
/// and clockwise around hollows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The height of the line, in metres.
    pub elevation: f64,
    /// The index of its level among the requested levels, from 0.
    pub level: usize,
    /// Whether the line is a ring. The first point of a ring is not repeated as the last.
    pub closed: bool,
    /// Metres east and south of the world's origin.
    pub points: Vec<[f64; 2]>,
}

impl Line {
    /// The points of the line; a ring repeats the first one at the end.
    pub fn path(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let first = self.points.first().filter(|_| self.closed);
        self.points.iter().chain(first).copied()
    }

    /// The length, in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        let ends = self.path().zip(self.path().skip(1));
        ends.map(|([ax, ay], [bx, by])| ((bx - ax) * (bx - ax) + (by - ay) * (by - ay)).sqrt()).sum()
    }

    /// The area within a ring in square metres, positive if it encloses higher ground; 0 for an open line.
    #[must_use]
    pub fn area(&self) -> f64 {
        match self.closed {
            true => twice_area(&self.points) / 2.0,
            false => 0.0,
        }
    }
}

/// Twice the area within a ring, given by eastings and southings; positive if it is counter-clockwise with north up.
#[must_use]
pub fn twice_area(points: &[[f64; 2]]) -> f64 {
    let Some(&[x0, y0]) = points.first() else { return 0.0 };
    // Relative to the first point, because far from the origin rounding of products of coordinates would exceed the
    // area.
    let turns = points.windows(2).map(|pair| {
        let ([ax, ay], [bx, by]) = (pair[0], pair[1]);
        (ay - y0) * (bx - x0) - (ax - x0) * (by - y0)
    });
    turns.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_is_closed_and_has_an_area() {
        let far = 1e7;
        // West, south, east, north: counter-clockwise on a map.
        let square = [[0.0, 0.0], [0.0, 2.0], [3.0, 2.0], [3.0, 0.0]].map(|[x, y]| [x + far, y + far]);
        let ring = Line { elevation: 0.0, level: 0, closed: true, points: square.to_vec() };
        assert_eq!((ring.area(), ring.length(), ring.path().count()), (6.0, 10.0, 5));
        let open = Line { closed: false, ..ring.clone() };
        assert_eq!((open.area(), open.length(), open.path().count()), (0.0, 7.0, 4));
        let back = Line { points: square.iter().rev().copied().collect(), ..ring };
        assert_eq!(back.area(), -6.0);
    }
}
