//! Cast shadows.

use crate::checks::never;
use crate::grid::transposed;

/// Heights that cast shadows, and their transpose.
pub struct Shadows<'a> {
    heights: &'a [f32],
    turned: Vec<f32>,
    columns: usize,
    rows: usize,
    cell: f64,
}

/// A height below any ground.
const NOTHING: f32 = -1e30;

impl<'a> Shadows<'a> {
    /// Prepares rows of `columns` heights that are `cell` metres apart. Needs 4 bytes per sample.
    #[must_use]
    pub fn new(heights: &'a [f32], columns: usize, cell: f64) -> Shadows<'a> {
        let rows = heights.len() / columns.max(1);
        Shadows { heights, turned: transposed(heights, columns), columns, rows, cell }
    }

    /// Whether each sample is lit. `towards` is the unit vector to the sun: east, south and up.
    ///
    /// The height of the shadow is carried along lines that lead away from the sun, from row to row (or from column to
    /// column, whichever is closer to the sun's direction). Where the ground is higher, it is raised to the ground;
    /// otherwise it falls according to the sun's elevation. Heights are interpolated linearly between samples, and
    /// shadows between lines. The length of shadows is not limited. The time is O(samples), the memory 1 byte per
    /// sample.
    #[must_use]
    pub fn lit(&self, towards: [f64; 3]) -> Vec<bool> {
        let Ok(lit) = self.lit_by_rows(towards, &never);
        lit
    }

    /// [`Shadows::lit`]; `row` is called before each row (or column), and its error ends the work.
    ///
    /// # Errors
    /// The error of `row`.
    pub fn lit_by_rows<E>(&self, towards: [f64; 3], row: &impl Fn() -> Result<(), E>) -> Result<Vec<bool>, E> {
        let [east, south, up] = towards;
        Ok(if south.abs() >= east.abs() {
            self.sweep(self.heights, self.columns, [east, south], up, row)?
        } else {
            transposed(&self.sweep(&self.turned, self.rows, [south, east], up, row)?, self.rows)
        })
    }

    /// [`Shadows::lit`] over rows of `width`. `along` is the sun's direction: its component along the rows, then its
    /// larger component, from row to row.
    fn sweep<E>(
        &self,
        heights: &[f32],
        width: usize,
        along: [f64; 2],
        up: f64,
        check: &impl Fn() -> Result<(), E>,
    ) -> Result<Vec<bool>, E> {
        let count = heights.len() / width.max(1);
        let mut lit = vec![true; heights.len()];
        if width == 0 || along[1] == 0.0 {
            // The sun is at the zenith.
            return Ok(lit);
        }
        // From one row to the next, away from the sun: the number of columns by which a line moves, and the metres by
        // which the shadow falls.
        let shift = -along[0] / along[1].abs();
        let drop = (up / along[1].abs() * self.cell) as f32;
        // Line l is at column l + k shift in the k-th row. These lines cross the ground; there is one more line on each
        // side.
        let drift = shift * (count - 1) as f64;
        let first = (-drift.max(0.0)).floor() as i64 - 1;
        let last = (width - 1) as i64 + (-drift.min(0.0)).ceil() as i64 + 1;
        let mut ceilings = vec![NOTHING; (last - first + 1) as usize];
        for k in 0..count {
            check()?;
            // Start with the rows closest to the sun.
            let j = if along[1] > 0.0 { count - 1 - k } else { k };
            let row = &heights[j * width..(j + 1) * width];
            let place = k as f64 * shift;
            // The line at or before column 0, as a number of lines and the fraction before column 0.
            let whole = (-place).floor();
            let share = (-place - whole) as f32;
            let start = (whole as i64 - first) as usize;
            let lines = &mut ceilings[start..start + width + 1];
            let out = &mut lit[j * width..(j + 1) * width];
            for ((out, height), ceiling) in out.iter_mut().zip(row).zip(lines.windows(2)) {
                *out = *height >= ceiling[0] + (ceiling[1] - ceiling[0]) * share;
            }
            // The ground under each line; line 0 is `share` before column 0.
            let (west, east) = (row[0], row[width - 1]);
            let at = |column: usize| row.get(column).copied().unwrap_or(east);
            lines[0] = lines[0].max(west);
            for (n, ceiling) in lines.iter_mut().enumerate().skip(1) {
                let (before, after) = (row[n - 1], at(n));
                *ceiling = ceiling.max(after + (before - after) * share);
            }
            ceilings.iter_mut().for_each(|ceiling| *ceiling -= drop);
        }
        Ok(lit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A direction by azimuth, clockwise from north, and elevation, in degrees.
    fn towards(azimuth: f64, elevation: f64) -> [f64; 3] {
        let ((sa, ca), (se, ce)) = (libm::sincos(azimuth.to_radians()), libm::sincos(elevation.to_radians()));
        [sa * ce, -ca * ce, se]
    }

    #[test]
    fn a_tower_casts_its_shadow_as_far_as_the_sun_is_low() {
        let (columns, rows) = (61, 61);
        let mut heights = vec![0.0f32; columns * rows];
        // A tower of 3 x 3 samples, 95 m high, in the middle.
        for (y, x) in (29..32).flat_map(|y| (29..32).map(move |x| (y, x))) {
            heights[y * columns + x] = 95.0;
        }
        let shadows = Shadows::new(&heights, columns, 10.0);
        let at_45 = 9;
        for (azimuth, step) in [(0.0, [0, 1]), (90.0, [-1, 0]), (180.0, [0, -1]), (270.0, [1, 0])] {
            let lit = shadows.lit(towards(azimuth, 45.0));
            let at = |n: i64| lit[((30 + n * step[1]) * columns as i64 + 30 + n * step[0]) as usize];
            assert!(at(0) && !at(2) && !at(at_45), "{azimuth}");
            assert!(at(at_45 + 2) && at(-2), "{azimuth}");
            assert_eq!(lit.iter().filter(|lit| !**lit).count(), 3 * 9, "{azimuth}");
        }
        // On the diagonal it is shorter in samples, by a factor of sqrt(2).
        let lit = shadows.lit(towards(315.0, 45.0));
        let at = |n: usize| lit[(30 + n) * columns + 30 + n];
        assert!(!at(2) && !at(7) && at(9));
        assert!(shadows.lit([0.0, 0.0, 1.0]).iter().all(|lit| *lit));
    }

    #[test]
    fn it_is_what_looking_towards_the_sun_finds() {
        let (columns, rows, cell) = (70usize, 50usize, 10.0);
        let height =
            |x: f64, y: f64| 80.0 * libm::sin(x * 0.15) * libm::cos(y * 0.12) + 15.0 * libm::sin(x * 0.3 + y * 0.25);
        let heights: Vec<f32> =
            (0..columns * rows).map(|k| height((k % columns) as f64, (k / columns) as f64) as f32).collect();
        let shadows = Shadows::new(&heights, columns, cell);
        for (azimuth, elevation) in
            [(13.0, 12.0), (77.0, 20.0), (140.0, 8.0), (201.0, 25.0), (260.0, 15.0), (333.0, 5.0)]
        {
            let towards = towards(azimuth, elevation);
            let lit = shadows.lit(towards);
            let flat = (1.0 - towards[2] * towards[2]).sqrt();
            let mut wrong = 0;
            for (k, lit) in lit.iter().enumerate() {
                let (i, j) = ((k % columns) as f64, (k / columns) as f64);
                let free = (1..2000).map(|n| f64::from(n) * 0.1).all(|way| {
                    let (x, y) = (i + towards[0] / flat * way, j + towards[1] / flat * way);
                    let inside = (0.0..=(columns - 1) as f64).contains(&x) && (0.0..=(rows - 1) as f64).contains(&y);
                    !inside || height(x, y) <= f64::from(heights[k]) + way * cell * towards[2] / flat
                });
                wrong += usize::from(*lit != free);
            }
            // Differences are allowed only along the edges of shadows, where heights are interpolated.
            assert!(wrong * 25 < lit.len(), "{azimuth}, {elevation}: {wrong} of {}", lit.len());
        }
    }
}
