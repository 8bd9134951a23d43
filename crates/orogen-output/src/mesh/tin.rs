//! An adaptive triangulation, refined where its error is largest.
//!
//! Greedy insertion (Garland and Heckbert, "Fast polygonal approximation of terrains and height fields", CMU-CS-95-181)
//! into a Delaunay triangulation: the sample with the largest error becomes a vertex, until all errors are within the
//! limit. There are two differences from the paper:
//!
//! - A triangle whose error is only slightly too large is first tried with one of its edges flipped: where the land has
//!   a preferred direction, a triangulation that follows it needs a fifth fewer triangles. Lawson's flips are valid for
//!   any surrounding edges.
//! - After an initial phase over the whole tile, refinement proceeds block by block, so that its data stays in cache.
//!   The order in which distant blocks are refined has little effect.
//!
//! The border is fixed beforehand from its own samples ([`super::border`]) and never refined, so tiles fit along their
//! edges. All decisions use exact integers, or f32 values that are the same at every SIMD level, so the result is the
//! same too.

use std::collections::BinaryHeap;

use super::border::polyline;
use super::scan::{Worst, exactly, furthest};
use super::tile::{Sample, Tile};
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;

/// In place of a twin: the edge belongs to the border.
const OUTSIDE: u32 = u32::MAX;
/// In place of a twin: the triangle beyond is about to be added and will link the two.
const LATER: u32 = u32::MAX - 1;

/// Side of a block in samples, as a power of two.
const BLOCK: u32 = 6;
/// Number of samples per vertex at which work starts to proceed block by block.
const SPARSE: usize = 1024;
/// All blocks are refined down to the first multiple of the error, then down to the next.
const SWEEPS: [f32; 2] = [4.0, 2.0];
/// The largest multiple of the error at which a flip is tried.
const FLIPPED: f32 = 3.0;

/// The memory of a triangulation, reused for one tile after another.
#[derive(Default)]
pub(super) struct Workspace {
    triangles: Vec<Triangle>,
    queue: Queue,
}

/// Triangulates a tile of at least 2 x 2 finite samples with an error of at most `max_error`. Returns triples of
/// samples, each clockwise in the picture.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn triangulate<'a>(
    tile: &Tile,
    max_error: f64,
    workspace: &'a mut Workspace,
    progress: &Progress,
) -> Result<impl Iterator<Item = [Sample; 3]> + Clone + use<'a>> {
    let mut tin = Tin::new(tile, max_error, workspace);
    tin.lay_out(max_error);
    tin.refine(progress)?;
    Ok(workspace.triangles.iter().map(|triangle| triangle.corners))
}

/// A triangle and its neighbors. Edge 4 t + k leads from vertex k of triangle t to the next.
#[derive(Clone, Copy)]
struct Triangle {
    corners: [Sample; 3],
    /// The opposite edges in the neighboring triangles.
    twins: [u32; 3],
    /// Its sample with the largest error, or [`Worst::UNKNOWN`].
    worst: Worst,
}

/// The arithmetic for distances.
enum Precision {
    Quick,
    Exact,
}

struct Tin<'a> {
    tile: &'a Tile,
    precision: Precision,
    /// Samples with a larger error become vertices.
    limit: f32,
    triangles: &'a mut Vec<Triangle>,
    queue: &'a mut Queue,
    /// Number of vertices.
    count: usize,
    /// For each sample of the border, counted clockwise from the first one, the edge that starts there along the
    /// border.
    along: Vec<u32>,
    /// Triangles to scan.
    fresh: Vec<u32>,
    /// Edges to check, kept to avoid allocations.
    doubtful: Vec<u32>,
}

