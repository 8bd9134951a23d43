//! Tiles are read by the text of the specification, and compared with their samples.

use super::*;
use std::collections::BTreeMap;

/// Hills at a zoom, as heights of global columns and rows; with cliffs.
fn height(column: i64, row: i64) -> f32 {
    let (x, y) = (column as f64, row as f64);
    let hills = 400.0 * libm::sin(x * 0.031) * libm::cos(y * 0.027) + 30.0 * libm::sin(x * 0.21 + y * 0.17);
    (hills + if x + 0.3 * y > 300.0 { 120.0 } else { 0.0 }) as f32
}

const ZOOM: u32 = 12;

/// The bytes of the tile in a column from the west and a row from the south.
fn tile(column: i64, row: i64, max_error: f64, of: impl Fn(i64, i64) -> f32) -> Vec<u8> {
    let side = 180.0 / f64::from(1 << ZOOM);
    let [west, south] = [column as f64 * side - 180.0, row as f64 * side - 90.0];
    let top = ((1 << ZOOM) - 1 - row) * CELLS as i64;
    let cells = |first: i64| first - 1..=first + CELLS as i64 + 1;
    let samples: Vec<f32> =
        cells(top).flat_map(|j| cells(column * CELLS as i64).map(move |i| (i, j))).map(|(i, j)| of(i, j)).collect();
    let tile = QuantizedTile {
        bounds: [west, south, west + side, south + side],
        samples: &samples,
        max_error,
        step: 0.5,
        has_normals: true,
        metadata: Some("{\"available\":[]}"),
    };
    tile.to_bytes(&Progress::none()).unwrap()
}

/// A tile that was read.
struct Read {
    center: Vector,
    range: [f64; 2],
    sphere: (Vector, f64),
    /// Columns, rows from the south and heights, each 0 to 32767.
    vertices: Vec<[u16; 3]>,
    triangles: Vec<[usize; 3]>,
    edges: [Vec<usize>; 4],
    normals: Vec<u8>,
    metadata: String,
}

struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (first, rest) = self.0.split_at(N);
        self.0 = rest;
        first.try_into().unwrap()
    }

    fn f64s<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| f64::from_le_bytes(self.take()))
    }

    fn u32(&mut self) -> usize {
        u32::from_le_bytes(self.take()) as usize
    }

    fn u16(&mut self) -> u16 {
        u16::from_le_bytes(self.take())
    }
}

fn read(bytes: &[u8]) -> Read {
    let length = bytes.len();
    let mut from = Bytes(bytes);
    let center = from.f64s();
    let range = [0; 2].map(|_| f64::from(f32::from_le_bytes(from.take())));
    let sphere = (from.f64s(), from.f64s::<1>()[0]);
    let occlusion: Vector = from.f64s();
    assert!(globe::length(occlusion) >= 1.0 - 1e-9);
    let count = from.u32();
    let mut vertices = vec![[0; 3]; count];
    for axis in 0..3 {
        let mut sum = 0i32;
        for vertex in &mut vertices {
            let code = i32::from(from.u16());
            sum += (code >> 1) ^ -(code & 1);
            vertex[axis] = u16::try_from(sum).unwrap();
        }
    }
    let is_wide = count > 65_536;
    if is_wide {
        let odd = (length - from.0.len()) % 4;
        from.0 = &from.0[(4 - odd) % 4..];
    }
    let index = |from: &mut Bytes| if is_wide { from.u32() } else { usize::from(from.u16()) };
    let mut highest = 0;
    let mut next = |from: &mut Bytes| {
        let code = index(from);
        let found = highest - code;
        highest += usize::from(code == 0);
        found
    };
    let triangles = (0..from.u32()).map(|_| [0; 3].map(|_| next(&mut from))).collect();
    let edges = [0; 4].map(|_| (0..from.u32()).map(|_| index(&mut from)).collect());
    assert_eq!((from.take(), from.u32()), ([NORMALS], 2 * count));
    let normals = from.0[..2 * count].to_vec();
    from.0 = &from.0[2 * count..];
    assert_eq!(from.take(), [METADATA]);
    let whole = from.u32();
    let own = from.u32();
    assert_eq!((whole, own), (from.0.len() + 4, from.0.len()));
    let metadata = String::from_utf8(from.0.to_vec()).unwrap();
    Read { center, range, sphere, vertices, triangles, edges, normals, metadata }
}

