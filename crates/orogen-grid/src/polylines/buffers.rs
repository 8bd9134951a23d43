//! Lines with a distance around each, as buffers of geographic information systems: which of them contain a position.

use super::segments::distance;

/// Number of segments of a piece.
const PIECE: usize = 4;

/// Number of pieces that a search finds at once.
const BATCH: usize = 16;

/// The points within a distance of a line, for many lines, in a tree of boxes.
///
/// A search visits the boxes around a position and few others, so it takes as long with many lines far away as without them. It finds lines in their
/// order, whatever the tree is, and allocates nothing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Buffers {
    /// The distance around each line.
    radii: Vec<f64>,
    /// Start and end of each segment.
    segments: Vec<[[f64; 2]; 2]>,
    /// In the order of lines.
    pieces: Vec<Piece>,
    nodes: Vec<Node>,
}

/// Segments of a line that follow each other.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    line: u32,
    first: u32,
    count: u32,
}

/// A box around pieces, with the distance around their lines.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    low: [f64; 2],
    high: [f64; 2],
    /// The first and the last piece in it.
    pieces: [u32; 2],
    /// The second of two nodes, of which the first follows this one; `None` for a single piece.
    second: Option<u32>,
}

impl Node {
    fn contains(&self, at: [f64; 2]) -> bool {
        (0..2).all(|k| self.low[k] <= at[k] && at[k] <= self.high[k])
    }
}

/// The first pieces of those that a search finds, from `from` on, in their order.
struct Batch {
    from: u32,
    pieces: [u32; BATCH],
    count: usize,
}

impl Batch {
    /// Whether a node may have pieces that belong to it.
    fn wants(&self, node: &Node) -> bool {
        let [first, last] = node.pieces;
        last >= self.from && (self.count < BATCH || first < self.pieces[BATCH - 1])
    }

    fn insert(&mut self, piece: u32) {
        let place = self.pieces[..self.count].partition_point(|other| *other < piece);
        if place < BATCH {
            self.count = (self.count + 1).min(BATCH);
            self.pieces[place..self.count].rotate_right(1);
            self.pieces[place] = piece;
        }
    }
}