impl<'a> Tin<'a> {
    fn new(tile: &'a Tile, max_error: f64, workspace: &'a mut Workspace) -> Tin<'a> {
        // A few f32 roundings of numbers up to the largest height, doubled for safety.
        let greatest = f64::from(tile.greatest());
        let rounding = greatest * f64::from(f32::EPSILON) * 4.0;
        let quick = max_error > 64.0 * rounding && greatest < 1e30;
        let (precision, limit) = match quick {
            true => (Precision::Quick, max_error - rounding),
            false => (Precision::Exact, max_error - greatest * f64::EPSILON * 4.0),
        };
        // Rounded down: the limit as f32 must not exceed it.
        let limit = match limit as f32 {
            rounded if f64::from(rounded) > limit => rounded.next_down(),
            rounded => rounded,
        };
        let Workspace { triangles, queue } = workspace;
        triangles.clear();
        // Reserves the maximum, so that it never moves. The system assigns memory only to written pages.
        triangles.reserve_exact(2 * (tile.width - 1) * (tile.height - 1));
        queue.reset();
        Tin {
            tile,
            precision,
            limit: limit.max(0.0),
            triangles,
            queue,
            count: 0,
            along: vec![LATER; 2 * (tile.width + tile.height)],
            fresh: Vec::new(),
            doubtful: Vec::new(),
        }
    }

    fn worst(&self, triangle: u32) -> Worst {
        self.triangles[triangle as usize].worst
    }

    /// The vertex at which an edge starts.
    fn start(&self, edge: u32) -> Sample {
        self.triangles[(edge / 4) as usize].corners[(edge % 4) as usize]
    }

    fn twin(&self, edge: u32) -> u32 {
        self.triangles[(edge / 4) as usize].twins[(edge % 4) as usize]
    }

    /// The position of a border sample, clockwise from the first one.
    fn around(&self, sample: Sample) -> usize {
        let [east, south] = [self.tile.width - 1, self.tile.height - 1];
        let [column, row] = sample.place().map(|at| at as usize);
        match [column, row] {
            [column, 0] => column,
            [column, row] if column == east => east + row,
            [column, row] if row == south => 2 * east + south - column,
            [_, row] => 2 * (east + south) - row,
        }
    }

    /// Makes two triangles over the tile, then the vertices along its border.
    fn lay_out(&mut self, max_error: f64) {
        let (east, south) = (self.tile.width as i32 - 1, self.tile.height as i32 - 1);
        let side = |line: &dyn Fn(i32) -> [i32; 2], last: i32| -> Vec<[i32; 2]> {
            let heights: Vec<f64> = (0..=last).map(|i| f64::from(self.tile.at(line(i)))).collect();
            polyline(&heights, max_error).into_iter().map(|i| line(i as i32)).collect()
        };
        // Once around, from each corner of the tile to the next, always in the direction east or south.
        let mut sides = [
            side(&|i| [i, 0], east),
            side(&|i| [east, i], south),
            side(&|i| [i, south], east),
            side(&|i| [0, i], south),
        ];
        sides[2].reverse();
        sides[3].reverse();
        let (mut border, mut ends) = (Vec::new(), Vec::new());
        for side in &sides {
            ends.push(border.len());
            border.extend(side[..side.len() - 1].iter().map(|&place| Sample::at(place)));
        }
        self.count = border.len();
        let [a, b, c, d] = [ends[0], ends[1], ends[2], ends[3]];
        let first = self.add(None, [border[a], border[b], border[c]], [OUTSIDE, OUTSIDE, LATER]);
        self.add(None, [border[a], border[c], border[d]], [4 * first + 2, OUTSIDE, OUTSIDE]);
        // The middle vertex first: otherwise one vertex would be adjacent to all others.
        let mut stretches = vec![[a, b], [b, c], [c, d], [d, border.len()]];
        while let Some([from, to]) = stretches.pop() {
            if to - from >= 2 {
                let middle = from + (to - from) / 2;
                self.split(self.along[self.around(border[from])], border[middle]);
                stretches.extend([[from, middle], [middle, to]]);
            }
        }
        self.look();
    }

    fn refine(&mut self, progress: &Progress) -> Result<()> {
        progress.check()?;
        let enough = self.tile.width * self.tile.height / SPARSE;
        while self.count < enough
            && let Some(triangle) = self.queue.pop_above(0, self.limit, self.triangles)
        {
            self.insert_worst(triangle);
        }
        self.queue.cut(self.tile, self.triangles);
        for factor in SWEEPS {
            self.sweep(factor * self.limit, progress)?;
        }
        // A block may leave work in a block that is already done.
        while self.sweep(self.limit, progress)? {}
        Ok(())
    }

    /// Refines all blocks down to an error; returns whether anything changed.
    fn sweep(&mut self, error: f32, progress: &Progress) -> Result<bool> {
        let mut busy = false;
        for block in 0..self.queue.blocks.len() {
            progress.check()?;
            while let Some(triangle) = self.queue.pop_above(block, error, self.triangles) {
                busy = true;
                if self.worst(triangle).error > FLIPPED * self.limit || !self.flip(triangle) {
                    self.insert_worst(triangle);
                }
            }
        }
        Ok(busy)
    }

    /// Makes the worst sample of a triangle a vertex.
    fn insert_worst(&mut self, triangle: u32) {
        self.count += 1;
        self.insert(triangle, self.worst(triangle).at);
        self.look();
    }

    /// Inserts a vertex inside a triangle or on its edge.
    fn insert(&mut self, triangle: u32, new: Sample) {
        let Triangle { corners: [a, b, c], twins: [ab, bc, ca], .. } = self.triangles[triangle as usize];
        let edge = 4 * triangle;
        for (k, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
            if turn(from, to, new) == 0 {
                return self.split(edge + k as u32, new);
            }
        }
        let first = self.add(Some(triangle), [a, b, new], [ab, LATER, LATER]);
        let second = self.add(None, [b, c, new], [bc, LATER, 4 * first + 1]);
        let third = self.add(None, [c, a, new], [ca, 4 * first + 2, 4 * second + 1]);
        self.settle([4 * first, 4 * second, 4 * third]);
    }

    /// Splits an edge, and the one or two adjacent triangles, at a vertex on it.
    fn split(&mut self, edge: u32, new: Sample) {
        let (left, right) = (next(edge), previous(edge));
        let (from, to, apex) = (self.start(edge), self.start(left), self.start(right));
        let (outer_left, outer_right) = (self.twin(left), self.twin(right));
        let twin = self.twin(edge);
        if twin == OUTSIDE {
            let first = self.add(Some(edge / 4), [new, to, apex], [OUTSIDE, outer_left, LATER]);
            let second = self.add(None, [from, new, apex], [OUTSIDE, 4 * first + 2, outer_right]);
            return self.settle([4 * first + 1, 4 * second + 2]);
        }
        let (far_left, far_right) = (previous(twin), next(twin));
        let far_apex = self.start(far_left);
        let (beyond_left, beyond_right) = (self.twin(far_left), self.twin(far_right));
        let first = self.add(Some(edge / 4), [new, to, apex], [LATER, outer_left, LATER]);
        let second = self.add(None, [from, new, apex], [LATER, 4 * first + 2, outer_right]);
        let third = self.add(Some(twin / 4), [new, from, far_apex], [4 * second, beyond_right, LATER]);
        let fourth = self.add(None, [to, new, far_apex], [4 * first, 4 * third + 2, beyond_left]);
        self.settle([4 * first + 1, 4 * second + 2, 4 * third + 1, 4 * fourth + 2]);
    }

    /// Flips edges until no edge has the opposite vertex within the circumcircle of its triangle (Lawson's algorithm),
    /// starting around a new vertex.
    fn settle<const N: usize>(&mut self, edges: [u32; N]) {
        self.doubtful.extend(edges);
        while let Some(edge) = self.doubtful.pop() {
            let twin = self.twin(edge);
            if twin == OUTSIDE {
                continue;
            }
            let [from, to, apex] = [edge, next(edge), previous(edge)].map(|edge| self.start(edge));
            if within_circle([from, to, apex], self.start(previous(twin))) {
                let [near, far] = self.turn_edge(edge);
                self.doubtful.extend([4 * near + 1, 4 * far + 2]);
            }
        }
    }

    /// Replaces the edge between two triangles by the other diagonal of their quadrilateral. Returns the two triangles;
    /// the new edge is the first of each, and a side of the quadrilateral adjacent to the apex of `edge` is the last
    /// edge of each.
    fn turn_edge(&mut self, edge: u32) -> [u32; 2] {
        let twin = self.twin(edge);
        let (left, right) = (next(edge), previous(edge));
        let (far_left, far_right) = (previous(twin), next(twin));
        let [from, to, apex, far_apex] = [edge, left, right, far_left].map(|edge| self.start(edge));
        let [outer_left, outer_right, beyond_left, beyond_right] =
            [left, right, far_left, far_right].map(|edge| self.twin(edge));
        let near = self.add(Some(edge / 4), [apex, far_apex, to], [LATER, beyond_left, outer_left]);
        let far = self.add(Some(twin / 4), [far_apex, apex, from], [4 * near, outer_right, beyond_right]);
        [near, far]
    }

    /// Flips the edge of a triangle that brings it and its neighbor within the limit, the best of the three; returns
    /// whether there is one.
    fn flip(&mut self, triangle: u32) -> bool {
        let mut best: Option<(f32, u32)> = None;
        for edge in [4 * triangle, 4 * triangle + 1, 4 * triangle + 2] {
            let twin = self.twin(edge);
            if twin == OUTSIDE {
                continue;
            }
            let [from, to, apex, far_apex] =
                [edge, next(edge), previous(edge), previous(twin)].map(|edge| self.start(edge));
            if turn(apex, far_apex, to) <= 0 || turn(far_apex, apex, from) <= 0 {
                continue;
            }
            let near = self.furthest([apex, far_apex, to]).error;
            if near > self.limit {
                continue;
            }
            let error = near.max(self.furthest([far_apex, apex, from]).error);
            if error <= self.limit && best.is_none_or(|(least, _)| error < least) {
                best = Some((error, edge));
            }
        }
        let Some((_, edge)) = best else { return false };
        for triangle in self.turn_edge(edge) {
            self.triangles[triangle as usize].worst = Worst::NONE;
        }
        self.fresh.clear();
        true
    }

    /// Writes a triangle, over another or as a new one, with the twins of its edges, and links the twins back.
    fn add(&mut self, over: Option<u32>, corners: [Sample; 3], twins: [u32; 3]) -> u32 {
        let written = Triangle { corners, twins, worst: Worst::UNKNOWN };
        let triangle = match over {
            Some(triangle) => {
                self.triangles[triangle as usize] = written;
                triangle
            }
            None => {
                self.triangles.push(written);
                self.triangles.len() as u32 - 1
            }
        };
        for (k, twin) in twins.into_iter().enumerate() {
            let edge = 4 * triangle + k as u32;
            match twin {
                OUTSIDE => {
                    let at = self.around(corners[k]);
                    self.along[at] = edge;
                }
                LATER => {}
                _ => self.triangles[(twin / 4) as usize].twins[(twin % 4) as usize] = edge,
            }
        }
        self.fresh.push(triangle);
        triangle
    }

    /// Scans all triangles that were written since the last call.
    fn look(&mut self) {
        for index in 0..self.fresh.len() {
            let triangle = self.fresh[index];
            let Triangle { corners, worst, .. } = self.triangles[triangle as usize];
            if worst == Worst::UNKNOWN {
                let worst = self.furthest(corners);
                self.triangles[triangle as usize].worst = worst;
                if worst.error > self.limit {
                    self.queue.push(triangle, worst);
                }
            }
        }
        self.fresh.clear();
    }

    fn furthest(&self, corners: [Sample; 3]) -> Worst {
        match self.precision {
            Precision::Quick => furthest(self.tile, corners),
            Precision::Exact => exactly(self.tile, corners),
        }
    }
}

