//! The coordinate grid of a map: lines at round coordinates, with numbers along all four sides.

use super::furniture::{Align, Desk, SMALL};
use super::geometry::{Point, Rect};
use super::options::GridStep;
use super::scene::line;
use super::ticks::{Count, step, step_words, ticks_every};
use crate::map::text::Face;
use orogen_grid::error::{Error, ErrorKind, Result};

/// Minimum distance between lines, in millimetres: of an automatic grid, and of a given grid.
const SUITABLE: f64 = 20.0;
const LEAST: f64 = 1.0;

/// Length of ticks outside the map's frame, in millimetres.
const MARK: f32 = 1.3;

/// A coordinate grid.
pub struct GridLines {
    step: f64,
    counts: [Count; 2],
    /// The coordinates at the map's left and right, and at its top and bottom.
    spans: [[f64; 2]; 2],
}

impl GridLines {
    /// A grid over these coordinates, on a map of about this width and height in millimetres.
    ///
    /// # Errors
    /// If its lines would be too dense, or none would be on the map.
    pub fn new(wanted: GridStep, spans: [[f64; 2]; 2], counts: [Count; 2], size: [f64; 2]) -> Result<GridLines> {
        let lengths = spans.map(|[from, to]| (to - from).abs());
        // Units per millimetre along the axis with more of them.
        let dense = f64::max(lengths[0] / size[0], lengths[1] / size[1]);
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let step = match wanted {
            GridStep::Automatic => step(SUITABLE * dense, 1),
            GridStep::Every(step) if step >= LEAST * dense => step,
            GridStep::Every(step) => {
                return refuse(format!(
                    "lines of a grid every {} are less than {LEAST} mm apart on this map; use at least {}",
                    step_words(step, counts[0]),
                    step_words(self::step(LEAST * dense, 1), counts[0])
                ));
            }
        };
        let grid = GridLines { step, counts, spans };
        match (grid.lines(0).is_empty() && grid.lines(1).is_empty(), wanted) {
            (true, GridStep::Every(step)) => refuse(format!(
                "no line of a grid every {} crosses the map; use a smaller distance",
                step_words(step, counts[0])
            )),
            _ => Ok(grid),
        }
    }

    /// A description of the grid for the legend.
    pub fn words(&self) -> String {
        format!("Grid, {} apart", step_words(self.step, self.counts[0]))
    }

    /// The lines across (0) or down (1): their positions, 0 to 1, and their coordinates.
    fn lines(&self, axis: usize) -> Vec<(f32, String)> {
        let span = self.spans[axis];
        let share = |value: f64| ((value - span[0]) / (span[1] - span[0])) as f32;
        let ticks = ticks_every(span, self.step, self.counts[axis]);
        ticks.into_iter().map(|(value, name)| (share(value), name)).filter(|(at, _)| (0.0..=1.0).contains(at)).collect()
    }

    /// Draws the lines.
    pub fn draw(&self, desk: &mut Desk, map: Rect) {
        let mut lines: Vec<Vec<Point>> = Vec::new();
        for (share, _) in self.lines(0) {
            lines.push(vec![map.at(share, 0.0), map.at(share, 1.0)]);
        }
        for (share, _) in self.lines(1) {
            lines.push(vec![map.at(0.0, share), map.at(1.0, share)]);
        }
        // A bright edge for visibility on dark ground.
        desk.scene.lines(lines.clone(), 0.4, desk.colors.page, 0.25);
        desk.scene.lines(lines, 0.15, desk.colors.ink, 0.8);
    }

    /// Draws ticks and coordinates along all sides of the map.
    pub fn frame(&self, desk: &mut Desk, map: Rect) {
        let Rect { left, top, width, height } = map;
        let (right, bottom) = (map.right(), map.bottom());
        let mut marks: Vec<Vec<Point>> = Vec::new();
        let mut free = f32::MIN;
        for (share, name) in self.lines(0) {
            let x = left + width * share;
            marks.push(line([[x, bottom], [x, bottom + MARK]]));
            marks.push(line([[x, top], [x, top - MARK]]));
            let half = desk.letters.width(&name, Face::Regular, SMALL) / 2.0;
            if x - half > free && x + half < desk.scene.size.width - 1.0 {
                desk.small(&name, Point::new(x, bottom + MARK + 2.9), Align::Middle);
                desk.small(&name, Point::new(x, top - MARK - 0.9), Align::Middle);
                free = x + half + 1.5;
            }
        }
        let mut free = f32::MIN;
        let mut rows = self.lines(1);
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (share, name) in rows {
            let y = top + height * share;
            marks.push(line([[left, y], [left - MARK, y]]));
            marks.push(line([[right, y], [right + MARK, y]]));
            if y > free {
                desk.small(&name, Point::new(left - MARK - 0.9, y + 0.95), Align::End);
                desk.small(&name, Point::new(right + MARK + 0.9, y + 0.95), Align::Start);
                free = y + SMALL * 1.2;
            }
        }
        desk.scene.lines(marks, 0.2, desk.colors.ink, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(step: GridStep, spans: [[f64; 2]; 2], count: Count) -> Result<GridLines> {
        GridLines::new(step, spans, [count; 2], [240.0, 160.0])
    }

    #[test]
    fn lines_are_at_round_coordinates_that_suit_the_scale() {
        // 1 : 100 000, so that 2 km are 20 mm.
        let spans = [[376_500.0, 400_500.0], [5_216_000.0, 5_200_000.0]];
        let automatic = grid(GridStep::Automatic, spans, Count::Metres).unwrap();
        assert_eq!((automatic.step, automatic.words().as_str()), (2000.0, "Grid, 2 km apart"));
        let columns = automatic.lines(0);
        assert_eq!((columns.len(), columns[0].1.as_str()), (12, "378 km"));
        assert!((columns[0].0 - 1500.0 / 24_000.0).abs() < 1e-6);
        // Rows from the top of the map, where the coordinates are largest.
        let rows = automatic.lines(1);
        assert_eq!((rows.len(), rows.last().map(|row| (row.0, row.1.as_str()))), (9, Some((0.0, "5216 km"))));
        let given = grid(GridStep::Every(2500.0), spans, Count::Metres).unwrap();
        assert_eq!(given.lines(0)[0].1, "377.5 km");
        let degrees = grid(GridStep::Automatic, [[7.03, 7.27], [46.1, 45.98]], Count::Latitude).unwrap();
        assert_eq!((degrees.words().as_str(), degrees.lines(1).len()), ("Grid, 0.02° apart", 7));
    }

    #[test]
    fn grids_that_show_nothing_are_refused() {
        let spans = [[100.0, 24_100.0], [100.0, 16_100.0]];
        for (step, why) in [
            (5.0, "every 5 m are less than 1 mm apart on this map; use at least 100 m"),
            (1e6, "no line of a grid every 1000 km crosses the map"),
        ] {
            let error = grid(GridStep::Every(step), spans, Count::Metres).err().unwrap().to_string();
            assert!(error.contains(why), "{error}");
        }
    }
}