impl Buffers {
    /// The buffers of lines: the points of each, and the distance around it. A line of one point is a disc. Lines with a coordinate or a distance that
    /// is not finite contain nothing.
    #[must_use]
    pub fn new<'a>(lines: impl IntoIterator<Item = (&'a [[f64; 2]], f64)>) -> Buffers {
        let mut made = Buffers::default();
        let mut boxes = Vec::new();
        for (line, (points, radius)) in lines.into_iter().enumerate() {
            made.radii.push(radius);
            let is_valid = radius >= 0.0 && radius.is_finite() && points.iter().flatten().all(|part| part.is_finite());
            if is_valid {
                made.add(line as u32, points, radius, &mut boxes);
            }
        }
        let mut order: Vec<u32> = (0..made.pieces.len() as u32).collect();
        if !order.is_empty() {
            made.group(&mut order, &boxes);
        }
        made
    }

    fn add(&mut self, line: u32, points: &[[f64; 2]], radius: f64, boxes: &mut Vec<[[f64; 2]; 2]>) {
        let start = self.segments.len();
        self.segments.extend(points.windows(2).map(|pair| [pair[0], pair[1]]).filter(|[a, b]| a != b));
        // A line whose points coincide is a point.
        if self.segments.len() == start {
            self.segments.extend(points.first().map(|point| [*point, *point]));
        }
        for first in (start..self.segments.len()).step_by(PIECE) {
            let count = PIECE.min(self.segments.len() - first);
            let ends = || self.segments[first..first + count].iter().flatten();
            let low = [0, 1].map(|k| ends().map(|end| end[k]).fold(f64::MAX, f64::min) - radius);
            let high = [0, 1].map(|k| ends().map(|end| end[k]).fold(f64::MIN, f64::max) + radius);
            self.pieces.push(Piece { line, first: first as u32, count: count as u32 });
            boxes.push([low, high]);
        }
    }

    /// The tree over pieces: halves by the middles of their boxes along the longer side.
    fn group(&mut self, pieces: &mut [u32], boxes: &[[[f64; 2]; 2]]) -> Node {
        let at = self.nodes.len();
        if let [piece] = *pieces {
            let [low, high] = boxes[piece as usize];
            let node = Node { low, high, pieces: [piece; 2], second: None };
            self.nodes.push(node);
            return node;
        }
        let middle = |piece: u32, k: usize| {
            let [low, high] = boxes[piece as usize];
            0.5 * low[k] + 0.5 * high[k]
        };
        let side = |k: usize| {
            let along = || pieces.iter().map(|piece| middle(*piece, k));
            along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)
        };
        let axis = usize::from(side(1) > side(0));
        pieces.sort_by(|a, b| middle(*a, axis).total_cmp(&middle(*b, axis)).then(a.cmp(b)));
        let (left, right) = pieces.split_at_mut(pieces.len() / 2);
        // Its place is before those of its halves.
        self.nodes.push(Node { low: [0.0; 2], high: [0.0; 2], pieces: [0; 2], second: None });
        let left = self.group(left, boxes);
        let second = self.nodes.len() as u32;
        let right = self.group(right, boxes);
        let node = Node {
            low: [0, 1].map(|k| left.low[k].min(right.low[k])),
            high: [0, 1].map(|k| left.high[k].max(right.high[k])),
            pieces: [left.pieces[0].min(right.pieces[0]), left.pieces[1].max(right.pieces[1])],
            second: Some(second),
        };
        self.nodes[at] = node;
        node
    }

    /// Calls `visit` with the index of each line whose buffer contains a position, and the distance from the line, in the order of lines.
    pub fn visit(&self, at: [f64; 2], visit: impl FnMut(usize, f64)) {
        self.visit_counted(at, visit, &mut 0);
    }

    /// The same; adds the number of boxes and segments looked at to `visited`.
    fn visit_counted(&self, at: [f64; 2], mut visit: impl FnMut(usize, f64), visited: &mut usize) {
        if self.nodes.is_empty() {
            return;
        }
        let mut report = |nearest: Option<(u32, f64)>| {
            if let Some((line, square)) = nearest {
                let (line, distance) = (line as usize, square.sqrt());
                if distance <= self.radii[line] {
                    visit(line, distance);
                }
            }
        };
        // The line whose pieces are being looked at, and the square of the distance from it.
        let mut nearest = None;
        let mut batch = Batch { from: 0, pieces: [0; BATCH], count: 0 };
        loop {
            self.search(0, at, &mut batch, visited);
            for piece in &batch.pieces[..batch.count] {
                let Piece { line, first, count } = self.pieces[*piece as usize];
                *visited += count as usize;
                let segments = &self.segments[first as usize..(first + count) as usize];
                let square = segments.iter().map(|ends| distance(*ends, at).0).fold(f64::INFINITY, f64::min);
                nearest = match nearest {
                    Some((own, least)) if own == line => Some((line, square.min(least))),
                    before => {
                        report(before);
                        Some((line, square))
                    }
                };
            }
            if batch.count < BATCH {
                return report(nearest);
            }
            batch = Batch { from: batch.pieces[BATCH - 1] + 1, count: 0, ..batch };
        }
    }

    fn search(&self, node: usize, at: [f64; 2], batch: &mut Batch, visited: &mut usize) {
        let found = &self.nodes[node];
        *visited += 1;
        if !(batch.wants(found) && found.contains(at)) {
            return;
        }
        match found.second {
            Some(second) => {
                self.search(node + 1, at, batch, visited);
                self.search(second as usize, at, batch, visited);
            }
            None => batch.insert(found.pieces[0]),
        }
    }

    /// Memory that they take, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let bytes = size_of_val(&*self.radii)
            + size_of_val(&*self.segments)
            + size_of_val(&*self.pieces)
            + size_of_val(&*self.nodes);
        bytes as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn found(buffers: &Buffers, at: [f64; 2]) -> Vec<(usize, f64)> {
        let mut found = Vec::new();
        buffers.visit(at, |line, distance| found.push((line, distance)));
        found
    }

    #[test]
    fn a_point_is_a_disc_and_lines_come_in_their_order() {
        let lines: [(&[[f64; 2]], f64); 4] = [
            (&[[0.0, 0.0], [100.0, 0.0]], 10.0),
            (&[[50.0, 0.0]], 5.0),
            (&[[50.0, 8.0], [50.0, 8.0]], 8.0),
            (&[[f64::NAN, 0.0]], 1e9),
        ];
        let buffers = Buffers::new(lines);
        assert_eq!(found(&buffers, [50.0, 4.0]), [(0, 4.0), (1, 4.0), (2, 4.0)]);
        assert_eq!(found(&buffers, [50.0, 5.0]), [(0, 5.0), (1, 5.0), (2, 3.0)]);
        assert_eq!(found(&buffers, [50.0, 9.0]), [(0, 9.0), (2, 1.0)]);
        assert_eq!(found(&buffers, [106.0, 8.0]), [(0, 10.0)]);
        assert_eq!(found(&buffers, [106.0, 8.1]), []);
        assert_eq!(found(&buffers, [f64::NAN, 0.0]), []);
        assert_eq!(found(&Buffers::default(), [0.0, 0.0]), []);
        assert_eq!(found(&Buffers::new([(&[][..], 1.0)]), [0.0, 0.0]), []);
        assert!(buffers.memory() > 100);
    }

    /// Random lines, each a walk of up to 40 points, in a square of 1000 m.
    fn random(count: usize) -> Vec<(Vec<[f64; 2]>, f64)> {
        let mut random = Random::new(7, 0);
        let mut next = |range: f64| range * random.share();
        let mut line = || {
            let mut at = [next(1000.0), next(1000.0)];
            let points = (0..1 + next(40.0) as usize).map(|_| {
                at = at.map(|part| part + next(60.0) - 30.0);
                at
            });
            let points: Vec<[f64; 2]> = points.collect();
            (points, next(80.0))
        };
        (0..count).map(|_| line()).collect()
    }

    #[test]
    fn the_tree_finds_what_a_look_at_every_segment_finds() {
        let lines = random(300);
        let buffers = Buffers::new(lines.iter().map(|(points, radius)| (points.as_slice(), *radius)));
        let mut most = 0;
        for k in 0..400 {
            let at = [f64::from(k % 20) * 55.3 - 30.0, f64::from(k / 20) * 55.3 - 30.0];
            let nearest = |points: &[[f64; 2]]| {
                let ends = |k: usize| [points[k], points[(k + 1).min(points.len() - 1)]];
                (0..points.len()).map(|k| distance(ends(k), at).0).fold(f64::INFINITY, f64::min).sqrt()
            };
            let expect: Vec<(usize, f64)> = lines
                .iter()
                .enumerate()
                .map(|(line, (points, radius))| (line, nearest(points), radius))
                .filter(|(_, distance, radius)| distance <= radius)
                .map(|(line, distance, _)| (line, distance))
                .collect();
            assert_eq!(found(&buffers, at), expect, "{at:?}");
            most = most.max(expect.len());
        }
        assert!(most > BATCH, "{most} lines at a position: a search has several batches");
    }

    #[test]
    fn lines_far_away_cost_nothing() {
        let near = (vec![[0.0, 0.0], [30.0, 10.0]], 20.0);
        let cost = |far: usize| {
            let lines = random(far)
                .into_iter()
                .map(|(points, radius)| (points.into_iter().map(|[x, y]| [x + 5000.0, y]).collect(), radius));
            let lines: Vec<(Vec<[f64; 2]>, f64)> = [near.clone()].into_iter().chain(lines).collect();
            let buffers = Buffers::new(lines.iter().map(|(points, radius)| (points.as_slice(), *radius)));
            let (mut visited, mut count) = (0, 0);
            buffers.visit_counted([10.0, 5.0], |_, _| count += 1, &mut visited);
            assert_eq!(count, 1);
            (visited, buffers.segments.len())
        };
        let ((alone, _), (among, segments)) = (cost(0), cost(2000));
        assert_eq!(alone, 2, "a box and a segment");
        assert!(among <= 2 * 17 && segments > 30_000, "{among} visits of {segments} segments");
    }
}
