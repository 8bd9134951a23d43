//! A line of points, or the boundary of an area.

use super::cubic::Cubic;

/// A piece of an outline. It starts at the end of the previous piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Piece {
    /// A straight line to a point: east, south, height.
    Straight([f64; 3]),
    /// A cubic Bézier curve: two control points, and the end with its height.
    Curve([[f64; 2]; 2], [f64; 3]),
}

impl Piece {
    /// The end point of the piece.
    #[must_use]
    pub fn end(&self) -> [f64; 3] {
        match self {
            Piece::Straight(end) | Piece::Curve(_, end) => *end,
        }
    }
}

/// A line of straight pieces and curves. Coordinates are in metres: x to the east, y to the south, and a height.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// The first point.
    pub start: [f64; 3],
    /// The pieces, in order.
    pub pieces: Vec<Piece>,
    /// Whether a straight line leads from the last point to the first.
    pub closed: bool,
}

impl Outline {
    /// The line of straight pieces through points; a single point at the origin if there are none.
    #[must_use]
    pub fn of_points(points: &[[f64; 3]]) -> Outline {
        let (start, rest) = points.split_first().unwrap_or((&[0.0; 3], &[]));
        Outline { start: *start, pieces: rest.iter().map(|point| Piece::Straight(*point)).collect(), closed: false }
    }

    /// The same outline, closed.
    #[must_use]
    pub fn closed(self) -> Outline {
        Outline { closed: true, ..self }
    }

    /// The same outline in other coordinates: x and y are multiplied by a scale, then an offset is added. Heights are
    /// unchanged.
    #[must_use]
    pub fn placed(&self, scale: [f64; 2], offset: [f64; 2]) -> Outline {
        let flat = |[x, y]: [f64; 2]| [x * scale[0] + offset[0], y * scale[1] + offset[1]];
        let point = |[x, y, z]: [f64; 3]| {
            let [x, y] = flat([x, y]);
            [x, y, z]
        };
        let piece = |piece: &Piece| match *piece {
            Piece::Straight(end) => Piece::Straight(point(end)),
            Piece::Curve(control, end) => Piece::Curve(control.map(flat), point(end)),
        };
        Outline { start: point(self.start), pieces: self.pieces.iter().map(piece).collect(), closed: self.closed }
    }

    /// A smooth curve through the points: centripetal Catmull-Rom splines (Yuksel, Schaefer and Keyser 2011), which
    /// have no loops and no cusps between points. An outline that already has curves or has fewer than three different
    /// points is returned unchanged.
    #[must_use]
    pub fn smoothed(&self) -> Outline {
        if self.pieces.iter().any(|piece| matches!(piece, Piece::Curve(..))) {
            return self.clone();
        }
        let mut points = vec![self.start];
        for end in self.pieces.iter().map(Piece::end) {
            if points.last().is_some_and(|last| apart(last, &end) > 0.0) {
                points.push(end);
            }
        }
        let is_ring = points.len() > 1 && points.last().is_some_and(|last| apart(last, &self.start) == 0.0);
        let closed = self.closed || is_ring;
        if is_ring {
            points.pop();
        }
        let count = points.len();
        if count < 3 {
            return self.clone();
        }
        let at = |k: usize| points[k % count];
        let spans = if closed { count } else { count - 1 };
        let pieces = (0..spans).map(|k| {
            let (b, c) = (at(k), at(k + 1));
            // Beyond the ends of an open line, the neighbor is mirrored at the end.
            let mirrored = |end: [f64; 3], next: [f64; 3]| [0, 1, 2].map(|i| end[i] + (end[i] - next[i]));
            let a = if k > 0 || closed { at(k + count - 1) } else { mirrored(b, c) };
            let d = if k + 2 < count || closed { at(k + 2) } else { mirrored(c, b) };
            Piece::Curve([control(a, b, c), control(d, c, b)], c)
        });
        // The last curve ends at the first point, so no closing line is left to draw.
        Outline { start: self.start, pieces: pieces.collect(), closed }
    }