/// Priority queues of triangles by error, the largest first; one queue per block after [`Queue::cut`].
///
/// Entries may be outdated: a changed triangle is inserted again.
#[derive(Default)]
struct Queue {
    blocks: Vec<BinaryHeap<u64>>,
    /// Blocks per row after the queue was cut; before, there is one queue.
    across: Option<u32>,
}

impl Queue {
    /// Clears it for a new tile.
    fn reset(&mut self) {
        self.blocks.iter_mut().for_each(BinaryHeap::clear);
        self.blocks.resize_with(self.blocks.len().max(1), BinaryHeap::new);
        self.across = None;
    }

    fn push(&mut self, triangle: u32, worst: Worst) {
        let [column, row] = worst.at.place().map(|at| (at as u32) >> BLOCK);
        let block = self.across.map_or(0, |across| row * across + column);
        // The bits of positive floats sort like their values. Of equal errors, the older triangle comes first.
        self.blocks[block as usize].push(u64::from(worst.error.to_bits()) << 32 | u64::from(!triangle));
    }

    /// Removes the triangle with the largest error, if that is more than `error`.
    fn pop_above(&mut self, block: usize, error: f32, triangles: &[Triangle]) -> Option<u32> {
        let heap = &mut self.blocks[block];
        while let Some(key) = heap.peek() {
            let (triangle, off) = (!(*key as u32), f32::from_bits((key >> 32) as u32));
            if off <= error {
                return None;
            }
            heap.pop();
            if triangles[triangle as usize].worst.error == off {
                return Some(triangle);
            }
        }
        None
    }

