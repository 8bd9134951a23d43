//! The occupied parts of a sheet, and which line passes where, on a grid of squares.

use super::geometry::{Point, Rect};

/// Side of a square in millimetres.
const SQUARE: f32 = 0.4;

/// Squares over a rectangle, each with a value.
#[derive(Debug, Clone)]
struct Squares<T> {
    columns: usize,
    rows: usize,
    values: Vec<T>,
    origin: Point,
}

impl<T: Copy> Squares<T> {
    fn filled(area: Rect, value: T) -> Squares<T> {
        let [columns, rows] = [area.width, area.height].map(|side| (side / SQUARE).floor().max(0.0) as usize);
        Squares { columns, rows, values: vec![value; columns * rows], origin: area.corner() }
    }

    fn at(&self, place: Point) -> Option<usize> {
        let way = self.origin.to(place);
        let [i, j] = [way.x, way.y].map(|side| (side / SQUARE).floor());
        let inside = (0.0..self.columns as f32).contains(&i) && (0.0..self.rows as f32).contains(&j);
        inside.then(|| j as usize * self.columns + i as usize)
    }

    /// The squares within `reach` of a point; `None` for squares outside the rectangle.
    fn around(&self, place: Point, reach: f32) -> impl Iterator<Item = Option<usize>> + '_ {
        let steps = (reach / SQUARE).ceil() as i32;
        (-steps..=steps)
            .flat_map(move |v| (-steps..=steps).map(move |u| [u as f32 * SQUARE, v as f32 * SQUARE]))
            .filter(move |[u, v]| u * u + v * v <= reach * reach)
            .map(move |[u, v]| self.at(place.moved(u, v)))
    }
}

/// Calls `each` with points along a line, at most a square apart.
fn along(line: &[Point], mut each: impl FnMut(Point)) {
    for pair in line.windows(2) {
        let steps = (pair[0].distance(pair[1]) / SQUARE).ceil().clamp(1.0, 1e4) as usize;
        for k in 0..=steps {
            each(pair[0].toward(pair[1], k as f32 / steps as f32));
        }
    }
}

/// The occupied parts of a sheet, where no label may be placed.
#[derive(Debug, Clone)]
pub struct Taken(Squares<bool>);

impl Taken {
    /// An empty rectangle. Everything outside it counts as occupied.
    pub fn none(area: Rect) -> Taken {
        Taken(Squares::filled(area, false))
    }

    /// Marks everything within `reach` of a point as occupied.
    pub fn take(&mut self, place: Point, reach: f32) {
        let found: Vec<usize> = self.0.around(place, reach).flatten().collect();
        found.into_iter().for_each(|square| self.0.values[square] = true);
    }

    /// Marks a line as occupied.
    pub fn take_line(&mut self, line: &[Point], reach: f32) {
        along(line, |place| self.take(place, reach));
    }

    /// Whether everything within `reach` of a point is free.
    pub fn is_free(&self, place: Point, reach: f32) -> bool {
        self.0.around(place, reach).all(|square| square.is_some_and(|square| !self.0.values[square]))
    }
}

/// Which of several lines passes through each square.
#[derive(Debug, Clone)]
pub struct Passing(Squares<u32>);

/// No line, and several lines.
const NONE: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

impl Passing {
    /// The squares through which these lines pass. Lines are numbered in their order.
    pub fn of<'a>(area: Rect, lines: impl Iterator<Item = &'a [Point]>) -> Passing {
        let mut passing = Passing(Squares::filled(area, NONE));
        for (line, nth) in lines.zip(0u32..SEVERAL) {
            along(line, |place| {
                if let Some(square) = passing.0.at(place) {
                    let value = &mut passing.0.values[square];
                    *value = if *value == NONE || *value == nth { nth } else { SEVERAL };
                }
            });
        }
        passing
    }

    /// Whether only this line passes within `reach` of a point.
    pub fn is_alone(&self, nth: usize, place: Point, reach: f32) -> bool {
        let is_own = |value: u32| value == NONE || value as usize == nth;
        self.0.around(place, reach).flatten().all(|square| is_own(self.0.values[square]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::line;
    use super::*;

    #[test]
    fn lines_are_alone_where_no_other_is_near() {
        let lines = [line([[0.0, 10.0], [40.0, 10.0]]), line([[0.0, 11.0], [20.0, 11.0], [40.0, 20.0]])];
        let passing = Passing::of(Rect::new(0.0, 0.0, 40.0, 40.0), lines.iter().map(Vec::as_slice));
        assert!(!passing.is_alone(0, Point::new(5.0, 10.0), 1.5) && !passing.is_alone(1, Point::new(5.0, 11.0), 1.5));
        assert!(passing.is_alone(0, Point::new(35.0, 10.0), 1.5) && passing.is_alone(1, Point::new(35.0, 18.0), 1.5));
        assert!(passing.is_alone(0, Point::new(5.0, 10.0), 0.3));
    }
}
