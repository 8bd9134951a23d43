//! The straight segments of a drawing, in a tree of boxes.

use super::outline::Outline;

/// Maximum number of segments of a drawing. Curves that would have more are flattened at a larger tolerance.
pub const MAX_SEGMENTS: usize = 1 << 20;

/// Number of segments of a leaf of the tree.
const LEAF: usize = 4;

/// Minimum number of segments of a box that may have an additional slanted box.
const SLANTED: usize = 4 * LEAF;

/// A straight segment of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    /// Start and end: east, south, height.
    ends: [[f64; 3]; 2],
    /// The distance along the line from its start to the start of the segment.
    chainage: f64,
    length: f64,
    line: u32,
}

impl Segment {
    /// The ends without their heights.
    fn flat(&self) -> [[f64; 2]; 2] {
        self.ends.map(|[x, y, _]| [x, y])
    }
}

/// A box around consecutive segments or around whole lines.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    low: [f64; 2],
    high: [f64; 2],
    /// y of the first and the last point of consecutive segments; equal for whole rings.
    ends: [f64; 2],
    content: Content,
    /// The index of the slanted box; [`NONE`] if it would not be much smaller.
    slanted: u32,
}

/// The index that stands for no slanted box.
const NONE: u32 = u32::MAX;

/// A box that is turned to the direction of its segments. Long parallel segments, such as those of a zigzag line, have
/// axis-aligned boxes that all overlap, so that a search would visit all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Slanted {
    /// A unit vector along the box.
    along: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
    /// The largest coordinate, for the bound of rounding errors.
    largest: f64,
    /// The first and the last point of consecutive segments; equal for whole rings.
    ends: [[f64; 2]; 2],
}

impl Slanted {
    /// A position in the axes of the box: along it and across it.
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [u, v] = self.along;
        [x * u + y * v, y * u - x * v]
    }

    /// A lower bound of the square of the distance from a position to the box; 0 inside it.
    fn square_to(&self, at: [f64; 2]) -> f64 {
        let turned = self.turned(at);
        let rounding = 4.0 * f64::EPSILON * (self.largest + at[0].abs() + at[1].abs());
        let [x, y] = [0, 1].map(|k| ((self.low[k] - turned[k]).max(turned[k] - self.high[k]) - rounding).max(0.0));
        x * x + y * y
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Content {
    /// Segments: the index of the first one, and their number.
    Leaf(u32, u32),
    /// Two child nodes: the next node, and the one with this index.
    Pair(u32),
}

/// The segments of lines, in a tree of boxes. A search visits only boxes near the position, so its time hardly depends
/// on the number of segments far away.
///
/// The results depend only on the position and the segments. Of several segments at the same distance, the first counts
/// as the nearest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Segments {
    segments: Vec<Segment>,
    /// The length of each line.
    lengths: Vec<f64>,
    nodes: Vec<Node>,
    slanted: Vec<Slanted>,
    /// See [`Segments::visits`].
    visits: f64,
}

/// The point of a drawing that is nearest to a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    segment: Segment,
    /// The position on the segment, 0 at its start and 1 at its end.
    share: f64,
    square: f64,
    line_length: f64,
}

impl Nearest {
    /// The distance, in metres.
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.square.sqrt()
    }

    /// The height at the point, which is linear along a segment.
    #[must_use]
    pub fn height(&self) -> f64 {
        let [from, to] = self.segment.ends.map(|end| end[2]);
        if self.share >= 1.0 { to } else { from + (to - from) * self.share }
    }

    /// The distance along the line from its start, in metres.
    #[must_use]
    pub fn chainage(&self) -> f64 {
        self.segment.chainage + self.segment.length * self.share
    }

    /// The index of the line.
    #[must_use]
    pub fn line(&self) -> usize {
        self.segment.line as usize
    }

    /// The length of the line, in metres.
    #[must_use]
    pub fn line_length(&self) -> f64 {
        self.line_length
    }

    /// The position on the line, 0 at its start and 1 at its end.
    #[must_use]
    pub fn position(&self) -> f64 {
        if self.line_length > 0.0 { (self.chainage() / self.line_length).min(1.0) } else { 0.0 }
    }
}

