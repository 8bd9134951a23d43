//! Seams between a chunk and coarser neighbors.

use orogen_grid::grid::Grid;

/// Sides of a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Sides {
    /// The first row.
    pub north: bool,
    /// The last column.
    pub east: bool,
    /// The last row.
    pub south: bool,
    /// The first column.
    pub west: bool,
}

/// Closes the cracks between a chunk and coarser neighbors. Along the given sides every second sample, which the
/// neighbor lacks, is moved to the line between its two neighbors, which is the edge of the neighbor's triangle.
///
/// Shared samples do not change. They are equal unless the recipe has filters; with filters, use skirts instead.
pub fn stitch(grid: &mut Grid, sides: Sides) {
    let window = *grid.window();
    if window.is_empty() {
        return;
    }
    let (last_column, last_row) = (window.width - 1, window.height - 1);
    for (row, wanted) in [(0, sides.north), (last_row, sides.south)] {
        if wanted {
            let samples = grid.row_mut(row);
            for i in odd(window.x, window.width) {
                samples[i] = middle(samples[i - 1], samples[i + 1]);
            }
        }
    }
    for (column, wanted) in [(0, sides.west), (last_column, sides.east)] {
        if wanted {
            for j in odd(window.y, window.height) {
                let samples = middle(grid[(column, j - 1)], grid[(column, j + 1)]);
                grid.row_mut(j)[column] = samples;
            }
        }
    }
}

/// The samples at odd positions of the lattice, between others; a coarser lattice has the even ones.
fn odd(first: i64, count: usize) -> impl Iterator<Item = usize> {
    let start = if first.rem_euclid(2) == 0 { 1 } else { 2 };
    (start..count.saturating_sub(1)).step_by(2)
}

fn middle(a: f32, b: f32) -> f32 {
    0.5 * a + 0.5 * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    fn squares(window: Window) -> Grid {
        let square = |j: usize, i: usize| (window.east(i) * window.east(i) + 10.0 * window.south(j)) as f32;
        let data = (0..window.height).flat_map(|j| (0..window.width).map(move |i| square(j, i))).collect();
        Grid::from_data(window, data).unwrap()
    }

    #[test]
    fn a_seam_lies_on_the_coarser_edges() {
        let before = squares(Window::new(5, 5, 1.0).at(4, -8));
        let mut after = before.clone();
        stitch(&mut after, Sides { north: true, ..Sides::default() });
        // 16 25 36 49 64 becomes 16 26 36 50 64, over -80.
        assert_eq!(after.row(0), [-64.0, -54.0, -44.0, -30.0, -16.0]);
        assert!((1..5).all(|j| after.row(j) == before.row(j)));
        let mut east = before.clone();
        stitch(&mut east, Sides { east: true, ..Sides::default() });
        assert_eq!(east, before, "a straight column is on the line already");
        let mut all = before.clone();
        stitch(&mut all, Sides { north: true, east: true, south: true, west: true });
        for (j, i) in (0..5).flat_map(|j| (0..5).map(move |i| (j, i))) {
            let moved = all[(i, j)] != before[(i, j)];
            assert_eq!(moved, (j == 0 || j == 4) && i % 2 == 1, "({i}, {j})");
        }
    }

    #[test]
    fn a_cut_chunk_keeps_its_last_sample() {
        let before = squares(Window::new(4, 1, 1.0).at(2, 0));
        let mut after = before.clone();
        stitch(&mut after, Sides { south: true, ..Sides::default() });
        assert_eq!((after[(1, 0)], after[(3, 0)]), (10.0, before[(3, 0)]));
    }
}
