//! The cavity of a hollow solid, open below: its ceiling keeps a distance from the surface.

use orogen_grid::parallel;

use super::scale::Scale;
use super::surface::Surface;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;

/// Number of vertices of the ceiling per wall thickness, if samples are dense enough.
const PARTS: f64 = 8.0;

/// Ratio of the diagonal of a cell to its side, rounded up.
const DIAGONAL: f64 = 1.415;

/// Height of the ceiling where no cavity is allowed, in millimetres.
const NOWHERE: f32 = -1.0;

/// A ceiling over a rectangle, in millimetres.
#[derive(Debug)]
pub(super) struct Ceiling {
    /// The columns of its vertices, from west to east.
    pub xs: Vec<f32>,
    /// The rows of its vertices, from north to south, as distances from the south.
    pub ys: Vec<f32>,
    /// The heights of its vertices, row by row.
    pub heights: Vec<f32>,
    /// Distance between the samples of the surface in millimetres.
    cell: f32,
}

impl Ceiling {
    /// The ceiling below a surface, at least `wall` millimetres from it and from its sides.
    ///
    /// With `is_cut`, samples that are not above the base are not part of the solid: the ceiling is below 0 where it
    /// would be less than `wall` from such a sample.
    ///
    /// The ceiling is the lower envelope of balls with radius `wall` around all samples. Each vertex takes the lowest
    /// height within a cell of it, so that the ceiling is nowhere too high.
    ///
    /// # Errors
    /// If the base or the solid is too small for such walls.
    pub fn of(surface: &Surface, scale: &Scale, wall: f64, is_cut: bool) -> Result<Ceiling> {
        let grid = surface.grid;
        let cell = grid.window().cell * scale.scale;
        let sides = [grid.width(), grid.height()].map(|samples| (samples - 1) as f64 * cell);
        // Maximum vertical error of a mesh with few triangles.
        let error = surface.shape.deviation(grid) * f64::from(surface.exaggeration) * scale.scale;
        if scale.base <= wall + error {
            return Err(refuse(format!(
                "walls of {} mm need a base that is thicker than {} mm, because the ceiling of the cavity is as thick as the walls; use a larger --base or a smaller --hollow",
                number(wall),
                number(((wall + error) * 100.0).ceil() / 100.0)
            )));
        }
        if sides.iter().any(|side| *side < 3.0 * wall) {
            return Err(refuse(format!(
                "a solid of {} x {} mm is too small for walls of {} mm; use a smaller --hollow, or leave it out",
                number((sides[0] * 10.0).round() / 10.0),
                number((sides[1] * 10.0).round() / 10.0),
                number(wall)
            )));
        }
        let step = (wall / (PARTS * cell)).ceil().max(1.0);
        let along = |side: f64| -> Vec<f64> {
            let (first, last, gap) = (wall, side - wall, step * cell);
            let between = (0..).map(|k| f64::from(k) * gap).skip_while(|at| *at < first + gap / 2.0);
            let between = between.take_while(|at| *at < last - gap / 2.0);
            std::iter::once(first).chain(between).chain([last]).collect()
        };
        let (xs, mut ys) = (along(sides[0]), along(sides[1]));
        ys.reverse();
        // The ceiling between two vertices must not be too high either, so each vertex takes the lowest height within
        // this distance. Vertices are up to one and a half steps apart.
        let slack = (1.5 * step + 1.0) * cell * DIAGONAL;
        let reach = wall + slack;
        let (level, clear) = (scale.base as f32, if is_cut { reach + cell * DIAGONAL } else { reach });
        let drop = |away: f64| {
            let away = (away - slack).max(0.0);
            (wall * wall - away * away).max(0.0).sqrt()
        };
        let range = |at: f64, samples: usize| {
            let [from, to] = [at - clear, at + clear].map(|at| (at / cell).clamp(0.0, (samples - 1) as f64));
            from.ceil() as usize..=to.floor() as usize
        };
        let rows = parallel::map(&ys, |y| -> Vec<f32> {
            let south = sides[1] - *y;
            let height = |x: &f64| {
                let mut least = f64::INFINITY;
                for row in range(south, grid.height()) {
                    for column in range(*x, grid.width()) {
                        let away = libm::hypot(column as f64 * cell - x, row as f64 * cell - south);
                        if away >= clear {
                            continue;
                        }
                        let up = scale.place(surface, column, row)[2];
                        if is_cut && up <= level {
                            return NOWHERE;
                        }
                        if away < reach {
                            least = least.min(f64::from(up) - drop(away));
                        }
                    }
                }
                (least - error) as f32
            };
            xs.iter().map(height).collect()
        });
        let narrow = |places: Vec<f64>| places.into_iter().map(|at| at as f32).collect();
        Ok(Ceiling { xs: narrow(xs), ys: narrow(ys), heights: rows.concat(), cell: cell as f32 })
    }

    /// The height at a position between the vertices; below 0 where no cavity is allowed. It is linear between
    /// positions that are as close as samples.
    pub fn at(&self, [x, y]: [f32; 2]) -> f32 {
        let (column, row) = (self.xs.partition_point(|at| *at <= x), self.ys.partition_point(|at| *at > y));
        let [width, height] = [self.xs.len(), self.ys.len()];
        // Between a position outside and the next one, the outline of a cavity may be at either.
        let near = |side: f32, at: f32| (side - at).abs() < self.cell;
        let is_outside = column == 0
            || column == width
            || row == 0
            || row == height
            || near(self.xs[0], x)
            || near(self.xs[width - 1], x)
            || near(self.ys[0], y)
            || near(self.ys[height - 1], y);
        if is_outside {
            return NOWHERE;
        }
        let across = (x - self.xs[column - 1]) / (self.xs[column] - self.xs[column - 1]);
        let down = (y - self.ys[row - 1]) / (self.ys[row] - self.ys[row - 1]);
        let mix = |from: f32, to: f32, share: f32| from + (to - from) * share;
        let along = |row: usize| {
            let first = row * width + column - 1;
            mix(self.heights[first], self.heights[first + 1], across)
        };
        mix(along(row - 1), along(row), down)
    }

    /// The vertices along each side, counter-clockwise from above: along the north, the west, the south and the east,
    /// each with both of its ends.
    pub fn sides(&self) -> [Vec<u32>; 4] {
        let [width, height] = [self.xs.len() as u32, self.ys.len() as u32];
        let at = |column: u32, row: u32| row * width + column;
        [
            (0..width).rev().map(|column| at(column, 0)).collect(),
            (0..height).map(|row| at(0, row)).collect(),
            (0..width).map(|column| at(column, height - 1)).collect(),
            (0..height).rev().map(|row| at(width - 1, row)).collect(),
        ]
    }
}

fn refuse(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}
