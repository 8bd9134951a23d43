//! Search for the sample with the largest vertical distance from a triangle.

use orogen_simd::{Body, F32Lanes, Simd, U32Lanes, dispatch};

use super::tile::{Sample, Tile};

/// Maximum number of lanes of a register.
const LANES: usize = 16;

/// A triangle with at most this many samples in a row is processed sample by sample.
const NARROW: i32 = 4;

/// Tests every sample of a triangle, except its vertices and the tile's border. A sample on an edge belongs to the
/// triangle west of it, on a horizontal edge to the one south of it, so it is tested exactly once.
///
/// Computes in f32, with the same bits at any SIMD level. Of equal distances the first, row by row, is returned.
#[inline]
pub(super) fn furthest(tile: &Tile, corners: [Sample; 3]) -> Worst {
    let [a, b, c] = corners.map(Sample::place);
    let [east, south] = [0, 1].map(|axis| [b[axis] - a[axis], c[axis] - a[axis]]);
    // By Pick's theorem a triangle with this area has no samples except its vertices.
    if (east[0] * south[1] - east[1] * south[0]).abs() == 1 {
        return Worst::NONE;
    }
    let [least, most] = [east[0].min(east[1]).min(0), east[0].max(east[1]).max(0)];
    match most - least <= NARROW {
        true => one_by_one(tile, [a, b, c]),
        false => dispatch(Scan { tile, corners: [a, b, c] }),
    }
}

/// The vectorised part of [`furthest`].
struct Scan<'a> {
    tile: &'a Tile,
    /// Columns and rows of the vertices.
    corners: [[i32; 2]; 3],
}

/// A sample and its distance from the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Worst {
    /// Vertical distance, in metres.
    pub error: f32,
    pub at: Sample,
}

impl Worst {
    /// The result for a triangle without samples.
    pub const NONE: Worst = Worst { error: 0.0, at: Sample::FIRST };
    /// The result for a triangle that was not scanned.
    pub const UNKNOWN: Worst = Worst { error: -1.0, at: Sample::FIRST };
}

/// The vertices from north to south, and derived values.
struct Triangle {
    corners: [[i32; 2]; 3],
    /// The height of the first vertex, and the rise per column and row.
    height: f64,
    rise: [f64; 2],
    /// Whether the middle vertex is east of the long edge.
    middle_east: bool,
    /// The first and the last row to scan.
    rows: [i32; 2],
}

impl Triangle {
    /// `None` if there is no row to scan.
    #[inline(always)]
    fn new(tile: &Tile, corners: [[i32; 2]; 3]) -> Option<Triangle> {
        // Vertices of the same row keep their order. Branchless, because the branch would be unpredictable.
        let mut keys = [0, 1, 2].map(|k| {
            let corner = corners[k];
            (corner[1] as u64) << 34 | (k as u64) << 32 | u64::from(Sample::at(corner).number())
        });
        for [a, b] in [[0, 1], [1, 2], [0, 1]] {
            (keys[a], keys[b]) = (keys[a].min(keys[b]), keys[a].max(keys[b]));
        }
        let corners = keys.map(|key| Sample::from_number(key as u32).place());
        let [a, b, c] = corners;
        let first = if a[1] == b[1] { a[1] } else { a[1] + 1 };
        let rows = [first.max(1), (c[1] - 1).min(tile.height as i32 - 2)];
        if rows[0] > rows[1] {
            return None;
        }
        let away = |p: [i32; 2]| [f64::from(p[0] - a[0]), f64::from(p[1] - a[1])];
        let ([bx, by], [cx, cy]) = (away(b), away(c));
        // Exact: the differences are small integers.
        let area = bx * cy - by * cx;
        let height = f64::from(tile.at(a));
        let [b, c] = [b, c].map(|p| f64::from(tile.at(p)) - height);
        let rise = [(b * cy - c * by) / area, (c * bx - b * cx) / area];
        Some(Triangle { corners, height, rise, middle_east: area > 0.0, rows })
    }

    /// The height of the surface at a sample.
    #[inline(always)]
    fn surface(&self, column: i32, row: i32) -> f64 {
        let [x, y] = self.corners[0];
        self.height + (self.rise[1] * f64::from(row - y) + self.rise[0] * f64::from(column - x))
    }
}

/// The rows of a triangle, from the north.
struct Spans<'a> {
    triangle: &'a Triangle,
    /// The next row, and the last one before the short edge changes.
    row: i32,
    until: i32,
    /// The tile's last column but one.
    east: i32,
    long: Edge,
    short: Edge,
}

