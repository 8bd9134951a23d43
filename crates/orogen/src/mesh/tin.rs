//! A triangulation that grows where the surface is furthest off.
//!
//! Greedy insertion (Garland and Heckbert, "Fast polygonal approximation of terrains and height fields", CMU-CS-95-181) into a
//! Delaunay triangulation: the sample furthest from the surface becomes a corner, until none is further than allowed. Two things
//! differ from the paper:
//!
//! - A triangle that is only a little too far off is first tried with one of its edges flipped: where the land has a direction,
//!   a triangulation that follows it needs a fifth fewer triangles. Flips of Lawson's stay valid whatever the edges around are.
//! - After a start over the whole tile, work goes block by block, so that what is touched stays in cache; the order in which
//!   blocks far from each other are refined changes little.
//!
//! The border is fixed beforehand from its own samples ([`super::border`]) and never refined, so tiles fit along their edges.
//! All decisions are exact integers or compared f32s that are the same at every SIMD level, so the result is too.

use std::collections::BinaryHeap;

use orogen_simd::dispatch;

use super::border::polyline;
use super::scan::{Scan, Worst, exactly};
use super::tile::Tile;
use crate::error::Result;
use crate::progress::Progress;

/// In place of a twin: the edge is part of the border.
const OUTSIDE: u32 = u32::MAX;
/// In place of a twin: the triangle beyond is about to be added and will link the two.
const LATER: u32 = u32::MAX - 1;

/// The side of a block in samples, as a power of two.
const BLOCK: u32 = 6;
/// How many samples there are for each corner when work begins to go block by block.
const SPARSE: usize = 1024;
/// Blocks are refined down to these multiples of the error, all of them before the next.
const SWEEPS: [f32; 2] = [4.0, 2.0];
/// The greatest multiple of the error at which a flip is tried.
const FLIPPED: f32 = 3.0;

/// Triangles over a tile: places of samples (column, row), and triples of them, each clockwise seen as a picture.
pub(super) struct Triangulation {
    pub places: Vec<[i32; 2]>,
    pub triangles: Vec<[u32; 3]>,
}

/// Triangulates a tile of at least 2 x 2 finite samples so that none is further than `max_error` from the surface.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn triangulate(tile: &Tile, max_error: f64, progress: &Progress) -> Result<Triangulation> {
    let mut tin = Tin::new(tile, max_error);
    tin.lay_out(max_error);
    tin.refine(progress)?;
    Ok(Triangulation { places: tin.places, triangles: tin.corners })
}

/// How distances are measured.
enum Precision {
    Quick,
    Exact,
}

struct Tin<'a> {
    tile: &'a Tile,
    precision: Precision,
    /// Samples further off than this become corners.
    limit: f32,
    places: Vec<[i32; 2]>,
    /// Edge 3 t + k leads from corner k of triangle t to the next.
    corners: Vec<[u32; 3]>,
    /// The same edge seen from the triangle beyond it.
    twins: Vec<u32>,
    /// For each triangle, its furthest sample; `None` until it is looked at.
    worst: Vec<Option<Worst>>,
    /// For each corner on the border, the edge that leads on along it.
    along: Vec<u32>,
    queue: Queue,
    /// Triangles to look at.
    fresh: Vec<u32>,
    /// Edges to check, kept to save allocations.
    doubtful: Vec<u32>,
}

