//! Adaptive meshes with a bounded vertical error.

use std::sync::{Mutex, PoisonError};

use orogen_grid::parallel;

use super::packed::PackedTriangles;
use super::shape::{Part, Shape, enough};
use super::tile::Tile;
use super::tin::{Workspace, triangulate};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;

/// Maximum number of cells of a tile along each side; larger grids are split. Coordinates within a tile must be small
/// enough for exact arithmetic in 64 bits, and a tile's data should fit in cache.
pub const TILE: usize = 1024;

/// A surface through some of the samples with a vertical error of at most `max_error` metres at every sample.
///
/// Greedy insertion (Garland and Heckbert, 1995) with edge flips that save vertices. With `max_error` at 1 % of the
/// relief, it has about a thirtieth of the full grid's triangles. Grids of more than 1024 cells a side are split into
/// tiles that are meshed in parallel. The vertices along an edge depend only on the samples of that edge, so tiles of a
/// grid fit without cracks, and so do meshes of windows that share an edge row. The result does not depend on the
/// number of threads.
///
/// # Errors
/// The grid has fewer than two columns or rows, or samples that are not finite; or `max_error` is negative or not
/// finite.
pub fn adaptive(grid: &Grid, max_error: f64) -> Result<Shape> {
    adaptive_with(grid, max_error, &Progress::none())
}

/// [`adaptive`] with progress and cancellation.
///
/// # Errors
/// The errors of [`adaptive`], and cancellation.
pub fn adaptive_with(grid: &Grid, max_error: f64, progress: &Progress) -> Result<Shape> {
    enough(grid)?;
    let refuse = |why: String| Err(Error::new(ErrorKind::Request, why));
    if !(max_error >= 0.0 && max_error.is_finite()) {
        return refuse(format!("the maximum error of a mesh must be at least 0 m, not {max_error}"));
    }
    let holes_of = |heights: &[f32]| heights.iter().filter(|height| !height.is_finite()).count();
    let holes: usize = parallel::map(grid.data().chunks(parallel::SAMPLES), holes_of).into_iter().sum();
    if holes > 0 {
        return refuse(format!(
            "{holes} of {} samples are nodata, and an adaptive mesh needs all samples; write the full grid instead (without --max-error), which omits triangles at nodata samples",
            grid.data().len()
        ));
    }
    let [across, down] = [cuts(grid.width()), cuts(grid.height())];
    let tiles: Vec<[[usize; 2]; 2]> = down
        .windows(2)
        .flat_map(|rows| across.windows(2).map(|columns| [[columns[0], rows[0]], [columns[1], rows[1]]]))
        .collect();
    progress.expect(tiles.len() as f64);
    // Buffers, one per thread, reused for one tile after another.
    let free: Mutex<Vec<(Vec<f32>, Workspace)>> = Mutex::default();
    // A panic of a thread that holds the lock leaves the data usable.
    let lock = || free.lock().unwrap_or_else(PoisonError::into_inner);
    let parts: Result<Vec<Part>> = parallel::try_map(tiles, |[[left, top], [right, bottom]]| {
        let (memory, mut workspace) = lock().pop().unwrap_or_default();
        let tile = Tile::of(grid, [left, top], [right - left + 1, bottom - top + 1], memory);
        let triangles = triangulate(&tile, max_error, &mut workspace, progress)?;
        // From clockwise in the picture, with y downward, to counter-clockwise from above.
        let triangles = PackedTriangles::new(triangles.map(|[a, b, c]| [a, c, b]));
        lock().push((tile.into_memory(), workspace));
        progress.advance(1.0);
        Ok(Part { corner: [left, top], triangles })
    });
    drop(free);
    Ok(Shape::joined([grid.width(), grid.height()], parts?))
}