impl Segments {
    /// The segments of outlines. Curves are replaced by segments at most `tolerance` metres from them. If these are
    /// more than [`MAX_SEGMENTS`], the tolerance is doubled until they are not. Straight pieces beyond that number are
    /// left out.
    #[must_use]
    pub fn new(outlines: &[Outline], tolerance: f64) -> Segments {
        let count = |tolerance: f64| outlines.iter().map(|outline| outline.flattened_len(tolerance)).sum::<u64>();
        let mut tolerance = tolerance;
        while tolerance < 1e12 && count(tolerance) > MAX_SEGMENTS as u64 {
            tolerance *= 2.0;
        }
        let mut made = Segments::default();
        let mut lines = Vec::with_capacity(outlines.len());
        for outline in outlines {
            lines.extend(made.add(outline, tolerance));
        }
        if !lines.is_empty() {
            let root = made.group(&mut lines);
            let mut visited = 0;
            for at in trials([root.low, root.high]) {
                let _ =
                    (made.nearest_counted(at, f64::INFINITY, &mut visited), made.is_inside_counted(at, &mut visited));
            }
            made.visits = visited as f64 / TRIALS as f64;
        }
        made
    }

    /// The mean number of segments that a search visits, at some trial positions: a measure of its time.
    #[must_use]
    pub fn visits(&self) -> f64 {
        self.visits
    }

    /// Adds a line of straight pieces with its own tree. Returns its root node and its box; `None` if no point has
    /// finite coordinates.
    pub(super) fn add_line(&mut self, outline: &Outline) -> Option<(usize, [[f64; 2]; 2])> {
        let (first, end) = self.add(outline, 0.0)?;
        let root = self.nodes.len();
        let Node { low, high, .. } = self.chain(first, end);
        Some((root, [low, high]))
    }

    /// Adds the segments of a line. Returns their range; `None` if there are none.
    fn add(&mut self, outline: &Outline, tolerance: f64) -> Option<(usize, usize)> {
        let (first, line) = (self.segments.len(), self.lengths.len() as u32);
        let (mut from, mut chainage) = (outline.start, 0.0);
        let mut push = |to: [f64; 3]| {
            let (x, y) = (to[0] - from[0], to[1] - from[1]);
            let length = (x * x + y * y).sqrt();
            let is_valid = from.iter().chain(&to).all(|number| number.is_finite());
            if length > 0.0 && is_valid && self.segments.len() < MAX_SEGMENTS {
                self.segments.push(Segment { ends: [from, to], chainage, length, line });
                chainage += length;
                from = to;
            }
        };
        outline.flatten(tolerance, &mut push);
        // A line whose points coincide is a point.
        if self.segments.len() == first && outline.start.iter().all(|number| number.is_finite()) {
            let ends = [outline.start; 2];
            self.segments.push(Segment { ends, chainage: 0.0, length: 0.0, line });
        }
        self.lengths.push(chainage);
        (self.segments.len() > first).then_some((first, self.segments.len()))
    }

    /// Builds the tree over lines, given as ranges of segments: divides them in halves by the centers of their boxes
    /// along the longer side.
    fn group(&mut self, lines: &mut [(usize, usize)]) -> Node {
        if let [(first, end)] = lines {
            return self.chain(*first, *end);
        }
        let at = self.nodes.len();
        let boxes = lines.iter().map(|(first, end)| bounds(&self.segments[*first..*end]));
        let middles: Vec<[f64; 2]> = boxes.map(|(low, high)| [0, 1].map(|k| 0.5 * low[k] + 0.5 * high[k])).collect();
        let side = |k: usize| {
            let along = || middles.iter().map(|middle| middle[k]);
            along().fold(f64::MIN, f64::max) - along().fold(f64::MAX, f64::min)
        };
        let axis = usize::from(side(1) > side(0));
        let mut order: Vec<(f64, (usize, usize))> =
            middles.iter().map(|middle| middle[axis]).zip(lines.iter().copied()).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        lines.iter_mut().zip(order).for_each(|(line, (_, sorted))| *line = sorted);
        let half = lines.len() / 2;
        let (left, right) = lines.split_at_mut(half);
        self.pair(at, |tree| tree.group(left), |tree| tree.group(right), Some([0.0; 2]))
    }

