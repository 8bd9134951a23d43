//! Windows and positions as points and vectors of the crate `mint`, which glam, nalgebra, cgmath and others can
//! convert.

use ::mint::{Point2, Vector2};

use crate::Window;

impl Window {
    /// The position of sample (i, j), in metres: x points east, y points south.
    ///
    /// ```
    /// use mint::{Point2, Vector2};
    /// use orogen_grid::Window;
    ///
    /// let window = Window::new(65, 33, 10.0).at(100, -50);
    /// assert_eq!(window.point(Vector2 { x: 1, y: 2 }), Point2 { x: 1010.0, y: -480.0 });
    /// ```
    #[must_use]
    pub fn point(&self, sample: Vector2<usize>) -> Point2<f64> {
        Point2 { x: self.east(sample.x), y: self.south(sample.y) }
    }

    /// The positions of the first and the last sample, in metres; equal if the window has at most one sample.
    ///
    /// ```
    /// use mint::Point2;
    /// use orogen_grid::Window;
    ///
    /// let [first, last] = Window::new(65, 33, 10.0).at(100, -50).corners();
    /// assert_eq!((first, last), (Point2 { x: 1000.0, y: -500.0 }, Point2 { x: 1640.0, y: -180.0 }));
    /// ```
    #[must_use]
    pub fn corners(&self) -> [Point2<f64>; 2] {
        let last = Vector2 { x: self.width.saturating_sub(1), y: self.height.saturating_sub(1) };
        [self.point(Vector2 { x: 0, y: 0 }), self.point(last)]
    }

    /// Number of columns and rows.
    #[must_use]
    pub fn size(&self) -> Vector2<usize> {
        Vector2 { x: self.width, y: self.height }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_positions_of_samples_even_without_samples() {
        let window = Window::new(4, 3, 2.5).at(-2, 7);
        let [first, last] = window.corners();
        assert_eq!([first.x, first.y], [window.east(0), window.south(0)]);
        assert_eq!([last.x, last.y], [window.east(3), window.south(2)]);
        assert_eq!(window.size(), Vector2 { x: 4, y: 3 });
        let [first, last] = Window::new(0, 5, 2.5).corners();
        assert_eq!((first, last), (Point2 { x: 0.0, y: 0.0 }, Point2 { x: 0.0, y: 10.0 }));
    }
}
