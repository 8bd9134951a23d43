//! D8: each cell drains to its steepest lower neighbour.

use super::direction::{NONE, STEPS, hashed, one_of};
use super::outlets::Outlets;
use super::receivers::Receivers;
use crate::grid::Grid;
use rayon::prelude::*;

/// The neighbour to which each cell falls most steeply (O'Callaghan and Mark 1984): the drop, over square root of 2 on a
/// diagonal. Outlets, and cells without a lower neighbour, have none. Between equals a hash of the cell's place on the lattice
/// decides.
///
/// Costs O(cells); rows side by side.
pub fn receivers(heights: &Grid, outlets: &Outlets) -> Receivers {
    let mut receivers = Receivers::none(*heights.window());
    let window = *heights.window();
    if window.width < 3 || window.height < 3 {
        return receivers;
    }
    let rows = receivers.codes_mut().par_chunks_mut(window.width).enumerate();
    rows.filter(|(j, _)| *j > 0 && j + 1 < window.height).for_each(|(j, codes)| {
        let rows = [heights.row(j - 1), heights.row(j), heights.row(j + 1)];
        steepest_sets(rows, codes);
        let y = window.y + j as i64;
        for (i, (code, outlet)) in codes.iter_mut().zip(outlets.mask().row(j)).enumerate() {
            *code = if *outlet { NONE } else { chosen(*code, window.x + i as i64, y) };
        }
    });
    receivers
}

#[inline(always)]
fn chosen(set: u8, x: i64, y: i64) -> u8 {
    if set & set.wrapping_sub(1) == 0 { set.trailing_zeros() as u8 } else { one_of(set, hashed(x, y)) }
}

/// The set of directions of steepest descent of every inner cell of the middle row. The first and last are left as they are.
fn steepest_sets(rows: [&[f32]; 3], sets: &mut [u8]) {
    const DIAGONAL: f32 = std::f32::consts::FRAC_1_SQRT_2;
    let count = sets.len() - 2;
    let middle = &rows[1][1..=count];
    // Eight rows of neighbours, each as long as the row of middles: loops over equal slices become SIMD.
    let around = STEPS.map(|(east, south)| {
        let start = (1 + east) as usize;
        &rows[(1 + south) as usize][start..start + count]
    });
    let [e, se, s, sw, w, nw, n, ne] = around.map(|row| &row[..count]);
    for (i, set) in sets[1..=count].iter_mut().enumerate() {
        let h = middle[i];
        let drops = [
            h - e[i],
            (h - se[i]) * DIAGONAL,
            h - s[i],
            (h - sw[i]) * DIAGONAL,
            h - w[i],
            (h - nw[i]) * DIAGONAL,
            h - n[i],
            (h - ne[i]) * DIAGONAL,
        ];
        let most = drops.iter().fold(f32::MIN_POSITIVE, |most, drop| if *drop > most { *drop } else { most });
        let mut found = 0u32;
        for (k, drop) in drops.iter().enumerate() {
            found |= u32::from(*drop == most) << k;
        }
        *set = found as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::direction::{DISTANCES, neighbour, strides};
    use crate::hydrology::samples;

    #[test]
    fn no_neighbour_falls_more_steeply() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let receivers = receivers(&heights, &outlets);
            let (h, strides) = (heights.data(), strides(heights.width()));
            for (c, here) in h.iter().enumerate() {
                if outlets.at(c) {
                    assert_eq!(receivers.code(c), NONE);
                    continue;
                }
                let drops: Vec<f64> =
                    (0..8).map(|k| f64::from(here - h[neighbour(c, strides[k])]) / DISTANCES[k]).collect();
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
        let all = receivers(&heights, &Outlets::new(&heights, None));
        let part = Window::new(20, 15, 1.0).at(heights.window().x + 9, heights.window().y + 6);
        let cropped = heights.crop(&part).unwrap();
        let tile = receivers(&cropped, &Outlets::new(&cropped, None));
        for j in 1..14 {
            for i in 1..19 {
                assert_eq!(tile.code(j * 20 + i), all.code((j + 6) * 40 + i + 9));
            }
        }
    }
}