    /// Builds the tree over consecutive segments.
    fn chain(&mut self, first: usize, end: usize) -> Node {
        let segments = &self.segments[first..end];
        if segments.len() <= LEAF {
            let (low, high) = bounds(segments);
            let y = |segment: Option<&Segment>, side: usize| segment.map_or(0.0, |segment| segment.ends[side][1]);
            let ends = [y(segments.first(), 0), y(segments.last(), 1)];
            let node =
                Node { low, high, ends, content: Content::Leaf(first as u32, (end - first) as u32), slanted: NONE };
            self.nodes.push(node);
            return node;
        }
        let (at, middle) = (self.nodes.len(), first + (end - first) / 2);
        self.pair(at, |tree| tree.chain(first, middle), |tree| tree.chain(middle, end), None)
    }

    fn pair(
        &mut self,
        at: usize,
        left: impl FnOnce(&mut Segments) -> Node,
        right: impl FnOnce(&mut Segments) -> Node,
        ends: Option<[f64; 2]>,
    ) -> Node {
        let empty = Node { low: [0.0; 2], high: [0.0; 2], ends: [0.0; 2], content: Content::Leaf(0, 0), slanted: NONE };
        self.nodes.push(empty);
        let left = left(self);
        let second = self.nodes.len();
        let right = right(self);
        let mut node = Node {
            low: [0, 1].map(|k| left.low[k].min(right.low[k])),
            high: [0, 1].map(|k| left.high[k].max(right.high[k])),
            ends: ends.unwrap_or([left.ends[0], right.ends[1]]),
            content: Content::Pair(second as u32),
            slanted: NONE,
        };
        if let Some(slanted) = self.slanted(at, &node, ends.is_none()) {
            node.slanted = self.slanted.len() as u32;
            self.slanted.push(slanted);
        }
        self.nodes[at] = node;
        node
    }

    /// The slanted box of `node`, whose segments are those of the nodes after `at`, if it is less than half as large.
    /// The segments of a chain are consecutive.
    fn slanted(&self, at: usize, node: &Node, is_chain: bool) -> Option<Slanted> {
        let segments = || {
            self.nodes[at + 1..].iter().flat_map(|node| match node.content {
                Content::Leaf(first, count) => &self.segments[first as usize..(first + count) as usize],
                Content::Pair(_) => &[],
            })
        };
        let area = |low: [f64; 2], high: [f64; 2]| (high[0] - low[0]) * (high[1] - low[1]);
        let longest = segments().max_by(|a, b| a.length.total_cmp(&b.length)).filter(|longest| longest.length > 0.0)?;
        let [[ax, ay], [bx, by]] = longest.flat();
        let along = [(bx - ax) / longest.length, (by - ay) / longest.length];
        let ends = match (is_chain, segments().next(), segments().last()) {
            (true, Some(first), Some(last)) => [first.flat()[0], last.flat()[1]],
            _ => [[0.0; 2]; 2],
        };
        let (low, high) = ([f64::MAX; 2], [f64::MIN; 2]);
        let mut slanted = Slanted { along, low, high, largest: 0.0, ends };
        let mut count = 0;
        for segment in segments() {
            count += 1;
            for end in segment.flat() {
                let turned = slanted.turned(end);
                slanted.low = [0, 1].map(|k| slanted.low[k].min(turned[k]));
                slanted.high = [0, 1].map(|k| slanted.high[k].max(turned[k]));
                slanted.largest = slanted.largest.max(end[0].abs() + end[1].abs());
            }
        }
        let is_smaller = area(slanted.low, slanted.high) < 0.5 * area(node.low, node.high);
        (count >= SLANTED && is_smaller).then_some(slanted)
    }

