//! Buffers in the sense of geographic information systems: all points within a distance of a line. Finds the buffers
//! that contain a position.

use super::outline::Outline;
use super::segments::{Segments, TRIALS, trials};

/// Number of lines that a search collects at once.
const BATCH: usize = 16;

/// Number of batches after which the search visits lines in their order instead.
const MAX_BATCHES: usize = 4;

/// Number of boxes that a box of the next level contains, in the order of lines.
const GROUP: usize = 16;

/// The points within a distance of a line, for many lines, in a tree of boxes.
///
/// A search visits only boxes and segments near the position, so its time hardly depends on the number of lines far
/// away. It finds lines in their order, independent of the tree, and does not allocate memory.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Buffers {
    /// The distance around each line.
    radii: Vec<f64>,
    /// The segments of all lines, a tree for each.
    segments: Segments,
    /// The lines that have points, in their order.
    lines: Vec<Line>,
    nodes: Vec<Node>,
    /// The boxes of the lines in their order, then boxes around groups of these, and so on.
    ordered: Vec<Vec<Bounds>>,
    /// See [`Buffers::visits`].
    visits: f64,
}

/// A line that has points.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    /// Its index among all lines that were given.
    index: u32,
    /// The root of the tree of its segments.
    root: u32,
}

/// A box: its minimum and maximum coordinates.
type Bounds = [[f64; 2]; 2];

fn contains([low, high]: &Bounds, at: [f64; 2]) -> bool {
    (0..2).all(|k| low[k] <= at[k] && at[k] <= high[k])
}

fn union([low, high]: Bounds, [other_low, other_high]: Bounds) -> Bounds {
    [[0, 1].map(|k| low[k].min(other_low[k])), [0, 1].map(|k| high[k].max(other_high[k]))]
}

/// A box around lines, including the distances around them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    bounds: Bounds,
    /// The first and the last line in the box.
    lines: [u32; 2],
    /// The index of the second child; the first child follows this node. `None` for a single line.
    second: Option<u32>,
}

/// The first lines that a search finds, beginning with line `from`, in their order.
struct Batch {
    from: u32,
    lines: [u32; BATCH],
    count: usize,
}

impl Batch {
    /// Whether a node may contain lines that belong to the batch.
    fn wants(&self, node: &Node) -> bool {
        let [first, last] = node.lines;
        last >= self.from && (self.count < BATCH || first < self.lines[BATCH - 1])
    }

    fn insert(&mut self, line: u32) {
        let place = self.lines[..self.count].partition_point(|other| *other < line);
        if place < BATCH {
            self.count = (self.count + 1).min(BATCH);
            self.lines[place..self.count].rotate_right(1);
            self.lines[place] = line;
        }
    }
}