impl<'a> Spans<'a> {
    #[inline(always)]
    fn new(triangle: &'a Triangle, tile: &Tile) -> Spans<'a> {
        let [a, b, c] = triangle.corners;
        let [row, last] = triangle.rows;
        let (short, until) = match row < b[1] {
            true => (Edge::new(a, b, row), last.min(b[1] - 1)),
            false => (Edge::new(b, c, row), last),
        };
        Spans { triangle, row, until, east: tile.width as i32 - 2, long: Edge::new(a, c, row), short }
    }

    /// The next row, and its first and its last column; the last is before the first if the row is empty.
    ///
    /// Not an `Iterator`: a loop over one would not be compiled with the level's instructions.
    #[inline(always)]
    fn next(&mut self) -> Option<[i32; 3]> {
        let row = self.row;
        if row > self.until {
            let last = self.triangle.rows[1];
            if row > last {
                return None;
            }
            let [_, b, c] = self.triangle.corners;
            (self.short, self.until) = (Edge::new(b, c, row), last);
        }
        let [west, east] = match self.triangle.middle_east {
            true => [self.long.column, self.short.column],
            false => [self.short.column, self.long.column],
        };
        self.row += 1;
        self.long.step();
        self.short.step();
        Some([row, (west + 1).max(1), east.min(self.east)])
    }
}

/// The column at or west of an edge, computed exactly for one row after another.
struct Edge {
    column: i32,
    /// The distance of the edge east of that column, in units of 1 / `down`.
    part: i32,
    /// The increments of both per row.
    step: [i32; 2],
    /// Number of rows of the edge.
    down: i32,
}

impl Edge {
    /// The edge from `a` down to `b`, at row `y`.
    #[inline(always)]
    fn new(a: [i32; 2], b: [i32; 2], y: i32) -> Edge {
        let (right, down, skip) = (b[0] - a[0], b[1] - a[1], y - a[1]);
        let step = [right.div_euclid(down), right.rem_euclid(down)];
        let mut edge = Edge { column: a[0], part: 0, step, down };
        if skip == 1 {
            edge.step();
        } else if skip > 1 {
            edge.column += (skip * right).div_euclid(down);
            edge.part = (skip * right).rem_euclid(down);
        }
        edge
    }

    #[inline(always)]
    fn step(&mut self) {
        self.column += self.step[0];
        self.part += self.step[1];
        // Branchless, because the branch would be unpredictable.
        let carry = i32::from(self.part >= self.down);
        self.column += carry;
        self.part -= self.down * carry;
    }
}

impl Body for Scan<'_> {
    type Output = Worst;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Worst {
        let tile = self.tile;
        let Some(triangle) = Triangle::new(tile, self.corners) else { return Worst::NONE };
        let heights = tile.heights();
        let rise = simd.f32(triangle.rise[0] as f32);
        let (iota, lanes) = (simd.iota().i32_to_f32(), simd.f32(S::LANES as f32));
        let zero = simd.f32(0.0);
        let (mut worst, mut at) = (zero, simd.u32(0));
        let mut spans = Spans::new(&triangle, tile);
        while let Some([row, west, east]) = spans.next() {
            let mut left = east - west + 1;
            if left <= 0 {
                continue;
            }
            let mut first = row as usize * tile.stride + west as usize;
            let start = simd.f32(triangle.surface(west, row) as f32);
            let mut away = iota;
            let mut number = Sample::at([west, row]).number();
            while left > 0 {
                let error = ((start + rise * away) - simd.load(&heights[first..first + S::LANES])).abs();
                let error = match left >= S::LANES as i32 {
                    true => error,
                    false => error.select(iota.lt(simd.f32(left as f32)), zero),
                };
                let further = worst.lt(error);
                worst = error.select(further, worst);
                at = simd.u32(number).select(further, at);
                left -= S::LANES as i32;
                first += S::LANES;
                number += S::LANES as u32;
                away = away + lanes;
            }
        }
        let (mut errors, mut places) = ([0.0; LANES], [0; LANES]);
        worst.store(&mut errors);
        at.store(&mut places);
        let mut found = Worst::NONE;
        for (lane, (&error, &place)) in errors.iter().zip(&places).enumerate().take(S::LANES) {
            let at = Sample::from_number(place + lane as u32);
            if error > found.error || error == found.error && at < found.at {
                found = Worst { error, at };
            }
        }
        found
    }
}

/// [`furthest`], sample by sample.
fn one_by_one(tile: &Tile, corners: [[i32; 2]; 3]) -> Worst {
    let Some(triangle) = Triangle::new(tile, corners) else { return Worst::NONE };
    let rise = triangle.rise[0] as f32;
    let mut worst = Worst::NONE;
    let mut spans = Spans::new(&triangle, tile);
    while let Some([row, west, east]) = spans.next() {
        if west > east {
            continue;
        }
        let start = triangle.surface(west, row) as f32;
        for column in west..=east {
            let error = ((start + rise * (column - west) as f32) - tile.at([column, row])).abs();
            if error > worst.error {
                worst = Worst { error, at: Sample::at([column, row]) };
            }
        }
    }
    worst
}