impl<'a> Tin<'a> {
    fn new(tile: &'a Tile, max_error: f64) -> Tin<'a> {
        // A handful of f32 roundings of numbers up to the greatest height; twice that, to be sure.
        let greatest = f64::from(tile.greatest());
        let rounding = greatest * f64::from(f32::EPSILON) * 4.0;
        let quick = max_error > 64.0 * rounding && greatest < 1e30;
        let (precision, limit) = match quick {
            true => (Precision::Quick, max_error - rounding),
            false => (Precision::Exact, max_error - greatest * f64::EPSILON * 4.0),
        };
        // Down: the limit as f32 must not be above it.
        let limit = match limit as f32 {
            rounded if f64::from(rounded) > limit => rounded.next_down(),
            rounded => rounded,
        };
        Tin {
            tile,
            precision,
            limit: limit.max(0.0),
            places: Vec::new(),
            corners: Vec::new(),
            twins: Vec::new(),
            worst: Vec::new(),
            along: Vec::new(),
            queue: Queue::new(),
            fresh: Vec::new(),
            doubtful: Vec::new(),
        }
    }

    fn place(&self, corner: u32) -> [i32; 2] {
        self.places[corner as usize]
    }

    /// The corner that an edge begins at.
    fn start(&self, edge: u32) -> u32 {
        self.corners[(edge / 3) as usize][(edge % 3) as usize]
    }

    fn twin(&self, edge: u32) -> u32 {
        self.twins[edge as usize]
    }

    /// Two triangles over the tile, then the corners along its border.
    fn lay_out(&mut self, max_error: f64) {
        let (east, south) = (self.tile.width as i32 - 1, self.tile.height as i32 - 1);
        let side = |line: &dyn Fn(i32) -> [i32; 2], last: i32| -> Vec<[i32; 2]> {
            let heights: Vec<f64> = (0..=last).map(|i| f64::from(self.tile.at(line(i)))).collect();
            polyline(&heights, max_error).into_iter().map(|i| line(i as i32)).collect()
        };
        // Once around, from each corner of the tile to the next; always measured eastwards and southwards.
        let mut sides = [
            side(&|i| [i, 0], east),
            side(&|i| [east, i], south),
            side(&|i| [i, south], east),
            side(&|i| [0, i], south),
        ];
        sides[2].reverse();
        sides[3].reverse();
        let mut ends = Vec::new();
        for side in &sides {
            ends.push(self.places.len() as u32);
            self.places.extend(&side[..side.len() - 1]);
        }
        self.along = vec![LATER; self.places.len()];
        let [a, b, c, d] = [ends[0], ends[1], ends[2], ends[3]];
        let first = self.add(None, [a, b, c], [OUTSIDE, OUTSIDE, LATER]);
        self.add(None, [a, c, d], [3 * first + 2, OUTSIDE, OUTSIDE]);
        let count = self.places.len() as u32;
        // The middle one first: else one corner would have them all as neighbours.
        let mut stretches: Vec<[u32; 2]> = vec![[a, b], [b, c], [c, d], [d, count]];
        while let Some([from, to]) = stretches.pop() {
            if to - from >= 2 {
                let middle = from + (to - from) / 2;
                self.split(self.along[from as usize], middle);
                stretches.extend([[from, middle], [middle, to]]);
            }
        }
        self.look();
    }

    fn refine(&mut self, progress: &Progress) -> Result<()> {
        progress.check()?;
        let enough = self.tile.width * self.tile.height / SPARSE;
        while self.places.len() < enough
            && let Some(triangle) = self.queue.pop_above(0, self.limit, &self.worst)
        {
            self.insert_worst(triangle);
        }
        self.queue.cut(self.tile, &self.worst);
        for factor in SWEEPS {
            self.sweep(factor * self.limit, progress)?;
        }
        // A block may leave work to one that has been done.
        while self.sweep(self.limit, progress)? {}
        Ok(())
    }

    /// Refines all blocks, one after the other, down to an error; tells whether anything was done.
    fn sweep(&mut self, error: f32, progress: &Progress) -> Result<bool> {
        let mut busy = false;
        for block in 0..self.queue.blocks.len() {
            progress.check()?;
            while let Some(triangle) = self.queue.pop_above(block, error, &self.worst) {
                busy = true;
                let off = self.worst[triangle as usize].map_or(0.0, |worst| worst.error);
                if off > FLIPPED * self.limit || !self.flip(triangle) {
                    self.insert_worst(triangle);
                }
            }
        }
        Ok(busy)
    }

    /// Makes the furthest sample of a triangle a corner.
    fn insert_worst(&mut self, triangle: u32) {
        let Some(worst) = self.worst[triangle as usize] else { return };
        let stride = self.tile.stride as u32;
        self.places.push([(worst.at % stride) as i32, (worst.at / stride) as i32]);
        self.insert(triangle, self.places.len() as u32 - 1);
        self.look();
    }

    /// Puts a corner that lies in or on the edge of a triangle into the triangulation.
    fn insert(&mut self, triangle: u32, new: u32) {
        let [a, b, c] = self.corners[triangle as usize];
        let place = self.place(new);
        let edge = 3 * triangle;
        for (k, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
            if turn(self.place(from), self.place(to), place) == 0 {
                return self.split(edge + k as u32, new);
            }
        }
        let [ab, bc, ca] = [self.twin(edge), self.twin(edge + 1), self.twin(edge + 2)];
        let first = self.add(Some(triangle), [a, b, new], [ab, LATER, LATER]);
        let second = self.add(None, [b, c, new], [bc, LATER, 3 * first + 1]);
        let third = self.add(None, [c, a, new], [ca, 3 * first + 2, 3 * second + 1]);
        self.settle([3 * first, 3 * second, 3 * third]);
    }

    /// Cuts an edge, and the one or two triangles beside it, at a corner that lies on it.
    fn split(&mut self, edge: u32, new: u32) {
        let (left, right) = (next(edge), previous(edge));
        let (from, to, apex) = (self.start(edge), self.start(left), self.start(right));
        let (outer_left, outer_right) = (self.twin(left), self.twin(right));
        let twin = self.twin(edge);
        if twin == OUTSIDE {
            let first = self.add(Some(edge / 3), [new, to, apex], [OUTSIDE, outer_left, LATER]);
            let second = self.add(None, [from, new, apex], [OUTSIDE, 3 * first + 2, outer_right]);
            return self.settle([3 * first + 1, 3 * second + 2]);
        }
        let (far_left, far_right) = (previous(twin), next(twin));
        let far_apex = self.start(far_left);
        let (beyond_left, beyond_right) = (self.twin(far_left), self.twin(far_right));
        let first = self.add(Some(edge / 3), [new, to, apex], [LATER, outer_left, LATER]);
        let second = self.add(None, [from, new, apex], [LATER, 3 * first + 2, outer_right]);
        let third = self.add(Some(twin / 3), [new, from, far_apex], [3 * second, beyond_right, LATER]);
        let fourth = self.add(None, [to, new, far_apex], [3 * first, 3 * third + 2, beyond_left]);
        self.settle([3 * first + 1, 3 * second + 2, 3 * third + 1, 3 * fourth + 2]);
    }

    /// Flips edges as long as one has the corner beyond it within the circle around its triangle (Lawson's algorithm), beginning
    /// with those around a new corner.
    fn settle<const N: usize>(&mut self, edges: [u32; N]) {
        self.doubtful.extend(edges);
        while let Some(edge) = self.doubtful.pop() {
            let twin = self.twin(edge);
            if twin == OUTSIDE {
                continue;
            }
            let [from, to, apex] = [edge, next(edge), previous(edge)].map(|edge| self.place(self.start(edge)));
            if within_circle([from, to, apex], self.place(self.start(previous(twin)))) {
                let [near, far] = self.turn_edge(edge);
                self.doubtful.extend([3 * near + 1, 3 * far + 2]);
            }
        }
    }

    /// Replaces the edge between two triangles by the other diagonal of their quadrilateral; returns them, the new edge being
    /// the first of each. The one side of the quadrilateral that the apex of `edge` sees is the last edge of each.
    fn turn_edge(&mut self, edge: u32) -> [u32; 2] {
        let twin = self.twin(edge);
        let (left, right) = (next(edge), previous(edge));
        let (far_left, far_right) = (previous(twin), next(twin));
        let [from, to, apex, far_apex] = [edge, left, right, far_left].map(|edge| self.start(edge));
        let [outer_left, outer_right, beyond_left, beyond_right] =
            [left, right, far_left, far_right].map(|edge| self.twin(edge));
        let near = self.add(Some(edge / 3), [apex, far_apex, to], [LATER, beyond_left, outer_left]);
        let far = self.add(Some(twin / 3), [far_apex, apex, from], [3 * near, outer_right, beyond_right]);
        [near, far]
    }

    /// Turns the edge of a triangle by which it and its neighbour come to lie within the limit, best of the three; tells
    /// whether there is one.
    fn flip(&mut self, triangle: u32) -> bool {
        let mut best: Option<(f32, u32)> = None;
        for edge in [3 * triangle, 3 * triangle + 1, 3 * triangle + 2] {
            let twin = self.twin(edge);
            if twin == OUTSIDE {
                continue;
            }
            let [from, to, apex, far_apex] =
                [edge, next(edge), previous(edge), previous(twin)].map(|edge| self.place(self.start(edge)));
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
            self.worst[triangle as usize] = Some(Worst::NONE);
        }
        self.fresh.clear();
        true
    }

    /// Writes a triangle over another or as a new one, with the twins of its edges, and links those back.
    fn add(&mut self, over: Option<u32>, corners: [u32; 3], twins: [u32; 3]) -> u32 {
        let triangle = match over {
            Some(triangle) => {
                self.corners[triangle as usize] = corners;
                self.worst[triangle as usize] = None;
                triangle
            }
            None => {
                self.corners.push(corners);
                self.twins.extend([LATER; 3]);
                self.worst.push(None);
                self.corners.len() as u32 - 1
            }
        };
        for (k, twin) in twins.into_iter().enumerate() {
            let edge = 3 * triangle + k as u32;
            self.twins[edge as usize] = twin;
            match twin {
                OUTSIDE => self.along[corners[k] as usize] = edge,
                LATER => {}
                _ => self.twins[twin as usize] = edge,
            }
        }
        self.fresh.push(triangle);
        triangle
    }

    /// Looks at all triangles that were written since it was last done.
    fn look(&mut self) {
        for index in 0..self.fresh.len() {
            let triangle = self.fresh[index];
            if self.worst[triangle as usize].is_none() {
                let worst = self.furthest(self.corners[triangle as usize].map(|corner| self.place(corner)));
                self.worst[triangle as usize] = Some(worst);
                if worst.error > self.limit {
                    self.queue.push(triangle, worst);
                }
            }
        }
        self.fresh.clear();
    }

    fn furthest(&self, corners: [[i32; 2]; 3]) -> Worst {
        match self.precision {
            Precision::Quick => dispatch(Scan { tile: self.tile, corners }),
            Precision::Exact => exactly(self.tile, corners),
        }
    }
}

/// Triangles by their error, the greatest first; block by block, once it was cut.
///
/// What is taken out may be out of date: a triangle that changed was put in again.
struct Queue {
    blocks: Vec<BinaryHeap<u64>>,
    /// Samples a row of the tile's memory and blocks a row, once it was cut.
    rows: Option<[u32; 2]>,
}

impl Queue {
    fn new() -> Queue {
        Queue { blocks: vec![BinaryHeap::new()], rows: None }
    }

