//! Grids as arrays of the crate `ndarray` with two axes, (row, column), in row-major order.

use ::ndarray::{Array2, ArrayView2, ArrayViewMut2};

use crate::{Grid, Window};

/// The samples as an array indexed by (row, column), without a copy.
///
/// ```
/// use ndarray::{ArrayView2, Axis};
/// use orogen_grid::{Grid, Window};
///
/// let mut grid = Grid::filled(Window::new(3, 2, 10.0), 1.0);
/// grid[(2, 0)] = 4.0;
/// let array = ArrayView2::from(&grid);
/// assert_eq!(array[[0, 2]], 4.0);
/// assert_eq!(array.sum_axis(Axis(1)).to_vec(), [6.0, 3.0]);
/// ```
impl<'a, T: Copy> From<&'a Grid<T>> for ArrayView2<'a, T> {
    fn from(grid: &'a Grid<T>) -> ArrayView2<'a, T> {
        let none: &'a [[T; 0]] = &[];
        // This fails only if a grid without samples has more rows or columns than an array supports.
        ArrayView2::from_shape((grid.height(), grid.width()), grid.data()).unwrap_or_else(|_| none.into())
    }
}

/// The samples as a mutable array indexed by (row, column), without a copy.
impl<'a, T: Copy> From<&'a mut Grid<T>> for ArrayViewMut2<'a, T> {
    fn from(grid: &'a mut Grid<T>) -> ArrayViewMut2<'a, T> {
        let none: &'a mut [[T; 0]] = &mut [];
        let shape = (grid.height(), grid.width());
        ArrayViewMut2::from_shape(shape, grid.data_mut()).unwrap_or_else(|_| none.into())
    }
}

/// The samples as an array indexed by (row, column), without a copy. The window is dropped.
impl<T: Copy> From<Grid<T>> for Array2<T> {
    fn from(grid: Grid<T>) -> Array2<T> {
        let none: &[[T; 0]] = &[];
        let shape = (grid.height(), grid.width());
        Array2::from_shape_vec(shape, grid.into_data()).unwrap_or_else(|_| ArrayView2::from(none).to_owned())
    }
}

impl<T: Copy> Grid<T> {
    /// A grid over an array indexed by (row, column); `None` if the array does not have the rows and columns of
    /// `window`. An array in row-major order is not copied.
    ///
    /// ```
    /// use ndarray::array;
    /// use orogen_grid::{Grid, Window};
    ///
    /// let grid = Grid::from_array(Window::new(3, 2, 10.0), array![[0, 1, 2], [3, 4, 5]]).ok_or("another shape")?;
    /// assert_eq!(grid[(2, 1)], 5);
    /// # Ok::<(), &str>(())
    /// ```
    #[must_use]
    pub fn from_array(window: Window, array: Array2<T>) -> Option<Grid<T>> {
        if array.dim() != (window.height, window.width) {
            return None;
        }
        let data = match array.is_standard_layout() {
            // If the array was sliced, its memory may contain samples before the first one or after the last one.
            true => match array.into_raw_vec_and_offset() {
                (data, None | Some(0)) if data.len() == window.len() => data,
                (data, offset) => data.into_iter().skip(offset.unwrap_or(0)).take(window.len()).collect(),
            },
            false => array.iter().copied().collect(),
        };
        Grid::from_data(window, data)
    }
}

#[cfg(test)]
mod tests {
    use ::ndarray::{Array2, ArrayView2, ArrayViewMut2, Axis, Slice, array};

    use crate::{Grid, Window};

    const WINDOW: Window = Window { x: 5, y: -2, width: 3, height: 2, cell: 10.0 };

    fn grid() -> Grid<i32> {
        Grid::from_data(WINDOW, vec![0, 1, 2, 10, 11, 12]).unwrap()
    }

    #[test]
    fn rows_come_first() {
        let mut grid = grid();
        let array = array![[0, 1, 2], [10, 11, 12]];
        assert_eq!(ArrayView2::from(&grid), array);
        assert_eq!(Array2::from(grid.clone()), array);
        ArrayViewMut2::from(&mut grid)[[1, 0]] = 7;
        assert_eq!(grid[(0, 1)], 7);
    }

    #[test]
    fn there_and_back() {
        assert_eq!(Grid::from_array(WINDOW, Array2::from(grid())), Some(grid()));
        // An array in column-major order, and a part of a larger array.
        let columns = array![[0, 10], [1, 11], [2, 12]].reversed_axes();
        assert!(!columns.is_standard_layout());
        assert_eq!(Grid::from_array(WINDOW, columns), Some(grid()));
        let mut larger = array![[9, 9, 9], [0, 1, 2], [10, 11, 12], [9, 9, 9]];
        larger.slice_axis_inplace(Axis(0), Slice::from(1..3));
        assert_eq!(Grid::from_array(WINDOW, larger), Some(grid()));
    }

    #[test]
    fn another_shape_is_refused() {
        assert_eq!(Grid::from_array(WINDOW, Array2::from_elem((3, 2), 0)), None);
        assert_eq!(Grid::from_array(WINDOW, Array2::from_elem((2, 4), 0)), None);
    }

    #[test]
    fn no_samples() {
        for (rows, columns) in [(0, 0), (0, 4), (4, 0)] {
            let empty = Grid::filled(Window::new(columns, rows, 1.0), 0u8);
            assert_eq!(ArrayView2::from(&empty).dim(), (rows, columns));
            assert_eq!(Grid::from_array(*empty.window(), Array2::from(empty.clone())), Some(empty));
        }
        let uncountable = Grid::filled(Window::new(0, usize::MAX, 1.0), 0u8);
        assert!(ArrayView2::from(&uncountable).is_empty());
        assert!(Array2::from(uncountable).is_empty());
    }
}