    /// The length of all lines, in metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// The number of segments.
    #[must_use]
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// Whether there are no segments.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Memory of the segments and their tree, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let bytes = self.segments.len() * size_of::<Segment>()
            + self.nodes.len() * size_of::<Node>()
            + self.slanted.len() * size_of::<Slanted>()
            + self.lengths.len() * size_of::<f64>();
        bytes as u64
    }

    /// The nearest point at a distance of at most `within` metres; `None` if there is none.
    #[must_use]
    pub fn nearest(&self, at: [f64; 2], within: f64) -> Option<Nearest> {
        self.nearest_counted(at, within, &mut 0)
    }

    /// Like [`Segments::nearest`]; adds the number of visited segments to `visited`.
    fn nearest_counted(&self, at: [f64; 2], within: f64, visited: &mut usize) -> Option<Nearest> {
        let best = self.nearest_of(0, at, within * within, visited)?;
        best.found.map(|(index, share)| {
            let segment = self.segments[index];
            let line_length = self.lengths.get(segment.line as usize).copied().unwrap_or(0.0);
            Nearest { segment, share, square: best.square, line_length }
        })
    }

    /// The square of the distance to the line under a node, if it is at most `square`. Adds the number of visited
    /// segments to `visited`.
    pub(super) fn square_to(&self, node: usize, at: [f64; 2], square: f64, visited: &mut usize) -> Option<f64> {
        let best = self.nearest_of(node, at, square, visited)?;
        best.found.map(|_| best.square)
    }

    fn nearest_of(&self, node: usize, at: [f64; 2], square: f64, visited: &mut usize) -> Option<Best> {
        if !(at[0].is_finite() && at[1].is_finite() && square >= 0.0) || self.nodes.is_empty() {
            return None;
        }
        let mut best = Best { square, found: None };
        self.search(node, at, &mut best, visited);
        Some(best)
    }

    /// A lower bound of the square of the distance from a position to the segments of a node.
    fn square_to_node(&self, node: usize, at: [f64; 2]) -> f64 {
        let node = &self.nodes[node];
        let square = node.square_to(at);
        self.slanted.get(node.slanted as usize).map_or(square, |slanted| slanted.square_to(at).max(square))
    }

    fn search(&self, node: usize, at: [f64; 2], best: &mut Best, visited: &mut usize) {
        match self.nodes[node].content {
            Content::Leaf(first, count) => {
                let first = first as usize;
                *visited += count as usize;
                for (k, segment) in self.segments[first..first + count as usize].iter().enumerate() {
                    let (square, share) = distance(segment.flat(), at);
                    let index = first + k;
                    // Of equal distances the first segment counts, independent of the order of the tree.
                    let is_first = best.found.is_none_or(|(other, _)| index < other);
                    if square < best.square || square == best.square && is_first {
                        *best = Best { square, found: Some((index, share)) };
                    }
                }
            }
            Content::Pair(second) => {
                let nodes = [node + 1, second as usize];
                let squares = nodes.map(|node| self.square_to_node(node, at));
                let order = if squares[1] < squares[0] { [1, 0] } else { [0, 1] };
                for k in order {
                    if squares[k] <= best.square {
                        self.search(nodes[k], at, best, visited);
                    }
                }
            }
        }
    }

    /// Whether a position is inside by the even-odd rule: a ray from it crosses the segments an odd number of times.
    /// Lines that are not closed have no inside.
    #[must_use]
    pub fn is_inside(&self, at: [f64; 2]) -> bool {
        self.is_inside_counted(at, &mut 0)
    }

    /// Like [`Segments::is_inside`]; adds the number of visited segments to `visited`.
    fn is_inside_counted(&self, at: [f64; 2], visited: &mut usize) -> bool {
        at[0].is_finite() && at[1].is_finite() && !self.nodes.is_empty() && self.crossings_odd(0, at, visited)
    }

    /// Whether a ray to the east crosses the segments of a node an odd number of times.
    fn crossings_odd(&self, node: usize, at: [f64; 2], visited: &mut usize) -> bool {
        let found = &self.nodes[node];
        let [x, y] = at;
        if y < found.low[1] || y > found.high[1] || x > found.high[0] {
            return false;
        }
        // The whole node is to the east. The number is odd if and only if the ends of the chain are on different sides
        // of y, wherever the points between are.
        if x < found.low[0] {
            return (found.ends[0] <= y) != (found.ends[1] <= y);
        }
        // The position is outside a convex area around the chain. All chains in the area with the same ends then have
        // the same parity, including the straight line between the ends.
        if let Some(slanted) = self.slanted.get(found.slanted as usize)
            && slanted.square_to(at) > 0.0
        {
            return crosses(slanted.ends, at);
        }
        match found.content {
            Content::Pair(second) => {
                self.crossings_odd(node + 1, at, visited) != self.crossings_odd(second as usize, at, visited)
            }
            Content::Leaf(first, count) => {
                *visited += count as usize;
                let segments = &self.segments[first as usize..(first + count) as usize];
                segments.iter().filter(|segment| crosses(segment.flat(), at)).count() % 2 == 1
            }
        }
    }
}