    fn push(&mut self, triangle: u32, worst: Worst) {
        let block = match self.rows {
            None => 0,
            Some([stride, across]) => ((worst.at / stride) >> BLOCK) * across + ((worst.at % stride) >> BLOCK),
        };
        // The bits of positive floats are ordered as they are. Of two with the same error, the older first.
        self.blocks[block as usize].push(u64::from(worst.error.to_bits()) << 32 | u64::from(!triangle));
    }

    /// The triangle with the greatest error, if it is more than `error`.
    fn pop_above(&mut self, block: usize, error: f32, worst: &[Option<Worst>]) -> Option<u32> {
        let heap = &mut self.blocks[block];
        while let Some(key) = heap.peek() {
            let (triangle, off) = (!(*key as u32), f32::from_bits((key >> 32) as u32));
            if off <= error {
                return None;
            }
            heap.pop();
            if worst[triangle as usize].is_some_and(|worst| worst.error == off) {
                return Some(triangle);
            }
        }
        None
    }

    /// Makes one queue for each block of the tile.
    fn cut(&mut self, tile: &Tile, worst: &[Option<Worst>]) {
        let blocks = |samples: usize| samples.div_ceil(1 << BLOCK);
        self.rows = Some([tile.stride as u32, blocks(tile.width) as u32]);
        let whole =
            std::mem::replace(&mut self.blocks, vec![BinaryHeap::new(); blocks(tile.width) * blocks(tile.height)]);
        for key in whole.into_iter().flat_map(BinaryHeap::into_vec) {
            let triangle = !(key as u32);
            if let Some(worst) = worst[triangle as usize]
                && worst.error.to_bits() == (key >> 32) as u32
            {
                self.push(triangle, worst);
            }
        }
    }
}

fn next(edge: u32) -> u32 {
    if edge % 3 == 2 { edge - 2 } else { edge + 1 }
}

fn previous(edge: u32) -> u32 {
    if edge.is_multiple_of(3) { edge + 2 } else { edge - 1 }
}

/// Twice the area of a triangle: positive if it is clockwise seen as a picture.
fn turn(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> i64 {
    let away = |p: [i32; 2]| [i64::from(p[0] - a[0]), i64::from(p[1] - a[1])];
    let ([bx, by], [cx, cy]) = (away(b), away(c));
    bx * cy - by * cx
}

/// Whether `p` lies within the circle around a triangle. Exact: a tile has far fewer than 2^15 samples a side.
fn within_circle([a, b, c]: [[i32; 2]; 3], p: [i32; 2]) -> bool {
    let seen = |q: [i32; 2]| {
        let [x, y] = [i64::from(q[0] - p[0]), i64::from(q[1] - p[1])];
        (x, y, x * x + y * y)
    };
    let ((ax, ay, a), (bx, by, b), (cx, cy, c)) = (seen(a), seen(b), seen(c));
    a * (bx * cy - by * cx) - b * (ax * cy - ay * cx) + c * (ax * by - ay * bx) > 0
}