/// [`furthest`] in f64: for distances close to the rounding of f32, and for very large heights.
pub(super) fn exactly(tile: &Tile, corners: [Sample; 3]) -> Worst {
    let corners = corners.map(Sample::place);
    let Some(triangle) = Triangle::new(tile, corners) else { return Worst::NONE };
    let (mut worst, mut at) = (0.0, Sample::FIRST);
    let mut spans = Spans::new(&triangle, tile);
    while let Some([row, west, east]) = spans.next() {
        for column in west..=east {
            let error = (triangle.surface(column, row) - f64::from(tile.at([column, row]))).abs();
            // A vertex is on the surface; rounding must not say otherwise.
            if error > worst && !corners.contains(&[column, row]) {
                (worst, at) = (error, Sample::at([column, row]));
            }
        }
    }
    Worst { error: worst as f32, at }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::{Grid, Window};
    use orogen_simd::{Level, dispatch_at};

    fn bumpy(side: usize) -> Tile {
        let data =
            (0..side * side).map(|i| 1000.0 + ((i as u32).wrapping_mul(2_654_435_761) >> 20) as f32 / 7.0).collect();
        Tile::of(&Grid::from_data(Window::new(side, side, 1.0), data).unwrap(), [0, 0], [side, side], Vec::new())
    }

    fn cross(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> i64 {
        i64::from(b[0] - a[0]) * i64::from(c[1] - a[1]) - i64::from(b[1] - a[1]) * i64::from(c[0] - a[0])
    }

    /// Triangles of all kinds: wide, tall, thin, horizontal at the top or the bottom, at the tile's border.
    fn triangles(side: i32) -> Vec<[[i32; 2]; 3]> {
        let mut state = 1u32;
        let mut draw = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) % side as u32) as i32
        };
        let mut triangles =
            vec![[[0, 0], [side - 1, 0], [0, side - 1]], [[1, 1], [2, 1], [1, 2]], [[0, 3], [40, 3], [7, 4]]];
        while triangles.len() < 400 {
            let corners = [[draw(), draw()], [draw(), draw()], [draw(), draw()]];
            if cross(corners[0], corners[1], corners[2]) != 0 {
                triangles.push(corners);
            }
        }
        triangles
    }

    #[test]
    fn every_level_finds_the_sample_that_a_plain_search_finds() {
        let side = 61;
        let tile = bumpy(side as usize);
        for corners in triangles(side) {
            let mut worst = 0.0f64;
            let [a, b, c] = corners;
            let area = cross(a, b, c) as f64;
            for y in 1..side - 1 {
                for x in 1..side - 1 {
                    let p = [x, y];
                    let parts = [cross(b, c, p), cross(c, a, p), cross(a, b, p)].map(|part| part as f64 / area);
                    if parts.iter().all(|part| *part > 0.0) {
                        let surface: f64 = parts.iter().zip(corners).map(|(w, q)| w * f64::from(tile.at(q))).sum();
                        worst = worst.max((surface - f64::from(tile.at(p))).abs());
                    }
                }
            }
            let found = exactly(&tile, corners.map(Sample::at));
            // Samples on an edge may be at a larger distance than those inside.
            assert!(f64::from(found.error) >= worst - 1e-3, "{corners:?}");
            for level in Level::available() {
                let quick = dispatch_at(level, Scan { tile: &tile, corners }).unwrap();
                assert!((quick.error - found.error).abs() < 2e-3, "{corners:?} {level:?}: {quick:?} {found:?}");
                assert_eq!(quick, dispatch_at(Level::Scalar, Scan { tile: &tile, corners }).unwrap(), "{level:?}");
                assert_eq!(quick, one_by_one(&tile, corners), "{level:?}");
            }
            assert_eq!(furthest(&tile, corners.map(Sample::at)), one_by_one(&tile, corners), "{corners:?}");
        }
    }

    /// Two triangles with a shared edge together visit every sample inside their square once.
    #[test]
    fn neighbors_leave_no_sample_out() {
        let side = 40;
        let tile = bumpy(side as usize);
        for [from, to] in [[[5, 5], [30, 22]], [[30, 3], [5, 35]], [[5, 20], [30, 20]], [[17, 2], [17, 37]]] {
            let mut seen = vec![0; (side * side) as usize];
            let inside = [[1, 21], [38, 1], [38, 38], [2, 37], [20, 2], [20, 38], [1, 1]];
            let (left, right): (Vec<[i32; 2]>, Vec<[i32; 2]>) = inside.iter().partition(|p| cross(from, to, **p) > 0);
            for third in [left[0], right[0]] {
                let triangle = Triangle::new(&tile, [from, to, third]).unwrap();
                let mut spans = Spans::new(&triangle, &tile);
                while let Some([row, west, east]) = spans.next() {
                    for column in west..=east {
                        seen[(row * side + column) as usize] += 1;
                    }
                }
            }
            for y in 1..side - 1 {
                for x in 1..side - 1 {
                    let p = [x, y];
                    let on_edge = cross(from, to, p) == 0;
                    let within = [left[0], right[0]].iter().any(|&third| {
                        let turn = cross(from, to, third).signum();
                        [[from, to], [to, third], [third, from]].iter().all(|&[a, b]| cross(a, b, p) * turn >= 0)
                            && (on_edge || cross(from, to, p) * turn > 0)
                            && cross(to, third, p) * turn > 0
                            && cross(third, from, p) * turn > 0
                    });
                    let times = seen[(y * side + x) as usize];
                    assert!(times <= 1, "{p:?} is seen {times} times");
                    assert!(times == 1 || !within, "{p:?} is not seen");
                }
            }
        }
    }
}