/// Number of trial positions at which the work of a search is measured.
pub(super) const TRIALS: usize = 16;

/// The trial positions in a box.
pub(super) fn trials([low, high]: [[f64; 2]; 2]) -> impl Iterator<Item = [f64; 2]> {
    (0..TRIALS).map(move |k| {
        // An irrational step, so that it matches no pattern of the drawing.
        let shares = [(k as f64 + 0.5) / TRIALS as f64, (0.5 + 0.618_033_988_75 * k as f64).fract()];
        [0, 1].map(|axis| low[axis] + shares[axis] * (high[axis] - low[axis]))
    })
}

struct Best {
    square: f64,
    found: Option<(usize, f64)>,
}

impl Node {
    /// The square of the distance from a position to the box.
    fn square_to(&self, at: [f64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|k| (self.low[k] - at[k]).max(at[k] - self.high[k]).max(0.0));
        x * x + y * y
    }
}

fn bounds(segments: &[Segment]) -> ([f64; 2], [f64; 2]) {
    let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
    for end in segments.iter().flat_map(|segment| segment.ends) {
        for k in 0..2 {
            low[k] = low[k].min(end[k]);
            high[k] = high[k].max(end[k]);
        }
    }
    (low, high)
}

/// The square of the distance to the straight line between two points, and the nearest position on it as a share of its
/// length.
pub(super) fn distance([[ax, ay], [bx, by]]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> (f64, f64) {
    let (rx, ry, ux, uy) = (x - ax, y - ay, bx - ax, by - ay);
    let along = rx * ux + ry * uy;
    let square = ux * ux + uy * uy;
    // Distances to the ends are distances to points, so that two segments that meet have exactly the same distance.
    if along >= square && square > 0.0 {
        let (ex, ey) = (x - bx, y - by);
        return (ex * ex + ey * ey, 1.0);
    }
    if along <= 0.0 || square == 0.0 {
        return (rx * rx + ry * ry, 0.0);
    }
    let share = along / square;
    let (ex, ey) = (rx - share * ux, ry - share * uy);
    (ex * ex + ey * ey, share)
}

/// Whether a ray from a position to the east crosses a segment. A point of the drawing at exactly this y counts as
/// above.
fn crosses([[ax, ay], [bx, by]]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> bool {
    if (ay <= y) == (by <= y) {
        return false;
    }
    let side = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
    if by > ay { side > 0.0 } else { side < 0.0 }
}

#[cfg(test)]
mod tests;