impl Read {
    fn height(&self, quantized: u16) -> f64 {
        self.range[0] + f64::from(quantized) / 32_767.0 * (self.range[1] - self.range[0])
    }

    /// The column, the row from the north and the height of a vertex.
    fn at(&self, vertex: usize) -> [f64; 3] {
        let [u, v, h] = self.vertices[vertex];
        let cell = |part: u16| (f64::from(part) / 32_767.0 * CELLS as f64).round();
        [cell(u), CELLS as f64 - cell(v), self.height(h)]
    }

    /// Positions along an edge, and heights in whole steps, with normals.
    fn edge(&self, edge: usize, along: usize) -> BTreeMap<u16, (i64, [u8; 2])> {
        let all = self.edges[edge].iter().map(|k| {
            let [u, v, h] = self.vertices[*k];
            let steps = self.height(h) / 0.5;
            assert!((steps - steps.round()).abs() < 1e-6, "{steps}");
            ([u, v][along], (steps.round() as i64, [self.normals[2 * k], self.normals[2 * k + 1]]))
        });
        all.collect()
    }
}

#[test]
fn a_mesh_is_within_its_error_at_every_sample_and_covers_the_tile_once() {
    for max_error in [1.0, 20.0] {
        let found = read(&tile(4096, 2048, max_error, height));
        assert!(found.vertices.len() > 50 && found.vertices.len() < 66_000);
        let mut seen = vec![0u32; (CELLS + 1) * (CELLS + 1)];
        let mut area = 0.0;
        for triangle in &found.triangles {
            let [a, b, c] = triangle.map(|k| found.at(k));
            let cross =
                |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            let flat = |p: [f64; 3]| [p[0], p[1]];
            // Counter-clockwise from above; rows count south.
            let twice = -cross(flat(a), flat(b), flat(c));
            assert!(twice > 0.0);
            area += twice / 2.0;
            let span = |axis: usize| {
                let parts = [a[axis], b[axis], c[axis]];
                (
                    parts.iter().copied().fold(f64::INFINITY, f64::min) as usize,
                    parts.iter().copied().fold(0.0, f64::max) as usize,
                )
            };
            let ((left, right), (top, bottom)) = (span(0), span(1));
            for row in top..=bottom {
                for column in left..=right {
                    let p = [column as f64, row as f64];
                    let weights = [cross(p, flat(b), flat(c)), cross(flat(a), p, flat(c)), cross(flat(a), flat(b), p)];
                    let weights = weights.map(|weight| -weight / twice);
                    if weights.iter().all(|weight| *weight >= 0.0) {
                        seen[row * (CELLS + 1) + column] += 1;
                        let mesh = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
                        let top = ((1 << ZOOM) - 1 - 2048) * CELLS;
                        let land = height((4096 * CELLS + column) as i64, (top + row) as i64);
                        assert!((mesh - f64::from(land)).abs() <= max_error + 1e-6, "{column} {row}: {mesh} {land}");
                    }
                }
            }
        }
        assert_eq!(area, (CELLS * CELLS) as f64);
        assert!(seen.iter().all(|count| *count > 0));
        assert_eq!(found.metadata, "{\"available\":[]}");
        // The sphere has all vertices.
        let side = 180.0 / f64::from(1 << ZOOM);
        for k in 0..found.vertices.len() {
            let [column, row, height] = found.at(k);
            let longitude = 4096.0 * side - 180.0 + column / CELLS as f64 * side;
            let latitude = 2049.0 * side - 90.0 - row / CELLS as f64 * side;
            let point = globe::point([longitude.to_radians(), latitude.to_radians()], height);
            assert!(globe::length(globe::minus(point, found.sphere.0)) <= found.sphere.1 + 1e-6);
        }
        assert_eq!(found.center, found.sphere.0);
    }
}