impl Buffers {
    /// The buffers of lines, given as the points of each line and the distance around it. A line of one point is a
    /// disc. Lines with a coordinate or a distance that is not finite contain nothing.
    #[must_use]
    pub fn new<'a>(lines: impl IntoIterator<Item = (&'a [[f64; 2]], f64)>) -> Buffers {
        let mut made = Buffers::default();
        let mut boxes: Vec<Bounds> = Vec::new();
        for (index, (points, radius)) in lines.into_iter().enumerate() {
            made.radii.push(radius);
            let is_valid = radius >= 0.0 && radius.is_finite() && points.iter().flatten().all(|part| part.is_finite());
            if !is_valid || points.is_empty() {
                continue;
            }
            let points: Vec<[f64; 3]> = points.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
            if let Some((root, [low, high])) = made.segments.add_line(&Outline::of_points(&points)) {
                made.lines.push(Line { index: index as u32, root: root as u32 });
                boxes.push([low.map(|part| part - radius), high.map(|part| part + radius)]);
            }
        }
        let mut order: Vec<u32> = (0..made.lines.len() as u32).collect();
        if !order.is_empty() {
            made.group(&mut order, &boxes);
        }
        while boxes.len() > 1 {
            let next = boxes.chunks(GROUP).filter_map(|group| group.iter().copied().reduce(union)).collect();
            made.ordered.push(std::mem::replace(&mut boxes, next));
        }
        if let Some(root) = made.nodes.first() {
            let mut visited = 0;
            trials(root.bounds).for_each(|at| made.visit_counted(at, |_, _| {}, &mut visited));
            made.visits = visited as f64 / TRIALS as f64;
        }
        made
    }

    /// The mean number of boxes and segments that a search visits, at some trial positions: a measure of its time.
    #[must_use]
    pub fn visits(&self) -> f64 {
        self.visits
    }

    /// Builds the tree over lines: divides them in halves by the centers of their boxes along the longer side.
    fn group(&mut self, lines: &mut [u32], boxes: &[Bounds]) -> Node {
        let at = self.nodes.len();
        if let [line] = *lines {
            let node = Node { bounds: boxes[line as usize], lines: [line; 2], second: None };
            self.nodes.push(node);
            return node;
        }
        let middle = |line: u32, k: usize| {
            let [low, high] = boxes[line as usize];
            0.5 * low[k] + 0.5 * high[k]
        };
        let side = |k: usize| {
            let along = || lines.iter().map(|line| middle(*line, k));
            along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)
        };
        let axis = usize::from(side(1) > side(0));
        lines.sort_by(|a, b| middle(*a, axis).total_cmp(&middle(*b, axis)).then(a.cmp(b)));
        let (left, right) = lines.split_at_mut(lines.len() / 2);
        // A node comes before its children.
        self.nodes.push(Node { bounds: [[0.0; 2]; 2], lines: [0; 2], second: None });
        let left = self.group(left, boxes);
        let second = self.nodes.len() as u32;
        let right = self.group(right, boxes);
        let node = Node {
            bounds: union(left.bounds, right.bounds),
            lines: [left.lines[0].min(right.lines[0]), left.lines[1].max(right.lines[1])],
            second: Some(second),
        };
        self.nodes[at] = node;
        node
    }

    /// Calls `visit` for each line whose buffer contains the position, in the order of lines, with the line's index and
    /// the distance to the line.
    pub fn visit(&self, at: [f64; 2], visit: impl FnMut(usize, f64)) {
        self.visit_counted(at, visit, &mut 0);
    }

    /// Like [`Buffers::visit`]; adds the number of visited boxes and segments to `visited`.
    fn visit_counted(&self, at: [f64; 2], mut visit: impl FnMut(usize, f64), visited: &mut usize) {
        if self.nodes.is_empty() {
            return;
        }
        let mut found = |line: u32, visited: &mut usize| {
            let Line { index, root } = self.lines[line as usize];
            let radius = self.radii[index as usize];
            // Rounding must not exclude points exactly at the radius.
            let within = radius * radius * (1.0 + 4.0 * f64::EPSILON);
            let square = self.segments.square_to(root as usize, at, within, visited);
            if let Some(distance) = square.map(f64::sqrt).filter(|distance| *distance <= radius) {
                visit(index as usize, distance);
            }
        };
        let mut batch = Batch { from: 0, lines: [0; BATCH], count: 0 };
        for _ in 0..MAX_BATCHES {
            self.search(0, at, &mut batch, visited);
            batch.lines[..batch.count].iter().for_each(|line| found(*line, visited));
            if batch.count < BATCH {
                return;
            }
            batch = Batch { from: batch.lines[BATCH - 1] + 1, count: 0, ..batch };
        }
        // With so many lines, a search batch by batch would visit most boxes many times.
        let top = self.ordered.len().saturating_sub(1);
        let boxes = self.ordered.get(top).map_or(0, Vec::len);
        (0..boxes).for_each(|k| self.in_order((top, k), at, batch.from, visited, &mut found));
    }

    /// Calls `found` for the lines under a box of the level `level` of `ordered` whose own boxes contain a position,
    /// beginning with line `from`.
    fn in_order(
        &self,
        (level, k): (usize, usize),
        at: [f64; 2],
        from: u32,
        visited: &mut usize,
        found: &mut impl FnMut(u32, &mut usize),
    ) {
        *visited += 1;
        if !contains(&self.ordered[level][k], at) {
            return;
        }
        if level == 0 {
            if k as u32 >= from {
                found(k as u32, visited);
            }
            return;
        }
        let below = k * GROUP..((k + 1) * GROUP).min(self.ordered[level - 1].len());
        below.for_each(|k| self.in_order((level - 1, k), at, from, visited, found));
    }

    fn search(&self, node: usize, at: [f64; 2], batch: &mut Batch, visited: &mut usize) {
        let found = &self.nodes[node];
        *visited += 1;
        if !(batch.wants(found) && contains(&found.bounds, at)) {
            return;
        }
        match found.second {
            Some(second) => {
                self.search(node + 1, at, batch, visited);
                self.search(second as usize, at, batch, visited);
            }
            None => batch.insert(found.lines[0]),
        }
    }

    /// Memory of the buffers, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let ordered: usize = self.ordered.iter().map(|level| size_of_val(level.as_slice())).sum();
        let bytes = size_of_val(&*self.radii) + size_of_val(&*self.lines) + size_of_val(&*self.nodes) + ordered;
        bytes as u64 + self.segments.memory()
    }
}

#[cfg(test)]
mod tests {
    use super::super::segments::distance;
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
        let lines = random(2500);
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
        assert!(most > BATCH * MAX_BATCHES, "{most} lines at a position: a search goes on in the order of lines");
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

    #[test]
    fn many_points_and_many_lines_at_a_position_are_looked_at_once() {
        // A zigzag line whose segments all lie within the distance, and as many discs.
        let fro: Vec<[f64; 2]> = (0..20_000).map(|k| [0.05 * f64::from(k), f64::from(k % 2) * 600.0]).collect();
        let line = Buffers::new([(fro.as_slice(), 2000.0)]);
        let (mut visited, mut distances) = (0, Vec::new());
        line.visit_counted([500.0, -30.0], |_, distance| distances.push(distance), &mut visited);
        assert!(distances.len() == 1 && (distances[0] - 30.0).abs() < 1e-3 && visited < 100, "{distances:?} {visited}");
        let discs = Buffers::new(fro.iter().map(|point| (std::slice::from_ref(point), 2000.0)));
        let (mut visited, mut found) = (0, Vec::new());
        discs.visit_counted([500.0, -30.0], |line, _| found.push(line), &mut visited);
        assert_eq!(found, (0..fro.len()).collect::<Vec<_>>());
        assert!(visited < 10 * fro.len(), "{visited}");
    }
}
