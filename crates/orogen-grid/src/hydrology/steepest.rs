//! D8: each cell drains to one lower neighbor.

use super::direction::{NONE, STEPS, hashed, one_of};
use super::outlets::Outlets;
use super::points::Points;
use super::receivers::Receivers;
use crate::grid::Grid;
use crate::parallel;

/// The rule that chooses the receiver.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Descent<'a> {
    /// Steepest descent (O'Callaghan and Mark 1984); the drop is divided by sqrt(2) on a diagonal.
    Steepest,
    /// Like `Steepest`, but a diagonal drop is divided by a random length from 1 to 2, hashed from the cell's position
    /// and this number (Rho8, Fairfield and Leymarie 1991). On a slope between two directions the receivers alternate,
    /// and on average the flow follows the slope. D8 always takes the same direction and gives straight parallel lines.
    Scattered(u32),
    /// Steepest descent between irregular points.
    Interpolation(&'a Points),
}

/// The receiver of each cell. Outlets, and cells without a lower neighbor, have none. Ties are broken by a hash of the
/// cell's position on the lattice.
///
/// Costs O(cells). Rows are computed in parallel.
#[must_use]
pub fn receivers(heights: &Grid, outlets: &Outlets, descent: Descent) -> Receivers {
    let mut receivers = Receivers::none(*heights.window());
    let window = *heights.window();
    if window.width < 3 || window.height < 3 {
        return receivers;
    }
    let rows = receivers.codes_mut().chunks_mut(window.width).enumerate().take(window.height - 1).skip(1);
    parallel::for_each_init(
        rows,
        || vec![std::f32::consts::FRAC_1_SQRT_2; window.width - 2],
        |diagonals, (j, codes)| {
            let y = window.y + j as i64;
            if let Descent::Scattered(salt) = descent {
                for (i, diagonal) in diagonals.iter_mut().enumerate() {
                    *diagonal = scattered(window.x + i as i64 + 1, y, salt);
                }
            }
            let rows = [heights.row(j - 1), heights.row(j), heights.row(j + 1)];
            match descent {
                Descent::Interpolation(points) => steepest_between(rows, points.around(j), codes),
                _ => steepest_sets(rows, diagonals, codes),
            }
            for (i, (code, outlet)) in codes.iter_mut().zip(outlets.mask().row(j)).enumerate() {
                *code = if *outlet { NONE } else { chosen(*code, window.x + i as i64, y) };
            }
        },
    );
    receivers
}

/// The inverse of a random length from 1 to 2.
#[inline]
fn scattered(x: i64, y: i64, salt: u32) -> f32 {
    let share = (hashed(x, y ^ (i64::from(salt) << 32)) >> 8) as f32 * (1.0 / (1 << 24) as f32);
    1.0 / (2.0 - share)
}

#[inline(always)]
fn chosen(set: u8, x: i64, y: i64) -> u8 {
    if set & set.wrapping_sub(1) == 0 { set.trailing_zeros() as u8 } else { one_of(set, hashed(x, y)) }
}

/// The set of directions of steepest descent for every inner cell of the middle row; drops along diagonals are
/// multiplied by `diagonals`. The first and last entries are unchanged.
fn steepest_sets(rows: [&[f32]; 3], diagonals: &[f32], sets: &mut [u8]) {
    let count = sets.len() - 2;
    let middle = &rows[1][1..=count];
    let [e, se, s, sw, w, nw, n, ne] = around(rows, count);
    let diagonals = &diagonals[..count];
    for (i, set) in sets[1..=count].iter_mut().enumerate() {
        let (h, diagonal) = (middle[i], diagonals[i]);
        let drops = [
            h - e[i],
            (h - se[i]) * diagonal,
            h - s[i],
            (h - sw[i]) * diagonal,
            h - w[i],
            (h - nw[i]) * diagonal,
            h - n[i],
            (h - ne[i]) * diagonal,
        ];
        *set = largest(&drops);
    }
}