#[test]
fn neighbors_have_the_same_vertices_heights_and_normals_along_their_edge() {
    let at = |column, row| read(&tile(column, row, 5.0, height));
    let (own, east, north) = (at(4096, 2048), at(4097, 2048), at(4096, 2049));
    // West, south, east, north.
    assert!(own.edges.iter().all(|edge| edge.len() >= 2));
    assert_eq!(own.edge(2, 1), east.edge(0, 1));
    assert_eq!(own.edge(3, 0), north.edge(1, 0));
    assert!(own.edge(2, 1).len() > 5 && own.edge(2, 1) != own.edge(0, 1));
    let corners = own.edge(3, 0);
    assert!(corners.contains_key(&0) && corners.contains_key(&32_767));
}

#[test]
fn steps_are_whole_quantized_numbers() {
    for (low, high, steps, step) in [
        (0.0, 0.0, 7, 0.5),
        (-3.2, 9.9, 31, 0.5),
        (0.0, 500.0, 1057, 0.5),
        (-8000.0, 8300.0, MOST, 0.5),
        (0.0, 40_000.0, MOST, 2.0),
    ] {
        let heights = Heights::of([low, high].into_iter(), 0.5);
        assert_eq!((heights.steps, heights.step), (steps, step), "{low} {high}");
        assert!(heights.low <= f64::from(low) && heights.high() >= f64::from(high));
        assert!((heights.read(high) - f64::from(high)).abs() <= step / 2.0);
    }
}

#[test]
fn every_sample_of_rough_land_may_be_a_vertex() {
    let rough = |column: i64, row: i64| {
        let mixed = ((column << 20) ^ row).cast_unsigned().wrapping_mul(0x9E37_79B9_7F4A_7C15);
        ((mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f32 * 1e-3
    };
    let found = read(&tile(10, 20, 0.3, rough));
    assert!(found.vertices.len() > 65_536, "{}", found.vertices.len());
    assert_eq!(found.triangles.iter().flatten().max(), Some(&(found.vertices.len() - 1)));
}

#[test]
fn normals_point_up_and_lean_away_from_what_rises() {
    assert_eq!(oct([0.0, 0.0, 1.0]), [128, 128]);
    assert_eq!(oct([1.0, 0.0, 0.0]), [255, 128]);
    assert_eq!(oct([0.0, 0.0, -1.0]), [255, 255]);
    let side = 180.0 / 4096.0;
    let slope = |column: i64, _: i64| (column % 4096) as f32;
    let samples: Vec<f32> = (0..SIDE * SIDE).map(|k| slope((k % SIDE) as i64, 0)).collect();
    let tile = QuantizedTile {
        bounds: [0.0, 0.0, side, side],
        samples: &samples,
        max_error: 1.0,
        step: 0.5,
        has_normals: true,
        metadata: None,
    };
    // At 0 degrees east and north, x is up and y is east.
    let [x, y, z] = tile.normal(0, CELLS);
    let cell = (side / CELLS as f64).to_radians() * 6_378_137.0;
    assert!(x > 0.9 && (y / x + 1.0 / cell).abs() < 1e-9 && z.abs() < 1e-9, "{x} {y} {z}");
}

#[test]
fn samples_that_are_missing_are_refused() {
    let samples = vec![f32::NAN; SIDE * SIDE];
    let tile = QuantizedTile {
        bounds: [0.0, 0.0, 1.0, 1.0],
        samples: &samples,
        max_error: 1.0,
        step: 0.5,
        has_normals: false,
        metadata: None,
    };
    assert!(tile.to_bytes(&Progress::none()).unwrap_err().to_string().contains("finite samples"));
    assert!(QuantizedTile { samples: &[1.0], ..tile }.to_bytes(&Progress::none()).is_err());
}