    /// Makes one queue per block of the tile.
    fn cut(&mut self, tile: &Tile, triangles: &[Triangle]) {
        let blocks = |samples: usize| samples.div_ceil(1 << BLOCK);
        let whole = std::mem::take(&mut self.blocks[0]);
        self.across = Some(blocks(tile.width) as u32);
        self.blocks.resize_with(blocks(tile.width) * blocks(tile.height), BinaryHeap::new);
        for key in whole {
            let triangle = !(key as u32);
            let worst = triangles[triangle as usize].worst;
            if worst.error.to_bits() == (key >> 32) as u32 {
                self.push(triangle, worst);
            }
        }
    }
}

fn next(edge: u32) -> u32 {
    if edge % 4 == 2 { edge - 2 } else { edge + 1 }
}

fn previous(edge: u32) -> u32 {
    if edge.is_multiple_of(4) { edge + 2 } else { edge - 1 }
}

/// Twice the area of a triangle: positive if it is clockwise in the picture.
fn turn(a: Sample, b: Sample, c: Sample) -> i32 {
    let a = a.place();
    let away = |p: Sample| {
        let [x, y] = p.place();
        [x - a[0], y - a[1]]
    };
    let ([bx, by], [cx, cy]) = (away(b), away(c));
    bx * cy - by * cx
}

/// Whether `p` is within the circumcircle of a triangle. Exact: a tile has far fewer than 2^15 samples per side.
fn within_circle([a, b, c]: [Sample; 3], p: Sample) -> bool {
    let p = p.place();
    let seen = |q: Sample| {
        let [x, y] = q.place();
        let [x, y] = [x - p[0], y - p[1]];
        (x, y, i64::from(x * x + y * y))
    };
    let ((ax, ay, a), (bx, by, b), (cx, cy, c)) = (seen(a), seen(b), seen(c));
    a * i64::from(bx * cy - by * cx) - b * i64::from(ax * cy - ay * cx) + c * i64::from(ax * by - ay * bx) > 0
}
