//! Geomorphons: classification of landforms by lines of sight.
//!
//! After Jasiewicz and Stepinski, "Geomorphons: a pattern recognition approach to classification and mapping of
//! landforms" (2013). In each of eight directions the ground within a search radius counts as higher, lower or level,
//! depending on the zenith and nadir angles of its horizon. The numbers of higher and of lower directions determine the
//! form.

use crate::checks::{never, steps};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use crate::{error, parallel};

/// The ten landforms, in the order of their codes from 1.
pub const FORMS: [&str; 10] =
    ["flat", "peak", "ridge", "shoulder", "spur", "slope", "hollow", "footslope", "valley", "pit"];

/// The code of a form by the number of lower (row) and higher (column) directions, from the table in the paper.
#[doc(hidden)]
pub const CODES: [[u8; 9]; 9] = [
    [1, 1, 1, 8, 8, 9, 9, 9, 10],
    [1, 1, 8, 8, 8, 9, 9, 9, 0],
    [1, 4, 6, 6, 7, 7, 9, 0, 0],
    [4, 4, 6, 6, 6, 7, 0, 0, 0],
    [4, 4, 5, 6, 6, 0, 0, 0, 0],
    [3, 3, 5, 5, 0, 0, 0, 0, 0],
    [3, 3, 3, 0, 0, 0, 0, 0, 0],
    [3, 3, 0, 0, 0, 0, 0, 0, 0],
    [2, 0, 0, 0, 0, 0, 0, 0, 0],
];

const STEPS: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// The rule that decides whether a direction is level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Level {
    /// The zenith and nadir angles of the horizon differ by no more than the limit, as in the paper.
    ByDifference,
    /// Neither the highest nor the lowest line of sight is steeper than the limit, as in r.geomorphon; otherwise the
    /// steeper of the two decides.
    BySteepest,
}

/// The search radius and the rule for level directions.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Look {
    /// Search radius along the axes, in samples.
    pub straight: usize,
    /// Search radius along the diagonals, in steps; at most `straight`.
    pub diagonal: usize,
    /// The angle limit of level ground, in degrees.
    pub flat: f64,
    /// The rule to which the limit applies.
    pub level: Level,
}

orogen_noise::builder!(
    Look:
    with_straight(straight: usize),
    with_diagonal(diagonal: usize),
    with_flat(flat: f64),
    with_level(level: Level)
);

impl Look {
    /// A search with the same number of steps in all directions and the paper's rule. `flat` is in degrees.
    #[must_use]
    pub fn square(radius: usize, flat: f64) -> Look {
        Look { straight: radius, diagonal: radius, flat, level: Level::ByDifference }
    }

    /// A search with the same distance in all directions: `reach` cells. `flat` is in degrees.
    #[must_use]
    pub fn round(reach: f64, flat: f64, level: Level) -> Look {
        let straight = (reach as usize).max(1);
        let diagonal = ((reach * std::f64::consts::FRAC_1_SQRT_2) as usize).clamp(1, straight);
        Look { straight, diagonal, flat, level }
    }
}

/// The form of every sample of `grid` that is at least `straight` samples from its border, as a code from 1 (see
/// [`FORMS`]). The code is 0 if the sample or a sample in its lines of sight is not finite.
///
/// Costs O(samples times 8 radius). Rows are computed in parallel.
#[must_use]
pub fn geomorphons(grid: &Grid, look: &Look) -> Grid<u8> {
    let Ok(out) = geomorphons_by_rows(grid, look, &never);
    out
}

/// [`geomorphons`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn geomorphons_with(grid: &Grid, look: &Look, progress: &Progress) -> error::Result<Grid<u8>> {
    geomorphons_by_rows(grid, look, &steps(progress, grid.height().saturating_sub(2 * look.straight)))
}

/// [`geomorphons`]; `row` is called for each row.
fn geomorphons_by_rows<E: Send>(
    grid: &Grid,
    look: &Look,
    row: &(impl Fn() -> Result<(), E> + Sync),
) -> Result<Grid<u8>, E> {
    let radius = look.straight;
    let from = *grid.window();
    let window = Window {
        x: from.x + radius as i64,
        y: from.y + radius as i64,
        width: from.width.saturating_sub(2 * radius),
        height: from.height.saturating_sub(2 * radius),
        cell: from.cell,
    };
    let mut out = Grid::filled(window, 0u8);
    if window.is_empty() {
        return Ok(out);
    }
    let limit = libm::tan(look.flat.to_radians());
    parallel::try_for_each(out.data_mut().chunks_mut(window.width).enumerate(), |(j, forms)| {
        row()?;
        for (i, form) in forms.iter_mut().enumerate() {
            *form = form_at(grid, [i + radius, j + radius], look, limit).unwrap_or(0);
        }
        Ok(())
    })?;
    Ok(out)
}