/// The columns (or rows) at which this many samples are split evenly into tiles, including the first and the last.
fn cuts(samples: usize) -> Vec<usize> {
    let cells = samples - 1;
    let tiles = cells.div_ceil(TILE);
    (0..=tiles).map(|tile| (cells as u128 * tile as u128 / tiles as u128) as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;
    use std::collections::{BTreeMap, BTreeSet};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

    /// Hills with a valley between them, a cliff and a plain.
    fn land(width: usize, height: usize) -> Grid {
        land_at([0, 0], width, height)
    }

    fn land_at([left, top]: [i64; 2], width: usize, height: usize) -> Grid {
        let window = Window::new(width, height, 10.0).at(left, top);
        let mut data = Vec::new();
        for j in 0..height as i64 {
            for i in 0..width as i64 {
                let (x, y) = ((left + i) as f64, (top + j) as f64);
                let hills = 300.0 * libm::sin(x * 0.041) * libm::cos(y * 0.037) + 60.0 * libm::sin(x * 0.23 + y * 0.17);
                let cliff = if x + 0.3 * y > 90.0 { 80.0 } else { 0.0 };
                data.push((hills.max(-100.0) + cliff) as f32);
            }
        }
        Grid::from_data(window, data).unwrap()
    }

    fn triangles(shape: &Shape, grid: &Grid) -> Vec<[u32; 3]> {
        let mut all = Vec::new();
        (0..shape.pieces()).for_each(|piece| shape.piece(grid, piece, |triangle| all.push(triangle)));
        assert_eq!(all.len(), shape.triangles());
        all
    }

    /// Checks that all triangles face up, cover the grid once and share their edges; returns the vertices along the
    /// grid's border.
    fn check(shape: &Shape, grid: &Grid) -> BTreeSet<[usize; 2]> {
        let [east, south] = [grid.width() - 1, grid.height() - 1];
        let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        let (mut area, mut used) = (0, BTreeSet::new());
        for triangle in triangles(shape, grid) {
            let [a, b, c] = triangle.map(|corner| shape.sample(corner).map(|place| place as i64));
            let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(turn < 0, "counter-clockwise from above");
            area -= turn;
            for [from, to] in [[0, 1], [1, 2], [2, 0]] {
                assert_eq!(
                    edges.insert([triangle[from], triangle[to]], 1),
                    None,
                    "an edge has one triangle on each side"
                );
            }
            used.extend(triangle);
        }
        assert_eq!(area as usize, 2 * east * south);
        assert_eq!(used.len(), shape.corners());
        let mut border = BTreeSet::new();
        for [from, to] in edges.keys() {
            if !edges.contains_key(&[*to, *from]) {
                let [a, b] = [shape.sample(*from), shape.sample(*to)];
                let along = |axis: usize, at: usize| a[axis] == at && b[axis] == at;
                assert!(along(0, 0) || along(0, east) || along(1, 0) || along(1, south), "a crack from {a:?} to {b:?}");
                border.extend([a, b]);
            }
        }
        border
    }

    #[test]
    fn no_sample_is_further_than_allowed() {
        let grid = land(200, 150);
        let mut before = usize::MAX;
        for max_error in [0.0, 0.01, 1.0, 4.0, 20.0, 100.0, 1e4] {
            let shape = adaptive(&grid, max_error).unwrap();
            check(&shape, &grid);
            assert!(shape.deviation(&grid) <= max_error + 1e-9, "{} over {max_error}", shape.deviation(&grid));
            assert!(shape.triangles() <= before);
            before = shape.triangles();
        }
        assert_eq!(before, 2);
        let few = adaptive(&grid, 4.0).unwrap().triangles();
        assert!(few < 199 * 149 * 2 / 4, "{few} triangles");
    }

    #[test]
    fn windows_that_share_an_edge_have_the_same_corners_on_it() {
        let [west, east] = [land_at([0, 0], 101, 80), land_at([100, 0], 90, 80)];
        let [left, right] = [adaptive(&west, 5.0).unwrap(), adaptive(&east, 5.0).unwrap()];
        let rows = |border: BTreeSet<[usize; 2]>, column: usize| -> Vec<usize> {
            border.into_iter().filter(|place| place[0] == column).map(|place| place[1]).collect()
        };
        let shared = rows(check(&left, &west), 100);
        assert_eq!(shared, rows(check(&right, &east), 0));
        assert!(shared.len() > 4, "{shared:?}");
    }

    #[test]
    fn a_grid_of_several_tiles_has_no_cracks_on_any_number_of_threads() {
        let grid = land(1500, 1300);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| adaptive(&grid, 30.0)).unwrap()
        };
        let shape = on(1);
        check(&shape, &grid);
        assert!(shape.deviation(&grid) <= 30.0);
        assert_eq!(shape, on(3));
    }

    #[test]
    fn work_that_is_stopped_ends_soon() {
        let grid = land(900, 900);
        let (stop, done) = (Arc::new(AtomicBool::new(true)), Arc::new(AtomicUsize::new(0)));
        let told = Arc::clone(&done);
        let progress = Progress::new(move |_| _ = told.fetch_add(1, Ordering::Relaxed)).stopped_by(stop);
        let error = adaptive_with(&grid, 0.001, &progress).unwrap_err();
        assert_eq!((error.kind(), done.load(Ordering::Relaxed)), (ErrorKind::Cancelled, 0), "no tile is made");
    }

    #[test]
    fn flat_and_level_ground_is_two_triangles() {
        for (width, height) in [(2, 2), (2, 9), (9, 2), (3, 3), (700, 900), (2000, 3)] {
            let flat = Grid::filled(Window::new(width, height, 5.0), 12.5);
            let shape = adaptive(&flat, 0.0).unwrap();
            let tiles = width.div_ceil(TILE + 1) * height.div_ceil(TILE + 1);
            assert_eq!(shape.triangles(), 2 * tiles, "{width} x {height}");
            assert_eq!(check(&shape, &flat).len(), shape.corners());
        }
    }

    #[test]
    fn extreme_heights_are_handled() {
        for scale in [5e35f32, 1e-36, 1e-42] {
            let mut grid = land(40, 40);
            grid.data_mut().iter_mut().for_each(|height| *height *= scale);
            let max_error = 5.0 * f64::from(scale);
            let shape = adaptive(&grid, max_error).unwrap();
            check(&shape, &grid);
            let off = shape.deviation(&grid);
            assert!(off <= max_error * (1.0 + 1e-9), "{off} over {max_error}");
            assert!(shape.triangles() > 100);
        }
        let mut high = land(40, 40);
        high.data_mut().iter_mut().for_each(|height| *height += 8e6);
        let shape = adaptive(&high, 1.0).unwrap();
        // The rounding error of the sum of three such heights in f64.
        assert!(shape.deviation(&high) <= 1.0 + 1e-8);
    }

    #[test]
    fn what_cannot_be_is_a_sentence() {
        let says = |grid: &Grid, max_error: f64, expect: &str| {
            let error = adaptive(grid, max_error).unwrap_err().to_string();
            assert!(error.contains(expect), "{error}");
        };
        says(&land(1, 50), 1.0, "at least 2 x 2 samples, and there are 1 x 50");
        says(&land(50, 1), 1.0, "50 x 1");
        says(&land(5, 5), -1.0, "at least 0 m, not -1");
        says(&land(5, 5), f64::NAN, "not NaN");
        let mut holes = land(5, 5);
        holes.row_mut(2)[3] = f32::NAN;
        says(&holes, 1.0, "1 of 25 samples are nodata");
    }

    #[test]
    fn lattices_leave_out_what_touches_a_hole() {
        let grid = land(9, 7);
        let full = Shape::lattice(&grid, 1).unwrap();
        assert_eq!((full.corners(), full.triangles()), (63, 96));
        check(&full, &grid);
        assert_eq!(full.deviation(&grid), 0.0);
        let coarse = Shape::lattice(&grid, 3).unwrap();
        assert_eq!((coarse.corners(), coarse.triangles()), (4 * 3, 12));
        check(&coarse, &grid);
        let corner = Shape::lattice(&grid, 100).unwrap();
        assert_eq!(corner.triangles(), 2);

        let mut holes = grid.clone();
        holes.row_mut(3)[4] = f32::INFINITY;
        holes.row_mut(0)[0] = f32::NAN;
        let shape = Shape::lattice(&holes, 1).unwrap();
        // Four cells lose one triangle each, and the cell at the corner loses one.
        assert_eq!((shape.corners(), shape.triangles()), (61, 91));
        for triangle in triangles(&shape, &holes) {
            for corner in triangle {
                let [column, row] = shape.sample(corner);
                assert!(holes[(column, row)].is_finite());
            }
        }
        let mut lonely = Grid::filled(Window::new(3, 3, 1.0), f32::NAN);
        lonely.row_mut(1)[1] = 1.0;
        assert!(Shape::lattice(&lonely, 1).unwrap_err().to_string().contains("no three neighboring samples"));
    }
}
