//! Clips lines and polygons at the sides of a rectangle, so that the parts in two rectangles with a common side meet in
//! the same points.
//!
//! A point on the western or northern side is inside, a point on the eastern or southern side is outside. A cut depends
//! only on the segment and the side, so the neighbor's cut has the same bits if positions are [snapped].

use super::given::snapped;
use super::joints::Path;
use super::rings::{holds, nested};
use crate::contour::line::twice_area;

/// A rectangle in columns and rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// Western, northern, eastern and southern side.
    pub sides: [f64; 4],
}

/// A part of a line within a rectangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The points of the part.
    pub points: Vec<[f64; 3]>,
    /// The indices of the line's points in this part; empty if the part only crosses the rectangle between two points.
    pub inner: std::ops::Range<usize>,
    /// Whether the part begins at a side instead of the start of the line.
    pub enters: bool,
    /// Whether the part ends at a side instead of the end of the line.
    pub leaves: bool,
}

impl Rectangle {
    /// Whether a point is inside.
    #[must_use]
    pub fn holds(&self, [x, y, _]: [f64; 3]) -> bool {
        let [west, north, east, south] = self.sides;
        west <= x && x < east && north <= y && y < south
    }

    /// For each side that `point` is beyond, the position along a segment, 0 to 1, at which the segment crosses the
    /// side.
    fn crossings(&self, a: [f64; 3], b: [f64; 3], point: [f64; 3]) -> impl Iterator<Item = (f64, usize)> {
        let [west, north, east, south] = self.sides;
        let beyond = [point[0] < west, point[1] < north, point[0] >= east, point[1] >= south];
        let sides = self.sides;
        let along = move |side: usize| {
            let c = side % 2;
            (sides[side] - a[c]) / (b[c] - a[c])
        };
        (0..4).filter(move |side| beyond[*side]).map(move |side| (along(side), side))
    }

    /// The point at which a segment crosses a side.
    fn cut(&self, a: [f64; 3], b: [f64; 3], (along, side): (f64, usize)) -> [f64; 3] {
        let [west, north, east, south] = self.sides;
        let at = |c: usize| a[c] + snapped(along * (b[c] - a[c]));
        let height = (a[2] + along * (b[2] - a[2])).clamp(a[2].min(b[2]), a[2].max(b[2]));
        match side % 2 {
            0 => [self.sides[side], at(1).clamp(north, south), height],
            _ => [at(0).clamp(west, east), self.sides[side], height],
        }
    }