/// Like [`steepest_sets`], but the drop to each neighbor is multiplied by the row of its direction in
/// `inverse_distance`.
fn steepest_between(rows: [&[f32]; 3], inverse_distance: [&[f32]; 8], sets: &mut [u8]) {
    let count = sets.len() - 2;
    let middle = &rows[1][1..=count];
    let around = around(rows, count);
    let inverse_distance = inverse_distance.map(|row| &row[..count]);
    for (i, set) in sets[1..=count].iter_mut().enumerate() {
        *set = largest(&std::array::from_fn(|k| (middle[i] - around[k][i]) * inverse_distance[k][i]));
    }
}

/// The eight rows of neighbors of the inner cells, all of the same length, because loops over equal slices are
/// vectorized.
#[inline(always)]
fn around(rows: [&[f32]; 3], count: usize) -> [&[f32]; 8] {
    STEPS.map(|(east, south)| {
        let start = (1 + east) as usize;
        &rows[(1 + south) as usize][start..start + count]
    })
}

/// The set of the largest drops; empty if there is no drop.
#[inline(always)]
fn largest(drops: &[f32; 8]) -> u8 {
    let most = drops.iter().fold(f32::MIN_POSITIVE, |most, drop| if *drop > most { *drop } else { most });
    let mut found = 0u32;
    for (k, drop) in drops.iter().enumerate() {
        found |= u32::from(*drop == most) << k;
    }
    found as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::direction::{DISTANCES, neighbor, strides};
    use crate::hydrology::samples;

    #[test]
    fn no_neighbor_falls_more_steeply() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let receivers = receivers(&heights, &outlets, Descent::Steepest);
            let (h, strides) = (heights.data(), strides(heights.width()));
            for (c, here) in h.iter().enumerate() {
                if outlets.at(c) {
                    assert_eq!(receivers.code(c), NONE);
                    continue;
                }
                let drops: Vec<f64> =
                    (0..8).map(|k| f64::from(here - h[neighbor(c, strides[k])]) / DISTANCES[k]).collect();
                let most = drops.iter().copied().fold(0.0, f64::max);
                match receivers.code(c) {
                    NONE => assert!(most <= 0.0),
                    code => assert!(drops[usize::from(code)] >= most * (1.0 - 1e-6) && most > 0.0),
                }
            }
        }
    }

    #[test]
    fn a_shifted_window_chooses_the_same() {
        let heights = samples::steps(40, 30, 5);
        let all = receivers(&heights, &Outlets::new(&heights, None), Descent::Scattered(3));
        let part = Window::new(20, 15, 1.0).at(heights.window().x + 9, heights.window().y + 6);
        let cropped = heights.crop(&part).unwrap();
        let tile = receivers(&cropped, &Outlets::new(&cropped, None), Descent::Scattered(3));
        for j in 1..14 {
            for i in 1..19 {
                assert_eq!(tile.code(j * 20 + i), all.code((j + 6) * 40 + i + 9));
            }
        }
    }

    #[test]
    fn scattered_water_goes_where_the_slope_does() {
        // A plane that falls in directions between two of the eight. D8 goes straight along one of them.
        for angle in [10.0f64, 22.5, 40.0, 70.0] {
            let (east, south) = (libm::cos(angle.to_radians()), libm::sin(angle.to_radians()));
            let mut plane = Grid::filled(Window::new(202, 202, 1.0), 0.0);
            for j in 0..202 {
                for i in 0..202 {
                    plane.row_mut(j)[i] = -(east * i as f64 + south * j as f64) as f32;
                }
            }
            let receivers = receivers(&plane, &Outlets::new(&plane, None), Descent::Scattered(7));
            let (mut x, mut y) = (0, 0);
            for code in receivers.codes().iter().filter(|code| **code != NONE) {
                x += STEPS[usize::from(*code)].0;
                y += STEPS[usize::from(*code)].1;
            }
            let got = libm::atan2(y as f64, x as f64).to_degrees();
            assert!((got - angle).abs() < 6.0, "{got}, not {angle}");
        }
    }
}