/// The form of one sample; `limit` is the tangent of the angle limit of level ground.
fn form_at(grid: &Grid, [i, j]: [usize; 2], look: &Look, limit: f64) -> Option<u8> {
    let here = f64::from(grid[(i, j)]);
    let (mut lower, mut higher) = (0usize, 0usize);
    for (east, south) in STEPS {
        // Rise per step. Equal slopes give equal quotients, so that slopes up and down cancel if heights are whole
        // metres.
        let (mut up, mut down) = (f64::NEG_INFINITY, f64::INFINITY);
        let farthest = if east * south == 0 { look.straight } else { look.diagonal };
        for step in 1..=farthest as isize {
            let there = grid[(i.wrapping_add_signed(east * step), j.wrapping_add_signed(south * step))];
            let slope = (f64::from(there) - here) / step as f64;
            if !slope.is_finite() {
                return None;
            }
            up = up.max(slope);
            down = down.min(slope);
        }
        let length = ((east * east + south * south) as f64).sqrt() * grid.window().cell;
        (up, down) = (up / length, down / length);
        let sum = up + down;
        let tells = match look.level {
            // If the highest line of sight is at angle b and the lowest at d, the nadir angle minus the zenith angle is
            // b + d, and its tangent is sum / rest.
            Level::ByDifference => {
                let rest = 1.0 - up * down;
                rest <= 0.0 || sum.abs() > limit * rest
            }
            Level::BySteepest => up.abs().max(down.abs()) > limit,
        };
        // The highest line is above the lowest: it is the steeper one if the sum is above 0.
        higher += usize::from(tells && sum > 0.0);
        lower += usize::from(tells && sum < 0.0);
    }
    Some(CODES[lower][higher])
}

/// Counts the samples of each code, starting with code 0.
pub fn count(forms: &Grid<u8>, counts: &mut [u64; 11]) {
    forms.data().iter().for_each(|form| counts[usize::from(*form).min(10)] += 1);
}

/// The share of each form among the samples that have a form, in the order of [`FORMS`]; zeros if there are none.
#[must_use]
pub fn shares(counts: &[u64; 11]) -> [f64; 10] {
    let total: u64 = counts[1..].iter().sum();
    std::array::from_fn(|k| if total == 0 { 0.0 } else { counts[k + 1] as f64 / total as f64 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form_of(f: impl Fn(f64, f64) -> f64) -> &'static str {
        let window = Window::new(9, 9, 10.0).at(-4, -4);
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..9 {
            for i in 0..9 {
                grid.row_mut(j)[i] = f(window.east(i), window.south(j)) as f32;
            }
        }
        let forms = geomorphons(&grid, &Look::square(4, 1.0));
        assert_eq!((forms.width(), forms.height()), (1, 1));
        FORMS[usize::from(forms[(0, 0)]) - 1]
    }

    #[test]
    fn plain_forms_have_their_names() {
        assert_eq!(form_of(|_, _| 5.0), "flat");
        assert_eq!(form_of(|x, y| -(x * x + y * y).sqrt()), "peak");
        assert_eq!(form_of(|x, y| (x * x + y * y).sqrt()), "pit");
        assert_eq!(form_of(|x, _| -x.abs()), "ridge");
        assert_eq!(form_of(|x, _| x.abs()), "valley");
        assert_eq!(form_of(|x, _| x), "slope");
        assert_eq!(form_of(|x, _| x.min(0.0)), "shoulder");
        assert_eq!(form_of(|x, _| x.max(0.0)), "footslope");
        assert_eq!(form_of(|x, y| x - 0.5 * y.abs()), "spur");
        assert_eq!(form_of(|x, y| x + 0.5 * y.abs()), "hollow");
        assert_eq!(form_of(|x, _| 0.005 * x), "flat", "within a degree");
    }

    #[test]
    fn equal_slopes_up_and_down_are_level_at_any_cell() {
        for cell in [0.1, 30.0, 50.000_946_969_697, 92.6] {
            let mut grid = Grid::filled(Window::new(15, 15, cell), 40.0);
            for j in 0..15usize {
                for i in 0..15usize {
                    // Down by 1 in one step, up by 3 in three and by 7 in seven.
                    let ring = i.abs_diff(7).max(j.abs_diff(7));
                    grid.row_mut(j)[i] += [0.0, -1.0, 0.0, 3.0, 0.0, 0.0, 0.0, 7.0][ring];
                }
            }
            for level in [Level::BySteepest, Level::ByDifference] {
                let look = Look { level, ..Look::square(7, 0.1) };
                assert_eq!(FORMS[usize::from(geomorphons(&grid, &look)[(0, 0)]) - 1], "flat", "{cell} {level:?}");
            }
        }
    }

    #[test]
    fn shares_sum_to_one_and_missing_samples_have_no_form() {
        let mut grid = Grid::filled(Window::new(20, 20, 1.0), 1.0);
        grid.row_mut(10)[10] = f32::NAN;
        let forms = geomorphons(&grid, &Look::square(3, 1.0));
        assert_eq!(forms.data().iter().filter(|f| **f == 0).count(), 25);
        let mut counts = [0; 11];
        count(&forms, &mut counts);
        assert_eq!((counts[0], shares(&counts)[0]), (25, 1.0));
        assert_eq!(shares(&[4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]), [0.0; 10]);
        assert!(geomorphons(&grid, &Look::square(10, 1.0)).window().is_empty());
    }
}