    /// Calls `visit` with every point after the first: the ends of straight pieces, and points on curves such that the
    /// segments between them are at most `tolerance` from the curve. A closed outline ends with its first point.
    pub fn flatten(&self, tolerance: f64, mut visit: impl FnMut([f64; 3])) {
        let mut from = self.start;
        for piece in &self.pieces {
            if let Piece::Curve([b, c], end) = *piece {
                flatten_curve(from, [b, c], end, tolerance, &mut visit);
            } else {
                visit(piece.end());
            }
            from = piece.end();
        }
        if self.closed && from != self.start {
            visit(self.start);
        }
    }

    /// Upper bound of the number of points that [`Outline::flatten`] visits.
    #[must_use]
    pub fn flattened_len(&self, tolerance: f64) -> u64 {
        let mut from = self.start;
        let mut count = 1;
        for piece in &self.pieces {
            let end = piece.end();
            count += match piece {
                Piece::Straight(_) => 1,
                Piece::Curve([b, c], _) => u64::from(Cubic([flat(from), *b, *c, flat(end)]).segments(tolerance)),
            };
            from = end;
        }
        count
    }
}

/// The heights of intermediate points are linear along the segments.
fn flatten_curve(
    from: [f64; 3],
    [b, c]: [[f64; 2]; 2],
    end: [f64; 3],
    tolerance: f64,
    visit: &mut impl FnMut([f64; 3]),
) {
    let curve = Cubic([flat(from), b, c, flat(end)]);
    let count = curve.segments(tolerance);
    let point = |k: u32| if k == count { flat(end) } else { curve.at(f64::from(k) / f64::from(count)) };
    let step = |k: u32| {
        let ([ax, ay], [bx, by]) = (point(k), point(k + 1));
        ((bx - ax) * (bx - ax) + (by - ay) * (by - ay)).sqrt()
    };
    let length: f64 = if from[2] == end[2] { 1.0 } else { (0..count).map(step).sum() };
    let mut along = 0.0;
    for k in 1..count {
        let [x, y] = point(k);
        let z = if from[2] == end[2] || length == 0.0 {
            end[2]
        } else {
            along += step(k - 1);
            from[2] + (end[2] - from[2]) * (along / length)
        };
        visit([x, y, z]);
    }
    visit(end);
}

fn flat([x, y, _]: [f64; 3]) -> [f64; 2] {
    [x, y]
}

fn apart(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let (x, y) = (a[0] - b[0], a[1] - b[1]);
    (x * x + y * y).sqrt()
}