    /// The crossing at which a segment that ends inside enters, or a segment that begins inside leaves.
    fn entry(&self, a: [f64; 3], b: [f64; 3]) -> Option<(f64, usize)> {
        self.crossings(a, b, a).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn exit(&self, a: [f64; 3], b: [f64; 3]) -> Option<(f64, usize)> {
        self.crossings(a, b, b).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The parts of a line within the rectangle, in the order of the line.
    #[must_use]
    pub fn pieces(&self, line: &[[f64; 3]]) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        let mut open: Option<Piece> = None;
        for (k, b) in line.iter().copied().enumerate() {
            let a = if k > 0 { line[k - 1] } else { b };
            match (open.is_some(), self.holds(b)) {
                (true, true) => {}
                (true, false) => {
                    if let (Some(mut piece), Some(exit)) = (open.take(), self.exit(a, b)) {
                        piece.push(self.cut(a, b, exit));
                        piece.leaves = true;
                        pieces.push(piece);
                    }
                }
                (false, true) => {
                    let mut piece = Piece { points: Vec::new(), inner: k..k, enters: false, leaves: false };
                    if let Some(entry) = self.entry(a, b).filter(|_| k > 0) {
                        piece.points.push(self.cut(a, b, entry));
                        piece.enters = true;
                    }
                    open = Some(piece);
                }
                (false, false) => {
                    if let (Some(entry), Some(exit)) = (self.entry(a, b), self.exit(a, b))
                        && entry.0 < exit.0
                        && (0.0..=1.0).contains(&entry.0)
                        && exit.0 <= 1.0
                    {
                        let points = vec![self.cut(a, b, entry), self.cut(a, b, exit)];
                        pieces.push(Piece { points, inner: k..k, enters: true, leaves: true });
                    }
                }
            }
            if let Some(piece) = &mut open {
                piece.push(b);
                piece.inner.end = k + 1;
            }
        }
        pieces.extend(open);
        pieces
    }

    /// The parts of a shore within the rectangle. For a ring whose first point is inside, the last part continues with
    /// the first one.
    fn arcs(&self, line: &Path) -> Vec<Piece> {
        let line: Vec<[f64; 3]> = line.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        let mut pieces = self.pieces(&line);
        let is_ring = line.len() > 3 && line.first() == line.last();
        if is_ring
            && pieces.len() > 1
            && pieces.first().is_some_and(|first| !first.enters)
            && pieces.last().is_some_and(|last| !last.leaves)
            && let Some(mut last) = pieces.pop()
        {
            let first = &mut pieces[0];
            last.points.extend_from_slice(&first.points[1..]);
            last.leaves = first.leaves;
            *first = last;
        }
        pieces
    }

    /// The parts of a line without heights within the rectangle.
    #[must_use]
    pub fn lines(&self, line: &Path) -> Vec<Path> {
        let path = |piece: Piece| piece.points.into_iter().map(|[x, y, _]| [x, y]).collect::<Path>();
        self.arcs(line).into_iter().map(path).filter(|path| path.len() > 1).collect()
    }

    /// The parts of a polygon within the rectangle: `part` is an outer ring and its holes. Rings have the polygon to
    /// their left with north up.
    #[must_use]
    pub fn polygons(&self, part: &[Path]) -> Vec<Vec<Path>> {
        let mut rings: Vec<Path> = Vec::new();
        let mut arcs: Vec<Path> = Vec::new();
        for ring in part {
            for piece in self.arcs(ring) {
                let path: Path = piece.points.iter().map(|[x, y, _]| [*x, *y]).collect();
                if piece.enters && piece.leaves { arcs.push(path) } else { rings.push(path) }
            }
        }
        let [west, north, east, south] = self.sides;
        if arcs.is_empty() {
            let around = |ring: &Path| holds(ring, [west, north]);
            if part.split_first().is_some_and(|(outer, holes)| around(outer) && !holes.iter().any(around)) {
                rings.push(vec![[west, north], [west, south], [east, south], [east, north], [west, north]]);
            }
        } else {
            rings.extend(self.linked(&arcs));
        }
        rings.retain(|ring| ring.len() > 3 && twice_area(ring) != 0.0);
        nested(rings.iter().collect())
    }

    /// Distance of a point on a side from the north-western corner, counter-clockwise with north up.
    fn around(&self, [x, y]: [f64; 2]) -> f64 {
        let [west, north, east, south] = self.sides;
        let (width, height) = (east - west, south - north);
        match () {
            () if x == west => y - north,
            () if y == south => height + x - west,
            () if x == east => height + width + south - y,
            () => 2.0 * height + width + east - x,
        }
    }

    /// Rings of arcs that enter and leave. From the end of each arc, a ring continues along the sides to the start of
    /// the next one.
    fn linked(&self, arcs: &[Path]) -> Vec<Path> {
        let [west, north, east, south] = self.sides;
        let corners = [[west, south], [east, south], [east, north], [west, north]];
        let (width, height) = (east - west, south - north);
        let whole = 2.0 * (width + height);
        let at_corner = [height, height + width, 2.0 * height + width, whole];
        let ends = |arc: &Path| arc.first().copied().zip(arc.last().copied());
        let mut starts: Vec<(f64, usize)> = (arcs.iter().enumerate())
            .filter_map(|(k, arc)| ends(arc).map(|(first, _)| (self.around(first), k)))
            .collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut used = vec![false; arcs.len()];
        let mut rings = Vec::new();
        for first in 0..arcs.len() {
            if used[first] {
                continue;
            }
            let mut ring: Path = Vec::new();
            let mut at = first;
            loop {
                used[at] = true;
                ring.extend_from_slice(&arcs[at]);
                let Some((_, last)) = ends(&arcs[at]) else { break };
                let here = self.around(last);
                let split = starts.partition_point(|(start, _)| *start < here);
                let order = starts[split..].iter().chain(&starts[..split]);
                // Starts and ends alternate along the sides, so the next start is unused or is the first one.
                let next = order.copied().find(|(_, arc)| !used[*arc] || *arc == first);
                let Some((start, next)) = next else { break };
                let there = if start < here { start + whole } else { start };
                let passed = (0..8).map(|k| (at_corner[k % 4] + if k > 3 { whole } else { 0.0 }, corners[k % 4]));
                ring.extend(passed.filter(|(at, _)| here < *at && *at < there).map(|(_, corner)| corner));
                if next == first {
                    break;
                }
                at = next;
            }
            ring.dedup();
            if ring.first() != ring.last() {
                ring.extend(ring.first().copied());
            }
            rings.push(ring);
        }
        rings
    }
}

impl Piece {
    fn push(&mut self, point: [f64; 3]) {
        if self.points.last().is_none_or(|last| last[..2] != point[..2]) {
            self.points.push(point);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::direction::hashed;

    const LEFT: Rectangle = Rectangle { sides: [-0.5, -0.5, 9.5, 9.5] };
    const RIGHT: Rectangle = Rectangle { sides: [9.5, -0.5, 19.5, 9.5] };

    /// A random walk whose points are snapped.
    fn walk(seed: i64) -> Vec<[f64; 3]> {
        let mut at = [9.0, 5.0, 0.0];
        (0..60)
            .map(|k| {
                let random = |c: i64| f64::from(hashed(seed * 100 + k, c)) / f64::from(u32::MAX) * 2.0 - 1.0;
                at = [snapped(at[0] + 2.0 * random(0)), snapped(at[1] + 2.0 * random(1)), at[2] - 1.0];
                at
            })
            .collect()
    }

    #[test]
    fn parts_of_lines_meet_in_the_same_points_and_have_the_length_of_the_whole() {
        let length = |line: &[[f64; 3]]| -> f64 {
            line.windows(2).map(|p| libm::hypot(p[1][0] - p[0][0], p[1][1] - p[0][1])).sum()
        };
        let both = Rectangle { sides: [-0.5, -0.5, 19.5, 9.5] };
        let mut met = 0;
        for seed in 0..50 {
            let line = walk(seed);
            let sum = |pieces: &[Piece]| pieces.iter().map(|piece| length(&piece.points)).sum::<f64>();
            let (left, right, whole) = (LEFT.pieces(&line), RIGHT.pieces(&line), both.pieces(&line));
            assert!((sum(&left) + sum(&right) - sum(&whole)).abs() < 1e-9, "{seed}");
            for (one, other) in [(&left, &right), (&right, &left)] {
                for piece in one.iter().filter(|piece| piece.leaves) {
                    let last = piece.points[piece.points.len() - 1];
                    if last[0] == 9.5 && last[1] > -0.5 && last[1] < 9.5 {
                        assert!(other.iter().any(|piece| piece.enters && piece.points[0] == last), "{seed}: {last:?}");
                        met += 1;
                    }
                }
            }
            for piece in left.iter().chain(&right) {
                assert!(piece.points.windows(2).all(|pair| pair[1][2] <= pair[0][2]));
                assert_eq!(
                    piece.inner.len() + usize::from(piece.enters) + usize::from(piece.leaves),
                    piece.points.len()
                );
            }
        }
        assert!(met > 50, "{met}");
    }

    #[test]
    fn parts_of_polygons_have_the_area_of_the_whole() {
        // A comb whose teeth cross the common side, with a hole in every second tooth, and a ring around everything.
        let area = |parts: &[Vec<Path>]| parts.iter().flatten().map(|ring| twice_area(ring) / 2.0).sum::<f64>();
        let mut comb: Path = vec![[1.0, 0.0], [1.0, 9.0]];
        let mut part = vec![Vec::new()];
        for k in (0..4).rev() {
            let y = 2.0 * f64::from(k);
            comb.extend([[15.0, y + 1.5], [15.0, y + 0.25], [4.0, y + 0.25]]);
            if k % 2 == 0 {
                part.push(vec![[8.0, y + 0.5], [11.0, y + 0.5], [11.0, y + 1.0], [8.0, y + 1.0], [8.0, y + 0.5]]);
            }
        }
        comb.push([1.0, 0.0]);
        part[0] = comb;
        let (left, right) = (LEFT.polygons(&part), RIGHT.polygons(&part));
        assert!(twice_area(&part[0]) > 0.0 && twice_area(&part[1]) < 0.0);
        assert!((area(&left) + area(&right) - area(&[part])).abs() < 1e-5);
        assert_eq!((left.len(), right.len()), (1, 4));
        for ring in left.iter().chain(&right).flatten() {
            assert!(ring.len() > 3 && ring.first() == ring.last());
        }
        let around = vec![vec![[-50.0, -50.0], [-50.0, 50.0], [50.0, 50.0], [50.0, -50.0], [-50.0, -50.0]]];
        assert_eq!(area(&LEFT.polygons(&around)), 100.0);
        let island = vec![[2.0, 2.0], [4.0, 2.0], [4.0, 4.0], [2.0, 4.0], [2.0, 2.0]];
        let lake = [around[0].clone(), island.clone()];
        assert_eq!(area(&LEFT.polygons(&lake)), 96.0);
        assert_eq!(area(&RIGHT.polygons(&lake)), 100.0);
        let beyond: Path = island.iter().map(|[x, y]| [x + 30.0, *y]).rev().collect();
        assert!(LEFT.polygons(&[beyond]).is_empty());
    }
}