/// The control point after `b` of the spline from `b` to `c`, where `a` is the point before `b`.
fn control(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> [f64; 2] {
    let (before, after) = (apart(&a, &b), apart(&b, &c));
    // Centripetal: the knot intervals are the square roots of the distances.
    let (p, q) = (before.sqrt(), after.sqrt());
    let scale = 3.0 * p * (p + q);
    // Relative to `b`, so that positions far from the origin do not lose precision.
    [0, 1].map(|k| match scale > 0.0 {
        true => b[k] + (before * (c[k] - b[k]) - after * (a[k] - b[k])) / scale,
        false => b[k],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points_of(outline: &Outline, tolerance: f64) -> Vec<[f64; 3]> {
        let mut points = vec![outline.start];
        outline.flatten(tolerance, |point| points.push(point));
        points
    }

    #[test]
    fn straight_lines_keep_their_points() {
        let points = [[0.0, 0.0, 1.0], [10.0, 0.0, 2.0], [10.0, 10.0, 3.0]];
        let line = Outline::of_points(&points);
        assert_eq!(points_of(&line, 1.0), points);
        let ring = line.closed();
        assert_eq!(points_of(&ring, 1.0), [points[0], points[1], points[2], points[0]]);
        assert_eq!(ring.flattened_len(1.0), 3);
        assert!(points_of(&Outline::of_points(&[]), 1.0).len() == 1);
        assert_eq!(Outline::of_points(&points[..2]).smoothed(), Outline::of_points(&points[..2]));
    }

    #[test]
    fn a_smooth_line_passes_through_its_points_without_a_corner() {
        let points = [[0.0, 0.0, 0.0], [10.0, 30.0, 5.0], [11.0, 31.0, 6.0], [200.0, 0.0, 6.0], [200.0, 90.0, -3.0]];
        for closed in [false, true] {
            for offset in [0.0, 1e6] {
                let moved = points.map(|[x, y, z]| [x + offset, y - offset, z]);
                let line = Outline { closed, ..Outline::of_points(&moved) };
                let flat = points_of(&line.smoothed(), 1e-4);
                let mut places = moved.iter().map(|point| flat.iter().position(|other| other == point).unwrap());
                assert!(places.clone().is_sorted(), "{:?}", places.collect::<Vec<_>>());
                assert!(places.all(|place| place < flat.len()));
                for three in flat.windows(3) {
                    let [[ax, ay], [bx, by]] = [0, 1].map(|i| [0, 1].map(|k| three[i + 1][k] - three[i][k]));
                    let cosine = (ax * bx + ay * by) / (libm::hypot(ax, ay) * libm::hypot(bx, by));
                    assert!(cosine > 0.98, "{cosine} at {three:?}");
                }
                let heights = flat.iter().map(|point| point[2]);
                assert!(heights.fold(0.0f64, f64::max) <= 6.0, "heights do not overshoot");
                assert_eq!(closed, flat.last() == flat.first());
            }
        }
    }

    #[test]
    fn the_control_points_are_those_of_the_papers_knots() {
        // Barry and Goldman's pyramid, with square roots of distances as knot intervals.
        let points = [[0.0, 0.0, 0.0], [1.0, 3.0, 0.0], [7.0, 4.0, 0.0], [8.0, 0.0, 0.0]];
        let mut knots = [0.0; 4];
        for k in 1..4 {
            knots[k] = knots[k - 1] + apart(&points[k - 1], &points[k]).sqrt();
        }
        let spline = |share: f64| {
            let t = knots[1] + (knots[2] - knots[1]) * share;
            let mix = |a: [f64; 2], b: [f64; 2], from: f64, to: f64| {
                [0, 1].map(|k| (a[k] * (to - t) + b[k] * (t - from)) / (to - from))
            };
            let first: Vec<[f64; 2]> =
                (0..3).map(|k| mix(flat(points[k]), flat(points[k + 1]), knots[k], knots[k + 1])).collect();
            let second: Vec<[f64; 2]> = (0..2).map(|k| mix(first[k], first[k + 1], knots[k], knots[k + 2])).collect();
            mix(second[0], second[1], knots[1], knots[2])
        };
        let Piece::Curve([b, c], end) = Outline::of_points(&points).smoothed().pieces[1] else { panic!("a curve") };
        let curve = Cubic([flat(points[1]), b, c, flat(end)]);
        for k in 0..=10 {
            let share = f64::from(k) / 10.0;
            let (a, b) = (curve.at(share), spline(share));
            assert!((a[0] - b[0]).abs() < 1e-12 && (a[1] - b[1]).abs() < 1e-12, "{a:?} {b:?}");
        }
    }

    #[test]
    fn points_that_coincide_do_no_harm() {
        let p = [5.0, 5.0, 1.0];
        for points in [vec![p; 5], vec![p, p, [6.0, 5.0, 1.0], [6.0, 5.0, 1.0], [9.0, 9.0, 1.0], p]] {
            for closed in [false, true] {
                let line = Outline { closed, ..Outline::of_points(&points) };
                let flat = points_of(&line.smoothed(), 0.01);
                assert!(flat.iter().flatten().all(|number| number.is_finite()), "{flat:?}");
                assert_eq!(flat.last(), Some(&p));
            }
        }
    }
}
